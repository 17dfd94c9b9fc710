#include "sim/exchange/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace coif
{

static bool sound(glm::vec3 p)
{
    constexpr float kFarthest = 1e6f; // in any unit no hair is so far away
    return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
}

void drop_bad_strands(HairFile& file)
{
    Curves& c = file.curves;
    // Values that nobody can use are as if they were not there.
    if (!std::ranges::all_of(c.width, [](float w) { return w >= 0.0f && w <= 1e6f; }))
    {
        c.width.clear();
        file.remark.emplace_back("its widths are not all numbers from 0 on, and are not read");
    }
    if (!std::ranges::all_of(c.color, sound))
    {
        c.color.clear();
        file.remark.emplace_back("its colours are not all numbers, and are not read");
    }
    if (!std::ranges::all_of(c.root_uv, [](glm::vec2 uv) { return sound({uv, 0.0f}); }))
    {
        c.root_uv.clear();
        file.remark.emplace_back("its root UVs are not all numbers, and are not read");
    }
    Curves kept;
    kept.group_name = c.group_name;
    size_t single = 0, wild = 0, empty = 0, first = 0;
    for (size_t s = 0; s < c.strands(); ++s)
    {
        const size_t begin = first, count = c.count[s], end = begin + count;
        first = end;
        const auto points = c.position.begin() + long(begin);
        const bool all_sound = std::all_of(points, points + long(count), sound);
        const bool moves = std::any_of(points, points + long(count), [&](glm::vec3 p) { return p != points[0]; });
        single += count < 2;
        wild += count >= 2 && !all_sound;
        empty += count >= 2 && all_sound && !moves;
        if (count < 2 || !all_sound || !moves)
            continue;
        kept.count.push_back(uint32_t(count));
        kept.position.insert(kept.position.end(), points, points + long(count));
        if (!c.width.empty())
            kept.width.insert(kept.width.end(), c.width.begin() + long(begin), c.width.begin() + long(end));
        if (!c.color.empty())
            kept.color.insert(kept.color.end(), c.color.begin() + long(begin), c.color.begin() + long(end));
        const auto keep = [&](auto& to, const auto& from)
        {
            if (!from.empty())
                to.push_back(from[s]);
        };
        keep(kept.root_uv, c.root_uv);
        keep(kept.id, c.id);
        keep(kept.guide, c.guide);
        keep(kept.group, c.group);
    }
    c = std::move(kept);
    const auto say = [&](size_t strands, const char* why)
    {
        if (strands > 0)
            file.remark.push_back(fmt::format("{} of its strands {}, and are dropped", strands, why));
    };
    say(single, "have less than two points");
    say(wild, "have points that are no numbers, or lie beyond a million");
    say(empty, "have no length");
}

} // namespace coif
