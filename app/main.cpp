#include "app/commands.h"
#include "sim/error.h"

#include <cstdio>
#include <exception>

int main(int argc, char** argv)
try
{
    return coif::run_command(argc, argv);
}
catch (const coif::Error& e)
{
    fmt::print(stderr, "coif: {}\n", e.what());
    return 1;
}
catch (const std::exception& e)
{
    fmt::print(stderr, "coif: {} (this is a fault of coif's own; please report it)\n", e.what());
    return 1;
}
