// Two styles in one window, in the same motion at the same time; the way from one to the other; and the legend of what
// the strands' colours tell.
#include "app/editor.h"
#include "app/lettering.h"
#include "app/morph.h"
#include "sim/error.h"
#include "sim/source.h"

#include <glm/gtc/quaternion.hpp>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace coif
{

namespace fs = std::filesystem;

void Editor::put_beside(const fs::path& file)
{
    guarded(
        [&]
        {
            beside_.style = file.empty() ? saved_ : load_hairstyle(file);
            beside_.from.reset();
            beside_.at = 0.0f;
            if (beside_.simulation)
                split(true);
        });
    redraw_ = kRedraw;
}

void Editor::show_beside(bool on)
{
    beside_.shown = on;
    if (!on)
        split(false);
}

// Both begin the motion anew, so that they are at the same time of it.
void Editor::split(bool on)
{
    beside_.simulation.reset();
    redraw_ = kRedraw;
    if (!on || !beside_.style)
        return;
    guarded(
        [&]
        {
            auto other = alive(*beside_.style);
            if (!beside_.renderer)
                beside_.renderer = std::make_unique<Renderer>(data_folder() / "shaders");
            other->step(simulation_->hand()); // a leap to where the head is
            const bool played = simulation_->playing();
            const Motion motion = played ? find_motion(motion_) : Motion{};
            if (played)
            {
                simulation_->play(motion);
                other->play(motion);
            }
            beside_.began = simulation_->time() - other->time();
            beside_.simulation = std::move(other);
        });
}

// As many steps as A has taken, or as its own rate makes of them, with the hand on the same way.
void Editor::follow()
{
    Simulation& other = *beside_.simulation;
    const double due = simulation_->time() - beside_.began - other.time();
    const int steps = int(std::lround(due / other.step_seconds()));
    const Pose from = other.hand(), to = simulation_->hand();
    for (int i = 1; i <= steps; ++i)
    {
        const double share = double(i) / steps;
        other.step({glm::mix(from.origin, to.origin, share), glm::slerp(from.turn, to.turn, share), {}});
    }
    if (steps > 0 && !other.solver().asleep())
        redraw_ = std::max(redraw_, 2);
}

void Editor::morph(float at)
{
    // What has been edited since is where the way begins now.
    if (!beside_.from || !difference(style_, morphed(*beside_.from, *beside_.style, double(beside_.at))).empty())
        beside_.from = style_;
    beside_.at = at;
    style_ = morphed(*beside_.from, *beside_.style, double(at));
    apply();
}

std::string Editor::half_name(bool b) const
{
    return b ? "B: " + beside_.style->name() : "A: " + style_.name() + (unsaved_ ? " *" : "");
}

// A picture of both, marked as the window is.
void Editor::mark_halves(Image& both, int half) const
{
    const int letters = std::max(12, both.height / 48), gap = letters / 2;
    if (half < 8 * letters || both.height < 4 * letters)
        return;
    fill(both, half, 0, 1, both.height, {120, 120, 120});
    for (const bool b : {false, true})
    {
        const TextLine line = line_of(half_name(b), letters, half - 4 * gap);
        const int left = (b ? both.width : half) - line.width - 2 * gap;
        fill(both, left - gap, gap, line.width + 2 * gap, line.height + gap, {34, 36, 40});
        write_line(both, line, left, gap + gap / 2, {235, 235, 235});
    }
}

void Editor::draw_beside()
{
    beside_.places.clear();
    ImGui::SetNextWindowPos(ImVec2(0.5f * float(view_width_), float(view_height_) - kMessageRoom),
                            ImGuiCond_FirstUseEver, ImVec2(0.5f, 1.0f));
    bool open = true;
    if (ImGui::Begin("A and B", &open, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse))
    {
        keep_in_view(float(view_width_), float(view_height_) - kMessageRoom);
        ImGui::AlignTextToFramePadding();
        ImGui::Text("A: %s", style_.name().c_str());
        ImGui::SameLine();
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted("  B:");
        ImGui::SameLine();
        ImGui::SetNextItemWidth(150.0f);
        const std::string name = beside_.style ? beside_.style->name() : "choose one";
        if (ImGui::BeginCombo("##b", name.c_str()))
        {
            if (ImGui::Selectable("this one as saved"))
                put_beside({});
            for (const fs::path& file : preset_files())
                if (ImGui::Selectable(file.stem().string().c_str(), beside_.style && beside_.style->file == file))
                    put_beside(file);
            ImGui::EndCombo();
        }
        beside_.places["b"] = last_widget();
        explain("The style to compare with, or to morph into.");
        ImGui::SameLine();
        ImGui::BeginDisabled(!browser_.shown || browser_.selected.empty());
        if (ImGui::Button("from the browser"))
            put_beside(browser_.selected);
        ImGui::EndDisabled();
        explain("Takes what is chosen in the browser of presets (b) for B.");
        ImGui::BeginDisabled(!beside_.style);
        bool side_by_side = beside_.simulation != nullptr;
        if (ImGui::Checkbox("side by side", &side_by_side))
            split(side_by_side);
        beside_.places["split"] = last_widget();
        explain("Both in the same motion, at the same time, each in a half of the window.");
        ImGui::SameLine();
        ImGui::SetNextItemWidth(200.0f);
        float percent = 100.0f * beside_.at;
        if (ImGui::SliderFloat("morph A to B", &percent, 0.0f, 100.0f, "%.0f %%", ImGuiSliderFlags_AlwaysClamp))
            morph(0.01f * percent);
        beside_.places["morph"] = last_widget();
        explain(
            "Numbers and colours go over; choices, files and colliders switch in the middle. Save as keeps what came "
            "of it.");
        ImGui::EndDisabled();
    }
    ImGui::End();
    if (!open)
        show_beside(false);
    if (!beside_.simulation)
        return;
    // Whose half is whose, and a line between them.
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const float half = float(picture_width());
    draw.AddLine(ImVec2(half, 0.0f), ImVec2(half, float(view_height_)), IM_COL32(255, 255, 255, 90));
    for (const bool b : {false, true})
    {
        const std::string text = half_name(b);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        const ImVec2 at(half * (b ? 2.0f : 1.0f) - size.x - 12.0f, 10.0f);
        draw.AddRectFilled(ImVec2(at.x - 6.0f, at.y - 3.0f), ImVec2(at.x + size.x + 6.0f, at.y + size.y + 3.0f),
                           ImGui::GetColorU32(ImVec4(0.0f, 0.0f, 0.0f, kBacking)), 3.0f);
        draw.AddText(at, IM_COL32(235, 235, 235, 255), text.c_str());
    }
}

void Editor::draw_legend()
{
    const ImGuiWindowFlags plain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing |
                                   ImGuiWindowFlags_NoSavedSettings;
    ImGui::SetNextWindowPos(ImVec2(float(view_width_) - 8.0f, float(view_height_) - 8.0f), 0, ImVec2(1.0f, 1.0f));
    ImGui::SetNextWindowBgAlpha(kBacking);
    ImGui::Begin("legend", nullptr, plain);
    ImGui::TextUnformatted(legend_.title.c_str());
    const float width = 240.0f, height = 12.0f;
    const ImVec2 low = ImGui::GetCursorScreenPos();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const auto byte = [](float linear)
    {
        return int(std::lround(255.0 * (linear <= 0.0031308f ? 12.92 * double(linear)
                                                             : 1.055 * std::pow(double(linear), 1.0 / 2.4) - 0.055)));
    };
    const auto shade = [&](float value)
    {
        const glm::vec3 c = ramp_color(value);
        return IM_COL32(byte(c.r), byte(c.g), byte(c.b), 255);
    };
    // Sorts have a line each, numbers a scale.
    const size_t count = legend_.readings.size();
    const bool sorts =
        count == 2 || param_labels(*find_param("render.colors"))[size_t(style_.params.render_colors)] == "region";
    const float line = ImGui::GetTextLineHeight();
    ImGui::Dummy(ImVec2(width, sorts ? float(count) * line : height + line));
    for (size_t i = 0; i < count; ++i)
    {
        const char* text = legend_.readings[i].c_str();
        const float share = float(i) / float(count - 1);
        if (sorts)
        {
            const float y = low.y + float(i) * line;
            draw.AddRectFilled(ImVec2(low.x, y + 2.0f), ImVec2(low.x + 24.0f, y + height),
                               shade(count > 2 ? share
                                     : i == 0  ? kMixedPlace
                                               : kCopyPlace));
            draw.AddText(ImVec2(low.x + 32.0f, y), ImGui::GetColorU32(ImGuiCol_Text), text);
            continue;
        }
        draw.AddText(ImVec2(low.x + share * (width - ImGui::CalcTextSize(text).x), low.y + height),
                     ImGui::GetColorU32(ImGuiCol_Text), text);
    }
    for (int i = 0; i < 60 && !sorts; ++i)
        draw.AddRectFilled(ImVec2(low.x + float(i) * width / 60.0f, low.y),
                           ImVec2(low.x + float(i + 1) * width / 60.0f, low.y + height - 2.0f),
                           shade((float(i) + 0.5f) / 60.0f));
    ImGui::End();
}

} // namespace coif
