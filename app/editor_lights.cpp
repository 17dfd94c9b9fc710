// Lights in the view: shown about the head while a key is held, turned by the mouse, brightened by the wheel; and the
// files that they are kept in.
#include "app/editor.h"

#include "app/look_level.h"
#include "sim/error.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace coif
{

namespace fs = std::filesystem;

static constexpr double kEighth = 0.25 * std::numbers::pi; // of a turn
static constexpr double kReach = 16.0;                     // pixels from a sun's middle at which the mouse has it

LightGlobe Editor::globe() const
{
    const Pose& head = simulation_->solver().head();
    const glm::dvec3 middle = head.origin + head.turn * glm::dvec3(simulation_->solver().groom().center);
    return light_globe(camera_, middle, picture_width(), view_height_);
}

// As they shine: a file's, the style's own, or the one of look.light_direction.
std::vector<Light> Editor::lights() const
{
    if (const auto& shared = simulation_->assets().lights)
        return shared->lights;
    if (!style_.host.lights.empty())
        return style_.host.lights;
    return {only_light(style_.params)};
}

void Editor::take_own_lights()
{
    if (const auto& shared = simulation_->assets().lights; shared && !style_.host.look_lights.empty())
        set_own_lights(style_, LightRig(*shared));
}

void Editor::change_light(size_t i, const std::function<void(Light&)>& change)
{
    std::vector<Light> all = lights();
    if (i >= all.size())
        return;
    take_own_lights();
    change(all[i]);
    HairParams& p = style_.params;
    if (!style_.host.lights.empty())
        style_.host.lights.at(i) = all[i];
    else
    {
        p.look_light_direction = F4(all[i].direction.x, all[i].direction.y, all[i].direction.z, 0.0f);
        p.look_light_irradiance = all[i].irradiance;
    }
    stroke_.changed = true;
}

std::optional<size_t> Editor::light_under(double x, double y) const
{
    const LightGlobe around = globe();
    const std::vector<Light> all = lights();
    std::optional<size_t> nearest;
    double least = kReach;
    for (size_t i = 0; i < all.size(); ++i)
        if (const double away = glm::distance(place_of(around, all[i].direction), glm::dvec2(x, y)); away <= least)
        {
            least = away;
            nearest = i;
        }
    return nearest;
}

void Editor::show_lights(bool on)
{
    lights_shown_ = on;
    if (std::exchange(brightened_, false))
    {
        apply_strokes();
        note_edit(history_, style_, saved_, "brightness of lights");
    }
}

// Of the light under the mouse, or else of the one that was last chosen, which then goes the way that the mouse goes.
bool Editor::press_light(double x, double y)
{
    const std::vector<Light> all = lights();
    if (!lights_shown_ || all.empty())
        return false;
    show_lights(true); // and the wheel's edit ends
    panel_.light = std::min(light_under(x, y).value_or(panel_.light), all.size() - 1);
    held_.what = Grab::LIGHT;
    held_.light = panel_.light;
    held_.aside = glm::dvec3(place_of(globe(), all[held_.light].direction) - glm::dvec2(x, y), 0.0);
    return true;
}

void Editor::drag_light(double x, double y)
{
    const glm::dvec3 to = direction_at(globe(), glm::dvec2(x, y) + glm::dvec2(held_.aside));
    const glm::vec3 rounded = glm::vec3(glm::round(to * 1e3) / 1e3) + 0.0f; // no -0
    change_light(held_.light, [&](Light& light) { light.direction = rounded; });
}

void Editor::brighten_light(size_t i, double notches)
{
    constexpr double kDim = 0.05; // below it is dark
    change_light(i,
                 [&](Light& light)
                 {
                     const double to = double(light.irradiance) * std::pow(1.1, notches);
                     const double kept = to >= kDim ? to : notches > 0.0 ? kDim : 0.0;
                     light.irradiance = float(std::round(std::min(kept, 100.0) * 1e3) / 1e3);
                 });
    panel_.light = i;
    brightened_ = true;
}

void Editor::draw_lights()
{
    if (!lights_shown_ && held_.what != Grab::LIGHT)
        return;
    const LightGlobe around = globe();
    const auto at = [](glm::dvec2 p) { return ImVec2(float(p.x), float(p.y)); };
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.PushClipRect(ImVec2(0.0f, 0.0f), ImVec2(float(picture_width()), float(view_height_)));
    const float radius = float(around.radius);
    draw.AddCircle(at(around.center), radius, IM_COL32(255, 255, 255, 110), 96, 1.5f);
    draw.AddCircle(at(around.center), 2.0f * radius, IM_COL32(255, 255, 255, 40), 96, 1.0f);
    const auto write = [&](ImVec2 where, const std::string& text)
    {
        draw.AddText(ImVec2(where.x + 1.0f, where.y + 1.0f), IM_COL32(0, 0, 0, 200), text.c_str());
        draw.AddText(where, IM_COL32(255, 255, 255, 230), text.c_str());
    };
    const std::vector<Light> all = lights();
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const std::optional<size_t> under =
        held_.what == Grab::LIGHT ? std::optional(held_.light) : light_under(mouse.x, mouse.y);
    for (size_t i = 0; i < all.size(); ++i)
    {
        const Light& light = all[i];
        const glm::dvec2 place = place_of(around, light.direction);
        const bool behind = glm::distance(place, around.center) > around.radius;
        const auto tint = [&](float alpha)
        { return ImGui::ColorConvertFloat4ToU32(ImVec4(light.color.x, light.color.y, light.color.z, alpha)); };
        const double size = std::clamp(5.0 + 2.0 * std::sqrt(double(light.irradiance)), 5.0, kReach);
        draw.AddLine(at(place), at(around.center), tint(behind ? 0.3f : 0.6f), 1.5f);
        for (int ray = 0; ray < 8; ++ray)
        {
            const glm::dvec2 way(std::cos(ray * kEighth), std::sin(ray * kEighth));
            draw.AddLine(at(place + way * (size + 2.0)), at(place + way * (size + 6.0)), tint(0.9f), 1.5f);
        }
        draw.AddCircleFilled(at(place), float(size), behind ? IM_COL32(30, 30, 30, 220) : tint(1.0f), 24);
        draw.AddCircle(at(place), float(size), behind ? tint(1.0f) : IM_COL32(0, 0, 0, 160), 24, behind ? 3.0f : 1.0f);
        if (i == under || i == panel_.light)
            draw.AddCircle(at(place), float(size) + 8.0f, IM_COL32(255, 200, 90, i == under ? 255 : 130), 24, 2.0f);
        const std::string name = light.name.empty() ? fmt::format("light {}", i + 1) : light.name;
        write(ImVec2(float(place.x + size) + 12.0f, float(place.y) - 7.0f),
              fmt::format("{} {:.3g}{}", name, light.irradiance, behind ? ", behind" : ""));
    }
    write(ImVec2(at(around.center).x - radius, at(around.center).y + 2.0f * radius - 8.0f),
          all.empty() ? "No light but the sky: add one in the panel, under light."
                      : "Drag a light about the head, beyond the circle to behind it; wheel: brighter.");
    draw.PopClipRect();
}

// For the panel: the level that is shown, its cost, and its error if that was asked for.
void Editor::tell_of_look()
{
    if (look_probe_.look())
        redraw_ = std::max(redraw_, kRedraw);
    const LookCost& look = renderer_->look();
    panel_.look_cost = look.level <= LOOK_KAJIYA_KAY
                           ? "kajiya_kay: lit as it is drawn"
                           : fmt::format("{}: {:.1f} ms of light, {:.1f} of colours; should leave out {:.0f} %",
                                         level_name(look.level), look.light_ms, look.shade_ms, 100.0 * look.left_out);
    panel_.look_error = look_probe_.said(simulation_->params(), simulation_->lighting());
    panel_.look_measured = look_probe_.busy();
}

// What the panel's buttons ask for.
void Editor::draw_lights_dialog()
{
    const auto asked = std::exchange(panel_.asked, PanelState::NOTHING);
    if (asked == PanelState::MEASURE_LOOK)
        guarded([&] { look_probe_.begin(*renderer_, *simulation_, camera_, std::max(renderer_->look().level, 1)); });
    if (asked == PanelState::EDIT_LIGHTS)
    {
        take_own_lights();
        apply();
        note_edit(history_, style_, saved_, "lights edited here");
    }
    if (asked == PanelState::SAVE_LIGHTS)
    {
        lights_name_.clear();
        ImGui::OpenPopup("save lights as");
    }
    ImGui::SetNextWindowPos(ImVec2(0.5f * float(view_width_), 0.4f * float(view_height_)), 0, ImVec2(0.5f, 0.5f));
    if (!ImGui::BeginPopupModal("save lights as", nullptr, ImGuiWindowFlags_AlwaysAutoResize))
        return;
    const fs::path folder = style_.file.parent_path() / "lights";
    ImGui::TextDisabled("a name, in %s", fs::absolute(folder).c_str());
    ImGui::SetNextItemWidth(320.0f);
    if (ImGui::IsWindowAppearing())
        ImGui::SetKeyboardFocusHere();
    const bool enter = ImGui::InputText("##name", &lights_name_, ImGuiInputTextFlags_EnterReturnsTrue);
    const std::string file = lights_name_ + ".toml";
    const bool odd = std::ranges::any_of(lights_name_, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    const bool good = !odd && !lights_name_.empty() && lights_name_.size() <= 200 && lights_name_[0] != '.' &&
                      lights_name_.find('/') == std::string::npos;
    std::error_code error;
    const bool exists = good && fs::exists(fs::symlink_status(folder / file, error));
    if (exists)
        ImGui::TextColored(ImVec4(1.0f, 0.78f, 0.35f, 1.0f), "That file exists: its lights will be replaced.");
    ImGui::BeginDisabled(!good);
    const bool clicked = ImGui::Button(exists ? "Replace" : "Save");
    ImGui::EndDisabled();
    // The return key does not replace a file: that takes a click.
    if (good && (clicked || (enter && !exists)))
    {
        save_lights_as(file);
        ImGui::CloseCurrentPopup();
    }
    ImGui::SameLine();
    if (ImGui::Button("Cancel"))
        ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

// From then on the style shares them.
void Editor::save_lights_as(const std::string& file)
{
    guarded(
        [&]
        {
            const fs::path target = style_.file.parent_path() / "lights" / file;
            const auto& shared = simulation_->assets().lights;
            save_lights(shared ? *shared : own_lights(style_), target);
            watch_.know(target);
            static const Hairstyle defaults;
            style_.host.lights.clear();
            for (const char* of_sky : {"look.sky_color", "look.sky_radiance"})
                copy_value(defaults, style_, *find_param(of_sky));
            style_.host.look_lights = "lights/" + file;
            apply();
            simulation_->reload_lights(); // a name that it had before
            note_edit(history_, style_, saved_, "lights saved as " + file);
            say("wrote " + fs::absolute(target).string());
        });
}

} // namespace coif
