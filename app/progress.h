#pragma once
#include <chrono>
#include <string>

namespace coif
{

// One line on the terminal, "bob (3 of 10), 12 s", that each word writes over and that goes at the end, or before what
// is to stay. Nothing where words go to a file.
class Progress
{
  public:
    Progress() = default;
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;

    void say(const std::string& doing) const;
    void clear() const;

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

} // namespace coif
