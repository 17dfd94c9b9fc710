#include "app/progress.h"

#include <fmt/format.h>

#include <cstdio>
#include <unistd.h>

namespace coif
{

static void write_over(const std::string& text)
{
    static const bool terminal = isatty(STDERR_FILENO);
    if (terminal)
        fmt::print(stderr, "\r\033[K{}", text);
}

void Progress::say(const std::string& doing) { write_over(doing); }

void Progress::clear() { write_over({}); }

} // namespace coif
