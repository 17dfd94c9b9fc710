#pragma once
#include "app/gl.h"

#include <string>

struct ImGuiContext;

namespace coif
{

// A page of the window's own while something takes long that nothing else can be drawn beside, "bob falls to rest" over
// a bar. It has its own ImGui context, so it may come up in the middle of another's frame.
class Waiting
{
  public:
    explicit Waiting(const Window& window); // with ImGui's current context set up, whose fonts it shares
    ~Waiting();                             // before that context goes
    Waiting(const Waiting&) = delete;

    // Begins at share 0 and ends at 1. Nothing is shown of what is soon over.
    void say(const std::string& doing, double share);

    int shown() const { return shown_; } // pages so far

  private:
    const Window& window_;
    ImGuiContext* context_;
    double begin_ = 0.0; // s, of the window's clock
    int shown_ = 0;
};

} // namespace coif
