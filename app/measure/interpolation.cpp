// A12: how far hair that follows guides is from hair that is simulated, over the spacing of the guides; and what the
// share of turned copies does to that. The strands compared stand on the same roots, and the reference goes through the
// same passes, as strands that follow one guide of their own: all that differs is the interpolation.
#include "app/measure/cost.h"
#include "app/measure/geodesic.h"
#include "app/measure/measure.h"
#include "app/statistics.h"
#include "sim/error.h"
#include "sim/health.h"
#include "sim/median.h"
#include "sim/motion.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

namespace
{
constexpr float kFrame = 1.0f / 60.0f;
constexpr double kDegree = std::numbers::pi / 180.0;

struct Track
{
    std::vector<std::vector<float4>> nodes; // of all drawn strands, at each moment looked at
    Health worst;
};

struct Deviation
{
    std::vector<double> distance; // of a strand's nodes from the reference's, rms, as a share of its length
    double shortening = 0.0;      // worst of a segment, fraction
};
} // namespace

// Hair on a ball, so that neither a head's shape nor a style has a say: combed from a crown, without what differs from
// guide to guide (no two spacings could agree on that), and with nothing that couples strands.
static HairParams hair_on_a_ball()
{
    HairParams params;
    params.strand_length_variation = 0.0f;
    params.root_lift = 80.0f;
    params.root_lift_variation = params.root_sweep_variation = 0.0f;
    params.root_crown = F4(0.0f, 1.0f, 0.0f, 0.0f);
    params.root_part = 0.0f;
    params.interpolation_layer = 0.0f;
    params.forces_repulsion = 0.0f;
    params.look_self_shadow = 0.0f;
    return params;
}

static std::vector<Collider> colliders_of(const Ball& ball, bool contact)
{
    // A millimetre under the roots, as under the shipped scalp.
    return contact ? std::vector<Collider>{{ball.center, ball.radius - 0.001f, true}} : std::vector<Collider>{};
}

// A second to come to rest, then a turn of the head, looked at ten times a second from when it begins.
static Track follow(Solver& solver, const HairParams& params, bool quick)
{
    const Motion turn = find_motion("turn");
    const int settle = quick ? 40 : 60, seen = quick ? 54 : 78, begin = 18;
    Track track;
    for (int i = 1; i <= settle + seen; ++i)
    {
        const double t = double(i) * kFrame, script = t - settle * double(kFrame);
        solver.step({{script > 0.0 ? pose_at(turn, script) : Pose{}, t, kFrame}});
        if (i < settle + begin || (i - settle) % 6 != 0)
        {
            if (i % 16 == 0)
                solver.take_times(); // lets the queue's uploads go
            continue;
        }
        solver.draw();
        const Health now = measure_health(solver, params, true);
        track.worst.stretch_max = std::max(track.worst.stretch_max, now.stretch_max);
        track.worst.drawn_penetration_max = std::max(track.worst.drawn_penetration_max, now.drawn_penetration_max);
        const Mapped nodes = solver.drawn_positions();
        track.nodes.emplace_back(nodes.as<float4>(), nodes.as<float4>() + nodes.bytes() / sizeof(float4));
    }
    return track;
}

static glm::dvec3 xyz(const float4& v) { return {v.x, v.y, v.z}; }

static Deviation compare(const Track& track, const Track& reference, const Groom& groom)
{
    Deviation error;
    const size_t nodes = size_t(groom.nodes), strands = groom.drawn.size();
    const double length = groom.longest, segment = length / double(nodes - 2);
    for (size_t t = 0; t < track.nodes.size(); ++t)
        for (size_t s = 0; s < strands; ++s)
        {
            double squares = 0.0;
            for (size_t k = 2; k < nodes; ++k)
            {
                const glm::dvec3 p = xyz(track.nodes[t][s * nodes + k]);
                const glm::dvec3 away = p - xyz(reference.nodes[t][s * nodes + k]);
                squares += glm::dot(away, away);
                error.shortening = std::max(error.shortening,
                                            1.0 - glm::distance(p, xyz(track.nodes[t][s * nodes + k - 1])) / segment);
            }
            error.distance.push_back(std::sqrt(squares / double(nodes - 2)) / length);
        }
    return error;
}

