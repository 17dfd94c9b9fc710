// What happens on disk while a hairstyle is open: files that other programs change, and what a crash has left behind.
#include "app/editor.h"
#include "app/folders.h"
#include "sim/error.h"
#include "sim/source.h"

#include <imgui.h>

#include <algorithm>
#include <iterator>

namespace coif
{

namespace fs = std::filesystem;

static constexpr double kLookEvery = 0.2; // s between looks at files

void Editor::say(const std::string& message, bool error)
{
    message_ = message;
    message_is_error_ = error;
    redraw_ = kRedraw;
}

void Editor::note_unsaved()
{
    unsaved_ = gone_ || !same_style(style_, saved_);
    if (unsaved_)
        autosave_.keep(style_);
    else
        autosave_.clear();
}

// The style's own file, what it names, the motion that is played, kernels and shaders.
std::vector<fs::path> Editor::watched_files()
{
    std::vector<fs::path> files = {style_.file};
    for (const ParamInfo& info : param_table())
        if (info.kind == Kind::TEXT)
        {
            const auto& written =
                *reinterpret_cast<const std::string*>(reinterpret_cast<const char*>(&style_.host) + info.offset);
            try
            {
                if (written.empty())
                    named_.erase(info.path());
                else
                    named_[info.path()] = named_file(style_, info.path(), written);
            }
            catch (const Error&)
            {
                // It is gone: where it was it may come back.
            }
        }
    for (const auto& [key, file] : named_)
        files.push_back(file);
    std::ranges::copy(files_beside(style_), std::back_inserter(files));
    files.push_back(motion_file(motion_));
    std::error_code error;
    for (const char* folder : {"kernels", "shaders"})
        for (const fs::directory_entry& entry : fs::directory_iterator(data_folder() / folder, error))
            if (const std::string ending = entry.path().extension().string(); // not what a text editor leaves beside
                ending == ".cl" || ending == ".h" || ending == ".def" || ending == ".glsl" || ending == ".vert" ||
                ending == ".geom" || ending == ".frag")
                files.push_back(entry.path());
    return files;
}

void Editor::look_at_files()
{
    const double now = double(SDL_GetTicks64()) * 1e-3;
    if (now < next_look_)
        return;
    next_look_ = now + kLookEvery;
    watch_.set(watched_files());
    bool style = false, meshes = false, lights = false, motion = false, kernels = false, shaders = false,
         compiled_in = false;
    std::string vanished;
    std::error_code error;
    const std::vector<fs::path> beside = files_beside(style_);
    for (const fs::path& file : watch_.changed())
    {
        const bool named = std::ranges::any_of(named_, [&](const auto& entry) { return entry.second == file; });
        const bool of_lights = named_.contains("look.lights") && named_["look.lights"] == file;
        const bool there = fs::exists(file, error);
        style |= file == style_.file || (there && std::ranges::find(beside, file) != beside.end());
        lights |= of_lights && there;
        meshes |= named && there && !of_lights;
        motion |= file == motion_file(motion_) && there;
        if (!there && file != style_.file)
            vanished = file.string();
        compiled_in |= file.filename() == "params.def" || file.filename() == "shared.h";
        kernels |= there && file.parent_path().filename() == "kernels" && !named;
        // GLSL includes what both have in common.
        shaders |= there && !named && (file.parent_path().filename() == "shaders" || file.extension() == ".h");
    }
    if (!vanished.empty())
        say(vanished + " is gone; what was read of it stays", true);
    if (style)
        reload_style();
    const auto again = [&](const char* what, const std::function<void()>& action)
    {
        guarded(
            [&]
            {
                action();
                say(fmt::format("read {} again", what));
            });
        redraw_ = kRedraw;
    };
    if (meshes)
        again("the meshes", [&] { simulation_->set_style(style_, true); });
    if (lights)
        again("the lights",
              [&]
              {
                  simulation_->reload_lights();
                  if (beside_.simulation)
                      beside_.simulation->reload_lights();
              });
    if (motion)
        again("the motion",
              [&]
              {
                  const Motion fresh = find_motion(motion_); // a broken one does not stop the one that is played
                  if (simulation_->playing())
                      simulation_->play(fresh);
              });
    if (compiled_in)
        say("kernels/params.def and shared.h are part of the program too: build coif again, then start it again", true);
    else if (kernels || shaders)
        again("kernels and shaders",
              [&]
              {
                  if (kernels)
                      simulation_->solver().reload_kernels();
                  if (kernels && beside_.simulation)
                      beside_.simulation->solver().reload_kernels();
                  if (shaders)
                      renderer_->reload_shaders();
                  if (shaders && beside_.renderer)
                      beside_.renderer->reload_shaders();
              });
    if (const std::string trouble = autosave_.trouble(); !trouble.empty() && message_.find(trouble) == message_.npos)
        say("unsaved work cannot be kept in case of a crash, so save often: " + trouble, true);
}

void Editor::reload_style()
{
    std::error_code error;
    redraw_ = kRedraw;
    if (!fs::exists(style_.file, error))
    {
        gone_ = true;
        say(style_.file.string() + " is gone; what is on screen stays, and saving writes it again", true);
        note_unsaved();
        return;
    }
    guarded(
        [&]
        {
            Hairstyle fresh = load_hairstyle(style_.file);
            if (fresh.variants.contains(saved_.variant))
                switch_variant(fresh, saved_.variant);
            const bool came_back = std::exchange(gone_, false);
            if (same_style(saved_, fresh)) // but for its comments
            {
                style_.text = fresh.text;
                style_.places = fresh.places;
                saved_ = fresh;
                note_save(history_, saved_);
                known_time_ = written_at(style_.file);
                apply();
                say(style_.file.string() +
                    (came_back ? " is back" : " was written by another program; the hair is the same"));
            }
            else if (!same_style(saved_, style_))
                theirs_ = fresh;
            else
                take_theirs(fresh);
        });
}

// The file as another program has written it, in the motion that is going on.
void Editor::take_theirs(const Hairstyle& theirs)
{
    const Hairstyle fresh = theirs; // it may be theirs_
    held_.what = Grab::NONE;
    simulation_->set_style(fresh, true);
    const auto same_camera = [&](const ParamInfo& info)
    { return info.group != std::string_view("camera") || same_value(fresh, saved_, info); };
    const bool moved = !std::ranges::all_of(param_table(), same_camera);
    style_ = saved_ = fresh;
    known_time_ = written_at(style_.file);
    theirs_.reset();
    if (moved)
    {
        camera_ = camera_of(style_.params);
        camera_.target += simulation_->solver().head().origin;
    }
    apply();
    note_save(history_, saved_); // whatever is undone: that is on disk now
    note_edit(history_, style_, saved_, style_.name() + " was changed on disk");
    say("read " + style_.file.string() + " again");
}

void Editor::recover(size_t which)
{
    if (which >= recoveries_.size())
        return;
    guarded(
        [&]
        {
            const Recovery recovery = recoveries_[which];
            const Hairstyle fresh = recovered(recovery);
            Hairstyle saved = fresh;
            bool lost = false;
            try
            {
                saved = load_hairstyle(fresh.file);
            }
            catch (const Error&)
            {
                lost = true; // saving writes it again
            }
            show(fresh, saved);
            gone_ = lost;
            recoveries_.erase(recoveries_.begin() + ptrdiff_t(which));
            if (autosave_.take_over(recovery))
                say("recovered " + fresh.file.string() + ", as it was kept " + recovery.when + "; it is not saved yet");
            else
                say("another coif was faster to recover " + fresh.file.string() + "; here it is shown too");
        });
    apply();
    note_edit(history_, style_, saved_, "recovered " + style_.name());
}

// Windows that ask: what is to become of unsaved work that a crash left behind, and of a file that others have changed.
void Editor::draw_files()
{
    const auto at_top = [&](float y)
    {
        ImGui::SetNextWindowPos(ImVec2(0.5f * float(view_width_), y), ImGuiCond_Always, ImVec2(0.5f, 0.0f));
        ImGui::SetNextWindowSizeConstraints(ImVec2(200.0f, 0.0f), ImVec2(float(view_width_) - 16.0f, 500.0f));
    };
    const ImGuiWindowFlags plain = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_NoFocusOnAppearing;
    file_places_.clear();
    if (!recoveries_.empty())
    {
        at_top(0.3f * float(view_height_));
        bool open = true;
        ImGui::Begin("unsaved work was found", &open, plain);
        ImGui::TextUnformatted("An editor ended before this was saved:");
        size_t taken = recoveries_.size(), dropped = taken;
        if (ImGui::BeginTable("recoveries", 4, ImGuiTableFlags_SizingFixedFit))
        {
            for (size_t i = 0; i < recoveries_.size(); ++i)
            {
                const Recovery& recovery = recoveries_[i];
                ImGui::PushID(int(i));
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                ImGui::AlignTextToFramePadding();
                ImGui::TextUnformatted(recovery.file.empty() ? "untitled" : recovery.file.stem().c_str());
                explain(recovery.file.string());
                ImGui::TableNextColumn();
                ImGui::TextDisabled("kept %s", recovery.when.c_str());
                ImGui::TableNextColumn();
                if (ImGui::Button("Recover"))
                    taken = i;
                file_places_["Recover"] = last_widget();
                ImGui::TableNextColumn();
                if (ImGui::Button("Discard"))
                    dropped = i;
                ImGui::PopID();
            }
            ImGui::EndTable();
        }
        ImGui::TextDisabled("Closed, this asks again when coif is next started.");
        ImGui::End();
        if (!open)
            recoveries_.clear();
        else if (taken < recoveries_.size())
            carry_out(Recover{taken});
        else if (dropped < recoveries_.size())
        {
            discard(recoveries_[dropped]);
            recoveries_.erase(recoveries_.begin() + ptrdiff_t(dropped));
        }
    }
    if (theirs_)
    {
        at_top(0.15f * float(view_height_));
        ImGui::Begin("changed on disk", nullptr, plain);
        ImGui::Text("Another program has changed %s, and here it has unsaved changes.", style_.file.filename().c_str());
        ImGui::TextDisabled("%s", difference(saved_, *theirs_).c_str());
        const bool take = ImGui::Button("Take the file's");
        file_places_["Take the file's"] = last_widget();
        if (take)
            guarded([&] { take_theirs(*theirs_); });
        explain("what is on screen can be had again by undo");
        ImGui::SameLine();
        if (theirs_ && ImGui::Button("Keep mine"))
        {
            style_.text = theirs_->text;
            saved_ = *theirs_;
            note_save(history_, saved_);
            known_time_ = written_at(style_.file);
            theirs_.reset();
            apply();
        }
        explain("saving then writes your values into their file");
        ImGui::End();
    }
}

} // namespace coif
