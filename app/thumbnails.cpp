#include "app/thumbnails.h"

#include "app/watch.h"
#include "sim/error.h"
#include "sim/hairstyle.h"
#include "sim/source.h"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace coif
{

namespace fs = std::filesystem;
using namespace std::chrono_literals;

static constexpr int kVersion = 1;           // of what a thumbnail shows
static constexpr auto kLongest = 300s;       // that a picture may take
static constexpr auto kLookEvery = 1s;       // at the files that pictures are of
static constexpr size_t kMostPictures = 500; // kept

fs::path coif_program()
{
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error), beside = self.parent_path() / "coif";
    return fs::exists(beside, error) ? beside : self;
}

Thumbnails::Thumbnails(fs::path folder, fs::path program, std::string device)
    : folder_(std::move(folder)), program_(std::move(program)), device_(std::move(device))
{
}

Thumbnails::~Thumbnails()
{
    if (child_ <= 0)
        return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
}

Hash Thumbnails::hash_of(const fs::path& file)
{
    const auto time = written_at(file);
    const auto known = hashes_.find(file);
    if (known != hashes_.end() && known->second.first == time)
        return known->second.second;
    const std::string bytes = read_file(file);
    Hash hash;
    hash.add(bytes.data(), bytes.size());
    hashes_[file] = {time, hash};
    return hash;
}

void Thumbnails::find_key(const fs::path& style, Entry& entry)
{
    entry.files = {{style, written_at(style)}};
    Hash key;
    const auto add = [&](const fs::path& file)
    {
        const Hash hash = hash_of(file);
        key.add(hash.word, sizeof hash.word);
    };
    const Hairstyle hair = load_hairstyle(style);
    const int version[2] = {kVersion, kSize};
    key.add(version, sizeof version);
    add(style);
    for (const ParamInfo& info : param_table())
    {
        if (info.kind != Kind::TEXT)
            continue;
        const auto& named =
            *reinterpret_cast<const std::string*>(reinterpret_cast<const char*>(&hair.host) + info.offset);
        if (named.empty())
            continue;
        const fs::path file = named_file(hair, info.path(), named);
        entry.files[file] = written_at(file);
        add(file);
    }
    for (const fs::path& file : files_beside(hair))
    {
        entry.files[file] = written_at(file);
        add(file);
    }
    for (const char* folder : {"kernels", "shaders"})
    {
        std::vector<fs::path> sources;
        for (const fs::directory_entry& source : fs::directory_iterator(data_folder() / folder))
            if (source.is_regular_file())
                sources.push_back(source.path());
        std::ranges::sort(sources);
        for (const fs::path& source : sources)
            add(source);
    }
    const std::string fresh = fmt::format("{:016x}{:016x}", key.word[0], key.word[1]);
    if (fresh == entry.key && entry.state != Entry::FAILED)
        return;
    entry.key = fresh;
    entry.tried = false;
    entry.state = Entry::WAITING; // what is shown stays until there is something newer
}

bool Thumbnails::read_kept(Entry& entry)
try
{
    Image image = load_png(place(entry, ".png"));
    if (image.width != kSize || image.height != kSize)
        return false;
    entry.image = std::move(image);
    entry.state = Entry::DRAWN;
    ++entry.version;
    return true;
}
catch (const std::exception&)
{
    return false; // none, or a spoilt one
}

const Thumbnails::Entry& Thumbnails::of(const fs::path& style)
{
    Entry& entry = entries_[style];
    entry.wanted = calls_;
    return entry;
}

// The oldest go.
static void make_room(const fs::path& folder)
{
    std::vector<std::pair<fs::file_time_type, fs::path>> kept;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".png" && entry.is_regular_file())
            kept.emplace_back(entry.last_write_time(), entry.path());
    std::ranges::sort(kept);
    for (size_t i = 0; i + kMostPictures <= kept.size(); ++i)
        fs::remove(kept[i].second);
}

void Thumbnails::draw(const fs::path& style, Entry& entry)
{
    make_folder(folder_);
    make_room(folder_);
    const std::string picture = place(entry, ".png").string(), words = place(entry, ".txt").string();
    const std::string size = fmt::format("{0}x{0}", kSize);
    std::error_code error;
    std::vector<std::string> line = {
        program_.string(), "shot", fs::absolute(style).string(), "-o", picture, "--size", size, "--samples", "4",
        "--time",          "0.5"};
    if (!device_.empty())
        line.insert(line.end(), {"--device", device_});
    std::vector<char*> arguments;
    for (const std::string& word : line)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, words.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int failed = posix_spawn(&child_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed)
    {
        child_ = 0;
        throw fail("{} cannot be started: {}", program_.string(), std::strerror(failed));
    }
    setpriority(PRIO_PROCESS, id_t(child_), 5);
    since_ = std::chrono::steady_clock::now();
    drawing_ = style;
    drawing_key_ = entry.key;
    entry.tried = true;
}

// True when it has come to an end.
bool Thumbnails::look_after_child()
{
    int status = 0;
    const bool late = std::chrono::steady_clock::now() - since_ > kLongest;
    if (late)
        kill(child_, SIGKILL);
    const pid_t ended = waitpid(child_, &status, late ? 0 : WNOHANG);
    if (ended == 0)
        return false;
    child_ = 0;
    Entry& entry = entries_[drawing_];
    const fs::path words = folder_ / (drawing_key_ + ".txt");
    if (entry.key == drawing_key_ && entry.state == Entry::WAITING && !read_kept(entry))
    {
        entry.state = Entry::FAILED;
        ++entry.version;
        try
        {
            entry.why = read_file(words, 1 << 16);
        }
        catch (const Error&)
        {
            entry.why.clear();
        }
        if (late)
            entry.why = "it took too long to draw";
        if (entry.why.empty())
            entry.why = "coif ended without a picture of it";
    }
    std::error_code ignored;
    fs::remove(words, ignored);
    return true;
}

bool Thumbnails::work()
{
    ++calls_;
    bool changed = child_ > 0 && look_after_child();
    const auto now = std::chrono::steady_clock::now();
    const bool look = now - looked_ > kLookEvery;
    if (look)
        looked_ = now;
    // What is on screen first.
    std::vector<std::pair<long, fs::path>> order;
    for (const auto& [style, entry] : entries_)
        order.emplace_back(-entry.wanted, style);
    std::ranges::sort(order);
    for (const auto& [wanted, style] : order)
    {
        Entry& entry = entries_[style];
        const auto moved = [&] {
            return std::ranges::any_of(entry.files,
                                       [](const auto& file) { return written_at(file.first) != file.second; });
        };
        try
        {
            if ((entry.key.empty() && entry.state != Entry::FAILED) || (look && moved()))
                find_key(style, entry);
            if (entry.state != Entry::WAITING)
                continue;
            if (read_kept(entry))
                return true; // one a call: the window goes on
            if (child_ > 0)
                continue;
            if (entry.tried)
                throw fail("it cannot be kept in {}", folder_.string());
            draw(style, entry);
            return changed;
        }
        catch (const std::exception& e) // a broken style, or a folder that cannot be written
        {
            entry.state = Entry::FAILED;
            entry.why = e.what();
            ++entry.version;
            changed = true;
        }
    }
    return changed;
}

} // namespace coif
