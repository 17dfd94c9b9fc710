#pragma once
#include "sim/hairstyle.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

namespace coif
{

// When a file was last written, as far as can be told.
std::filesystem::file_time_type written_at(const std::filesystem::path& file);

// The files that a style keeps beside its own and writes with it: its rest shape, large maps and painted regions.
std::vector<std::filesystem::path> files_beside(const Hairstyle& style);

// Which files have changed on disk. Looks at them now and then instead of asking the system to tell: that is the same
// on every file system, sees files that vanish and come back, and a hundred looks take less than a millisecond.
class Watch
{
  public:
    // What to look at from now on; files that are new to it count as known as they are.
    void set(const std::vector<std::filesystem::path>& files);
    // Looks. Those that are otherwise than they were known: vanished, come back or written. What changes from one look
    // to the next waits for another, so that half a file is not read.
    std::vector<std::filesystem::path> changed();
    // As it is now it is known: we have written or read it ourselves.
    void know(const std::filesystem::path& file);

  private:
    struct Stamp
    {
        bool there = false;
        int64_t seconds = 0, nanoseconds = 0, bytes = 0;
        uint64_t inode = 0;
        bool operator==(const Stamp&) const = default;
    };
    struct Entry
    {
        Stamp known, seen;
    };
    static Stamp stamp_of(const std::filesystem::path& file);

    std::map<std::filesystem::path, Entry> files_;
};

} // namespace coif
