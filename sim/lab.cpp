#include "sim/lab.h"

#include "sim/error.h"
#include "sim/hairstyle.h"
#include "sim/solver.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace coif
{

static Groom hang(const LabStrand& strand, int copies)
{
    Groom groom;
    groom.nodes =
        strand.nodes + 1; // the first two of the kernels' are prescribed, and only their second is node 0 here
    groom.guides = copies;
    groom.blocks = (copies + LANES - 1) / LANES;
    groom.tip_mass = float(strand.tip_mass);
    groom.longest = float(strand.length);
    groom.extent = groom.farthest = float(strand.length);
    const size_t strands = size_t(groom.blocks) * LANES;
    groom.root_position.assign(strands * 3, 0.0f);
    groom.root_direction.assign(strands * 3, 0.0f);
    groom.segment_length.assign(strands, float(strand.length / (strand.nodes - 1)));
    for (int s = 0; s < groom.blocks * LANES; ++s)
    {
        groom.root_direction[size_t(strand_value(s, 0, 0, 1))] = float(std::sin(strand.angle));
        groom.root_direction[size_t(strand_value(s, 0, 1, 1))] = float(-std::cos(strand.angle));
    }
    return groom;
}

LabRun run_lab(const Device& device, const HairParams& authored, const LabStrand& strand, const RootPath& root,
               double seconds, double fps, int copies)
{
    const auto within = [](const char* what, double value, double low, double high)
    {
        if (!(value >= low && value <= high))
            throw fail("{} is {}, but must lie in [{}, {}]", what, value, low, high);
    };
    within("--nodes", strand.nodes, 2, 256);
    within("--length (m)", strand.length, 1e-6, 1e5);
    within("--tip-mass", strand.tip_mass, 1e-3, 1e3);
    within("--fps", fps, 1, 1e5);
    within("--seconds", seconds, 0, 3600);
    if (strand.gamma)
        within("--gamma", *strand.gamma, 1e-3, 1e6);

    HairParams params = authored;
    params.forces_repulsion = params.look_self_shadow = 0.0f;
    params.strand_spacing = 1.0f;
    params.bending_modulus = params.bending_attenuation = 0.0f;
    params.bending_droop = strand.gamma ? float(*strand.gamma) : INFINITY; // softer than any that bends
    if (!strand.gamma)
        params.solver_bending = 0.0f;
    Pose pose;
    pose.origin = root(0.0);
    Solver solver(device, params, hang(strand, copies), pose);

    LabRun run;
    const double rest = strand.length / (strand.nodes - 1);
    const auto look = [&](double t)
    {
        const Mapped view = solver.guide_positions();
        const float* x = view.as<float>();
        std::vector<glm::dvec3> nodes;
        for (int k = 1; k <= strand.nodes; ++k)
        {
            glm::dvec3 p;
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = double(x[strand_value(0, k, axis, strand.nodes + 1)]);
            nodes.push_back(p + solver.head().origin);
            if (k > 1)
                run.stretch =
                    std::max(run.stretch, std::abs(glm::distance(nodes.back(), nodes[nodes.size() - 2]) / rest - 1.0));
        }
        run.times.push_back(t);
        run.nodes.push_back(std::move(nodes));
    };
    look(0.0);
    const long frames = long(std::floor(seconds * fps + 1e-6));
    const int steps = std::max(1, int(std::ceil(60.0 / fps - 1e-9)));
    std::vector<double> spent;
    for (long f = 0; f < frames; ++f)
    {
        for (int i = 1; i <= steps; ++i)
        {
            const double h = 1.0 / (fps * steps), begin = double(f) / fps + (i - 1) * h;
            const auto way = [&](double share) { return Pose{root(begin + share * h), pose.turn, pose.wind}; };
            solver.step({{way(1.0), begin + h, float(h), way}});
        }
        double ms = 0.0;
        for (const auto& [pass, of_pass] : solver.take_times())
            ms += of_pass;
        spent.push_back(1e6 * ms / copies);
        look(double(f + 1) / fps);
    }
    if (!spent.empty())
    {
        std::nth_element(spent.begin(), spent.begin() + ptrdiff_t(spent.size() / 2), spent.end());
        run.nanoseconds = spent[spent.size() / 2];
    }
    return run;
}

RootRows load_root(const std::filesystem::path& file)
{
    constexpr size_t kMostRows = 1 << 20;
    const std::string text = read_file(file);
    RootRows rows;
    size_t begin = 0;
    for (int line = 1; begin < text.size(); ++line)
    {
        const size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view row(text.data() + begin, end - begin);
        begin = end + 1;
        while (!row.empty() && (row.back() == '\r' || row.back() == ' '))
            row.remove_suffix(1);
        if (row.empty())
            continue;
        double values[4];
        int count = 0;
        bool good = true;
        const char* at = row.data();
        const char* const stop = row.data() + row.size();
        while (good && count < 4)
        {
            while (at < stop && *at == ' ')
                ++at;
            const auto [next, fault] = std::from_chars(at, stop, values[count]);
            good = fault == std::errc() && std::isfinite(values[count]);
            at = next;
            while (at < stop && *at == ' ')
                ++at;
            ++count;
            if (good && count < 4)
            {
                good = at < stop && *at == ',';
                ++at;
            }
        }
        good = good && count == 4 && (at == stop || *at == ','); // further columns do not matter
        if (!good && line == 1)
            continue; // the header
        if (!good)
            throw fail("{}:{}: expected four finite numbers, t,x,y,z", file.string(), line);
        if (!rows.times.empty() && !(values[0] > rows.times.back()))
            throw fail("{}:{}: time {} does not come after {}", file.string(), line, values[0], rows.times.back());
        if (rows.times.size() >= kMostRows)
            throw fail("{}:{}: more than {} rows", file.string(), line, kMostRows);
        rows.times.push_back(values[0]);
        rows.points.push_back({values[1], values[2], values[3]});
    }
    if (rows.times.size() < 2)
        throw fail("{}: expected two rows t,x,y,z or more", file.string());
    return rows;
}

glm::dvec3 root_at(const RootRows& rows, double seconds)
{
    const std::vector<double>& t = rows.times;
    const std::vector<glm::dvec3>& p = rows.points;
    if (seconds <= t.front())
        return p.front();
    if (seconds >= t.back())
        return p.back();
    const size_t b = size_t(std::upper_bound(t.begin(), t.end(), seconds) - t.begin()), a = b - 1;
    // Tangents as the mean slope of both neighbours, weighed so that parabolas are met (unequal times too).
    const auto slope = [&](size_t i, size_t j) { return (p[j] - p[i]) / (t[j] - t[i]); };
    const auto tangent = [&](size_t i)
    {
        const size_t last = t.size() - 1;
        if (last == 1)
            return slope(0, 1);
        const size_t m = std::clamp<size_t>(i, 1, last - 1);
        const double before = t[m] - t[m - 1], after = t[m + 1] - t[m];
        const glm::dvec3 middle = (slope(m - 1, m) * after + slope(m, m + 1) * before) / (before + after);
        return i == m ? middle : i == 0 ? 2.0 * slope(0, 1) - middle : 2.0 * slope(last - 1, last) - middle;
    };
    const double h = t[b] - t[a], u = (seconds - t[a]) / h;
    const glm::dvec3 ta = tangent(a) * h, tb = tangent(b) * h;
    const double u2 = u * u, u3 = u2 * u;
    return p[a] * (2 * u3 - 3 * u2 + 1) + ta * (u3 - 2 * u2 + u) + p[b] * (3 * u2 - 2 * u3) + tb * (u3 - u2);
}

} // namespace coif
