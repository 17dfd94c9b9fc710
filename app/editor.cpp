#include "app/editor.h"

#include "app/display.h"
#include "app/folders.h"
#include "app/import.h"
#include "app/lens.h"
#include "app/lettering.h"
#include "app/sequence.h"
#include "sim/error.h"
#include "sim/source.h"

#include <backends/imgui_impl_opengl3.h>
#include <backends/imgui_impl_sdl.h>
#include <imgui.h>

#include <algorithm>
#include <ctime>

namespace coif
{

static constexpr int kPanelWidth = 400;            // pixels of the window
static constexpr int kMostSteps = 4;               // in one frame; what is over is dropped and counted
static constexpr double kSettle = 1.5;             // s that a style lives before it is first seen
static constexpr int kAtOnce = 2;                  // pictures of what stands still that are drawn in one frame
static constexpr Uint32 kIdleWait = 50;            // ms between looks at a paused window
static constexpr int kWidth = 1280, kHeight = 720; // of a fresh window

void Editor::guarded(const std::function<void()>& action)
{
    try
    {
        action();
    }
    catch (const Error& e)
    {
        message_ = e.what();
        message_is_error_ = true;
    }
    catch (const std::exception& e) // the device, the driver or the file system: no reason to lose what is unsaved
    {
        message_ = fmt::format("something failed underneath: {}; save your work", e.what());
        message_is_error_ = true;
    }
}

std::unique_ptr<Simulation> Editor::alive(const Hairstyle& style)
{
    return std::make_unique<Simulation>(device_, style,
                                        [this](double share) { waiting_->say("the hair falls to rest", share); });
}

void Editor::reset_hair()
{
    guarded([&] { simulation_->reset(); });
    if (beside_.simulation)
        guarded([&] { beside_.simulation->reset(); });
    bad_strand_.clear();
}

// Into the style, relative to the head: that is where a style's camera is when it is opened.
void Editor::keep_view()
{
    Camera kept = camera_;
    kept.target -= simulation_->solver().head().origin;
    keep_camera(kept, style_.params);
    apply();
}

Editor::Editor(const Options& options)
    : window_(kWidth, kHeight, Window::SHOWN), device_(shared_with_gl(open_device(options))),
      style_(load_style(options)), autosave_(recovery_folder()), device_wish_(options.device)
{
    recoveries_ = find_recoveries(recovery_folder());
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // app/settings.h keeps it with the rest
    ImGui::StyleColorsDark();
    ImGui::GetStyle().FrameRounding = 3.0f;
    ImGui::GetStyle().WindowBorderSize = 0.0f;
    ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 1.0f; // nothing is drawn behind the panel
    if (const std::filesystem::path font = font_file(); !font.empty())
        ImGui::GetIO().Fonts->AddFontFromFileTTF(font.c_str(), 14.0f);
    ImGui_ImplSDL2_InitForOpenGL(window_.sdl(), window_.context());
    ImGui_ImplOpenGL3_Init("#version 150");
    renderer_ = std::make_unique<Renderer>(data_folder() / "shaders");
    waiting_ = std::make_unique<Waiting>(window_);
    simulation_ = alive(style_);
    simulation_->settle(kSettle);
    // --set changes the style on screen, not what is on disk.
    saved_ = options.sets.empty() ? style_ : load_hairstyle(style_.file);
    known_time_ = written_at(style_.file);
    camera_ = camera_of(style_.params);
    apply();
    history_ = begin_history(style_, saved_);
    take_settings();
    SDL_EventState(SDL_DROPFILE, SDL_ENABLE);
    last_tick_ = SDL_GetPerformanceCounter();
}

Editor::~Editor()
{
    exporting_.stop = true;
    next_keep_ = 0.0;
    keep_settings();
    browse(false);
    waiting_.reset();
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplSDL2_Shutdown();
    ImGui::DestroyContext();
}

void Editor::apply()
{
    comparing_ = false;
    note_unsaved(); // before it is tried: it may be what brings the program down
    guarded([&] { simulation_->set_style(style_); });
    style_ = simulation_->style(); // the last good one, if that failed
    note_unsaved();
    SDL_SetWindowTitle(window_.sdl(), fmt::format("{}{} - coif", style_.name(), unsaved_ ? " *" : "").c_str());
    redraw_ = kRedraw;
}

void Editor::take(const std::filesystem::path& file)
{
    if (is_hair_file(file))
    {
        import_hair(file);
        return;
    }
    guarded(
        [&]
        {
            const Hairstyle fresh = load_hairstyle(file);
            show(fresh, fresh);
            gone_ = false;
        });
    apply();
    note_edit(history_, style_, saved_, "opened " + style_.name());
}

// A new style beside a file of hair, which is not written before it is saved.
void Editor::import_hair(const std::filesystem::path& file)
{
    std::string came_of_it; // empty where nothing did
    guarded(
        [&]
        {
            std::filesystem::path target = file;
            std::error_code error;
            for (int n = 1; n == 1 || std::filesystem::exists(target, error); ++n)
                target.replace_filename(file.stem().string() + (n > 1 ? fmt::format(".{}", n) : "") + ".toml");
            std::string report;
            const Hairstyle fresh = imported_style(file, target, {}, report);
            show(fresh, fresh);
            gone_ = true;
            came_of_it = report.substr(0, report.find_last_not_of('\n') + 1);
        });
    apply();
    note_edit(history_, style_, saved_, "imported " + file.filename().string());
    if (!came_of_it.empty())
        say(came_of_it);
}

// In the place of what was there. Throws Error, and then nothing has changed.
void Editor::show(const Hairstyle& fresh, const Hairstyle& saved)
{
    held_.what = Grab::NONE;
    simulation_->set_style(fresh, true);
    style_ = fresh;
    saved_ = saved;
    known_time_ = written_at(style_.file);
    theirs_.reset();
    simulation_->play(std::nullopt);
    simulation_->reset();
    simulation_->settle(kSettle);
    camera_ = camera_of(style_.params);
    camera_.target += simulation_->solver().head().origin;
    jumped_ = simulation_->jumped();
    message_.clear();
    if (beside_.simulation)
        split(true);
}

void Editor::go_back(size_t edit)
{
    held_.what = Grab::NONE;
    note_edit(history_, style_, saved_); // what is still being done
    const size_t before = history_.now;
    const Edit state = go_to(history_, edit);
    if (state.style.file != style_.file)
    {
        guarded([&] { simulation_->set_style(state.style, true); });
        known_time_ = written_at(state.style.file);
        theirs_.reset();
        std::error_code error;
        gone_ = !std::filesystem::exists(state.style.file, error);
    }
    style_ = state.style;
    saved_ = state.saved;
    if (!message_is_error_) // it was of what has just been taken back
        message_.clear();
    apply();
    if (!difference(style_, state.style).empty()) // it cannot be had again: its meshes may be gone
        history_.now = before;
}

// While it is on, the hair is as it was saved, in the same motion.
void Editor::compare(bool on)
{
    if (on == comparing_)
        return;
    comparing_ = on;
    guarded([&] { simulation_->set_style(on ? saved_ : style_); });
    redraw_ = kRedraw;
}

void Editor::undo_last()
{
    note_edit(history_, style_, saved_); // what is still being done is the last
    go_back(history_.now - std::min<size_t>(history_.now, 1));
}

void Editor::open(const std::filesystem::path& file) { carry_out(file); }

// Does it at once, or asks first what is to become of unsaved changes.
void Editor::carry_out(const Intent& intent)
{
    if (unsaved_)
        intent_ = intent;
    else if (const auto* file = std::get_if<std::filesystem::path>(&intent))
        take(*file);
    else if (const auto* wanted = std::get_if<Recover>(&intent))
        recover(wanted->which);
    else if (std::holds_alternative<Close>(intent) && exporting_.writing.valid() && !exporting_.stop)
    {
        exporting_.stop = true; // the second wish is the answer; a pose is written to its end all the same
        say("an export is being stopped; close again when it has said so", true);
    }
    else if (std::holds_alternative<Close>(intent))
    {
        closed_ = true;
        autosave_.clear();
    }
}

bool Editor::save(const std::filesystem::path& file)
{
    // Somebody else's change is not overwritten unasked: the second save in a row is the answer.
    std::error_code error;
    if (file == style_.file && std::filesystem::exists(file, error) && written_at(file) != known_time_)
    {
        known_time_ = written_at(file);
        message_ = file.string() + " was changed by another program; save again to replace that, or open it again";
        message_is_error_ = true;
        redraw_ = kRedraw;
        return false;
    }
    bool done = false;
    guarded(
        [&]
        {
            save_hairstyle(style_, file);
            saved_ = style_;
            note_save(history_, saved_);
            known_time_ = written_at(file);
            watch_.know(file);
            for (const std::filesystem::path& beside : files_beside(style_))
                watch_.know(beside);
            theirs_.reset();
            gone_ = false;
            simulation_->set_style(style_);
            message_ = "saved " + file.string();
            message_is_error_ = false;
            done = true;
        });
    apply();
    return done;
}

std::filesystem::path Editor::screenshot()
{
    const std::filesystem::path file = unused_name(screenshot_name_.empty() ? style_.name() : screenshot_name_);
    int width = view_width_, height = view_height_;
    std::sscanf(screenshot_size_.c_str(), "%dx%d", &width, &height);
    guarded(
        [&]
        {
            const auto taken = [&](Simulation& simulation)
            {
                simulation.solver().draw();
                FrameInput input = frame_input(simulation, camera_);
                input.samples = good_samples(input.params);
                input.transparent = transparent_;
                return input;
            };
            const auto picture = [&](Simulation& simulation, Renderer& renderer, int wide)
            { return renderer.picture(taken(simulation), wide, height); };
            if (beside_.simulation && is_linear(file))
                throw fail("{}: two halves side by side are written as .png alone", file.string());
            if (is_linear(file))
                save_hdr(file, renderer_->linear_picture(taken(*simulation_), width, height),
                         display_of(simulation_->params()).gain);
            else if (beside_.simulation)
            {
                Image both{width, height, std::vector<unsigned char>(size_t(4) * size_t(width) * size_t(height))};
                const int half = std::max(1, width / 2);
                paste(both, picture(*simulation_, *renderer_, half), 0, 0);
                paste(both, picture(*beside_.simulation, *beside_.renderer, width - half), half, 0);
                if (!transparent_)
                    mark_halves(both, half);
                save_png(file, both);
            }
            else
                save_png(file, picture(*simulation_, *renderer_, width));
            message_ = "wrote " + std::filesystem::absolute(file).string();
            message_is_error_ = false;
        });
    redraw_ = kRedraw;
    return message_is_error_ ? std::filesystem::path() : file;
}

void Editor::play(const std::string& motion)
{
    guarded(
        [&]
        {
            simulation_->play(find_motion(motion));
            if (beside_.simulation)
                beside_.simulation->play(find_motion(motion));
            motion_ = motion;
            paused_ = false;
        });
}

// One block of guides run again at eight times the substeps, in the motion that is played or was last: once for each
// choice that a tolerance makes, when no slider is held.
void Editor::measure_quality()
{
    const Quality& quality = simulation_->quality();
    if (quality.rungs.empty() || SDL_GetMouseState(nullptr, nullptr) != 0 ||
        (measured_ == quality.said && measured_motion_ == motion_))
        return;
    measured_ = quality.said;
    measured_motion_ = motion_;
    const Motion motion = find_motion(motion_);
    time_error_ = measure_time_error(device_, simulation_->params(), simulation_->solver().groom(), motion,
                                     std::min(motion.seconds, 2.0));
}

void Editor::advance(double seconds)
{
    const bool played = simulation_->playing(), slept = simulation_->solver().asleep();
    int pixels_wide = 0, pixels_high = 0;
    SDL_GL_GetDrawableSize(window_.sdl(), &pixels_wide, &pixels_high);
    simulation_->set_view(view_of(camera_, pixels_high));
    if (beside_.simulation)
        beside_.simulation->set_view(view_of(camera_, pixels_high));
    bool stepped = step_once_;
    if (step_once_)
        simulation_->step(hand_);
    else if (!paused_)
        stepped = simulation_->advance(seconds, hand_, kMostSteps) > 0;
    if (beside_.simulation)
        follow();
    if (played && !simulation_->playing() && held_.what != Grab::BRUSH && held_.what != Grab::CUT &&
        held_.what != Grab::LIGHT)
        held_.what = Grab::NONE; // the script has moved what the hand held
    if (held_.what != Grab::MOVE_HEAD && held_.what != Grab::TURN_HEAD)
        hand_ = simulation_->hand();
    camera_.target += simulation_->jumped() - jumped_; // a teleport takes the view along
    jumped_ = simulation_->jumped();
    if (stepped && !(slept && simulation_->solver().asleep())) // hair that sleeps looks as it did
        redraw_ = std::max(redraw_, 2);                        // the figures take another to fit their window
    step_once_ = false;
}

// Says which strand was reset, so that its author need not look for it.
void Editor::note_resets()
{
    const std::vector<Reset> found = find_resets(simulation_->solver(), resets_seen_);
    if (found.empty())
        return;
    for (const Reset& reset : found)
        healed_ += reset.times;
    bad_strand_ = fmt::format("strand {}{} reset in step {}: {}", found.back().strand,
                              found.size() > 1 ? fmt::format(" and {} more", found.size() - 1) : "",
                              simulation_->steps(), likely_cause(found.back(), simulation_->solver().info()));
}

bool Editor::frame()
{
    const bool refining = refined_ < good_samples(style_.params);
    if (redraw_ <= 0)
        SDL_WaitEventTimeout(nullptr, !refining && (paused_ || simulation_->solver().asleep()) ? kIdleWait : 1);
    for (SDL_Event event; take_event(event, mouse_);)
        handle(event);
    const Uint64 tick = SDL_GetPerformanceCounter();
    const double seconds = double(tick - last_tick_) / double(SDL_GetPerformanceFrequency());
    last_tick_ = tick;
    guarded([&] { advance(seconds); });
    guarded([&] { look_at_files(); });
    look_at_export();
    guarded([&] { tell_of_look(); });
    if (browser_.shown && thumbnails_ && thumbnails_->work())
        redraw_ = std::max(redraw_, kRedraw);
    keep_settings();
    const bool still = redraw_ <= 0 && (paused_ || simulation_->solver().asleep());
    if (closed_ || (redraw_ <= 0 && !(still && refined_ < good_samples(style_.params))))
        return !closed_;
    redraw_ = std::max(redraw_ - 1, 0);
    frame_ms_ = frames_++ == 0 ? 1e3 * seconds : frame_ms_ + 0.1 * (1e3 * seconds - frame_ms_);

    int width = 0, height = 0, pixels_wide = 0, pixels_high = 0;
    SDL_GetWindowSize(window_.sdl(), &width, &height);
    SDL_GL_GetDrawableSize(window_.sdl(), &pixels_wide, &pixels_high);
    view_width_ = std::max(1, width - (show_panel_ ? kPanelWidth : 0));
    view_height_ = std::max(1, height);

    guarded([&] { apply_strokes(); });
    guarded([&] { measure_quality(); });
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplSDL2_NewFrame();
    show_mouse(mouse_, window_.sdl());
    ImGui::NewFrame();
    draw_ui(); // may change the style, which shows in this very frame
    if (!ImGui::IsAnyItemActive() && held_.what == Grab::NONE && !brightened_) // a drag is one edit
        note_edit(history_, style_, saved_);
    ImGui::Render();

    guarded(
        [&]
        {
            simulation_->solver().draw();
            pass_ms_ = simulation_->solver().take_times();
            if (frames_ % 8 == 1)
                health_ = measure_health(simulation_->solver(), style_.params, false);
            note_resets();
            const int wide = picture_width() * pixels_wide / std::max(width, 1);
            FrameInput input = frame_input(*simulation_, camera_);
            refine(input, still && redraw_ <= 0); // else the panel has just changed it

            trial_.show(*renderer_, input, wide, pixels_high);
            legend_.title = input.colors.title;
            legend_.readings = input.colors.readings;
            if (!beside_.simulation)
                return;
            beside_.simulation->solver().draw();
            beside_.simulation->solver().take_times();
            FrameInput other = frame_input(*beside_.simulation, camera_);
            other.samples = input.samples;
            other.before = input.before;
            other.kept = input.kept;
            other.coarse_light = input.coarse_light;
            trial_.apply(other);
            beside_.renderer->show(other, wide, pixels_high, wide);
        });
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    SDL_GL_SwapWindow(window_.sdl());
    programs_.begin();
    give_way(1e3 * double(SDL_GetPerformanceCounter() - tick) / double(SDL_GetPerformanceFrequency()));
    return !closed_;
}

// What stands still is drawn again and again, each time a part of a pixel aside, and shown as the mean.
void Editor::refine(FrameInput& input, bool still)
{
    input.kept = leeway_.share();
    input.coarse_light = leeway_.coarse_light;
    input.before = still ? refined_ : 0;
    input.samples = still ? kAtOnce : 1;
    refined_ = still ? refined_ + kAtOnce : 0;
}

// After a frame that took so long, ms.
void Editor::give_way(double ms)
{
    const bool gave = leeway_.gives();
    const LookCost& look = renderer_->look();
    const double light_ms = std::exchange(followed_, look.followed) != look.followed ? look.light_ms : 0.0;
    leeway_.strands = int(simulation_->solver().groom().drawn.size());
    const bool typing = ImGui::GetIO().WantTextInput;
    note_frame(leeway_, ms, light_ms, held_.what != Grab::NONE || (ImGui::IsAnyItemActive() && !typing));
    if (leeway_.gives() || gave)
        redraw_ = std::max(redraw_, 1);
}

int edit(const Options& options)
{
    Editor editor(options);
    while (editor.frame())
        ;
    return 0;
}

} // namespace coif