std::vector<Row> measure_interpolation(const Measuring& with)
{
    const Ball ball;
    const HairParams params = hair_on_a_ball();
    const std::vector<glm::vec3> roots =
        even_roots(ball, with.quick ? 512 : 2048, float(10.0 * kDegree), float(110.0 * kDegree));
    std::vector<int> frequencies = {2, 3, 4, 6, 8, 12};
    if (!with.quick)
        frequencies.insert(frequencies.end(), {17, 24, 34});
    std::vector<Row> rows;
    for (const bool contact : {false, true})
    {
        const std::string setting = contact ? "contact" : "free";
        with.progress(setting + ", every strand simulated");
        const auto solver_of = [&](const Groom& groom)
        {
            auto solver = std::make_unique<Solver>(with.device, params, groom, Pose{});
            solver->set_colliders(colliders_of(ball, contact));
            return solver;
        };
        const Groom all = all_simulated(params, ball, roots);
        const Track reference = follow(*solver_of(all), params, with.quick);

        Solvers solvers;
        std::vector<double> spacing_mm, median_error;
        const size_t first = rows.size();
        for (const int frequency : frequencies)
        {
            const GeodesicGroom made = geodesic_groom(params, ball, roots, frequency);
            with.progress(fmt::format("{}, {} guides", setting, made.groom.guides));
            solvers.push_back(solver_of(made.groom));
            const Track track = follow(*solvers.back(), params, with.quick);
            const Deviation error = compare(track, reference, made.groom);
            spacing_mm.push_back(1e3 * made.spacing);
            median_error.push_back(median(error.distance));

            Row row;
            row.scene = "A12";
            row.setting = setting;
            row.solver = solver_name(params);
            row.knob = "guide spacing, mm";
            row.value = 1e3 * made.spacing;
            row.unit = "L";
            row.reference = "every strand simulated";
            row.stretch = track.worst.stretch_max;
            row.penetration_mm = 1e3 * track.worst.drawn_penetration_max;
            // The bound is for the spacing that coif's own scalp has, 17 mm.
            const bool shipped = frequency == 6;
            row.metric = "median";
            row.error = median_error.back();
            row.pass = shipped ? 0.01 : NAN;
            rows.push_back(row);
            row.metric = "p95";
            row.error = percentile(error.distance, 0.95);
            row.pass = shipped ? 0.03 : NAN;
            rows.push_back(row);
            row.metric = "shortening";
            row.error = error.shortening;
            row.unit = "fraction";
            row.pass = NAN;
            rows.push_back(row);
        }
        with.progress(setting + ", costs");
        const std::vector<double> ms = frame_ms(solvers, true, with.quick ? 5 : 11);
        for (size_t i = 0; i < 3 * solvers.size(); ++i)
        {
            rows[first + i].ms = ms[i / 3];
            rows[first + i].ns_strand_frame = 1e6 * ms[i / 3] / double(roots.size());
        }
        Row order;
        order.scene = "A12";
        order.setting = setting;
        order.metric = "order in spacing";
        order.solver = solver_name(params);
        order.error = observed_order(spacing_mm, median_error);
        order.reference = "every strand simulated";
        order.state_of_the_art = contact ? NAN : 2.0;
        order.at_least = true;
        rows.push_back(order);
    }
    return rows;
}

std::vector<Row> measure_ratio(const Measuring& with)
{
    const Ball ball;
    HairParams params = hair_on_a_ball();
    const std::vector<glm::vec3> covering = even_roots(ball, 4096, float(10.0 * kDegree), float(110.0 * kDegree));
    const GeodesicGroom made = geodesic_groom(params, ball, covering, 6);
    params.interpolation_strands = with.quick ? 512 : 2048;
    std::vector<Row> rows;
    Solvers solvers;
    for (const float ratio : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f})
    {
        with.progress(fmt::format("{:.0f} % copies", 100.0f * ratio));
        params.interpolation_ratio = ratio;
        Groom groom = grow(params, made.scalp);
        // Mixed strands are grown on flat triangles, a little under the ball that the reference's stand on.
        std::vector<glm::vec3> roots;
        for (DrawnStrand& strand : groom.drawn)
        {
            roots.push_back(ball.center + ball.radius * glm::normalize(glm::vec3(xyz(strand.root)) - ball.center));
            strand.root = F4(roots.back().x, roots.back().y, roots.back().z, strand.root.w);
        }
        const Groom all = all_simulated(params, ball, roots);
        Solver reference(with.device, params, all, Pose{});
        reference.set_colliders(colliders_of(ball, true));
        solvers.push_back(std::make_unique<Solver>(with.device, params, groom, Pose{}));
        solvers.back()->set_colliders(colliders_of(ball, true));
        const Track truth = follow(reference, params, with.quick);
        const Track track = follow(*solvers.back(), params, with.quick);
        const Deviation error = compare(track, truth, groom);
        Row row;
        row.scene = "ratio";
        row.solver = solver_name(params);
        row.knob = "share of copies";
        row.value = ratio;
        row.unit = "L";
        row.reference = "every strand simulated";
        row.stretch = track.worst.stretch_max;
        row.penetration_mm = 1e3 * track.worst.drawn_penetration_max;
        row.metric = "median";
        row.error = median(error.distance);
        rows.push_back(row);
        row.metric = "p95";
        row.error = percentile(error.distance, 0.95);
        rows.push_back(row);
    }
    const std::vector<double> ms = frame_ms(solvers, true, with.quick ? 5 : 11);
    for (size_t i = 0; i < rows.size(); ++i)
    {
        rows[i].ms = ms[i / 2];
        rows[i].ns_strand_frame = 1e6 * ms[i / 2] / double(params.interpolation_strands);
    }
    return rows;
}

} // namespace coif
