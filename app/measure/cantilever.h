#pragma once
#include <vector>

namespace coif
{

// A heavy elastic rod clamped level at one end, L long: its tip hangs H below the clamp and W away from it. What shape
// it takes is a matter of Gamma = rho g S L^3 / (E I) alone (Romero et al., Physical validation of simulators in
// Computer Graphics, 2021, of which this is the cantilever test).
struct Droop
{
    double gamma, height, width; // height and width as shares of L

    double ratio() const { return height / width; }
};

// The point of the master curve at which the tip is `angle` (rad, in (0, pi / 2)) short of hanging straight down: the
// smaller, the larger Gamma.
Droop droop_of_tip(double angle);

// The master curve at one Gamma, from 0.001 to 100,000.
Droop droop_at(double gamma);

// From one Gamma to another, evenly on a logarithmic scale.
std::vector<Droop> master_curve(double from, double to, int points);

} // namespace coif
