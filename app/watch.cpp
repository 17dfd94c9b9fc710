#include "app/watch.h"

#include <sys/stat.h>
#include <utility>

namespace coif
{

namespace fs = std::filesystem;

Watch::Stamp Watch::stamp_of(const fs::path& file)
{
    struct stat status;
    if (stat(file.c_str(), &status) != 0)
        return {};
    return {true, status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_size, status.st_ino};
}

void Watch::set(const std::vector<fs::path>& files)
{
    std::map<fs::path, Entry> wanted;
    for (const fs::path& file : files)
        if (const auto known = files_.find(file); known != files_.end())
            wanted.insert(*known);
        else
        {
            const Stamp now = stamp_of(file);
            wanted[file] = {now, now};
        }
    files_ = std::move(wanted);
}

std::vector<fs::path> Watch::changed()
{
    std::vector<fs::path> changed;
    for (auto& [file, entry] : files_)
    {
        const Stamp now = stamp_of(file), before = std::exchange(entry.seen, now);
        if (now == entry.known || now != before)
            continue;
        entry.known = now;
        changed.push_back(file);
    }
    return changed;
}

void Watch::know(const fs::path& file)
{
    if (const auto entry = files_.find(file); entry != files_.end())
        entry->second.known = entry->second.seen = stamp_of(file);
}

} // namespace coif
