#include "app/mouse.h"

#include <imgui.h>

namespace coif
{

static bool must_wait(const SDL_Event& event, const Mouse& mouse)
{
    const bool meant = mouse.pressed != 0 || mouse.released || mouse.turned;
    switch (event.type)
    {
    case SDL_MOUSEMOTION:
    case SDL_KEYDOWN:
    case SDL_KEYUP:
    case SDL_TEXTINPUT:
        return meant;
    case SDL_MOUSEBUTTONDOWN:
        return meant || mouse.moved;
    case SDL_MOUSEBUTTONUP: // at the place where it was pressed is a click
        return mouse.released || mouse.turned || mouse.moved;
    case SDL_MOUSEWHEEL:
        return mouse.pressed != 0 || mouse.released || mouse.moved;
    default:
        return false;
    }
}

static void note(const SDL_Event& event, Mouse& mouse)
{
    switch (event.type)
    {
    case SDL_MOUSEMOTION:
        mouse.x = event.motion.x;
        mouse.y = event.motion.y;
        mouse.moved = true;
        break;
    case SDL_MOUSEBUTTONDOWN:
        mouse.x = event.button.x;
        mouse.y = event.button.y;
        mouse.held |= SDL_BUTTON(event.button.button);
        mouse.pressed |= SDL_BUTTON(event.button.button);
        break;
    case SDL_MOUSEBUTTONUP:
        mouse.held &= ~SDL_BUTTON(event.button.button);
        mouse.released = true;
        break;
    case SDL_MOUSEWHEEL:
        mouse.turned = true;
        break;
    default:
        break;
    }
}

bool take_event(SDL_Event& event, Mouse& mouse)
{
    SDL_PumpEvents();
    if (SDL_PeepEvents(&event, 1, SDL_PEEKEVENT, SDL_FIRSTEVENT, SDL_LASTEVENT) < 1 || must_wait(event, mouse))
        return false;
    SDL_PeepEvents(&event, 1, SDL_GETEVENT, SDL_FIRSTEVENT, SDL_LASTEVENT);
    note(event, mouse);
    return true;
}

void show_mouse(Mouse& mouse, SDL_Window* window)
{
    ImGuiIO& io = ImGui::GetIO();
    if (!SDL_HasEvent(SDL_MOUSEBUTTONUP)) // one that was let go outside of the window may never be told
        mouse.held &= SDL_GetMouseState(nullptr, nullptr);
    if (SDL_GetMouseFocus() == window)
        io.MousePos = ImVec2(float(mouse.x), float(mouse.y));
    const int buttons[] = {SDL_BUTTON_LEFT, SDL_BUTTON_RIGHT, SDL_BUTTON_MIDDLE};
    for (int i = 0; i < 3; ++i)
        io.MouseDown[i] = ((mouse.held | mouse.pressed) & SDL_BUTTON(buttons[i])) != 0;
    mouse.pressed = 0;
    mouse.moved = mouse.released = mouse.turned = false;
}

} // namespace coif
