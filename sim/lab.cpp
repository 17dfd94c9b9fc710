#include "sim/lab.h"

#include "sim/error.h"
#include "sim/hairstyle.h"
#include "sim/median.h"

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
    groom.tip_mass = strand.tip_held ? INFINITY : float(strand.tip_mass);
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

// Of one strand without bending unless gamma is given.
static HairParams checked(const HairParams& authored, const LabStrand& strand, double fps)
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
    if (strand.gamma)
        within("--gamma", *strand.gamma, 1e-3, 1e6);
    if (!strand.start.empty() && int(strand.start.size()) != strand.nodes)
        throw fail("a start for {} nodes, but the strand has {}", strand.start.size(), strand.nodes);
    if (strand.tip_held && authored.solver_kind != 0)
        throw fail("only the direct solver can hold a strand's tip");

    HairParams params = authored;
    params.forces_repulsion = params.look_self_shadow = 0.0f;
    params.strand_spacing = 1.0f;
    params.bending_modulus = params.bending_attenuation = 0.0f;
    params.bending_droop = strand.gamma ? float(*strand.gamma) : INFINITY; // softer than any that bends
    if (!strand.gamma)
        params.solver_bending = 0.0f;
    return params;
}

// The head's origin is the root: node 1 of the kernels'.
static void put(const Device& device, const Solver& solver, const std::vector<glm::dvec3>& start)
{
    if (start.empty())
        return;
    const Groom& groom = solver.groom();
    std::vector<float> position(size_t(groom.blocks) * LANES * size_t(groom.nodes) * 3);
    for (int s = 0; s < groom.blocks * LANES; ++s)
        for (int k = 0; k < groom.nodes; ++k)
            for (int axis = 0; axis < 3; ++axis)
            {
                const glm::dvec3 p = k > 0 ? start[size_t(k - 1)] : 2.0 * start[0] - start[1];
                position[size_t(strand_value(s, k, axis, groom.nodes))] = float(p[axis] - start[0][axis]);
            }
    write(device, solver.buffers().at("position"), position);
}

Lab::Lab(const Device& device, const HairParams& params, const LabStrand& strand, const RootPath& root, double fps,
         int copies)
    : device_(device), strand_(strand), root_(root), fps_(fps), copies_(copies),
      solver_(device, checked(params, strand, fps), hang(strand, copies), Pose{root(0.0), glm::dquat(1, 0, 0, 0), {}})
{
    put(device, solver_, strand.start);
}

double Lab::frame()
{
    const int steps = std::max(1, int(std::ceil(60.0 / fps_ - 1e-9)));
    for (int i = 1; i <= steps; ++i)
    {
        const double h = 1.0 / (fps_ * steps), begin = double(frames_) / fps_ + (i - 1) * h;
        const auto way = [&](double share) {
            return Pose{root_(begin + share * h), solver_.head().turn, solver_.head().wind};
        };
        solver_.keep_awake();
        solver_.step({{way(1.0), begin + h, float(h), way}});
    }
    ++frames_;
    return 1e6 * sum_of(solver_.take_times()) / copies_;
}

void Lab::look(LabRun& run) const
{
    const Mapped position = solver_.guide_positions(),
                 velocity(device_, solver_.buffers().at("velocity"), position.bytes());
    const double rest = strand_.length / (strand_.nodes - 1);
    const auto first = [&](const Mapped& from, int k) { return vector_at(from.as<float>(), 0, k, strand_.nodes + 1); };
    std::vector<glm::dvec3> nodes, velocities;
    for (int k = 1; k <= strand_.nodes; ++k)
    {
        nodes.push_back(first(position, k) + solver_.head().origin);
        velocities.push_back(first(velocity, k));
        if (k > 1)
            run.stretch =
                std::max(run.stretch, std::abs(glm::distance(nodes.back(), nodes[nodes.size() - 2]) / rest - 1.0));
    }
    run.times.push_back(double(frames_) / fps_);
    run.nodes.push_back(std::move(nodes));
    run.velocities.push_back(std::move(velocities));
}

LabRun run_lab(const Device& device, const HairParams& params, const LabStrand& strand, const RootPath& root,
               double seconds, double fps, int copies)
{
    constexpr double kMostPositions = 1e7; // half a gigabyte, and as much again as text
    if (!(seconds >= 0.0 && seconds <= 3600.0))
        throw fail("--seconds is {}, but must lie in [0, 3600]", seconds);
    if (seconds * fps * strand.nodes > kMostPositions)
        throw fail("{} s at {} frames a second of {} nodes are more than the {} positions that a run may hold; ask for "
                   "fewer --seconds, --fps or --nodes",
                   seconds, fps, strand.nodes, kMostPositions);
    Lab lab(device, params, strand, root, fps, copies);
    LabRun run;
    lab.look(run);
    std::vector<double> spent;
    for (long f = 0; f < long(std::floor(seconds * fps + 1e-6)); ++f)
    {
        spent.push_back(lab.frame());
        lab.look(run);
    }
    run.nanoseconds = median(spent);
    return run;
}

RootRows load_root(const std::filesystem::path& file)
{
    constexpr size_t kMostRows = 1 << 20;
    constexpr double kFurthest = 1e6, kClosest = 1e-6; // m, s: between rows, slopes stay far from overflowing
    const std::string text = read_file(file);
    RootRows rows;
    size_t begin = text.starts_with("\xef\xbb\xbf") ? 3 : 0; // spreadsheets mark UTF-8 so
    for (int line = 1; begin < text.size(); ++line)
    {
        const size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view row(text.data() + begin, end - begin);
        begin = end + 1;
        while (!row.empty() && (row.back() == '\r' || row.back() == ' '))
            row.remove_suffix(1);
        while (!row.empty() && row.front() == ' ')
            row.remove_prefix(1);
        if (row.empty())
            continue;
        double values[4];
        if (line == 1 && std::from_chars(row.data(), row.data() + row.size(), values[0]).ec != std::errc())
            continue; // the header
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
        if (!good)
            throw fail("{}:{}: expected four finite numbers, t,x,y,z", file.string(), line);
        if (!rows.times.empty() && !(values[0] > rows.times.back()))
            throw fail("{}:{}: time {} does not come after {}", file.string(), line, values[0], rows.times.back());
        if (!rows.times.empty() && values[0] - rows.times.back() < kClosest)
            throw fail("{}:{}: time {} comes less than a microsecond after {}", file.string(), line, values[0],
                       rows.times.back());
        if (std::max({std::abs(values[1]), std::abs(values[2]), std::abs(values[3])}) > kFurthest)
            throw fail("{}:{}: a root further than {} m from the origin", file.string(), line, kFurthest);
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
