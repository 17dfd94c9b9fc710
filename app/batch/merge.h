#pragma once
#include "app/batch/list.h"

#include <optional>

namespace coif
{

struct MergeOptions
{
    std::filesystem::path folder; // of the results
    std::string output;           // a picture, film, table or text; a folder: each result by its own name
    std::optional<int> columns;   // of a sheet
    double fps = 30.0;            // of a film
};

// Joins the results in the list's order, whoever made them and when: pictures to a sheet or a film, .csv to one table,
// .json to one array, texts one after another. Names the tasks whose result is not there, has been changed, or is there
// in two ways, and then joins nothing. Removes what killed runs left unfinished. Returns the exit status: 1 for that,
// and where a joined row missed its bound. Throws Error for what cannot be joined or written.
int merge_tasks(const std::vector<Task>& tasks, const MergeOptions& wanted);

} // namespace coif
