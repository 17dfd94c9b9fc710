#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace coif
{

// What one does with hairstyle files in a folder without opening them. A file is never written over and never deleted:
// it goes to the folder `trash` inside its own. All throw Error, and then nothing has changed.

std::vector<std::filesystem::path> hairstyles_in(const std::filesystem::path& folder); // in alphabetical order

// Those of which the name contains the filter, upper and lower case alike.
std::vector<std::filesystem::path> filtered(const std::vector<std::filesystem::path>& files, const std::string& filter);

// Each returns the file that there is now. A name is one without folder and ending.
std::filesystem::path new_hairstyle(const std::filesystem::path& folder, const std::string& name);
std::filesystem::path duplicate_hairstyle(const std::filesystem::path& file, const std::string& name);
std::filesystem::path rename_hairstyle(const std::filesystem::path& file, const std::string& name);
std::filesystem::path trash_hairstyle(const std::filesystem::path& file);

// "bob" -> "bob-2", or the first number of which there is no hairstyle in the folder yet.
std::string unused_hairstyle(const std::filesystem::path& folder, const std::string& name);

} // namespace coif
