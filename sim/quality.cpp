#include "sim/quality.h"

#include "sim/error.h"
#include "sim/scatter.h"
#include "sim/simulation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace coif
{

// ---- sixteen guides, moved at several finenesses -----------------------------------------------------------------

static Groom sample(const Groom& all)
{
    Groom few = all;
    few.guides = LANES;
    few.blocks = 1;
    few.drawn.clear();
    few.drawn_multi = 0;
    few.hold = 0.0f;
    const auto pick = [&](const std::vector<float>& from, int nodes, int axes)
    {
        std::vector<float> to;
        if (from.empty())
            return to;
        to.resize(size_t(nodes * axes) * LANES);
        for (int s = 0; s < LANES; ++s)
        {
            const int g = int(long(s) * all.guides / LANES);
            for (int i = 0; i < nodes * axes; ++i)
                to[size_t(i * LANES + s)] = from[size_t((g / LANES * nodes * axes + i) * LANES + g % LANES)];
        }
        return to;
    };
    few.root_position = pick(all.root_position, 1, 3);
    few.root_direction = pick(all.root_direction, 1, 3);
    few.segment_length = pick(all.segment_length, 1, 1);
    few.natural_position = pick(all.natural_position, all.nodes, 3);
    few.bend_factor = pick(all.bend_factor, 1, 1);
    few.rest_position.clear();
    few.rest_multiplier.clear();
    few.looks.clear();
    few.held.clear(); // as if no ring held them: what swings behind one swings so
    few.tied.clear();
    few.tails.clear();
    return few;
}

static HairParams alone(HairParams params)
{
    params.forces_repulsion = params.look_self_shadow = 0.0f;
    return params;
}

// Lets the sample hang still, so that what follows is the motion's doing.
static void hang(const Device& device, const HairParams& params, Groom& groom)
{
    HairParams thick = params;
    thick.forces_drag = std::max(thick.forces_drag, 15.0f);
    Solver solver(device, thick, groom, {});
    for (int i = 0; i < 180; ++i)
        solver.step({{Pose{}, 0.0, 1.0f / 60.0f}});
    const Mapped position = solver.guide_positions();
    groom.rest_position = in_head_frame(position.as<float>(), groom, {1.0, 0.0, 0.0, 0.0});
    groom.rest_multiplier = solver.multipliers();
}

struct Sampled
{
    std::vector<float> positions; // frame after frame, as the solver lays them
    double nanoseconds = 0.0;     // a strand and step
    int most_substeps = 1;        // of a step, at its end
};

// Each step cut into `finer` ones, at as many times smaller a Courant number: as many substeps each, `finer` times as
// many in all.
static Sampled move(const Device& device, HairParams params, const Groom& groom, const Motion& motion, double seconds,
                    int finer)
{
    params.solver_courant /= float(finer);
    Solver solver(device, params, groom, pose_at(motion, 0.0));
    Sampled sampled;
    const double step = 1.0 / std::max(60.0, double(params.solver_rate)), h = step / finer;
    const long steps = std::lround(seconds / step), values = long(groom.nodes) * 3 * LANES;
    for (long i = 0; i < steps; ++i)
    {
        for (int j = 0; j < finer; ++j)
        {
            const double begin = double(i) * step + j * h;
            const auto way = [&](double share) { return pose_at(motion, begin + share * h); };
            solver.step({{way(1.0), begin + h, float(h), way}});
        }
        sampled.nanoseconds += 1e6 * sum_of(solver.take_times()) / double(steps * LANES);
        const Mapped view = solver.guide_positions();
        sampled.positions.insert(sampled.positions.end(), view.as<float>(), view.as<float>() + values);
    }
    sampled.most_substeps = substeps_of(read<int>(device, solver.buffers().at("pace"), 1)[0] - 1);
    return sampled;
}

// Root mean square distance of the nodes, in lengths of the longest strand.
static double apart(const Sampled& a, const Sampled& b, const Groom& groom)
{
    double sum = 0.0;
    for (size_t i = 0; i < a.positions.size(); ++i)
        sum += std::pow(double(a.positions[i]) - double(b.positions[i]), 2);
    // Three values a node, of which the first two are prescribed.
    const double nodes = double(a.positions.size()) / 3.0 * (groom.nodes - 2) / groom.nodes;
    return std::sqrt(sum / nodes) / double(groom.longest);
}

double measure_time_error(const Device& device, const HairParams& params, const Groom& groom, const Motion& motion,
                          double seconds)
{
    Groom few = sample(groom);
    const HairParams p = alone(params);
    hang(device, p, few);
    return apart(move(device, p, few, motion, seconds, 1), move(device, p, few, motion, seconds, 8), few);
}

double measure_thin_error(const Device& device, const HairParams& params, const Solver& hair)
{
    constexpr int kBlocks = 16, kStill = 30, kSteps = 180;
    constexpr double kStep = 1.0 / 60.0;
    constexpr double kElsewhere = 1.25; // other seconds of a shake err by up to 1.2 times as much
    const Motion motion = find_motion("shake");
    HairParams p = params;
    p.look_self_shadow = 0.0f;
    p.solver_far_tolerance = find_param("solver.far_tolerance")->max;
    const Groom groom = some_blocks(hair.groom(), kBlocks);
    Solver all(device, p, groom, pose_at(motion, 0.0)), thin(device, p, groom, pose_at(motion, 0.0));
    for (Solver* each : {&all, &thin})
    {
        each->set_body(hair.body());
        each->set_colliders(hair.colliders());
    }
    thin.let_blocks_sleep(true);
    thin.set_view(View{{0.0, 0.0, 1e6}, {0.0, 0.0, -1.0}, 1.0});
    thin.set_thin_error(0.0);
    const std::vector<FarBlock> blocks = far_blocks(params, groom);
    std::vector<double> in_block(blocks.size(), 0.0);
    double worst2 = 0.0;
    for (int i = 0; i < kSteps; ++i)
    {
        const double begin = std::max(0, i - kStill) * kStep, more = i < kStill ? 0.0 : kStep;
        const auto way = [&](double share) { return pose_at(motion, begin + share * more); };
        for (Solver* each : {&all, &thin})
        {
            each->keep_awake();
            each->step({{way(1.0), begin + more, float(kStep), way}});
        }
        const Mapped a = all.guide_positions(), b = thin.guide_positions();
        double sum = 0.0;
        for (int s = 0; s < groom.guides; ++s)
        {
            const size_t block = size_t(s / LANES);
            const int strands = std::min(LANES, groom.guides - s / LANES * LANES);
            double off2 = 0.0;
            for (int k = 2; k < groom.nodes; ++k)
            {
                const glm::dvec3 off =
                    vector_at(a.as<float>(), s, k, groom.nodes) - vector_at(b.as<float>(), s, k, groom.nodes);
                off2 += glm::dot(off, off);
            }
            off2 /= (groom.nodes - 2) * std::max(1e-18, blocks[block].length * blocks[block].length);
            sum += off2 / groom.guides;
            in_block[block] += off2 / (strands * double(kSteps));
        }
        worst2 = std::max(worst2, sum);
    }
    return kElsewhere * std::sqrt(std::max(worst2, *std::max_element(in_block.begin(), in_block.end())));
}

// ---- choosing ----------------------------------------------------------------------------------------------------

double Quality::predicted() const { return std::hypot(time_error, node_error); }

// Half a mass at the tip: 2.8, 0.9, 0.3, 0.1 % for 7, 15, 31, 63 links, the geometric means of what was measured there.
static double error_of_links(int links) { return 0.028 * std::pow(7.0 / links, 1.5); }

double error_of_guides(const HairParams& params, const Scalp& scalp, int guides)
{
    // Half a sphere of guides. Free of contact, 0.2 % at a spacing of 17 mm, by its square.
    const double spacing = std::sqrt(2.0 * std::numbers::pi) * double(scalp.radius) * double(params.head_scale) /
                           std::sqrt(std::max(1.0, double(guides)));
    return 0.002 * std::pow(spacing / 0.017, 2);
}

// Does the style say it, in its file or since?
static bool pinned(const Hairstyle& style, const char* path)
{
    static const Hairstyle defaults;
    return style.places.contains(path) || !same_value(style, defaults, *find_param(path));
}

// Rungs from a Courant number downwards, each with twice the substeps; their errors against the finest, and by
// Richardson's extrapolation beyond it.
static std::vector<Rung> climb(const Device& device, const HairParams& params, const Groom& groom, bool rate_pinned)
{
    constexpr int kRuns = 5;
    constexpr double kSeconds = 2.0;
    const Motion motion = find_motion("shake");
    Groom few = sample(groom);
    hang(device, params, few);
    std::array<Sampled, kRuns> runs;
    for (int k = 0; k < kRuns; ++k)
        runs[size_t(k)] = move(device, params, few, motion, kSeconds, 1 << k);
    const Sampled& finest = runs[kRuns - 1];
    // The order that the scheme has here, from the two finest pairs; first with bending, second without.
    const double pair = apart(runs[kRuns - 3], runs[kRuns - 2], few), last = apart(runs[kRuns - 2], finest, few);
    const double ratio = std::clamp(last > 0.0 ? pair / last : 4.0, 2.0, 4.0);
    std::vector<Rung> rungs;
    for (int k = 0; k + 1 < kRuns; ++k)
    {
        // What k halvings ask for, in substeps of fewer steps a second where there is room.
        float rate = params.solver_rate;
        while (float(runs[0].most_substeps << k) > MOST_SUBSTEPS * rate / params.solver_rate)
            rate *= 2.0f;
        if (rate > (rate_pinned ? params.solver_rate : find_param("solver.rate")->max))
            break;
        const int share = int(std::lround(rate / params.solver_rate));
        // The finest is not the truth: its own error is ratio^-(runs between) of this one's.
        const double error = apart(runs[size_t(k)], finest, few) / (1.0 - std::pow(ratio, k + 1 - kRuns));
        const int substeps = std::clamp((std::max(1, params.solver_substeps) << k) / share, 1, MOST_SUBSTEPS);
        rungs.push_back({params.solver_courant / float(1 << k), substeps, rate, error, runs[size_t(k)].nanoseconds});
    }
    return rungs;
}

// With its ties: hair behind a ring swings otherwise.
static Groom as_grown(const Hairstyle& style, Assets& assets)
{
    return style.host.ties.empty() ? grow(style.params, assets.scalp, style.host) : grown(style, assets);
}

Hairstyle meet_tolerance(const Device& device, const Hairstyle& style, Assets& assets, Quality& quality)
{
    const Scalp& scalp = assets.scalp;
    constexpr int kMostNodes = 64;
    quality = {};
    Hairstyle live = style;
    HairParams& p = live.params;
    const double tolerance = 0.01 * double(p.quality_tolerance);
    if (tolerance <= 0.0)
        return live;
    if (p.solver_kind != 0)
    {
        quality.said =
            fmt::format("tolerance {:.3g} %: nothing chosen or predicted; the style pins the pbd solver, whose "
                        "error no number of iterations bounds",
                        100.0 * tolerance);
        return live;
    }
    std::string chosen, held;
    const auto note = [](std::string& list, const std::string& what) { list += (list.empty() ? "" : ", ") + what; };

    // Nodes first: half the tolerance, as errors that are independent add; then substeps for what is left.
    if (pinned(style, "strand.nodes"))
        note(held, fmt::format("{} nodes", p.strand_nodes));
    else
    {
        for (const int nodes : {8, 12, 16, 24, 32, 48, kMostNodes})
        {
            p.strand_nodes = nodes;
            if (error_of_links(nodes - 2) <= tolerance * 0.7)
                break;
        }
        note(chosen, fmt::format("{} nodes", p.strand_nodes));
    }
    quality.node_error = error_of_links(p.strand_nodes - 2);

    // Each refinement of the scalp has about four times as many guides.
    const bool all = p.interpolation_guides == GUIDES_ALL || scalp.hair; // nothing is between, or a file says where
    const bool guides_pinned = all || pinned(style, "interpolation.refine");
    const int vertices = int(scalp.positions.size());
    const double of_guides = std::max(tolerance, error_of_links(kMostNodes - 2)); // guides never move better than that
    const int most = guides_pinned ? p.interpolation_refine : most_refinements(scalp);
    while (p.interpolation_refine < most &&
           error_of_guides(p, scalp, vertices << 2 * p.interpolation_refine) > of_guides)
        ++p.interpolation_refine;
    const Groom groom = as_grown(live, assets);
    quality.guide_error = all ? 0.0 : error_of_guides(p, scalp, groom.guides);
    note(guides_pinned ? held : chosen, fmt::format("{} guides", groom.guides));
    const bool substeps_pinned = pinned(style, "solver.courant") || pinned(style, "solver.substeps");
    HairParams probed = alone(p);
    if (!substeps_pinned)
        probed.solver_courant = 1.8f;
    quality.rungs = climb(device, probed, groom, substeps_pinned || pinned(style, "solver.rate"));
    const double left = std::sqrt(
        std::max(0.25 * tolerance * tolerance, tolerance * tolerance - quality.node_error * quality.node_error));
    if (!substeps_pinned)
        while (quality.chosen + 1 < quality.rungs.size() && quality.rungs[quality.chosen].error > left)
            ++quality.chosen;
    const Rung& rung = quality.rungs[quality.chosen];
    p.solver_courant = rung.courant;
    p.solver_substeps = rung.substeps;
    p.solver_rate = rung.rate;
    quality.time_error = rung.error;
    note(substeps_pinned ? held : chosen, fmt::format("courant {:.3g}", p.solver_courant));
    note(pinned(style, "solver.rate") ? held : chosen, fmt::format("{:.3g} steps a second", p.solver_rate));

    // What pictures and repulsion can tell apart at that tolerance (coif measure: grid, picture).
    if (!pinned(style, "grid.resolution"))
        p.grid_resolution = tolerance >= 0.05 ? 32 : 64;
    note(pinned(style, "grid.resolution") ? held : chosen, fmt::format("grid {}", p.grid_resolution));
    if (!pinned(style, "smoothing.subdivisions"))
        p.smoothing_subdivisions = tolerance >= 0.05 ? 3 : tolerance >= 0.02 ? 4 : 5;
    note(pinned(style, "smoothing.subdivisions") ? held : chosen,
         fmt::format("{} subdivisions", p.smoothing_subdivisions));
    quality.said = fmt::format("tolerance {:.3g} %: {}; the style pins {}", 100.0 * tolerance,
                               chosen.empty() ? "nothing to choose" : chosen, held.empty() ? "nothing" : held);
    if (quality.predicted() > tolerance)
        quality.said += fmt::format("; that comes to {:.2g} %, no less can be had", 100.0 * quality.predicted());
    return live;
}

std::string quality_text(const Quality& quality)
{
    std::string text = quality.said;
    if (quality.rungs.empty())
        return text;
    text += fmt::format("\npredicted, free of contact: {:.2g} % of the length: substeps {:.2g} %, nodes {:.2g} %; "
                        "drawn strands between guides {:.2g} %",
                        100.0 * quality.predicted(), 100.0 * quality.time_error, 100.0 * quality.node_error,
                        100.0 * quality.guide_error);
    for (size_t i = 0; i < quality.rungs.size(); ++i)
    {
        const Rung& rung = quality.rungs[i];
        text +=
            fmt::format("\n  {} courant {:.3g}, {:.3g} Hz: {:.2g} %, {:.0f} ns a strand and step",
                        i == quality.chosen ? '*' : ' ', rung.courant, rung.rate, 100.0 * rung.error, rung.nanoseconds);
    }
    return text + "\nin contact, errors under 3 % cannot be told: what bodies do to hair is known no better";
}

} // namespace coif
