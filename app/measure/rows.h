#pragma once
#include <cmath>
#include <string>
#include <vector>

namespace coif
{

// One figure that was measured: where, at which setting of which knob, how wrong, at what price. What a row does not
// know is NaN, which is an empty field of the CSV and null in JSON.
struct Row
{
    std::string scene;     // "A12"
    std::string setting;   // which of the scene's cases: "contact"
    std::string metric;    // what `error` is: "median distance"
    std::string solver;    // model that moved the guides
    std::string knob;      // what was turned, with its unit: "guide spacing, mm"
    double value = NAN;    // of the knob
    double measured = NAN; // the quantity itself, where it is not an error
    double error = NAN;    // against the reference; the better the smaller, or the larger if `at_least`
    std::string unit;      // of measured and error: "L" is a strand's length
    std::string reference; // what the error is against
    double stretch = NAN;  // worst of a guide's segment, fraction
    double penetration_mm = NAN;
    double ns_strand_frame =
        NAN;           // device time for a strand and a frame of 1/60 s; a drawn strand where those are counted
    double ms = NAN;   // of a whole picture or frame, where that is the price
    double pass = NAN; // bound that the error must keep; NaN: the row is not judged
    double state_of_the_art = NAN;
    bool at_least = false; // is a larger error better, as for an order or a similarity?

    bool judged() const { return !std::isnan(pass); }
    bool passed() const { return !judged() || within(pass); }
    bool excels() const { return !std::isnan(state_of_the_art) && within(state_of_the_art); }

  private:
    // A NaN keeps no bound.
    bool within(double bound) const { return at_least ? error >= bound : error <= bound; }
};

std::string case_of(const Row& row); // its scene and setting: "A12 contact"
bool in_percent(const Row& row);     // do people read its error best so: fractions, of a length too

// All rows with a head line, fields quoted as RFC 4180 asks.
std::string csv_of(const std::vector<Row>& rows);
std::vector<Row> rows_of(const std::string& csv); // to six digits

// One object: what ran on what, and the rows.
std::string json_of(const std::vector<Row>& rows, const std::string& device, bool quick);

// For people: a line a row, scene by scene, with a verdict beside those that have a bound.
std::string table_of(const std::vector<Row>& rows);

} // namespace coif
