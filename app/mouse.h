#pragma once
#include <SDL.h>

namespace coif
{

// The mouse by the events that have been handled. SDL tells where it is at the end of its queue: after a long frame
// that is where it went after a press, not where it pressed.
struct Mouse
{
    int x = 0, y = 0;   // window units
    Uint32 held = 0;    // buttons, as SDL_BUTTON() has them
    Uint32 pressed = 0; // since the last frame, though they may have been let go again
    bool moved = false, released = false, turned = false; // since the last frame; turned: the wheel
};

// Takes the next event that belongs to this frame. What would change what another one of the same frame meant waits for
// the next: a press after a move, as what lies under the mouse is known from a frame's drawing; and what the mouse or
// the keys do after a press or a turn of the wheel. Returns whether there was one. (Dear ImGui does so itself
// since 1.87.)
bool take_event(SDL_Event& event, Mouse& mouse);

// Tells Dear ImGui, between the platform's new frame and its own, and begins a frame.
void show_mouse(Mouse& mouse, SDL_Window* window);

} // namespace coif
