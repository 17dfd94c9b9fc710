#include "app/panel.h"

#include "app/panel_lights.h"
#include "app/panel_lists.h"
#include "app/randomise.h"
#include "sim/error.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <numbers>

namespace coif
{

static const ImVec4 kChanged(1.0f, 0.78f, 0.35f, 1.0f);

WidgetPlace last_widget()
{
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    return {low.x, low.y, high.x, high.y};
}

void explain(const std::string& text)
{
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        return;
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1.0f); // what is greyed is told of in plain
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26.0f);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

void keep_in_view(float width, float height)
{
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    const float right = std::max(0.0f, width - size.x), bottom = std::max(0.0f, height - size.y);
    const ImVec2 to(std::clamp(at.x, 0.0f, right), std::clamp(at.y, 0.0f, bottom));
    if ((to.x != at.x || to.y != at.y) && !ImGui::IsMouseDown(ImGuiMouseButton_Left)) // while it is dragged it may
        ImGui::SetWindowPos(to);
}

// Ranges over several powers of ten want a logarithmic slider.
static ImGuiSliderFlags slider_flags(const ParamInfo& info, float usual)
{
    const bool wide = info.min >= 0.0f && usual > 0.0f && info.max > 40.0f * usual;
    return ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : 0);
}

// A pixel of the mouse is a millimetre, a tenth of a degree, or a share of the range that a hand can hold.
static float drag_speed(const ParamInfo& info)
{
    const std::string_view unit = info.unit;
    return unit == "m" ? 0.001f : unit == "deg" ? 0.1f : std::min(0.05f, (info.max - info.min) * 0.0005f);
}

// A curve from root to tip with four points to drag, and its numbers below it to type. A point that the mouse has taken
// is the mouse's until it lets go, wherever that goes.
static bool draw_profile(float v[kMostNumbers], const ParamInfo& info, const char* id)
{
    constexpr float kRadius = 4.0f; // pixels
    const float width = ImGui::CalcItemWidth(), height = 3.0f * ImGui::GetFrameHeight();
    // A wide range has its root drawn, so that the factor 1 does not lie on the floor.
    const auto height_of = [&](float value)
    {
        const float share = (value - info.min) / (info.max - info.min);
        return info.max > 4.0f ? std::sqrt(share) : share;
    };
    const auto value_of = [&](float share)
    { return info.min + (info.max > 4.0f ? share * share : share) * (info.max - info.min); };

    ImGui::BeginGroup();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float left = corner.x + kRadius, step = (width - 2.0f * kRadius) / 3.0f;
    const float floor = corner.y + height - kRadius, room = height - 2.0f * kRadius;
    ImGui::InvisibleButton(id, ImVec2(width, height));
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const int under = std::clamp(int((mouse.x - left) / step + 0.5f), 0, 3);
    int* taken = ImGui::GetStateStorage()->GetIntRef(ImGui::GetID(id), 0);
    if (ImGui::IsItemActivated())
        *taken = under;
    const bool dragged = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
    bool changed = false;
    if (dragged)
    {
        const float to = value_of(std::clamp((floor - mouse.y) / room, 0.0f, 1.0f));
        const float rounded = std::clamp(std::round(to * 100.0f) / 100.0f, info.min, info.max);
        changed = rounded != v[*taken];
        v[*taken] = rounded;
    }
    const auto color = [](ImGuiCol which) { return ImGui::GetColorU32(which); };
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(corner, ImVec2(corner.x + width, corner.y + height), color(ImGuiCol_FrameBg),
                        ImGui::GetStyle().FrameRounding);
    ImVec2 points[4];
    for (int i = 0; i < 4; ++i)
        points[i] = ImVec2(left + float(i) * step, floor - room * height_of(v[i]));
    draw->AddPolyline(points, 4, color(ImGuiCol_PlotLines), 0, 1.5f);
    for (int i = 0; i < 4; ++i)
    {
        const bool lit = dragged ? i == *taken : hovered && i == under;
        draw->AddCircleFilled(points[i], kRadius, color(lit ? ImGuiCol_SliderGrabActive : ImGuiCol_SliderGrab));
    }
    ImGui::SetNextItemWidth(width);
    changed |= ImGui::DragFloat4("##numbers", v, (info.max - info.min) * 0.002f, info.min, info.max, "%.2f",
                                 ImGuiSliderFlags_AlwaysClamp);
    ImGui::EndGroup();
    return changed;
}

