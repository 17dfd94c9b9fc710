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

void Progress::say(const std::string& doing) const
{
    const auto spent = std::chrono::steady_clock::now() - begin_;
    write_over(fmt::format("{}, {} s", doing, std::chrono::duration_cast<std::chrono::seconds>(spent).count()));
}

void Progress::clear() const { write_over({}); }

} // namespace coif
