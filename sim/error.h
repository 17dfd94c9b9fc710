#pragma once
#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace coif
{

// The one exception: bad input, a file that cannot be read or written, a device that says no. The message is a whole
// sentence that names the place and the remedy. It is caught in main(), where it ends the program with status 1, and in
// the editor, which shows it and keeps the last good state. A broken invariant is a bug and asserts instead.
struct Error : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

// throw fail("{}: cannot be read", file)
template <typename... Args> Error fail(fmt::format_string<Args...> text, Args&&... args)
{
    return Error(fmt::format(text, std::forward<Args>(args)...));
}

} // namespace coif
