// coif jobs, run and merge: what many machines do together, from a list of lines, a command each.
#pragma once
#include "app/batch/jobs.h"
#include "app/batch/merge.h"
#include "app/batch/run.h"

#include <memory>

namespace CLI
{
class App;
}

namespace coif
{

// The three commands, and what they are asked for.
struct Batch
{
    CLI::App *jobs = nullptr, *run = nullptr, *merge = nullptr;
    std::string list, shard = "0/1";
    JobsOptions wanted;
    RunOptions running;
    MergeOptions merging;
};

// Adds them to the program's.
std::shared_ptr<Batch> add_batch(CLI::App& app);

// Was one of them asked for? Then its exit status: 2 where the list itself is wrong.
bool is_batch(const Batch& batch);
int run_batch(const Batch& batch, const CheckLine& check);

} // namespace coif