static bool draw_number(Hairstyle& style, const ParamInfo& info, const char* id)
{
    static const Hairstyle defaults;
    float v[kMostNumbers] = {}, usual[kMostNumbers] = {};
    get_numbers(style.params, info, v);
    get_numbers(defaults.params, info, usual);
    bool changed = false;
    switch (info.kind)
    {
    case Kind::FLOAT:
        changed = ImGui::SliderFloat(id, v, info.min, info.max,
                                     *info.unit ? fmt::format("%.4g {}", info.unit).c_str() : "%.4g",
                                     slider_flags(info, usual[0]));
        break;
    case Kind::INT:
    {
        int whole = int(v[0]);
        changed = ImGui::SliderInt(id, &whole, int(info.min), int(info.max), "%d", slider_flags(info, usual[0]));
        v[0] = float(whole);
        break;
    }
    case Kind::CHOICE:
    {
        const std::vector<std::string> labels = param_labels(info);
        if (ImGui::BeginCombo(id, labels[size_t(v[0])].c_str()))
        {
            for (size_t i = 0; i < labels.size(); ++i)
                if (ImGui::Selectable(labels[i].c_str(), i == size_t(v[0])))
                {
                    v[0] = float(i);
                    changed = true;
                }
            ImGui::EndCombo();
        }
        break;
    }
    case Kind::VECTOR:
        changed = ImGui::DragFloat3(id, v, drag_speed(info), info.min, info.max, "%.3g", ImGuiSliderFlags_AlwaysClamp);
        break;
    case Kind::PROFILE:
        changed = draw_profile(v, info, id);
        break;
    case Kind::COLOR:
        changed = ImGui::ColorEdit3(id, v);
        break;
    default:
        break;
    }
    if (changed)
    {
        double values[kMostNumbers];
        for (int i = 0; i < info.components(); ++i)
            values[i] = std::clamp(v[i], info.min, info.max);
        set_numbers(style.params, info, values);
    }
    return changed;
}

// Shapes are combed, frozen and taken away in the view.
static bool draw_shape(const Hairstyle& style, const ParamInfo& info, const char* id)
{
    const auto& shape = *reinterpret_cast<const StoredShape*>(reinterpret_cast<const char*>(&style.host) + info.offset);
    std::string said = shape.shapes ? (shape.file.empty() ? "not saved yet" : shape.file) : "none";
    ImGui::InputText(id, &said, ImGuiInputTextFlags_ReadOnly);
    return false;
}

static bool draw_text(Hairstyle& style, const ParamInfo& info, const char* id)
{
    auto& text = *reinterpret_cast<std::string*>(reinterpret_cast<char*>(&style.host) + info.offset);
    std::string edited = text;
    // A path is taken when it is whole, not letter by letter.
    if (!ImGui::InputText(id, &edited, ImGuiInputTextFlags_EnterReturnsTrue) || edited == text)
        return false;
    text = edited;
    return true;
}

