// What the editor draws over its picture: tools, parameters, dialogs, figures.
#include "app/editor.h"
#include "app/look_level.h"
#include "sim/error.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace coif
{

static const char kHelp[] = "drag the head         move it\n"
                            "ctrl-drag the head    turn it\n"
                            "drag a collider       move it\n"
                            "drag a ring           move it over the head\n"
                            "drag elsewhere        orbit (right button: anywhere)\n"
                            "middle drag           pan\n"
                            "wheel                 zoom\n"
                            "double click, f       frame the head\n"
                            "space                 pause, go on\n"
                            ".                     one step\n"
                            "r                     reset the hair\n"
                            "1 to 7                play a motion\n"
                            "esc                   stop the motion\n"
                            "g                     drawn strands, guides, both\n"
                            "k                     keep the camera in the style\n"
                            "p, F12                screenshot\n"
                            "ctrl-z                undo\n"
                            "ctrl-shift-z, ctrl-y  redo\n"
                            "c, held               as saved\n"
                            "u                     what was done, to go back to\n"
                            "ctrl-s                save\n"
                            "ctrl-shift-s          save as\n"
                            "ctrl-o                open\n"
                            "e, ctrl-e             export for other tools\n"
                            "b                     browse presets\n"
                            "a                     another style beside, morph\n"
                            "l, held               lights: drag them, wheel for brighter\n"
                            "s                     shape: brushes, cut, freeze, variants\n"
                            "[ ]                   a smaller, a larger brush\n"
                            "alt-click             takes the value under the brush\n"
                            "v                     colours: hair, stretch, density, kind, region, map\n"
                            "t                     times of the passes, device\n"
                            "F5                    read the shaders again\n"
                            "tab                   hide the panel\n"
                            "h, F1                 this list\n"
                            "ctrl-q                close";

static std::filesystem::path with_suffix(std::filesystem::path file)
{
    return file.has_extension() ? file : file.replace_extension(".toml");
}

void Editor::draw_ui()
{
    if (show_panel_)
    {
        ImGui::SetNextWindowPos(ImVec2(float(view_width_), 0.0f));
        ImGui::SetNextWindowSize(ImVec2(ImGui::GetIO().DisplaySize.x - float(view_width_), float(view_height_)));
        ImGui::Begin("panel", nullptr,
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove);
        draw_tools();
        ImGui::Separator();
        ImGui::BeginChild("parameters");
        if (draw_params_panel(style_, panel_))
            apply();
        if (!panel_.done.empty())
            note_edit(history_, style_, saved_, std::exchange(panel_.done, {}));
        ImGui::EndChild();
        ImGui::End();
    }
    draw_lights();
    draw_status();
    if (show_history_)
        draw_history();
    if (browser_.shown)
        draw_browser();
    if (beside_.shown)
        draw_beside();
    if (brushing_)
        draw_brushes();
    if (!legend_.readings.empty())
        draw_legend();
    if (exporting_.shown)
        draw_export();
    draw_files();
    draw_lights_dialog();
    draw_dialogs();
}

// All that was done, the newest last; what was undone is grey.
void Editor::draw_history()
{
    // Below the browser, above the legend.
    const ImVec2 low(float(view_width_) - 8.0f, 0.63f * float(view_height_));
    ImGui::SetNextWindowPos(low, ImGuiCond_FirstUseEver, ImVec2(1.0f, 0.0f));
    ImGui::SetNextWindowSize(ImVec2(280.0f, 0.26f * float(view_height_)), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowBgAlpha(kBacking);
    if (ImGui::Begin("what was done", &show_history_))
    {
        keep_in_view(float(view_width_), float(view_height_));
        for (size_t i = 0; i < history_.edits.size(); ++i)
        {
            ImGui::PushID(int(i));
            const bool undone = i > history_.now;
            if (undone)
                ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
            const bool chosen = ImGui::Selectable(history_.edits[i].what.c_str(), i == history_.now);
            if (undone)
                ImGui::PopStyleColor();
            ImGui::PopID();
            if (chosen)
                go_back(i);
        }
        if (ImGui::IsWindowAppearing() || history_.edits.size() != history_seen_)
            ImGui::SetScrollHereY(1.0f); // the newest is seen
        history_seen_ = history_.edits.size();
    }
    ImGui::End();
}

void Editor::draw_tools()
{
    const auto button = [](const char* label, const char* help)
    {
        const bool pressed = ImGui::Button(label);
        explain(help);
        return pressed;
    };
    // One that shows whether its window is open.
    const auto toggle = [&](const char* label, bool on, const char* help)
    {
        if (on)
            ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
        const bool pressed = button(label, help);
        if (on)
            ImGui::PopStyleColor();
        return pressed;
    };
    ImGui::SetNextItemWidth(115.0f);
    if (ImGui::BeginCombo("##open", style_.name().c_str()))
    {
        for (const std::filesystem::path& file : preset_files())
            if (ImGui::Selectable(file.stem().string().c_str(), file == style_.file))
                open(file);
        ImGui::EndCombo();
    }
    explain("Opens a preset; or drop a file onto the window.");
    ImGui::SameLine();
    if (toggle("Browse", browser_.shown, "b: presets with their pictures"))
        browse(!browser_.shown);
    ImGui::SameLine();
    if (button(unsaved_ ? "Save *" : "Save", "ctrl-s; a star where there is something to save"))
    {
        if (style_.file.empty())
            ask_save_as_ = true;
        else
            save(style_.file);
    }
    ImGui::SameLine();
    if (button("Save as", "ctrl-shift-s: under another name"))
        ask_save_as_ = true;
    ImGui::SameLine();
    if (button("Open", "ctrl-o: a preset, or a file by its path"))
        ask_open_ = true;
    ImGui::SameLine();
    if (toggle("?", show_help_, "h, F1: keys and mouse"))
        show_help_ = !show_help_;

    if (button(paused_ ? "Play###pause" : "Pause###pause", "space: time stands still, the hair can still be shaped"))
        paused_ = !paused_;
    ImGui::SameLine();
    if (button("Step", "full stop: one step of time"))
        paused_ = step_once_ = true;
    ImGui::SameLine();
    if (button("Undo", "ctrl-z; redo: ctrl-shift-z; all that was done: u"))
        undo_last();
    ImGui::SameLine();
    if (button("Reset", "r: the hair begins anew where it rests"))
        reset_hair();
    ImGui::SameLine();
    if (button("Keep view", "k: the style opens with the camera as it is now"))
        keep_view();
    ImGui::SameLine();
    if (toggle("Shape", brushing_, "s: brushes, scissors, freeze and variants"))
        brushing_ = !brushing_;
    ImGui::SameLine();
    if (toggle("A/B", beside_.shown, "a: another style beside this one, or on the way to it"))
        show_beside(!beside_.shown);
    int key = 0;
    for (const std::string& motion : motion_names())
    {
        if (key++)
            ImGui::SameLine(0.0f, 3.0f);
        const bool on = simulation_->motion_name() == motion;
        if (on)
            ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
        if (ImGui::SmallButton(motion.c_str()))
            play(motion);
        if (on)
            ImGui::PopStyleColor();
        explain(fmt::format("{}: moves the head so; esc stops it", key));
    }
    ImGui::SameLine();
    ImGui::Checkbox("give way", &leeway_.allowed);
    explain(fmt::format("Follows light less finely and draws fewer and wider strands while you drag something and a "
                        "frame takes longer than {:.0f} ms; they come back in steps when the hand rests. Files never "
                        "know of it.",
                        kFrameWanted));
    if (button("Screenshot", "p, F12: what the view shows, without windows, into the folder that coif was started in"))
        screenshot();
    ImGui::SameLine();
    if (toggle("Export", exporting_.shown, "e, ctrl-e: the hair as curves that other tools read"))
        show_export(!exporting_.shown);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(80.0f);
    if (ImGui::BeginCombo("##size", screenshot_size_.c_str()))
    {
        for (const char* size : {"as shown", "1920x1080", "2048x2048", "3840x2160", "8192x8192"})
            if (ImGui::Selectable(size, screenshot_size_ == size))
                screenshot_size_ = size;
        ImGui::EndCombo();
    }
    explain("Pixels of the picture");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(70.0f);
    ImGui::InputTextWithHint("##picture", style_.name().c_str(), &screenshot_name_);
    explain("Name of the picture, a path if you like; a number and .png follow.");
    ImGui::SameLine();
    ImGui::Checkbox("alpha", &transparent_);
    explain("No backdrop: the picture is clear where there is neither head nor hair.");
}

// What a tolerance has chosen: in a line, and in full when that is opened.
void Editor::draw_quality(float top)
{
    const Quality& quality = simulation_->quality();
    ImGui::SetNextWindowPos(ImVec2(8.0f, top));
    ImGui::SetNextWindowBgAlpha(kBacking);
    ImGui::Begin("quality", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoMove);
    const std::string line = quality.rungs.empty() ? "tolerance: nothing chosen"
                                                   : fmt::format("predicted {:.2g} %, measured substeps {:.2g} %",
                                                                 100.0 * quality.predicted(), 100.0 * time_error_);
    if (ImGui::TreeNodeEx("###quality", ImGuiTreeNodeFlags_SpanAvailWidth, "%s", line.c_str()))
    {
        ImGui::PushTextWrapPos(440.0f);
        ImGui::TextUnformatted(quality_text(quality).c_str());
        if (!quality.rungs.empty())
            ImGui::Text("measured in %s: substeps %.2g %%, against eight times as many", measured_motion_.c_str(),
                        100.0 * time_error_);
        ImGui::PopTextWrapPos();
        ImGui::TreePop();
    }
    ImGui::End();
}

void Editor::draw_status()
{
    const Solver& solver = simulation_->solver();
    const Groom& groom = solver.groom();
    const ImGuiWindowFlags plain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing;
    ImGui::SetNextWindowPos(ImVec2(8.0f, 8.0f));
    ImGui::SetNextWindowBgAlpha(kBacking);
    ImGui::PushStyleColor(ImGuiCol_TextDisabled, ImVec4(0.75f, 0.75f, 0.75f, 1.0f)); // what is usual is too dark here
    ImGui::Begin("figures", nullptr, plain);
    ImGui::Text("%.1f ms a frame, %.0f a second%s", frame_ms_, 1e3 / std::max(frame_ms_, 1e-3),
                paused_ ? ", paused" : "");
    if (comparing_)
        ImGui::TextColored(ImVec4(1.0f, 0.8f, 0.4f, 1.0f), "as saved");
    ImGui::Text("%d guides of %d nodes, %zu strands drawn", groom.guides, groom.nodes, groom.drawn.size());
    ImGui::Text("stretch %.1f %% at worst, %.2f %% on average", 100.0 * health_.stretch_max,
                100.0 * health_.stretch_mean);
    ImGui::Text("%.1f mm deep in head or colliders at worst", 1e3 * health_.penetration_max);
    if (healed_ > 0)
        ImGui::TextColored(ImVec4(1.0f, 0.5f, 0.4f, 1.0f), "strands healed %ld times", healed_);
    if (!bad_strand_.empty())
    {
        ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26.0f);
        ImGui::TextColored(ImVec4(1.0f, 0.5f, 0.4f, 1.0f), "%s", bad_strand_.c_str());
        ImGui::PopTextWrapPos();
    }
    if (simulation_->solver().asleep())
        ImGui::Text("asleep: at rest, nothing runs");
    else if (const int thin = solver.blocks_thin(); thin > 0)
        ImGui::Text("%d of %d blocks are far: half the nodes", thin, groom.blocks);
    if (simulation_->dropped() > 0)
        ImGui::Text("%ld steps dropped", simulation_->dropped());
    if (show_times_)
    {
        double sum = 0.0;
        const auto row = [](const std::string& pass, double ms)
        {
            ImGui::TextDisabled("%s", pass.c_str());
            ImGui::SameLine(150.0f);
            ImGui::TextDisabled("%6.2f ms", ms);
        };
        for (const auto& [pass, ms] : pass_ms_)
        {
            row(pass, ms);
            sum += ms;
        }
        row("all passes", sum);
        ImGui::TextDisabled("%s, %s", device_.name.c_str(), shares_gl(device_) ? "shared" : "mapped");
        ImGui::TextDisabled("%s", renderer_->name().c_str());
    }
    ImGui::TextDisabled("%s", trial_.said(style_.params).c_str());
    if (const LookCost& look = renderer_->look(); look.level > LOOK_KAJIYA_KAY)
        ImGui::TextDisabled("light by %s: %.1f ms, and %.1f ms as it is seen; leaves out %.0f %% of it",
                            level_name(look.level), look.light_ms, look.shade_ms, 100.0 * look.left_out);
    if (const std::string given = leeway_text(leeway_); !given.empty())
        ImGui::TextColored(ImVec4(1.0f, 0.8f, 0.4f, 1.0f), "%s", given.c_str());
    else if (refined_ > 1)
        ImGui::TextDisabled("still: the mean of %d pictures", refined_);
    const float below = ImGui::GetWindowHeight() + 12.0f;
    ImGui::End();
    ImGui::PopStyleColor();
    if (!simulation_->quality().said.empty())
        draw_quality(below);

    if (!message_.empty())
    {
        ImGui::SetNextWindowPos(ImVec2(8.0f, float(view_height_) - 8.0f), 0, ImVec2(0.0f, 1.0f));
        ImGui::SetNextWindowSizeConstraints(ImVec2(50.0f, 0.0f), ImVec2(float(view_width_) - 16.0f, 400.0f));
        ImGui::Begin("message", nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                         ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoMove);
        if (ImGui::SmallButton("x"))
            message_.clear();
        ImGui::SameLine();
        ImGui::PushTextWrapPos(float(view_width_) - 60.0f);
        ImGui::TextColored(message_is_error_ ? ImVec4(1.0f, 0.5f, 0.4f, 1.0f) : ImVec4(0.7f, 0.9f, 0.7f, 1.0f), "%s",
                           message_.c_str());
        ImGui::PopTextWrapPos();
        ImGui::End();
    }
    if (show_help_)
    {
        ImGui::SetNextWindowPos(ImVec2(0.5f * float(view_width_), 0.5f * float(view_height_)), 0, ImVec2(0.5f, 0.5f));
        ImGui::Begin("keys and mouse", &show_help_, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse);
        // Two columns: the font need not be of one width.
        ImGui::BeginTable("keys", 2);
        for (const char* line = kHelp; line;)
        {
            const char* end = strchr(line, '\n');
            const std::string text(line, end ? size_t(end - line) : strlen(line));
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(text.substr(0, 22).c_str());
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(text.substr(22).c_str());
            line = end ? end + 1 : nullptr;
        }
        ImGui::EndTable();
        ImGui::End();
    }
}

void Editor::draw_dialogs()
{
    const auto center = [&]
    { ImGui::SetNextWindowPos(ImVec2(0.5f * float(view_width_), 0.4f * float(view_height_)), 0, ImVec2(0.5f, 0.5f)); };
    const bool asking = !std::holds_alternative<std::monostate>(intent_);
    if (asking && !ImGui::IsPopupOpen("unsaved changes"))
        ImGui::OpenPopup("unsaved changes");
    center();
    if (ImGui::BeginPopupModal("unsaved changes", nullptr, ImGuiWindowFlags_AlwaysAutoResize))
    {
        ImGui::Text("%s has unsaved changes.", style_.name().c_str());
        const bool can_save = !style_.file.empty();
        bool go = false, stay = !asking;
        if (can_save && ImGui::Button("Save"))
            stay = !(go = save(style_.file));
        if (can_save)
            ImGui::SameLine();
        if (ImGui::Button("Discard"))
        {
            unsaved_ = false;
            go = true;
        }
        ImGui::SameLine();
        if (ImGui::Button("Cancel"))
            stay = true;
        if (go || stay)
        {
            const Intent intent = std::exchange(intent_, std::monostate{});
            ImGui::CloseCurrentPopup();
            if (go)
                carry_out(intent);
        }
        ImGui::EndPopup();
    }

    if (std::exchange(ask_save_as_, false))
    {
        save_as_ =
            style_.file.empty() ? "untitled.toml" : (style_.file.parent_path() / (style_.name() + "-2.toml")).string();
        ImGui::OpenPopup("save as");
    }
    center();
    if (ImGui::BeginPopupModal("save as", nullptr, ImGuiWindowFlags_AlwaysAutoResize))
    {
        ImGui::SetNextItemWidth(480.0f);
        if (ImGui::IsWindowAppearing())
            ImGui::SetKeyboardFocusHere();
        const bool enter = ImGui::InputText("##file", &save_as_,
                                            ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
        std::error_code error;
        const bool exists = !save_as_.empty() && std::filesystem::exists(with_suffix(save_as_), error);
        if (exists)
            ImGui::TextColored(ImVec4(1.0f, 0.78f, 0.35f, 1.0f), "That file exists and will be replaced.");
        // The return key does not replace a file: that takes a click.
        if ((enter && !exists) || ImGui::Button(exists ? "Replace" : "Save"))
            if (!save_as_.empty() && save(with_suffix(save_as_)))
                ImGui::CloseCurrentPopup();
        ImGui::SameLine();
        if (ImGui::Button("Cancel"))
            ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    }

    if (std::exchange(ask_open_, false))
    {
        save_as_.clear();
        ImGui::OpenPopup("open a hairstyle");
    }
    center();
    if (ImGui::BeginPopupModal("open a hairstyle", nullptr, ImGuiWindowFlags_AlwaysAutoResize))
    {
        for (const std::filesystem::path& file : preset_files())
            if (ImGui::Selectable(file.stem().string().c_str()))
            {
                open(file);
                ImGui::CloseCurrentPopup();
            }
        ImGui::Separator();
        ImGui::SetNextItemWidth(480.0f);
        if (ImGui::IsWindowAppearing())
            ImGui::SetKeyboardFocusHere();
        const bool enter = ImGui::InputTextWithHint(
            "##file", "or a path", &save_as_, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
        if ((ImGui::Button("Open") || enter) && !save_as_.empty())
        {
            open(save_as_);
            ImGui::CloseCurrentPopup();
        }
        ImGui::SameLine();
        if (ImGui::Button("Cancel"))
            ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    }
}

} // namespace coif
