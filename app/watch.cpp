#include "app/watch.h"

#include <sys/stat.h>
#include <utility>

namespace coif
{

namespace fs = std::filesystem;

fs::file_time_type written_at(const fs::path& file)
{
    std::error_code error;
    const auto time = fs::last_write_time(file, error);
    return error ? fs::file_time_type::min() : time;
}

std::vector<fs::path> files_beside(const Hairstyle& style)
{
    std::vector<fs::path> files;
    const auto add = [&](const std::string& name)
    {
        if (!name.empty())
            files.push_back(style.file.parent_path() / name);
    };
    add(style.host.groom_rest.file);
    for (const Region& region : style.host.regions)
        add(region.file);
    for (const ScalpMap& map : style.host.maps)
        add(map.file);
    return files;
}

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
