#include "app/batch/results.h"

#include "sim/hairstyle.h"
#include "sim/hash.h"
#include "sim/source.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <regex>
#include <set>
#include <unistd.h>

namespace coif
{

namespace fs = std::filesystem;

static std::string digits_of(const Hash& hash) { return fmt::format("{:016x}", hash.word[0] ^ hash.word[1]); }

static void add(Hash& hash, const std::string& text)
{
    const uint64_t size = text.size(); // where one ends and the next begins
    hash.add(&size, sizeof size);
    hash.add(text.data(), text.size());
}

static void add_file(Hash& hash, const fs::path& file)
{
    const int in = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    std::vector<char> block(1 << 16);
    for (size_t filled = 0; in >= 0;)
    {
        const ssize_t got = read(in, block.data() + filled, block.size() - filled);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            break;
        filled += size_t(got);
        if (got > 0 && filled < block.size())
            continue;
        hash.add(block.data(), filled);
        if (got == 0)
        {
            close(in);
            return;
        }
        filled = 0;
    }
    const std::string why = std::strerror(errno);
    if (in >= 0)
        close(in);
    throw fail("{}: cannot be read: {}", file.string(), why);
}

std::string digest_of_file(const fs::path& file)
{
    Hash hash;
    add_file(hash, file);
    return digits_of(hash);
}

std::string digest_of_program()
{
    Hash hash;
    static const std::string program = digest_of_file("/proc/self/exe"); // which cannot change while it runs
    add(hash, program);
    for (const char* part : {"kernels", "shaders", "hairstyles", "assets", "assets/motions"})
    {
        std::vector<fs::path> files;
        std::error_code error;
        for (const auto& entry : fs::directory_iterator(data_folder() / part, error))
            if (entry.is_regular_file(error) && entry.path().extension() != ".new")
                files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        for (const fs::path& file : files)
        {
            add(hash, file.filename().string());
            add_file(hash, file);
        }
    }
    return digits_of(hash);
}

static void gather(const toml::node& node, std::vector<std::string>& texts)
{
    if (const auto* text = node.as_string())
        texts.push_back(text->get());
    else if (const toml::table* table = node.as_table())
        for (const auto& [key, value] : *table)
            gather(value, texts);
    else if (const toml::array* array = node.as_array())
        for (const toml::node& value : *array)
            gather(value, texts);
}

// Whatever might be the name of another file.
static std::vector<std::string> texts_in(const fs::path& file)
{
    std::vector<std::string> texts;
    if (file.extension() == ".toml")
        try
        {
            const std::string text = read_file(file, 4 << 20);
            refuse_deep_keys(text, file);
            gather(toml::parse(text), texts);
        }
        catch (const std::exception&) // what is wrong with it, the task will tell
        {
        }
    if (file.extension() == ".gltf")
    {
        const std::string text = read_file(file, 256 << 20);
        // Bounded: a repetition is walked by recursion.
        static const std::regex uri("\"uri\"\\s{0,16}:\\s{0,16}\"([^\"]{1,255})\"");
        for (std::sregex_iterator i(text.begin(), text.end(), uri), end; i != end; ++i)
            texts.push_back((*i)[1]);
    }
    return texts;
}

namespace
{
struct Named
{
    std::vector<NamedFile> files = {};
    std::set<fs::path> seen = {};