// A padlock: closed, or open and faint.
static bool draw_lock(bool locked)
{
    const float height = ImGui::GetFrameHeight(), side = ImGui::GetFontSize() * 0.62f;
    const bool pressed = ImGui::InvisibleButton("lock", ImVec2(height * 0.8f, height));
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const bool hovered = ImGui::IsItemHovered();
    const ImU32 color = ImGui::GetColorU32(hovered  ? ImGuiCol_Text
                                           : locked ? ImGuiCol_CheckMark
                                                    : ImGuiCol_TextDisabled);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 middle(0.5f * (low.x + high.x), 0.5f * (low.y + high.y) + 0.15f * side);
    draw.AddRectFilled(ImVec2(middle.x - 0.5f * side, middle.y), ImVec2(middle.x + 0.5f * side, middle.y + 0.6f * side),
                       color, 1.5f);
    const float aside = locked ? 0.0f : 0.35f * side;
    draw.PathArcTo(ImVec2(middle.x + aside, middle.y - 0.1f * side), 0.3f * side, std::numbers::pi_v<float>,
                   2.0f * std::numbers::pi_v<float>, 8);
    draw.PathLineTo(ImVec2(middle.x + aside + 0.3f * side, middle.y));
    draw.PathStroke(color, 0, 1.5f);
    explain(locked ? "Locked: chance leaves it alone." : "Locks it against chance.");
    return pressed;
}

static bool contains(const std::string& text, const char* part)
{
    const auto same = [](char a, char b)
    { return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b)); };
    return std::search(text.begin(), text.end(), part, part + strlen(part), same) != text.end();
}

// Throws the dice: values within the locks, about where they are now.
static bool draw_chance(Hairstyle& style, PanelState& state)
{
    const bool thrown = ImGui::Button("Randomise");
    state.places["randomise"] = last_widget();
    explain(
        "Draws what shapes and colours the hair anew, about where it is now. The padlock behind a value, or a group's "
        "right button, keeps it as it is.");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(100.0f);
    if (ImGui::InputInt("seed", &state.seed))
        state.seed = std::max(state.seed, 0);
    explain("Of the next throw: it goes up by one with each.");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-ImGui::CalcTextSize("by").x - 2.0f * ImGui::GetStyle().ItemInnerSpacing.x);
    float percent = 100.0f * state.amount;
    if (ImGui::SliderFloat("by", &percent, 1.0f, 100.0f, "%.0f %%", ImGuiSliderFlags_AlwaysClamp))
        state.amount = 0.01f * percent;
    explain("How far a value may go: this much of its slider.");
    if (!thrown)
        return false;
    style = randomised(style, state.seed, double(state.amount), state.locked);
    state.done = fmt::format("randomise, seed {}", state.seed++);
    return true;
}

// What a tooltip says of the values that a parameter may have.
static std::string range_text(const ParamInfo& info, const Hairstyle& defaults)
{
    if (info.kind == Kind::LIST)
        return {};
    std::string text;
    if (info.kind == Kind::CHOICE)
        text = fmt::format("one of {}", fmt::join(param_labels(info), ", "));
    else if (!info.on_host() && info.kind != Kind::COLOR)
        text = fmt::format("{} to {}{}{}", info.min, info.max, *info.unit ? " " : "", info.unit);
    return fmt::format("{}{}{} by default", text, text.empty() ? "" : "; ", value_text(defaults, info));
}

