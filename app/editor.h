#pragma once
#include "app/options.h"

namespace coif
{

// Opens the editor's window on a hairstyle and runs until it is closed. Returns the exit status.
int edit(const Options& options);

} // namespace coif
