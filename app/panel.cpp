#include "app/panel.h"

#include "sim/error.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace coif
{

static const ImVec4 kChanged(1.0f, 0.78f, 0.35f, 1.0f);

// Ranges over several powers of ten want a logarithmic slider.
static ImGuiSliderFlags slider_flags(const ParamInfo& info, float usual)
{
    const bool wide = info.min >= 0.0f && usual > 0.0f && info.max > 40.0f * usual;
    return ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : 0);
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
        changed = ImGui::DragFloat3(id, v, (info.max - info.min) * 0.0005f, info.min, info.max, "%.3g",
                                    ImGuiSliderFlags_AlwaysClamp);
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

static bool draw_colliders(std::vector<Collider>& colliders)
{
    bool changed = false;
    for (size_t i = 0; i < colliders.size(); ++i)
    {
        Collider& c = colliders[i];
        ImGui::PushID(int(i));
        ImGui::Text("%s %zu", c.to ? "capsule" : "sphere", i + 1);
        ImGui::SameLine();
        changed |= ImGui::Checkbox("on the head", &c.on_head);
        ImGui::SameLine();
        const bool remove = ImGui::SmallButton("remove");
        changed |=
            ImGui::DragFloat3("center", &c.center.x, 0.002f, -100.0f, 100.0f, "%.3f m", ImGuiSliderFlags_AlwaysClamp);
        if (c.to)
            changed |=
                ImGui::DragFloat3("to", &c.to->x, 0.002f, -100.0f, 100.0f, "%.3f m", ImGuiSliderFlags_AlwaysClamp);
        changed |= ImGui::SliderFloat("radius", &c.radius, 0.005f, 1.0f, "%.3f m",
                                      ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
        ImGui::PopID();
        if (remove)
        {
            colliders.erase(colliders.begin() + ptrdiff_t(i));
            return true;
        }
    }
    if (colliders.size() >= MOST_COLLIDERS / 2)
        return changed;
    const bool sphere = ImGui::Button("add a sphere");
    ImGui::SameLine();
    const bool capsule = ImGui::Button("add a capsule");
    if (sphere || capsule)
    {
        colliders.push_back({glm::vec3(0.2f, 0.0f, 0.1f), 0.05f, false, {}});
        if (capsule)
            colliders.back().to = glm::vec3(0.2f, -0.2f, 0.1f);
        changed = true;
    }
    return changed;
}

bool draw_params_panel(Hairstyle& style, PanelState& state)
{
    static const Hairstyle defaults;
    bool changed = false, open = false;
    const char* group = "";
    state.places.clear();
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::InputTextWithHint("##filter", "find a parameter", state.filter, sizeof state.filter);
    for (const ParamInfo& info : param_table())
    {
        const std::string path = info.path();
        if (*state.filter && path.find(state.filter) == path.npos)
            continue;
        if (strcmp(group, info.group))
        {
            group = info.group;
            open = ImGui::CollapsingHeader(group, ImGuiTreeNodeFlags_DefaultOpen);
        }
        if (!open)
            continue;
        if (info.kind == Kind::LIST)
        {
            changed |= draw_colliders(style.host.colliders);
            continue;
        }
        const bool differs = !same_value(style, defaults, info);
        const std::string id = "##" + path;
        ImGui::PushID(path.c_str());
        ImGui::SetNextItemWidth(ImGui::GetWindowWidth() * 0.5f);
        const bool unread = !is_read(info, style.params);
        ImGui::BeginDisabled(unread);
        changed |= info.kind == Kind::TEXT ? draw_text(style, info, id.c_str()) : draw_number(style, info, id.c_str());
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        state.places[path] = {low.x, low.y, high.x, high.y};
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
            if (ImGui::IsItemHovered())
                ImGui::SetTooltip("back to the default, %s", value_text(defaults, info).c_str());
            ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
        }
        ImGui::BeginDisabled(unread);
        ImGui::TextColored(differs ? kChanged : ImGui::GetStyleColorVec4(ImGuiCol_Text), "%s", info.name);
        ImGui::EndDisabled();
        if (hovered || ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        {
            ImGui::BeginTooltip();
            ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24.0f);
            ImGui::TextUnformatted(info.help);
            if (unread)
                ImGui::TextColored(kChanged, "%s",
                                   fmt::format("Only the {} solver reads this.", only_reader(info)).c_str());
            if (!info.on_host() && info.kind != Kind::CHOICE && info.kind != Kind::COLOR)
                ImGui::TextDisabled(
                    "%s", fmt::format("{} to {} {}; ctrl-click to type", info.min, info.max, info.unit).c_str());
            ImGui::PopTextWrapPos();
            ImGui::EndTooltip();
        }
        ImGui::PopID();
    }
    return changed;
}

} // namespace coif
