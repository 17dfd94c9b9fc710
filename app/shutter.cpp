#include "app/shutter.h"

#include "app/lens.h"

#include <algorithm>
#include <cmath>

namespace coif
{

double open_steps(const Simulation& simulation)
{
    return open_seconds(simulation.params()) / simulation.step_seconds();
}

void note_moment(Moments& moments, const Simulation& simulation, long target)
{
    const double open = open_steps(simulation);
    const long first = long(std::floor(double(target) - open));
    while (!moments.empty() && moments.front().first < first)
        moments.pop_front();
    const long now = simulation.steps();
    if (open > 0.0 && now >= first && (moments.empty() || moments.back().first < now))
        moments.emplace_back(now, simulation.solver().moment());
}

Moment moment_at(const Moments& moments, const Simulation& simulation, double share)
{
    const double end = double(moments.back().first), begin = end - open_steps(simulation);
    const double at = std::max(begin + (end - begin) * share, double(moments.front().first));
    const size_t before = std::min(size_t(at) - size_t(moments.front().first), moments.size() - 1);
    const size_t after = std::min(before + 1, moments.size() - 1);
    return between(moments[before].second, moments[after].second, at - std::floor(at));
}

} // namespace coif
