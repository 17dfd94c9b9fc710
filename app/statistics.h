#pragma once
#include <cstddef>
#include <functional>
#include <vector>

namespace coif
{

// The value that `share` (0 to 1) of all values lie at or below, interpolated between ranks; 0 of none.
double percentile(std::vector<double> values, double share);

// The slope of log(error) over log(step) by least squares: 1 for a first-order scheme, 2 for a second-order one. Points
// that are not positive and finite are left out; NaN if fewer than two are left or all steps are the same.
double observed_order(const std::vector<double>& step, const std::vector<double>& error);

struct CostError
{
    double cost, error;
};

// Which points no other one beats in both, cheapest first: as indices. Of equal points the first stands for all; what
// is not finite is never on the front.
std::vector<size_t> pareto_front(const std::vector<CostError>& points);

// Runs all `repeats` times over, one after the other and not each many times in a row, so that a machine that slows
// down slows all of them; returns the median of what each said. Each should have been run once before.
std::vector<double> interleaved_medians(const std::vector<std::function<double()>>& runs, int repeats);

} // namespace coif
