#include "app/commands.h"
#include "sim/error.h"

#include <cstdio>
#include <exception>
#include <system_error>

int main(int argc, char** argv)
try
{
    const int status = coif::run_command(argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
        throw coif::Error("standard output cannot be written");
    return status;
}
catch (const coif::Error& e)
{
    fmt::print(stderr, "coif: {}\n", e.what());
    return 1;
}
catch (const std::system_error& e) // fmt's, when a terminal or pipe is gone
{
    fmt::print(stderr, "coif: {}\n", e.what());
    return 1;
}
catch (const std::exception& e)
{
    fmt::print(stderr, "coif: {} (this is a fault of coif's own; please report it)\n", e.what());
    return 1;
}
