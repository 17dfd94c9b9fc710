#pragma once
#include "sim/hairstyle.h"

namespace coif
{

// Where the cheaper style of a file goes: NAME.lean.toml beside it. A preset that was asked for by its bare name has
// its in the current folder.
std::filesystem::path lean_path(const std::string& asked, const std::filesystem::path& file);

// Throws Error unless `target` can be written: its folder is there and writable, and the file is new, or one that
// write_lean() wrote and nobody has changed since.
void check_lean(const std::filesystem::path& target);

// Saves `lean` as save_hairstyle() does, the comments of the file it comes from in their places, with a last line that
// says who wrote it from what and holds a sum of all before it. Throws Error as check_lean() and save_hairstyle() do.
void write_lean(const Hairstyle& lean, const std::filesystem::path& target);

} // namespace coif
