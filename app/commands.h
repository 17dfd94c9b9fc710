#pragma once

namespace coif
{

// The command line: finds the command, runs it, returns the exit status: 0, 1 for bad input or a failed check, 2 for
// bad usage. Throws Error for bad input.
int run_command(int argc, char** argv);

} // namespace coif
