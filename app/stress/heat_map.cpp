// Worst stretch over time step and stiffness, for both solvers, drawn by gnuplot.
#include "app/gnuplot.h"
#include "app/stress/cases.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace coif::stress
{

static const char kScript[] = R"(# gnuplot heat.gp: worst stretch of a shaken strand over time step and stiffness.
set datafile separator ','
set logscale cb
set cbrange [0.001:100]
set palette defined (0 '#f7fbff', 1 '#9ecae1', 2 '#4292c6', 3 '#fdae61', 4 '#d7191c', 5 '#67001f')
set cblabel 'worst stretch, %'
set ylabel 'steps a second, none cut'
set tics out nomirror
set rmargin 13
do for [kind in 'png svg'] {
    if (kind eq 'png') { set terminal pngcairo size 1500,620 font 'sans,11' } else { set terminal svg size 1500,620 font 'sans,11' }
    set output 'heat.'.kind
    set multiplot layout 1,2
    set title 'direct'
    set xlabel 'droop number Gamma (stiff to limp)'
    plot 'heat-direct.csv' matrix rowheaders columnheaders using 1:2:(($3 < 0.001) ? 0.001 : $3) with image notitle, \
         '' matrix rowheaders columnheaders using 1:2:(sprintf('%.2g', ($3 < 0.001) ? 0 : $3)) with labels font 'sans,9' notitle
    set title 'pbd, 10 sweeps'
    set xlabel 'bending (limp to stiff)'
    plot 'heat-pbd.csv' matrix rowheaders columnheaders using 1:2:(($3 < 0.001) ? 0.001 : $3) with image notitle, \
         '' matrix rowheaders columnheaders using 1:2:(sprintf('%.2g', ($3 < 0.001) ? 0 : $3)) with labels font 'sans,9' notitle
    unset multiplot
    unset output
}
)";

static Figures shaken(const Ground& ground, const HairParams& params, int rate)
{
    Trial trial(ground, params, ball(16, 16, 0.3));
    // Two swings a second by 10 cm. Steps as they are said: Simulation cuts those that are longer than 1/60 s in two.
    const int steps = ground.quick ? rate / 2 : 3 * rate / 2;
    for (int i = 1; i <= steps; ++i)
    {
        const double t = double(i) / rate, swing = std::sin(4.0 * std::numbers::pi * t);
        trial.step(pose({0.1 * swing, 0, 0}, 0.5 * swing), 1.0f / float(rate));
    }
    return trial.watch.worst;
}

Outcome heat_map(const Ground& ground)
{
    Outcome outcome;
    const std::vector<int> rates = ground.quick ? std::vector{30, 60, 240} : std::vector{15, 30, 60, 90, 120, 180, 240};
    const std::vector<double> values[2] = {{0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0},
                                           {0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0}};
    for (const int kind : {0, 1})
    {
        std::string csv = "rate";
        for (const double value : values[kind])
            csv += fmt::format(",{:g}", value);
        csv += '\n';
        for (const int rate : rates)
        {
            ground.say(fmt::format("{}, {} steps a second", kSolvers[kind], rate));
            csv += std::to_string(rate);
            for (const double value : values[kind])
            {
                HairParams params = lone(kind);
                (kind == 0 ? params.bending_droop : params.solver_bending) = float(value);
                const Figures figures = shaken(ground, params, rate);
                judge(outcome, kind, fmt::format("{} steps a second, {:g}", rate, value), figures);
                csv += fmt::format(",{:.4g}", 100.0 * figures.stretch);
            }
            csv += '\n';
        }
        write_file(ground.folder / fmt::format("heat-{}.csv", kSolvers[kind]), csv);
    }
    write_file(ground.folder / "heat.gp", kScript);
    if (!ground.keep)
        return outcome;
    if (run_gnuplot(ground.folder, "heat.gp", "/dev/null") == 0)
        outcome.note = (ground.folder / "heat.png").string();
    else
        outcome.note = "gnuplot did not draw it; on Debian: apt-get install gnuplot-nox, then gnuplot heat.gp";
    return outcome;
}

} // namespace coif::stress
