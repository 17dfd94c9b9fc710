#include "sim/models/baseline.h"

#include "sim/error.h"
#include "sim/median.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif::study
{

// Eq. 5.5: what each of n sweeps does so that all of them do `strength`.
static float per_sweep(float strength, int sweeps)
{
    return 1.0f - std::pow(1.0f - std::clamp(strength, 0.0f, 1.0f), 1.0f / float(sweeps));
}

BaselineSettings make_settings(const BaselineSetup& setup, glm::vec3 scalp, bool first)
{
    const float h = 1.0f / setup.rate;
    const float gain = setup.drag > 0.0f ? -std::expm1(-setup.drag * h) / setup.drag : h;
    BaselineSettings settings = {};
    settings.scalp = F4(scalp.x, scalp.y, scalp.z, 0.0f);
    settings.duration = h;
    settings.drag_keep = std::exp(-setup.drag * h);
    // Positions differ by velocities half a step earlier, so the first is reached in half a step (Verlet 1967).
    settings.push = (first ? 0.5f : 1.0f) * gain * setup.gravity;
    settings.stretching = per_sweep(setup.stretching, setup.iterations);
    settings.bending_scale = setup.bending_scale;
    settings.iterations = setup.iterations;
    settings.spheres = int(setup.spheres.size());
    return settings;
}

// Of each node, eq. 5.6; nodes 0 and 1 follow the scalp.
static std::vector<float> bending_of(const BaselineSetup& setup)
{
    std::vector<float> bending(size_t(setup.nodes));
    for (int i = 2; i < setup.nodes; ++i)
        bending[size_t(i)] =
            per_sweep(setup.bending, setup.iterations) / std::pow(float(i - 1), setup.bending_attenuation);
    return bending;
}

static Kernel load(const Device& device, const BaselineSetup& setup)
{
    const size_t most = device.device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
    if (setup.nodes < 3 || size_t(setup.nodes) > most || setup.iterations < 1 || setup.roots.empty())
        throw fail("the thesis' kernel takes strands of 3 to {} nodes on {}, at least one of them and one iteration; "
                   "these are {} strands of {} nodes and {} iterations",
                   most, device.name, setup.roots.size(), setup.nodes, setup.iterations);
    return load_kernel(device, "baseline/simulate", fmt::format("-D NODES={}", setup.nodes));
}

Baseline::Baseline(const Device& device, const BaselineSetup& setup, glm::vec3 scalp)
    : device_(device), setup_(setup), kernel_(load(device, setup))
{
    std::vector<float4> positions;
    for (const float4& root : setup.roots)
    {
        const glm::vec3 place(root.x, root.y, root.z), out = glm::normalize(place);
        for (int i = 0; i < setup.nodes; ++i)
        {
            const glm::vec3 node = scalp + place + float(i - 1) * root.w * out;
            positions.push_back(F4(node.x, node.y, node.z, 0.0f));
        }
    }
    const auto add = [&](const char* name, const auto& values)
    {
        buffers_[name] = allocate(device_, values.size() * sizeof(values[0]), "the thesis' strands");
        write(device_, buffers_[name], values);
    };
    add("position", positions);
    add("previous", positions);
    add("root", setup.roots);
    add("bending", bending_of(setup));
    add("spheres", setup.spheres);
    buffers_["settings"] = allocate(device_, sizeof(BaselineSettings), "the thesis' settings");
}

double Baseline::step(glm::vec3 scalp)
{
    write(device_, buffers_["settings"], std::vector<BaselineSettings>{make_settings(setup_, scalp, first_)});
    first_ = false;
    const size_t strands = setup_.roots.size(), nodes = size_t(setup_.nodes);
    const cl::Event event = run(device_, kernel_, buffers_, cl::NDRange(strands * nodes), cl::NDRange(nodes));
    event.wait();
    return double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                  event.getProfilingInfo<CL_PROFILING_COMMAND_START>()) /
           double(strands);
}

std::vector<glm::vec3> Baseline::positions() const
{
    std::vector<glm::vec3> nodes;
    for (const float4& p : read<float4>(device_, buffers_.at("position"), setup_.roots.size() * size_t(setup_.nodes)))
        nodes.emplace_back(p.x, p.y, p.z);
    return nodes;
}

BaselineResult run_baseline(const Device& device, const BaselineSetup& setup, int frames)
{
    Baseline baseline(device, setup, glm::vec3(0.0f));
    std::vector<double> ns(size_t(std::max(frames, 0)));
    for (double& each : ns)
        each = baseline.step(glm::vec3(0.0f));
    return {baseline.positions(), median(ns)};
}

} // namespace coif::study
