#include "app/table.h"

#include <fmt/format.h>

#include <algorithm>

namespace coif
{

std::string aligned(const std::vector<std::vector<std::string>>& lines, const std::vector<size_t>& words)
{
    std::vector<size_t> width;
    for (const auto& line : lines)
        for (size_t c = 0; c < line.size(); ++c)
        {
            width.resize(std::max(width.size(), c + 1));
            width[c] = std::max(width[c], line[c].size());
        }
    std::string out;
    for (const auto& line : lines)
    {
        std::string text;
        for (size_t c = 0; c < line.size(); ++c)
            text += std::ranges::count(words, c) ? fmt::format("{:<{}}  ", line[c], width[c])
                                                 : fmt::format("{:>{}}  ", line[c], width[c]);
        text.erase(text.find_last_not_of(' ') + 1);
        out += text + "\n";
    }
    return out;
}

} // namespace coif
