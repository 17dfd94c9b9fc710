#include "app/presets.h"

#include "app/watch.h"
#include "sim/error.h"
#include "sim/hairstyle.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

namespace coif
{

namespace fs = std::filesystem;

std::vector<fs::path> hairstyles_in(const fs::path& folder)
{
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().extension() == ".toml" && entry->is_regular_file(error))
            files.push_back(entry->path());
    std::ranges::sort(files);
    return files;
}

static std::string lower(std::string text)
{
    for (char& c : text)
        c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::vector<fs::path> filtered(const std::vector<fs::path>& files, const std::string& filter)
{
    std::vector<fs::path> kept;
    for (const fs::path& file : files)
        if (lower(file.stem().string()).find(lower(filter)) != std::string::npos)
            kept.push_back(file);
    return kept;
}

// Where a hairstyle of that name would lie, if it may be called so and there is none yet.
static fs::path free_place(const fs::path& folder, const std::string& name)
{
    const bool odd = std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    if (name.empty() || name[0] == '.' || name.find('/') != name.npos || odd || name.size() > 200)
        throw fail("'{}' is no name for a hairstyle: it must be short, must not begin with a dot and must hold no '/'",
                   name);
    const fs::path place = folder / (name + ".toml");
    std::error_code error;
    if (fs::exists(fs::symlink_status(place, error)))
        throw fail("{}: there is a hairstyle of that name already", place.string());
    return place;
}

// Unlike rename(2), leaves what is there by the time.
static void move(const fs::path& from, const fs::path& to)
{
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0)
        return;
    std::error_code error;
    if ((errno == EINVAL || errno == ENOSYS) && !fs::exists(to, error)) // a file system that does not know this
        fs::rename(from, to, error);
    else
        error.assign(errno, std::system_category());
    if (error)
        throw fail("{}: cannot become {}: {}", from.string(), to.string(), error.message());
}

// A new file with these bytes, whole or not at all.
static void make(const fs::path& place, const std::string& bytes)
{
    const fs::path beside = place.string() + fmt::format(".{}.new", getpid());
    write_file(beside, bytes);
    try
    {
        move(beside, place);
    }
    catch (...)
    {
        std::error_code ignored;
        fs::remove(beside, ignored);
        throw;
    }
}

fs::path new_hairstyle(const fs::path& folder, const std::string& name)
{
    const fs::path place = free_place(folder, name);
    make(place, fmt::format("# {}\n\n[strand]\nlength = 0.25\n", name));
    return place;
}

fs::path duplicate_hairstyle(const fs::path& file, const std::string& name)
{
    const fs::path place = free_place(file.parent_path(), name);
    make(place, read_file(file, 4 << 20));
    try
    {
        Hairstyle style = load_hairstyle(file);
        if (!files_beside(style).empty())
            save_hairstyle(style, place); // with copies of what lies beside it
    }
    catch (const Error&)
    {
        // A broken one is copied as it is.
    }
    return place;
}

fs::path rename_hairstyle(const fs::path& file, const std::string& name)
{
    const fs::path place = free_place(file.parent_path(), name);
    move(file, place);
    return place;
}

std::string unused_hairstyle(const fs::path& folder, const std::string& name)
{
    std::error_code error;
    for (int n = 2;; ++n)
        if (const std::string free = fmt::format("{}-{}", name, n);
            !fs::exists(fs::symlink_status(folder / (free + ".toml"), error)))
            return free;
}

fs::path trash_hairstyle(const fs::path& file)
{
    const fs::path trash = file.parent_path() / "trash";
    make_folder(trash);
    std::error_code error;
    fs::path place = trash / file.filename();
    if (fs::exists(fs::symlink_status(place, error)))
        place = trash / (unused_hairstyle(trash, file.stem().string()) + ".toml");
    move(file, place);
    return place;
}

} // namespace coif
