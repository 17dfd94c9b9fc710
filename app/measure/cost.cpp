#include "app/measure/cost.h"

#include "app/statistics.h"

namespace coif
{

std::vector<double> frame_ms(const Solvers& solvers, bool drawn, int repeats)
{
    const int frames = 4; // a single one may be shorter than the clock of the device can tell
    std::vector<std::function<double()>> runs;
    for (const std::unique_ptr<Solver>& solver : solvers)
        runs.push_back(
            [&solver, drawn]
            {
                solver->take_times();
                for (int i = 0; i < frames; ++i)
                {
                    solver->keep_awake();
                    solver->step({{solver->head(), 0.0, 1.0f / 60.0f}});
                    if (drawn)
                        solver->draw();
                }
                return sum_of(solver->take_times()) / frames;
            });
    interleaved_medians(runs, 1); // kernels are built at their first launch
    return interleaved_medians(runs, repeats);
}

} // namespace coif
