#include "app/lab.h"

#include "sim/error.h"

#include <cmath>
#include <numbers>

namespace coif
{

int lab(const Options& options, const LabOptions& wanted, bool seconds_given)
{
    Hairstyle style;
    style.params.forces_drag = float(wanted.drag);
    if (!(wanted.drag >= 0.0 && wanted.drag <= 1e6))
        throw fail("--drag is {}, but must lie in [0, 1e+06] 1/s", wanted.drag);
    if (!(std::abs(wanted.strand.angle) <= 360.0))
        throw fail("--angle is {}, but must lie in [-360, 360] degrees", wanted.strand.angle);
    for (const std::string& set : options.sets)
        if (set.starts_with("solver.") || set.starts_with("forces."))
            assign(style, set);
        else
            throw fail("--set {}: of a style's parameters the lab reads solver.* and forces.* only; the strand is what "
                       "--nodes, --length and --gamma say",
                       set);
    if (!wanted.solver.empty())
        assign(style, "solver.kind=" + wanted.solver);
    LabStrand strand = wanted.strand;
    strand.angle *= std::numbers::pi / 180.0;
    if (wanted.gamma != 0.0)
        strand.gamma = wanted.gamma;
    if (wanted.root.empty() && !seconds_given)
        throw fail("lab: give --root FILE.csv, or --seconds for a root that stays");

    double seconds = options.seconds;
    RootPath root = [](double) { return glm::dvec3(0.0); };
    RootRows rows;
    if (!wanted.root.empty())
    {
        rows = load_root(wanted.root);
        const double begin = rows.times.front(), end = rows.times.back() - begin;
        seconds = seconds_given ? std::min(seconds, end) : end;
        if (!seconds_given && end > 3600.0)
            throw fail("{}: lasts {} s, but the lab moves a strand for an hour at most; say --seconds", wanted.root,
                       end);
        root = [&rows, begin](double t) { return root_at(rows, begin + t); };
    }
    const Device device = open_device(options);
    const LabRun run = run_lab(device, style.params, strand, root, seconds, wanted.fps);

    const double begin = rows.times.empty() ? 0.0 : rows.times.front();
    std::string csv = "t";
    for (int k = 0; k < strand.nodes; ++k)
        csv += fmt::format(",x{0},y{0},z{0}", k);
    csv += '\n';
    for (size_t i = 0; i < run.times.size(); ++i)
    {
        csv += fmt::format("{:.9g}", begin + run.times[i]);
        for (const glm::dvec3& p : run.nodes[i])
            csv += fmt::format(",{:.9g},{:.9g},{:.9g}", p.x, p.y, p.z);
        csv += '\n';
    }
    if (options.output.empty())
        fmt::print("{}", csv);
    else
        write_file(options.output, csv);
    fmt::print(stderr, "{} nodes, {} rows, {}: worst stretch {:.3g} %\n", strand.nodes, run.times.size(),
               value_text(style, *find_param("solver.kind")), 100.0 * run.stretch);
    return 0;
}

} // namespace coif
