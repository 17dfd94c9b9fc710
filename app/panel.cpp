#include "app/panel.h"

#include "sim/error.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

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

static bool draw_number(Hairstyle& style, const ParamInfo& info, const char* id)
{
    static const Hairstyle defaults;
    float v[3] = {}, usual[3] = {};
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
    case Kind::COLOR:
        changed = ImGui::ColorEdit3(id, v);
        break;
    default:
        break;
    }
    if (changed)
    {
        double values[3];
        for (int i = 0; i < 3; ++i)
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
