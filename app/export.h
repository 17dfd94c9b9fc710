#pragma once
#include "app/options.h"
#include "app/sequence.h"
#include "sim/drawn_curve.h"
#include "sim/exchange/targets.h"

namespace coif
{

struct ExportOptions
{
    std::string target;            // "unreal", ...; empty: metres, y up
    std::string strands = "drawn"; // or "guides"
    std::string curve;             // "linear", "catmull_rom"; empty: what the format and the target take best
    int points = 0;                // of a strand; 0: the style's nodes, and more where that would lose its waves
};

// What options and a file's name come to.
struct ExportPlan
{
    std::filesystem::path file;
    const FormatInfo* format = nullptr;
    const Target* target = nullptr; // or none
    Placement placement;
    FileWords words;
    bool guides = false;
    int points = 0;
    bool cache = false; // frames of a motion, not one pose
};
// Throws Error for what cannot be, before anything is opened for it.
ExportPlan plan_export(const std::string& output, const ExportOptions& wanted, const Hairstyle& style);

// The hair as it is now, checked and placed. The solver must have drawn.
struct ExportHair
{
    Taken taken;
    Curves curves;
};
ExportHair take_hair(const Simulation& simulation, const ExportPlan& plan);

// Sentences on what the file will hold: counts, axes, units, what it leaves out and what the target is known to read.
std::vector<std::string> export_words(const ExportPlan& plan, const Curves& curves, const FileSize& size);

// Writes it, whole or not at all, and says so: "bob.abc: 4.45 MB, in 0.012 s". Throws Error.
std::string write_export(const ExportPlan& plan, const Curves& curves, const Cache* cache = nullptr);

// The frames that are asked for, or the one moment. Throws Error for what the format cannot hold.
std::vector<Frame> export_moments(ExportPlan& plan, const SequenceOptions& frames, double time);
Cache times_of(const std::vector<Frame>& moments, double fps);

// Hears what is being done; what it throws ends that, with nothing written.
struct ExportSays
{
    std::function<void(const std::string& doing, double share)> doing;
    std::function<void(const std::vector<std::string>& words)> words; // export_words(), before anything is written
};
// Plays a motion from its beginning and writes the hair at those moments; returns as write_export(). Throws Error.
std::string export_motion(const Device& device, const Hairstyle& style, const ExportPlan& plan, const Motion& motion,
                          const std::vector<Frame>& moments, const Cache& times, const ExportSays& says);

// `coif export`: plays the motion, and writes what hair has come to or, with frames, a cache. Returns the exit status.
int export_style(const Options& options, const ExportOptions& wanted, const SequenceOptions& frames);

} // namespace coif
