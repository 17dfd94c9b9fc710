// The window that writes the hair for other tools. What is asked for is said in full before it is written; sizes are
// found, and files written, beside the window, which goes on meanwhile.
#include "app/editor.h"
#include "app/image.h"
#include "sim/error.h"
#include "sim/source.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <chrono>

namespace coif
{

namespace fs = std::filesystem;

static const ImVec4 kWarning(1.0f, 0.78f, 0.35f, 1.0f);

template <typename T> static bool is_ready(const std::future<T>& future)
{
    return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void Editor::show_export(bool on)
{
    exporting_.shown = on;
    if (on && exporting_.file.empty())
        exporting_.file = (fs::current_path() / (style_.name() + ".usda")).string();
}

// What a file would be, by what is asked for and the hair as it is now.
void Editor::ask_export_words()
{
    Exporting& e = exporting_;
    const Groom& groom = simulation_->solver().groom();
    const std::string asked =
        fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}", e.file, e.wanted.target, e.wanted.strands, e.wanted.curve,
                    e.wanted.points, e.moves, e.frames.frames, e.frames.fps, groom.drawn.size(), groom.nodes);
    if (asked == e.asked || e.telling.valid())
        return;
    e.asked = asked;
    redraw_ = kRedraw;
    e.words.clear();
    e.trouble.clear();
    try
    {
        ExportPlan plan = plan_export(e.file, e.wanted, style_);
        const std::vector<Frame> moments = export_moments(plan, e.moves ? e.frames : SequenceOptions(), 0.0);
        const Cache times = times_of(moments, e.frames.fps);
        e.telling = std::async(std::launch::async,
                               [plan, times, hair = take_hair(*simulation_, plan)]
                               {
                                   const FileSize size =
                                       size_of(*plan.format, hair.curves, plan.words, plan.cache ? &times : nullptr);
                                   return export_words(plan, hair.curves, size);
                               });
    }
    catch (const Error& error)
    {
        e.trouble = error.what();
    }
}

void Editor::start_export()
{
    Exporting& e = exporting_;
    guarded(
        [&]
        {
            ExportPlan plan = plan_export(e.file, e.wanted, style_);
            const std::vector<Frame> moments = export_moments(plan, e.moves ? e.frames : SequenceOptions(), 0.0);
            check_folder(plan.file);
            e.share = 0.0f;
            e.stop = false;
            if (!plan.cache)
            {
                e.writing = std::async(std::launch::async, [plan, hair = take_hair(*simulation_, plan)]
                                       { return write_export(plan, hair.curves); });
                return;
            }
            // A life of its own, from the motion's beginning, as the command has it.
            e.writing = std::async(std::launch::async,
                                   [this, plan, moments, style = style_, motion = find_motion(motion_),
                                    times = times_of(moments, e.frames.fps)]
                                   {
                                       ExportSays says;
                                       says.doing = [this](const std::string&, double share)
                                       {
                                           exporting_.share = float(share);
                                           if (exporting_.stop)
                                               throw Error("the export was stopped; no file was written");
                                       };
                                       says.words = [](const auto&) {};
                                       const Device own = open_device(device_wish_, data_folder() / "kernels");
                                       return export_motion(own, style, plan, motion, moments, times, says);
                                   });
        });
}

// What has come of what goes on beside the window.
void Editor::look_at_export()
{
    Exporting& e = exporting_;
    if (e.telling.valid() || e.writing.valid())
        redraw_ = std::max(redraw_, 1);
    if (is_ready(e.telling) || is_ready(e.writing))
        redraw_ = kRedraw;
    if (is_ready(e.telling))
        try
        {
            e.words = e.telling.get();
        }
        catch (const Error& error)
        {
            e.trouble = error.what();
        }
    if (is_ready(e.writing))
        guarded([&] { say("wrote " + e.writing.get()); });
}

