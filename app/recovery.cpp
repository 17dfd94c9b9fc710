#include "app/recovery.h"

#include "sim/error.h"
#include "sim/hash.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace coif
{

namespace fs = std::filesystem;

static const char kFirstLine[] = "# coif: unsaved work on the hairstyle\n";
static const char kShapesFollow[] = "\n# coif: and the shapes of its strands\n";

// A lock on the file, which is made if `make`; -1 if another has it, or there is none.
static int locked(const fs::path& file, bool make)
{
    const int handle = ::open(file.c_str(), O_RDWR | O_CLOEXEC | (make ? O_CREAT : 0), 0600);
    struct stat mine, there;
    if (handle >= 0 && flock(handle, LOCK_EX | LOCK_NB) == 0 && fstat(handle, &mine) == 0 &&
        stat(file.c_str(), &there) == 0 && mine.st_ino == there.st_ino) // and nobody has removed it meanwhile
        return handle;
    if (handle >= 0)
        close(handle);
    return -1;
}

// "1234-0-89abcdef01234567.toml" -> "1234-0.lock"
static fs::path lock_of(const fs::path& kept)
{
    const std::string stem = kept.stem().string();
    return kept.parent_path() / (stem.substr(0, stem.rfind('-')) + ".lock");
}

static std::string time_text(const fs::path& file)
{
    struct stat status;
    if (stat(file.c_str(), &status) != 0)
        return {};
    const time_t now = std::time(nullptr);
    std::tm then = {}, today = {};
    localtime_r(&status.st_mtime, &then);
    localtime_r(&now, &today);
    char text[64];
    const bool same_day = then.tm_yday == today.tm_yday && then.tm_year == today.tm_year;
    return {text, std::strftime(text, sizeof text, same_day ? "%H:%M" : "%Y-%m-%d %H:%M", &then)};
}

// Its first line is said, the second names the hairstyle's file, and all that follows is the hairstyle; what else would
// lie in files beside that comes last.
static std::optional<Recovery> read_recovery(const fs::path& kept)
try
{
    const std::string bytes = read_file(kept, 256 << 20);
    const size_t begin = sizeof kFirstLine - 1, end = bytes.find('\n', begin);
    if (!bytes.starts_with(kFirstLine) || end == bytes.npos || bytes.compare(begin, 2, "# ") != 0)
        return std::nullopt;
    return Recovery{kept, bytes.substr(begin + 2, end - begin - 2), bytes.substr(end + 1), time_text(kept)};
}
catch (const std::exception&)
{
    return std::nullopt;
}

std::vector<Recovery> find_recoveries(const fs::path& folder)
{
    std::vector<std::pair<fs::file_time_type, Recovery>> found;
    std::error_code error;
    if (folder.empty())
        return {};
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
        files.push_back(entry.path());
    std::ranges::sort(files, [](const fs::path& a, const fs::path& b)
                      { return a.extension() < b.extension(); }); // what was half written and locks before the rest
    for (const fs::path& file : files)
    {
        const bool kept = file.extension() == ".toml";
        // "1234-0-89ab.toml.1234.new" was never finished.
        const bool unfinished = file.extension() == ".new";
        if (!kept && !unfinished)
            continue;
        const fs::path lock_file = lock_of(unfinished ? file.parent_path() / file.stem().stem() : file);
        const int lock = locked(lock_file, false);
        if (lock < 0 && fs::exists(lock_file, error))
            continue; // its editor lives
        if (unfinished)
            fs::remove(file, error);
        else if (std::optional<Recovery> recovery = read_recovery(file))
            found.emplace_back(fs::last_write_time(file, error), std::move(*recovery));
        if (lock >= 0)
            close(lock);
    }
    // Locks that nobody holds and that guard nothing any more.
    for (const fs::path& file : files)
    {
        const auto guards = [&](const auto& other) { return lock_of(other.second.kept) == file; };
        if (file.extension() != ".lock" || std::ranges::any_of(found, guards))
            continue;
        if (const int lock = locked(file, false); lock >= 0)
        {
            fs::remove(file, error);
            close(lock);
        }
    }
    std::ranges::stable_sort(found, [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<Recovery> recoveries;
    for (auto& [time, recovery] : found)
        recoveries.push_back(std::move(recovery));
    return recoveries;
}

Hairstyle recovered(const Recovery& recovery)
{
    const size_t shapes = recovery.text.rfind(kShapesFollow);
    if (shapes == std::string::npos)
        return parse_hairstyle(recovery.text, recovery.file);
    Hairstyle style = parse_hairstyle(recovery.text.substr(0, shapes), recovery.file, false);
    style.host.groom_rest.shapes = std::make_shared<const StrandShapes>(
        parse_shapes(recovery.text.substr(shapes + sizeof kShapesFollow - 1), recovery.kept.string()));
    return style;
}

void discard(const Recovery& recovery)
{
    std::error_code ignored;
    fs::remove(recovery.kept, ignored);
    fs::remove(lock_of(recovery.kept), ignored);
}

Autosave::Autosave(fs::path folder, std::chrono::milliseconds delay) : folder_(std::move(folder)), delay_(delay)
{
    static std::atomic<int> count = 0;
    lock_file_ = folder_ / fmt::format("{}-{}.lock", getpid(), count++);
    if (!folder_.empty())
        thread_ = std::thread([this] { write_in_turn(); });
}

Autosave::~Autosave()
{
    if (!thread_.joinable())
        return;
    {
        const std::lock_guard hold(mutex_);
        end_ = true;
    }
    news_.notify_all();
    thread_.join();
    if (lock_ < 0)
        return;
    std::error_code ignored;
    if (kept_.empty())
        fs::remove(lock_file_, ignored);
    close(lock_);
}

void Autosave::keep(const Hairstyle& style)
{
    {
        const std::lock_guard hold(mutex_);
        pending_ = style;
        clear_ = false;
    }
    news_.notify_all();
}

void Autosave::clear()
{
    {
        const std::lock_guard hold(mutex_);
        pending_.reset();
        clear_ = true;
    }
    news_.notify_all();
}

std::string Autosave::trouble()
{
    const std::lock_guard hold(mutex_);
    return std::exchange(trouble_, {});
}

static fs::path place_for(const fs::path& lock_file, const fs::path& style)
{
    std::error_code error;
    const std::string path = fs::weakly_canonical(style, error).string();
    Hash hash;
    hash.add(path.data(), path.size());
    return lock_file.parent_path() / fmt::format("{}-{:016x}.toml", lock_file.stem().string(), hash.word[0]);
}

void Autosave::write(const Hairstyle& style)
{
    const std::lock_guard hold(files_);
    const fs::path file = style.file.empty() ? fs::path() : fs::absolute(style.file);
    Hairstyle whole = style;
    for (ScalpMap& map : whole.host.maps)
        map.file.clear(); // values and all
    for (Region& region : whole.host.regions)
        region.file.clear();
    std::string text = kFirstLine + ("# " + file.string()) + "\n" + hairstyle_text(whole, style.file);
    if (style.host.groom_rest.shapes)
        text += kShapesFollow + shapes_text(*style.host.groom_rest.shapes);
    if (lock_ < 0)
    {
        make_folder(folder_);
        lock_ = locked(lock_file_, true);
        if (lock_ < 0)
            throw fail("{}: cannot be locked", lock_file_.string());
    }
    const fs::path place = place_for(lock_file_, style.file);
    write_file(place, text);
    std::error_code ignored;
    if (!kept_.empty() && kept_ != place)
        fs::remove(kept_, ignored);
    kept_ = place;
}

void Autosave::remove()
{
    const std::lock_guard hold(files_);
    std::error_code ignored;
    if (!kept_.empty())
        fs::remove(kept_, ignored);
    kept_.clear();
}

bool Autosave::take_over(const Recovery& recovery)
try
{
    const std::lock_guard hold(files_);
    if (lock_ < 0)
        lock_ = locked(lock_file_, true);
    const fs::path place = place_for(lock_file_, recovery.file);
    std::error_code error, ignored;
    if (lock_ < 0)
        return false;
    fs::rename(recovery.kept, place, error); // one of two that want it fails
    if (error)
        return false;
    fs::remove(lock_of(recovery.kept), ignored);
    if (!kept_.empty() && kept_ != place)
        fs::remove(kept_, ignored);
    kept_ = place;
    return true;
}
catch (const std::exception&)
{
    return false;
}

void Autosave::write_in_turn()
{
    std::unique_lock hold(mutex_);
    while (true)
    {
        news_.wait(hold, [&] { return pending_ || clear_ || end_; });
        if (clear_)
        {
            clear_ = false;
            hold.unlock();
            remove();
            hold.lock();
            continue;
        }
        if (!pending_) // the end, and nothing left to write
            return;
        // A drag changes the style with every frame; what it has come to by then is kept.
        news_.wait_for(hold, delay_, [&] { return clear_ || end_; });
        if (clear_ || !pending_)
            continue;
        const Hairstyle style = *std::exchange(pending_, std::nullopt);
        hold.unlock();
        std::string trouble;
        try
        {
            write(style);
        }
        catch (const std::exception& e)
        {
            trouble = e.what();
        }
        hold.lock();
        if (trouble.empty())
            continue;
        trouble_ = trouble;
        if (!pending_ && !clear_ && !end_)
        {
            // Again, until it can be kept or need not be.
            news_.wait_for(hold, 2 * delay_, [&] { return pending_ || clear_ || end_; });
            if (!pending_ && !clear_ && !end_)
                pending_ = style;
        }
    }
}

} // namespace coif
