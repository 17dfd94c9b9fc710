// What keys, mouse and dropped files do in the editor.
#include "app/editor.h"

#include <backends/imgui_impl_sdl.h>
#include <imgui.h>

#include <algorithm>

namespace coif
{

void Editor::handle_key(const SDL_Keysym& key)
{
    const bool control = key.mod & KMOD_CTRL, shift = key.mod & KMOD_SHIFT;
    redraw_ = kRedraw;
    if (control && key.sym == SDLK_s)
    {
        if (shift || style_.file.empty())
            ask_save_as_ = true;
        else
            save(style_.file);
        return;
    }
    if (control && ((key.sym == SDLK_z && shift) || key.sym == SDLK_y))
        go_back(history_.now + 1);
    else if (control && key.sym == SDLK_z)
        undo_last();
    else if (control && key.sym == SDLK_o)
        ask_open_ = true;
    else if (control && key.sym == SDLK_e)
        show_export(!exporting_.shown);
    else if (control && key.sym == SDLK_q)
        carry_out(Close{});
    if (control)
        return;
    const std::vector<std::string> motions = motion_names();
    const int number = int(key.sym) - SDLK_1;
    if (number >= 0 && number < int(std::min<size_t>(motions.size(), 9)))
        play(motions[size_t(number)]);
    switch (key.sym)
    {
    case SDLK_SPACE:
        paused_ = !paused_;
        break;
    case SDLK_PERIOD:
        paused_ = step_once_ = true;
        break;
    case SDLK_r:
        reset_hair();
        break;
    case SDLK_p:
    case SDLK_F12:
        screenshot();
        break;
    case SDLK_c:
        compare(true);
        break;
    case SDLK_l:
        lights_shown_ = true;
        break;
    case SDLK_a:
        show_beside(!beside_.shown);
        break;
    case SDLK_v:
        style_.params.render_colors =
            (style_.params.render_colors + 1) % int(param_labels(*find_param("render.colors")).size());
        apply();
        break;
    case SDLK_s:
        brushing_ = !brushing_;
        break;
    case SDLK_LEFTBRACKET:
        brush_.radius = std::max(0.004f, brush_.radius / 1.15f);
        break;
    case SDLK_RIGHTBRACKET:
        brush_.radius = std::min(0.15f, brush_.radius * 1.15f);
        break;
    case SDLK_b:
        browse(!browser_.shown);
        break;
    case SDLK_e:
        show_export(!exporting_.shown);
        break;
    case SDLK_u:
        show_history_ = !show_history_;
        break;
    case SDLK_f:
        frame_head(camera_, *simulation_);
        break;
    case SDLK_g:
        style_.params.render_show = (style_.params.render_show + 1) % 3;
        apply();
        break;
    case SDLK_k:
        keep_view();
        break;
    case SDLK_F5:
        guarded([&] { renderer_->reload_shaders(); });
        break;
    case SDLK_t:
        show_times_ = !show_times_;
        break;
    case SDLK_TAB:
        show_panel_ = !show_panel_;
        break;
    case SDLK_h:
    case SDLK_F1:
        show_help_ = !show_help_;
        break;
    case SDLK_ESCAPE:
        simulation_->play(std::nullopt);
        if (beside_.simulation)
            beside_.simulation->play(std::nullopt);
        show_help_ = false;
        break;
    default:
        break;
    }
}

void Editor::handle_mouse(const SDL_Event& event)
{
    if (event.type == SDL_MOUSEBUTTONDOWN && held_.what == Grab::NONE)
    {
        const bool of_b = event.button.x >= picture_width();
        held_left_ = of_b ? picture_width() : 0;
        const double x = event.button.x - held_left_, y = event.button.y;
        const SDL_Keymod mod = SDL_GetModState();
        redraw_ = kRedraw;
        if (event.button.button == SDL_BUTTON_LEFT && !of_b && (press_light(x, y) || press_brush(x, y)))
            return;
        if (event.button.button == SDL_BUTTON_LEFT && event.button.clicks == 2)
            frame_head(camera_, *simulation_);
        else if (event.button.button == SDL_BUTTON_LEFT)
        {
            held_ = grab(*simulation_, camera_, x, y, picture_width(), view_height_, mod & (KMOD_CTRL | KMOD_SHIFT));
            if (of_b && held_.what == Grab::COLLIDER) // B's own are not for dragging
                held_.what = Grab::ORBIT;
        }
        else
            held_.what = event.button.button == SDL_BUTTON_RIGHT ? Grab::ORBIT : Grab::PAN;
    }
    else if (event.type == SDL_MOUSEBUTTONUP)
    {
        if (held_.what == Grab::CUT)
            cut_along(held_.x, held_.y, event.button.x, event.button.y);
        end_stroke();
    }
    else if (event.type == SDL_MOUSEWHEEL)
    {
        if (const auto light = lights_shown_ ? light_under(mouse_.x, mouse_.y) : std::nullopt)
            brighten_light(*light, event.wheel.y);
        else
            zoom(camera_, event.wheel.y);
    }
    else if (event.type == SDL_MOUSEMOTION)
    {
        const double x = event.motion.x - held_left_, y = event.motion.y;
        if (held_.what == Grab::ORBIT)
            orbit(camera_, event.motion.xrel, event.motion.yrel);
        else if (held_.what == Grab::PAN)
            pan(camera_, event.motion.xrel, event.motion.yrel, view_height_);
        else if (held_.what == Grab::BRUSH)
            stroke(x, y, false);
        else if (held_.what == Grab::LIGHT)
            drag_light(x, y);
        else if (held_.what == Grab::COLLIDER)
        {
            Collider& collider = style_.host.colliders.at(held_.collider);
            const glm::vec3 center =
                dragged_collider(held_, *simulation_, camera_, x, y, picture_width(), view_height_);
            if (collider.to)
                collider.to = glm::clamp(*collider.to + center - collider.center, -100.0f, 100.0f);
            collider.center = center;
            stroke_.changed = true;
        }
        else if (held_.what == Grab::TIE)
        {
            style_.host.ties.at(held_.tie) =
                dragged_tie(held_, *simulation_, camera_, x, y, picture_width(), view_height_);
            stroke_.changed = true;
        }
        else if (held_.what == Grab::MOVE_HEAD || held_.what == Grab::TURN_HEAD)
            hand_ = dragged_head(held_, camera_, x, y, picture_width(), view_height_);
    }
    redraw_ = kRedraw;
}

void Editor::handle(const SDL_Event& event)
{
    ImGui_ImplSDL2_ProcessEvent(&event);
    const ImGuiIO& io = ImGui::GetIO();
    redraw_ = kRedraw;
    switch (event.type)
    {
    case SDL_QUIT:
        carry_out(Close{});
        break;
    case SDL_WINDOWEVENT:
        if (event.window.event == SDL_WINDOWEVENT_CLOSE)
            carry_out(Close{});
        break;
    case SDL_DROPFILE:
        open(event.drop.file);
        SDL_free(event.drop.file);
        break;
    case SDL_KEYDOWN:
        if (!io.WantTextInput && !ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId)) // a dialog has the keyboard
            handle_key(event.key.keysym);
        break;
    case SDL_KEYUP:
        if (event.key.keysym.sym == SDLK_c)
            compare(false);
        if (event.key.keysym.sym == SDLK_l)
            show_lights(false);
        break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEWHEEL:
        if (!io.WantCaptureMouse)
            handle_mouse(event);
        break;
    case SDL_MOUSEBUTTONUP:
    case SDL_MOUSEMOTION:
        if (held_.what != Grab::NONE)
            handle_mouse(event);
        break;
    default:
        break;
    }
}

} // namespace coif
