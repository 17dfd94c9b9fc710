// What somebody wrote, as errors quote it: short, and such that a terminal does nothing with it but to print it.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace coif
{

// Of a long text the first letters and dots. Control characters, those that turn the direction of writing, and bytes
// that are no UTF-8 are written as escapes.
std::string shown(std::string_view text, size_t most = 80);

// A file's name in the same way; of one that is longer than people's are, the beginning and the end.
std::string shown_file(const std::filesystem::path& file);

} // namespace coif
