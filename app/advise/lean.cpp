#include "app/advise/lean.h"

#include "sim/error.h"

#include <cstdint>
#include <unistd.h>

namespace coif
{

namespace fs = std::filesystem;

static const std::string kMark = "# Written by coif advise, which may write it again while this sum is true: ";

// FNV-1a, 64 bits (Fowler, Noll, Vo 1991).
static std::string sum_of(const std::string& text)
{
    uint64_t sum = 0xcbf29ce484222325u;
    for (const char c : text)
        sum = (sum ^ uint8_t(c)) * 0x100000001b3u;
    return fmt::format("{:016x}", sum);
}

static bool is_own(const std::string& text)
{
    const size_t mark = text.rfind(kMark);
    return mark != text.npos && text.substr(mark) == kMark + sum_of(text.substr(0, mark)) + "\n";
}

fs::path lean_path(const std::string& asked, const fs::path& file)
{
    std::error_code error;
    const fs::path name = file.stem().string() + ".lean.toml";
    return fs::exists(asked, error) ? file.parent_path() / name : name;
}

void check_lean(const fs::path& target)
{
    const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        throw fail("{}: cannot be written; is its folder there, and writable?", target.string());
    std::error_code error;
    if (fs::exists(target, error) && !(fs::is_regular_file(target, error) && is_own(read_file(target, 4 << 20))))
        throw fail("{}: is there already, and not as coif advise wrote it; name another file with -o", target.string());
}

void write_lean(const Hairstyle& lean, const fs::path& target)
{
    check_lean(target);
    std::string text = hairstyle_text(lean, target);
    if (!text.empty() && text.back() != '\n')
        text += '\n';
    text += kMark + sum_of(text) + "\n";
    parse_hairstyle(text, target); // what is written can be read
    write_file(target, text);
}

} // namespace coif
