#pragma once
#include "app/batch/list.h"

#include <map>
#include <string>
#include <vector>

namespace coif
{

// What is in a batch's folder. A result is called 000104-KEY-DIGEST.png: the task's number, what it was made from, and
// what is in it. So it is known to be the right one, and to be as it was made, from its name alone: no state is kept
// beside it, and no clock is asked.

// Of a whole file, 16 hexadecimal digits. Throws Error when it cannot be read.
std::string digest_of_file(const std::filesystem::path& file);

struct NamedFile
{
    std::string text; // as it is named
    std::filesystem::path file;
};

// Every file that a command's words name, or the value of a --set among them, and those that such a file names (of a
// .toml or .gltf), each once.
std::vector<NamedFile> named_files(const std::vector<std::string>& words);

// What a task's result hangs on: its words, the files that they name, and `program`. All is read anew at each call.
// Throws Error.
std::string digest_of_program(); // its kernels, shaders, presets and assets too
std::string key_of(const Task& task, const std::string& program = digest_of_program());

std::string stem_of(const Task& task, const std::string& key); // "000104-KEY"

struct Found
{
    std::filesystem::path file;
    std::string digest; // as its name says
};

// Results by their stem. More than one of the same stem: the task does not make the same bytes everywhere.
std::map<std::string, std::vector<Found>> results_in(const std::filesystem::path& folder);

// Is the file what its name says?
bool is_whole(const Found& found);

// Where a task works until its result is whole: a folder in the batch's, of this process alone.
std::filesystem::path unfinished_folder(const std::filesystem::path& folder, const std::string& stem);

// Takes a whole result into its place, on the disk before it has its name. Throws Error.
void keep_result(const std::filesystem::path& made, const std::filesystem::path& folder, const std::string& stem,
                 const std::string& ending);

// Removes what runs that were killed left unfinished more than a day ago, but for those of this machine that live.
// Returns how many.
int remove_unfinished(const std::filesystem::path& folder);

} // namespace coif
