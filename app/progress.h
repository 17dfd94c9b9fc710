#pragma once
#include <fmt/format.h>

#include <chrono>
#include <string>
#include <unistd.h>

namespace coif
{

// One line on standard error that says what is being done, and for how long already; nothing where that is no terminal.
class ProgressLine
{
  public:
    void say(const std::string& doing) const
    {
        const auto spent = std::chrono::steady_clock::now() - begin_;
        if (terminal_)
            fmt::print(stderr, "\r\033[K{} ({} s)", doing,
                       std::chrono::duration_cast<std::chrono::seconds>(spent).count());
    }
    void clear() const
    {
        if (terminal_)
            fmt::print(stderr, "\r\033[K");
    }

  private:
    bool terminal_ = isatty(STDERR_FILENO);
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

} // namespace coif
