#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

namespace coif
{

// Writes a file of a cache, with its folder. Of those with its extension there as many stay as make `most` with it, the
// latest. Leaves alone what is neither a file nor a link of its name. Throws std::exception where it cannot.
void write_cache_file(const std::filesystem::path& file, const std::string& bytes, size_t most);

} // namespace coif