void Editor::draw_export()
{
    Exporting& e = exporting_;
    ask_export_words();
    const auto choice = [&](const char* label, std::string& value, const std::vector<const char*>& values,
                            const std::vector<std::string>& names)
    {
        size_t now = 0;
        while (now + 1 < values.size() && value != values[now])
            ++now;
        if (ImGui::BeginCombo(label, names[now].c_str()))
        {
            for (size_t i = 0; i < values.size(); ++i)
                if (ImGui::Selectable(names[i].c_str(), i == now))
                    value = values[i];
            ImGui::EndCombo();
        }
        e.places[label] = last_widget();
    };
    ImGui::SetNextWindowPos(ImVec2(0.5f * float(view_width_), 0.2f * float(view_height_)), ImGuiCond_FirstUseEver,
                            ImVec2(0.5f, 0.0f));
    ImGui::SetNextWindowSize(ImVec2(520.0f, 0.0f), ImGuiCond_Always);
    ImGui::SetNextWindowBgAlpha(0.9f);
    if (ImGui::Begin("export", &e.shown, ImGuiWindowFlags_NoCollapse))
    {
        keep_in_view(float(view_width_), float(view_height_));
        ImGui::PushItemWidth(360.0f);
        std::vector<const char*> values = {""};
        std::vector<std::string> names = {"any tool: metres, y up"};
        for (const Target& target : targets())
        {
            values.push_back(target.name);
            names.push_back(fmt::format("{}, from {}", target.name, target.reads));
        }
        choice("for", e.wanted.target, values, names);
        values.clear();
        names.clear();
        std::string suffix;
        for (const FormatInfo& format : formats())
        {
            values.push_back(format.suffix);
            names.push_back(fmt::format("{}  {}", format.suffix, format.name));
            if (e.file.ends_with(format.suffix))
                suffix = format.suffix;
        }
        const std::string before = suffix;
        choice("format", suffix, values, names);
        if (suffix != before)
            e.file = e.file.substr(0, e.file.size() - before.size()) + suffix;
        choice("strands", e.wanted.strands, {"drawn", "guides"}, {"all that are drawn", "the guides"});
        choice("curve", e.wanted.curve, {"", "linear", "catmull_rom"},
               {"as the format has it", "straight pieces", "Catmull-Rom"});
        ImGui::InputInt("points", &e.wanted.points, 1, 8);
        explain("Of a strand, at equal lengths; 0: its nodes, and more where waves or curls need them.");
        ImGui::Checkbox("the motion", &e.moves);
        e.places["the motion"] = last_widget();
        explain(fmt::format("Frames of {} from its beginning, into one file: .usda or .abc.", motion_));
        if (e.moves)
        {
            ImGui::SameLine();
            ImGui::SetNextItemWidth(90.0f);
            ImGui::InputText("frames", &e.frames.frames, ImGuiInputTextFlags_AutoSelectAll);
            e.places["frames"] = last_widget();
            ImGui::SameLine();
            ImGui::SetNextItemWidth(70.0f);
            ImGui::InputDouble("a second", &e.frames.fps, 0.0, 0.0, "%g");
        }
        ImGui::InputText("file", &e.file, ImGuiInputTextFlags_AutoSelectAll);
        e.places["file"] = last_widget();
        ImGui::PopItemWidth();
        ImGui::Separator();
        ImGui::PushTextWrapPos(0.0f);
        for (const std::string& line : e.words)
            ImGui::TextUnformatted(line.c_str());
        if (!e.trouble.empty())
            ImGui::TextColored(kWarning, "%s", e.trouble.c_str());
        if (e.words.empty() && e.trouble.empty())
            ImGui::TextDisabled("...");
        std::error_code error;
        const bool exists = !e.file.empty() && fs::exists(e.file, error);
        if (exists && !e.writing.valid())
            ImGui::TextColored(kWarning, "That file exists and will be replaced.");
        ImGui::PopTextWrapPos();
        if (e.writing.valid())
        {
            ImGui::ProgressBar(e.share, ImVec2(360.0f, 0.0f));
            ImGui::SameLine();
            if (ImGui::Button("Stop"))
                e.stop = true;
            e.places["Stop"] = last_widget();
        }
        else
        {
            ImGui::BeginDisabled(!e.trouble.empty());
            if (ImGui::Button(exists ? "Replace" : "Export"))
                start_export();
            e.places["Export"] = last_widget();
            ImGui::EndDisabled();
        }
    }
    ImGui::End();
}

} // namespace coif
