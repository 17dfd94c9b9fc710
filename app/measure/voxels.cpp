// A13: does the repulsion hang on where the grid happens to lie? The same hair, at rest, is asked for its forces in
// grids moved by fractions of a voxel, and in a mirror; and whether all forces add up to nothing, as those between
// pairs would.
#include "app/measure/voxels.h"

#include "app/measure/cost.h"
#include "app/measure/geodesic.h"
#include "sim/error.h"
#include "sim/simulation.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace coif
{

namespace
{
constexpr float kFrame = 1.0f / 60.0f;

struct Noise
{
    double placement = 0.0;     // rms deviation among the offsets, against the mean force
    double net = 0.0;           // |sum| / sum of sizes, worst of the offsets
    double asymmetry = 0.0;     // rms deviation of the mirrored hair's forces, mirrored back, against the mean force
    std::vector<Forces> forces; // at each offset
};
} // namespace

// A part of a voxel along each axis; the first is the grid as coif lays it.
static const glm::vec3 kOffsets[] = {{0, 0, 0}, {0.25f, 0.5f, 0.75f}, {0.5f, 0.75f, 0.25f}, {0.75f, 0.25f, 0.5f}};

static std::vector<float> positions_of(const Solver& solver)
{
    const Mapped mapped = solver.guide_positions();
    return {mapped.as<float>(), mapped.as<float>() + mapped.bytes() / sizeof(float)};
}

Hair hair_of(const Device& device, const Hairstyle& style)
{
    Simulation simulation(device, style);
    simulation.settle(1.0);
    return {style.params, simulation.solver().groom(), positions_of(simulation.solver())};
}

// Many guides: so many that only a part of their nodes feeds the density.
static Hair crowd(const Measuring& with, const Hairstyle& style, int guides)
{
    const double degree = std::numbers::pi / 180.0;
    Hair hair{style.params, {}, {}};
    hair.groom = all_simulated(hair.params, {}, even_roots({}, guides, 0.0f, float(110.0 * degree)));
    hair.groom.drawn.clear();
    hair.groom.drawn_multi = 0;
    hair.params.forces_repulsion = 0.0f;
    Solver solver(with.device, hair.params, hair.groom, Pose{});
    solver.set_colliders({{glm::vec3(0.0f), 0.099f, true}});
    for (int i = 1; i <= 40; ++i)
        solver.step({{Pose{}, double(i) * kFrame, kFrame}});
    hair.params.forces_repulsion = style.params.forces_repulsion;
    hair.position = positions_of(solver);
    return hair;
}

// The left side to the right.
static Hair mirrored(Hair hair)
{
    for (std::vector<float>* values : {&hair.groom.root_position, &hair.groom.root_direction,
                                       &hair.groom.natural_position, &hair.groom.rest_position, &hair.position})
        for (size_t i = 0; i < values->size(); ++i)
            if (i / LANES % 3 == 0)
                (*values)[i] = -(*values)[i];
    hair.groom.center.x = -hair.groom.center.x;
    hair.groom.middle.x = -hair.groom.middle.x;
    return hair;
}

Probe probe_repulsion(const Device& device, const Hair& hair, glm::vec3 offset)
{
    Groom groom = hair.groom;
    const float voxel = 2.0f * (groom.longest + groom.farthest) / float(hair.params.grid_resolution - 3);
    groom.farthest += voxel; // room for the grid to move in
    groom.middle += offset * voxel;
    Solver solver(device, hair.params, groom, Pose{});
    write(device, solver.buffers().at("position"), hair.position);
    solver.step({{Pose{}, kFrame, kFrame}}); // still without repulsion: there was no density yet

    Buffers buffers = solver.buffers();
    buffers["acceleration"] = allocate(device, hair.position.size() * sizeof(float), "the forces");
    Kernel kernel = load_kernel(device, "probe_repulsion",
                                fmt::format("-D NODES={} -D RESOLUTION={} -D WIDTH={}", groom.nodes,
                                            hair.params.grid_resolution, device.width));
    run(device, kernel, buffers, cl::NDRange(size_t(groom.blocks * LANES / device.width)));
    const std::vector<float> values = read<float>(device, buffers.at("acceleration"), hair.position.size());
    const std::vector<float> position = positions_of(solver);
    Probe found{{}, {}, solver.info()};
    for (int g = 0; g < groom.guides; ++g)
        for (int k = 1; k < groom.nodes; ++k)
        {
            const auto of = [&](const std::vector<float>& from)
            {
                const auto at = [&](int axis) { return double(from[size_t(strand_value(g, k, axis, groom.nodes))]); };
                return glm::dvec3(at(0), at(1), at(2));
            };
            found.forces.push_back(of(values));
            found.nodes.push_back(of(position));
        }
    return found;
}

static double mean_size(const Forces& forces)
{
    double sum = 0.0;
    for (const glm::dvec3& f : forces)
        sum += glm::length(f);
    return sum / double(forces.size());
}

double difference(const Forces& forces, const Forces& reference)
{
    double sum = 0.0;
    for (size_t i = 0; i < forces.size(); ++i)
        sum += glm::dot(forces[i] - reference[i], forces[i] - reference[i]);
    return std::sqrt(sum / double(forces.size())) / mean_size(reference);
}

static Noise noise_of(const Measuring& with, const Hair& hair)
{
    Noise noise;
    for (const glm::vec3& offset : kOffsets)
    {
        noise.forces.push_back(probe_repulsion(with.device, hair, offset).forces);
        glm::dvec3 sum(0.0);
        for (const glm::dvec3& f : noise.forces.back())
            sum += f;
        const double sizes = mean_size(noise.forces.back()) * double(noise.forces.back().size());
        noise.net = std::max(noise.net, sizes > 0.0 ? glm::length(sum) / sizes : 0.0);
    }
    Forces mean(noise.forces[0].size(), glm::dvec3(0.0));
    for (const Forces& forces : noise.forces)
        for (size_t i = 0; i < mean.size(); ++i)
            mean[i] += forces[i] / double(std::size(kOffsets));
    double squares = 0.0;
    for (const Forces& forces : noise.forces)
        squares += std::pow(difference(forces, mean), 2) / double(std::size(kOffsets));
    noise.placement = std::sqrt(squares);

    Forces back = probe_repulsion(with.device, mirrored(hair), {0, 0, 0}).forces;
    for (glm::dvec3& f : back)
        f.x = -f.x;
    noise.asymmetry = difference(back, noise.forces[0]);
    return noise;
}

static Row row_of(const char* scene, const std::string& setting, const char* metric, double error, const Hair& hair)
{
    Row row;
    row.scene = scene;
    row.setting = setting;
    row.metric = metric;
    row.solver = solver_name(hair.params);
    row.error = error;
    row.unit = "fraction";
    row.knob = "grid resolution";
    row.value = hair.params.grid_resolution;
    return row;
}

std::vector<Row> measure_voxels(const Measuring& with)
{
    std::vector<Row> rows;
    const auto judge = [&](const std::string& setting, const Hair& hair)
    {
        with.progress(setting);
        const Noise noise = noise_of(with, hair);
        const struct
        {
            const char* metric;
            double error, pass, excellent;
            const char* reference;
        } judged[] = {{"placement noise", noise.placement, 0.15, 0.05, "mean of 4 grid offsets"},
                      {"asymmetry", noise.asymmetry, 0.15, 0.05, "the mirrored hair"},
                      {"net force", noise.net, 0.05, 0.001, "forces between pairs"}};
        for (const auto& j : judged)
        {
            Row row = row_of("A13", setting, j.metric, j.error, hair);
            row.pass = j.pass;
            row.state_of_the_art = j.excellent;
            row.reference = j.reference;
            rows.push_back(row);
        }
    };
    for (const char* name : {"bob", "curly"})
    {
        if (with.quick && std::string(name) != "bob")
            continue;
        judge(name, hair_of(with.device, load_hairstyle(find_style(name))));
    }
    const int many = with.quick ? 8192 : 32768;
    judge(fmt::format("{} guides", many), crowd(with, load_hairstyle(find_style("bob")), many));
    return rows;
}

// The forces without a grid: each node pushes each other one down the slope of a Gaussian as wide as the style asks
// for.
static Forces pair_forces(const std::vector<glm::dvec3>& nodes, const StepInfo& info, double blur)
{
    const double voxel = info.grid_corner.w, variance = blur * blur;
    const double volume = std::pow(2.0 * std::numbers::pi * variance, 1.5);
    // From density a voxel and its difference from voxel to voxel to density and slope.
    const double strength = double(info.repulsion) * DENSITY_ONE * std::pow(voxel, 4.0) / (volume * variance);
    Forces forces(nodes.size(), glm::dvec3(0.0));
    for (size_t i = 0; i < nodes.size(); ++i)
        for (size_t j = i + 1; j < nodes.size(); ++j)
        {
            const glm::dvec3 away = nodes[i] - nodes[j];
            const double squared = glm::dot(away, away) / variance;
            if (squared > 40.0)
                continue;
            const glm::dvec3 push = strength * std::exp(-0.5 * squared) * away;
            forces[i] += push;
            forces[j] -= push;
        }
    for (glm::dvec3& f : forces) // as kernels/forces.h bounds them
        f *= std::min(1.0, 50.0 / std::max(glm::length(f), 1e-6));
    return forces;
}

std::vector<Row> measure_grid(const Measuring& with)
{
    Hair hair = hair_of(with.device, load_hairstyle(find_style("bob")));
    const int own = hair.params.grid_resolution;
    const float own_blur = hair.params.grid_blur;
    with.progress("reference");
    const Probe at_rest = probe_repulsion(with.device, hair, {0, 0, 0});
    const Forces reference = pair_forces(at_rest.nodes, at_rest.info, own_blur);

    // Each knob alone, from where the style has it.
    struct Grid
    {
        const char* knob;
        int resolution;
        float blur;
    };
    std::vector<Grid> settings;
    for (const int resolution :
         with.quick ? std::vector<int>{16, 32, 64, 128} : std::vector<int>{8, 16, 24, 32, 48, 64, 96, 128})
        settings.push_back({"grid resolution", resolution, own_blur});
    for (const float blur : {0.0f, 0.01f, 0.015f, 0.02f, 0.03f, 0.05f})
        settings.push_back({"grid blur", own, blur});

    std::vector<Row> rows;
    Solvers solvers;
    for (const Grid& setting : settings)
    {
        with.progress(fmt::format("{}^3 voxels, blurred by {} m", setting.resolution, setting.blur));
        hair.params.grid_resolution = setting.resolution;
        hair.params.grid_blur = setting.blur;
        const Noise noise = noise_of(with, hair);
        Row row = row_of("grid", "bob", "force error", difference(noise.forces[0], reference), hair);
        row.knob = setting.knob;
        row.value = setting.knob == std::string("grid blur") ? double(setting.blur) : setting.resolution;
        row.reference = fmt::format("all pairs, {} m wide", own_blur);
        solvers.push_back(std::make_unique<Solver>(with.device, hair.params, hair.groom, Pose{}));
        rows.push_back(row);
        row.metric = "placement noise";
        row.error = noise.placement;
        row.reference = "mean of 4 grid offsets";
        rows.push_back(row);
    }
    const std::vector<double> ms = frame_ms(solvers, false, with.quick ? 5 : 11);
    for (size_t i = 0; i < rows.size(); ++i)
    {
        rows[i].ms = ms[i / 2];
        rows[i].ns_strand_frame = 1e6 * ms[i / 2] / hair.groom.guides;
    }
    return rows;
}

} // namespace coif
