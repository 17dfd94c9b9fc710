#include "app/statistics.h"

#include "sim/median.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace coif
{

double percentile(std::vector<double> values, double share)
{
    if (values.empty())
        return 0.0;
    std::sort(values.begin(), values.end());
    const double at = std::clamp(share, 0.0, 1.0) * double(values.size() - 1);
    const size_t below = size_t(at), above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], at - double(below));
}

double observed_order(const std::vector<double>& step, const std::vector<double>& error)
{
    double count = 0.0, sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
    for (size_t i = 0; i < step.size() && i < error.size(); ++i)
    {
        const double x = std::log(step[i]), y = std::log(error[i]);
        if (!std::isfinite(x) || !std::isfinite(y))
            continue;
        count += 1.0;
        sum_x += x;
        sum_y += y;
        sum_xx += x * x;
        sum_xy += x * y;
    }
    const double spread = count * sum_xx - sum_x * sum_x;
    return count >= 2.0 && spread > 1e-12 ? (count * sum_xy - sum_x * sum_y) / spread : NAN;
}

std::vector<size_t> pareto_front(const std::vector<CostError>& points)
{
    std::vector<size_t> order;
    for (size_t i = 0; i < points.size(); ++i)
        if (std::isfinite(points[i].cost) && std::isfinite(points[i].error))
            order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) {
                         return points[a].cost != points[b].cost ? points[a].cost < points[b].cost
                                                                 : points[a].error < points[b].error;
                     });
    std::vector<size_t> front;
    for (const size_t i : order)
        if (front.empty() || points[i].error < points[front.back()].error)
            front.push_back(i);
    return front;
}

std::vector<double> interleaved_medians(const std::vector<std::function<double()>>& runs, int repeats)
{
    std::vector<std::vector<double>> said(runs.size());
    for (int r = 0; r < repeats; ++r)
        for (size_t i = 0; i < runs.size(); ++i)
            said[i].push_back(runs[i]());
    std::vector<double> medians;
    for (const std::vector<double>& values : said)
        medians.push_back(median(values));
    return medians;
}

} // namespace coif
