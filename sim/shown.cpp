#include "sim/shown.h"

#include <fmt/format.h>

namespace coif
{

static constexpr size_t kLongFile = 200, kFileEnd = 80; // bytes

// How many bytes the letter takes that begins there; 0 where they are no UTF-8 (RFC 3629).
static size_t read_letter(std::string_view text, size_t at, char32_t& letter)
{
    const unsigned first = static_cast<unsigned char>(text[at]);
    const size_t length = first < 0x80   ? 1
                          : first < 0xc2 ? 0
                          : first < 0xe0 ? 2
                          : first < 0xf0 ? 3
                          : first < 0xf5 ? 4
                                         : 0;
    if (length == 0 || length > text.size() - at)
        return 0;
    letter = length == 1 ? first : first & (0x7fu >> length);
    for (size_t i = 1; i < length; ++i)
    {
        const unsigned next = static_cast<unsigned char>(text[at + i]);
        if ((next & 0xc0u) != 0x80u)
            return 0;
        letter = letter << 6 | (next & 0x3fu);
    }
    const bool longer_than_need_be = (length == 3 && letter < 0x800) || (length == 4 && letter < 0x10000);
    const bool surrogate = letter >= 0xd800 && letter <= 0xdfff;
    return longer_than_need_be || surrogate || letter > 0x10ffff ? 0 : length;
}

static bool is_plain(char32_t letter)
{
    const bool control = letter < 0x20 || (letter >= 0x7f && letter < 0xa0);
    const bool turns = (letter >= 0x202a && letter <= 0x202e) || (letter >= 0x2066 && letter <= 0x2069);
    const bool new_line = letter == 0x2028 || letter == 0x2029;
    return !control && !turns && !new_line;
}

std::string shown(std::string_view text, size_t most)
{
    std::string out;
    size_t at = 0;
    for (size_t letters = 0; at < text.size() && letters < most; ++letters)
    {
        char32_t letter = 0;
        const size_t length = read_letter(text, at, letter);
        if (length == 0)
            out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at]));
        else if (letter == '\n')
            out += "\\n";
        else if (!is_plain(letter))
            out += fmt::format("\\u{:04x}", unsigned(letter));
        else
            out += text.substr(at, length);
        at += length == 0 ? 1 : length;
    }
    return at < text.size() ? out + "..." : out;
}

std::string shown_file(const std::filesystem::path& file)
{
    const std::string name = file.string();
    if (name.size() <= kLongFile)
        return shown(name, kLongFile);
    size_t end = name.size() - kFileEnd;
    while (end < name.size() && (static_cast<unsigned char>(name[end]) & 0xc0u) == 0x80u)
        ++end; // within a letter
    const std::string_view all = name;
    return shown(all.substr(0, end)) + shown(all.substr(end));
}

} // namespace coif
