#include "sim/cache_file.h"

#include "sim/hairstyle.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace coif
{

namespace fs = std::filesystem;

void write_cache_file(const fs::path& file, const std::string& bytes, size_t most)
{
    fs::create_directories(file.parent_path());
    std::vector<std::pair<fs::file_time_type, fs::path>> kept;
    for (const fs::directory_entry& entry : fs::directory_iterator(file.parent_path()))
        if (entry.path().extension() == file.extension() && entry.is_regular_file())
            kept.emplace_back(entry.last_write_time(), entry.path());
    std::sort(kept.begin(), kept.end());
    for (size_t i = 0; i + most <= kept.size(); ++i)
        fs::remove(kept[i].second);
    if (fs::is_symlink(file))
        fs::remove(file); // what it names is somebody's
    if (fs::exists(file) && !fs::is_regular_file(file))
        return; // a pipe would wait for a reader
    write_file(file, bytes);
}

} // namespace coif