bool draw_params_panel(Hairstyle& style, PanelState& state)
{
    static const Hairstyle defaults;
    bool changed = false, open = false, found = false;
    const char* group = "";
    state.places.clear();
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::InputTextWithHint("##filter", "find a parameter, by its name or what it does", state.filter,
                             sizeof state.filter);
    state.places["filter"] = last_widget();
    changed |= draw_chance(style, state);
    const float lock_width = ImGui::GetFrameHeight() * 0.8f;
    for (const ParamInfo& info : param_table())
    {
        const std::string path = info.path();
        if (*state.filter && !contains(path, state.filter) && !contains(info.help, state.filter))
            continue;
        found = true;
        if (strcmp(group, info.group))
        {
            group = info.group;
            const bool was_open = *state.filter || !state.folded.contains(group); // what is looked for is shown
            ImGui::SetNextItemOpen(was_open);
            open = ImGui::CollapsingHeader(group);
            state.places[std::string("group ") + group] = last_widget();
            if (open != was_open && !*state.filter)
                open ? void(state.folded.erase(group)) : void(state.folded.insert(group));
            if (info.kind == Kind::LIST)
                explain(info.help);
            if (ImGui::BeginPopupContextItem())
            {
                const bool lock = ImGui::MenuItem("lock all against chance"), unlock = ImGui::MenuItem("unlock all");
                for (const ParamInfo& other : param_table())
                    if ((lock || unlock) && !strcmp(other.group, group))
                        lock ? void(state.locked.insert(other.path())) : void(state.locked.erase(other.path()));
                ImGui::EndPopup();
            }
        }
        if (!open)
            continue;
        if (info.kind == Kind::LIST)
        {
            ImGui::PushID(path.c_str());
            changed |= draw_list(style.host, info, state);
            ImGui::PopID();
            continue;
        }
        const bool differs = !same_value(style, defaults, info);
        const std::string id = "##" + path;
        ImGui::PushID(path.c_str());
        ImGui::SetNextItemWidth(ImGui::GetWindowWidth() * 0.5f);
        const bool unread = !is_read(info, style.params);
        ImGui::BeginDisabled(unread);
        const bool lights = path == "look.lights";
        changed |= lights                     ? draw_light_chooser(style, state, id.c_str())
                   : info.kind == Kind::TEXT  ? draw_text(style, info, id.c_str())
                   : info.kind == Kind::SHAPE ? draw_shape(style, info, id.c_str())
                                              : draw_number(style, info, id.c_str());
        const WidgetPlace row = state.places[path] = last_widget();
        ImGui::EndDisabled();
        const bool hovered = ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled);
        ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
        if (differs)
        {
            ImGui::PushStyleColor(ImGuiCol_Text, kChanged);
            if (ImGui::SmallButton("x"))
            {
                copy_value(defaults, style, info);
                style.places.erase(info.path()); // said no longer: a tolerance may choose it again
                changed = true;
            }
            ImGui::PopStyleColor();
            explain(fmt::format("Back to the default, {}", value_text(defaults, info)));
            ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
        }
        ImGui::BeginDisabled(unread);
        ImGui::TextColored(differs ? kChanged : ImGui::GetStyleColorVec4(ImGuiCol_Text), "%s", info.name);
        ImGui::EndDisabled();
        const bool name_hovered = ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled);
        if (is_left_to_chance(info, style.params))
        {
            const float inner = ImGui::GetWindowContentRegionMax().x, right = ImGui::GetWindowPos().x + inner;
            const bool locked = state.locked.contains(path);
            if (locked || ImGui::IsMouseHoveringRect(ImVec2(row.left, row.top), ImVec2(right, row.bottom)))
            {
                ImGui::SameLine(inner - lock_width);
                if (draw_lock(locked))
                    locked ? void(state.locked.erase(path)) : void(state.locked.insert(path));
                state.places[path + " lock"] = {right - lock_width, row.top, right, row.bottom};
            }
        }
        if (hovered || name_hovered)
        {
            ImGui::BeginTooltip();
            ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24.0f);
            ImGui::TextUnformatted(info.help);
            if (unread)
                ImGui::TextColored(kChanged, "%s", fmt::format("Read only where {}.", only_reader(info)).c_str());
            ImGui::TextDisabled("%s", range_text(info, defaults).c_str());
            if (info.kind == Kind::FLOAT || info.kind == Kind::INT)
                ImGui::TextDisabled("ctrl-click to type");
            else if (info.kind == Kind::VECTOR)
                ImGui::TextDisabled("drag: alt is finer, shift coarser; double click to type");
            else if (info.kind == Kind::TEXT && !lights)
                ImGui::TextDisabled("taken with the return key");
            ImGui::PopTextWrapPos();
            ImGui::EndTooltip();
        }
        if (lights)
            draw_light_buttons(style, state);
        if (path == "look.level")
            draw_look_cost(state);
        ImGui::PopID();
    }
    if (!found)
        ImGui::TextDisabled("no parameter has that in its name or help");
    return changed;
}

} // namespace coif
