#pragma once
#include <string>
#include <vector>

namespace coif
{

// Lines of cells as text, columns as wide as they need: words in those named, by their index, lean to the left, numbers
// in the others to the right. An empty line stays one.
std::string aligned(const std::vector<std::vector<std::string>>& lines, const std::vector<size_t>& words);

} // namespace coif
