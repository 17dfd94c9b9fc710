#pragma once
#include "app/advise/differences.h"
#include "app/advise/features.h"
#include "app/options.h"

namespace coif
{

// What `coif advise` is asked for.
struct AdviseOptions
{
    bool apply = false; // write the cheaper style
    bool json = false;
    std::string motion = "shake";
    double seconds = 1.0;
};

enum class Verdict
{
    LEAVE_OUT,    // the tolerance cannot tell it from the style as it is
    TOGETHER_NOT, // that would go, but not along with all else that goes
    KEEP,
    LACKS, // what the tolerance can tell, and the style does not have
    ENOUGH // the style does without, and nobody would see it
};

struct Advised
{
    Feature feature;
    Difference difference;
    Verdict verdict;
};

struct Advice
{
    std::string style, motion, device;
    double seconds = 0.0;
    double tolerance = 0.0;         // of motion, a fraction of the longest strand
    double picture_tolerance = 0.0; // 1 - SSIM: what the hair moved aside by that makes, and at most half of what
                                    // another seed does
    double another_seed = 0.0;      // what that does
    double step_ms = 0.0, picture_ms = 0.0; // Comparison
    Hairstyle base, lean;                   // what was measured, and without all that can be left out together
    Difference together;                    // of the lean one
    std::vector<Advised> features;
    int guides = 0;
    double guide_error = 0.0; // predicted: error_of_guides()
};

// Measures what the style does and does not do, then all together that it could leave out; while that is too much, what
// takes most of the tolerance goes back in. No verdict hangs on a time. Parameters as they are simulated:
// quality.tolerance has had its say. Throws Error as compare() does.
Advice advise_on(const Trial& trial, const Hairstyle& style);

// A table for people, and one JSON object.
std::string table_of(const Advice& advice);
std::string json_of(const Advice& advice, const std::string& written);

// Prints the advice and, if wanted, writes the cheaper style. Returns the exit status.
int advise(const Options& options, const AdviseOptions& wanted);

} // namespace coif
