#pragma once
#include <filesystem>
#include <string>

namespace coif
{

// Runs gnuplot on a script in a folder, both paths from there; its words are added to the file `words`. Returns its
// exit status, or -1 if it is not installed. Throws Error if the system takes no more processes.
int run_gnuplot(const std::filesystem::path& folder, const std::string& script, const std::string& words);

} // namespace coif
