#pragma once
#include "app/batch/list.h"

namespace coif
{

struct RunOptions
{
    std::filesystem::path folder; // of the results
    Shard shard;
    int jobs = 1;     // processes at a time
    int tries = 1;    // of a task that fails
    int threads = 0;  // processors for a task; 0: its share of what this process has
    bool told = true; // is there a line for each task on standard output?
};

// Does what is not done yet of the shard, each task in a process of its own, so that what one dies of is its status and
// no more. A result has its name only when it is whole and on the disk, so that this may be killed at any moment, run
// twice at once, and started again. Returns 1 if a task failed; the others are done nevertheless. Throws Error when the
// folder cannot be written or a task's files cannot be read, before any work.
int run_tasks(const std::vector<Task>& tasks, const RunOptions& wanted);

// For a command that does its work as tasks, `jobs` at a time, in a folder of the temporary ones that goes with this.
class RunHere
{
  public:
    RunHere(const std::vector<std::string>& lines, int jobs);
    ~RunHere();
    RunHere(const RunHere&) = delete;

    // The file that line `i` made; empty where it failed, and `fault` is what its log ends with.
    std::filesystem::path result(size_t i, std::string* fault = nullptr) const;

  private:
    std::filesystem::path folder_;
    std::vector<Task> tasks_;
    std::vector<std::string> stems_;
};

} // namespace coif
