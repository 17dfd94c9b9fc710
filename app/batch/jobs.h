#pragma once
#include "app/shot.h"

namespace coif
{

// What `coif jobs KIND` is asked for. `passed` are options of the command that a line calls, as they were said.
struct JobsOptions
{
    std::vector<std::string> styles;
    std::vector<std::string> passed;
    std::vector<std::string> only; // scenes or cases; none: all
    std::vector<std::string> vary; // group.key=a,b,c
    int random = 0;                // styles that chance makes of each
    int views = 36;                // of a turn
    long from = 0;                 // the first of the random styles of stress
    long count = -1;               // and how many; -1: its cases instead
    bool untimed = true;           // do tables have no times?
    int each = 20;                 // of them in a line
    int seed = 1;
    std::string format = "usda"; // of a cache
};

// Job lists, a line a task, whose results `coif merge` can join. What a line draws by chance hangs on the numbers in
// it. All throw Error for what no list can be made of.
std::vector<std::string> sheet_jobs(const JobsOptions& wanted);     // a picture of each style: a sheet
std::vector<std::string> turntable_jobs(const JobsOptions& wanted); // a picture of each view: a film, or a sheet
std::vector<std::string> sweep_jobs(const JobsOptions& wanted);     // a scene of `coif measure` each, or, of styles, a
                                                                    // report at each setting: a table
std::vector<std::string> stress_jobs(const JobsOptions& wanted);    // a case each, or some random styles: a table
std::vector<std::string> cache_jobs(const JobsOptions& wanted);     // a shot each: a folder

// The line of one shot as these options say it, into a file of that name.
std::string shot_job(const Options& options, const ShotOptions& shot, const std::string& name);

} // namespace coif