    void add_named(const std::string& text, const std::vector<fs::path>& folders)
    {
        std::error_code error;
        if (text.empty() || text.size() > 4096 || text.find('\0') != text.npos)
            return;
        for (const fs::path& folder : folders)
        {
            const fs::path file = folder / text; // an absolute path replaces the folder
            if (!fs::is_regular_file(file, error) || !seen.insert(fs::weakly_canonical(file, error)).second)
                continue;
            files.push_back({text, file});
            for (const std::string& inner : texts_in(file))
                add_named(inner, {file.parent_path()});
        }
    }
};
} // namespace

std::vector<NamedFile> named_files(const std::vector<std::string>& words)
{
    // --set head.mesh=X is beside the style.
    Named named;
    std::vector<fs::path> folders = {"."};
    std::error_code error;
    for (const std::string& word : words)
        if (const fs::path folder = fs::path(word).parent_path(); !folder.empty() && fs::is_regular_file(word, error))
            folders.push_back(folder);
    for (const std::string& word : words)
    {
        named.add_named(word, folders);
        if (const size_t at = word.find('='); at != word.npos)
        {
            std::string value = word.substr(at + 1);
            if (const size_t inner = value.find('='); word.starts_with("--") && inner != value.npos)
                value = value.substr(inner + 1);
            if (value.size() > 1 && (value[0] == '"' || value[0] == '\'') && value.back() == value[0])
                value = value.substr(1, value.size() - 2);
            named.add_named(value, folders);
        }
    }
    return named.files;
}

std::string key_of(const Task& task, const std::string& program)
{
    Hash hash;
    add(hash, program);
    add(hash, task.name);
    for (const std::string& word : task.words)
        add(hash, word);
    for (const NamedFile& named : named_files(task.words))
    {
        add(hash, named.text);
        add_file(hash, named.file);
    }
    return digits_of(hash);
}

std::string stem_of(const Task& task, const std::string& key) { return fmt::format("{:06}-{}", task.number, key); }

std::map<std::string, std::vector<Found>> results_in(const fs::path& folder)
{
    static const std::regex shape("([0-9]{6,}-[0-9a-f]{16})-([0-9a-f]{16})\\.[^.]*");
    std::map<std::string, std::vector<Found>> results;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
    {
        const std::string name = entry.path().filename().string();
        std::smatch part;
        if (std::regex_match(name, part, shape))
            results[part[1]].push_back({entry.path(), part[2]});
    }
    for (auto& [stem, found] : results)
        std::ranges::sort(found, {}, &Found::file);
    return results;
}

bool is_whole(const Found& found)
{
    try
    {
        return fs::is_regular_file(found.file) && digest_of_file(found.file) == found.digest;
    }
    catch (const std::exception&)
    {
        return false;
    }
}

static std::string host_name()
{
    char name[256] = {};
    gethostname(name, sizeof name - 1);
    std::string host = name;
    for (char& c : host)
        if (!std::isalnum(static_cast<unsigned char>(c)))
            c = '-';
    return host;
}

fs::path unfinished_folder(const fs::path& folder, const std::string& stem)
{
    return folder / fmt::format("{}.{}.{}.tmp", stem, host_name(), getpid());
}

static void to_disk(const fs::path& file)
{
    const int opened = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    const int status = opened < 0 ? -1 : fsync(opened);
    const std::string why = std::strerror(errno);
    if (opened >= 0)
        close(opened);
    if (status != 0)
        throw fail("{}: cannot be written to the disk: {}", file.string(), why);
}

void keep_result(const fs::path& made, const fs::path& folder, const std::string& stem, const std::string& ending)
{
    to_disk(made);
    const fs::path file = folder / (stem + "-" + digest_of_file(made) + ending);
    std::error_code error;
    fs::rename(made, file, error);
    if (error)
        throw fail("{}: cannot be written: {}", file.string(), error.message());
    to_disk(folder);
}

int remove_unfinished(const fs::path& folder)
{
    static const std::regex shape("[0-9]{6,}-[0-9a-f]{16}\\.([^.]*)\\.([0-9]+)\\.tmp");
    int removed = 0;
    std::error_code error;
    const auto now = fs::file_time_type::clock::now();
    for (const auto& entry : fs::directory_iterator(folder, error))
    {
        const std::string name = entry.path().filename().string();
        std::smatch part;
        if (!std::regex_match(name, part, shape))
            continue;
        if (part[1] == host_name() && kill(pid_t(std::atol(part[2].str().c_str())), 0) == 0)
            continue;
        const auto written = fs::last_write_time(entry.path(), error);
        if (!error && now - written > std::chrono::hours(24) && fs::remove_all(entry.path(), error) > 0)
            ++removed;
    }
    return removed;
}

} // namespace coif
