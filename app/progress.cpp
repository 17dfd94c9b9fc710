#include "app/progress.h"

#include <fmt/format.h>

#include <cstdio>
#include <unistd.h>

namespace coif
{

void show_progress(const std::string& doing)
{
    static const bool terminal = isatty(STDERR_FILENO);
    if (terminal)
        fmt::print(stderr, "\r\033[K{}", doing);
}

} // namespace coif
