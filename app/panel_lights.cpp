#include "app/panel_lights.h"

#include "sim/light_file.h"

#include <imgui.h>
#include <imgui_stdlib.h>

namespace coif
{

bool draw_light_chooser(Hairstyle& style, PanelState& state, const char* id)
{
    std::string& named = style.host.look_lights;
    if (!ImGui::BeginCombo(id, named.empty() ? "the style's own" : named.c_str()))
        return false;
    if (ImGui::IsWindowAppearing())
        state.light_names = light_names(style.file.parent_path());
    std::string wanted = named;
    if (ImGui::Selectable("the style's own", named.empty()))
        wanted.clear();
    state.places["lights own"] = last_widget();
    for (const std::string& name : state.light_names)
    {
        if (ImGui::Selectable(name.c_str(), name == named))
            wanted = name;
        state.places["lights " + name] = last_widget();
    }
    std::string typed;
    if (ImGui::InputTextWithHint("##path", "or a path", &typed, ImGuiInputTextFlags_EnterReturnsTrue) && !typed.empty())
    {
        wanted = typed;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndCombo();
    const bool changed = wanted != named;
    named = wanted;
    return changed;
}

void draw_light_buttons(const Hairstyle& style, PanelState& state)
{
    ImGui::BeginDisabled(style.host.look_lights.empty());
    if (ImGui::SmallButton("edit here"))
        state.asked = PanelState::EDIT_LIGHTS;
    state.places["edit lights"] = last_widget();
    ImGui::EndDisabled();
    explain("Takes the file's lights and sky into the style, to be changed for it alone.");
    ImGui::SameLine();
    if (ImGui::SmallButton("save lights as..."))
        state.asked = PanelState::SAVE_LIGHTS;
    state.places["save lights"] = last_widget();
    explain("Writes lights and sky as they are now to a file that other styles can name too.");
}

void draw_look_cost(PanelState& state)
{
    if (state.look_cost.empty())
        return;
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextDisabled("%s", state.look_cost.c_str());
    if (!state.look_error.empty())
        ImGui::TextDisabled("%s", state.look_error.c_str());
    ImGui::PopTextWrapPos();
    ImGui::BeginDisabled(state.look_measured);
    if (ImGui::SmallButton(state.look_measured ? "is measured..." : "measure its error"))
        state.asked = PanelState::MEASURE_LOOK;
    state.places["measure look"] = last_widget();
    ImGui::EndDisabled();
    explain(
        "Follows light through the strands as they lie now, in a small picture, some seconds beside the window, and "
        "says how much of it this level has (red, green, blue) and how far it is off on the whole.");
}

} // namespace coif
