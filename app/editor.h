#pragma once
#include "app/brush.h"
#include "app/export.h"
#include "app/history.h"
#include "app/leeway.h"
#include "app/light_globe.h"
#include "app/look_probe.h"
#include "app/method_trial.h"
#include "app/mouse.h"
#include "app/options.h"
#include "app/panel.h"
#include "app/recovery.h"
#include "app/renderer.h"
#include "app/settings.h"
#include "app/thumbnails.h"
#include "app/viewport.h"
#include "app/waiting.h"
#include "app/watch.h"
#include "sim/health.h"
#include "sim/program_cache.h"

#include <SDL.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <variant>

namespace coif
{

// Opens the editor's window on a hairstyle and runs until it is closed. Returns the exit status.
int edit(const Options& options);

// The window of presets.
struct Browser
{
    bool shown = false;
    std::filesystem::path folder, selected;
    std::vector<std::filesystem::path> files;
    double listed = -1e9; // s, of the window's clock
    std::string filter;
    std::string asked, name;                                          // what a name is asked for, and the name
    std::map<std::filesystem::path, std::pair<int, GLuint>> pictures; // version and texture
    std::map<std::string, WidgetPlace> places;                        // of the last frame
};

// Another style beside the one that is edited, or that it is on the way to.
struct Beside
{
    bool shown = false;                        // its window
    std::optional<Hairstyle> style;            // B
    std::optional<Hairstyle> from;             // A, where a morph began
    float at = 0.0f;                           // of the way from A to B
    std::unique_ptr<Simulation> simulation;    // B alive, side by side with A
    std::unique_ptr<Renderer> renderer;        // a renderer keeps what it has sent to the driver
    double began = 0.0;                        // s of A's time when B's was 0
    std::map<std::string, WidgetPlace> places; // of the last frame
};

// The window that writes hair for other tools, and what goes on for it beside the editor.
struct Exporting
{
    bool shown = false;
    ExportOptions wanted;
    std::string file;
    bool moves = false; // the motion, as a cache
    SequenceOptions frames{"0:59", 30.0, 0};
    std::string asked;              // what `words` or `trouble` are of
    std::vector<std::string> words; // on what the file would be
    std::string trouble;            // why there would be none
    std::future<std::vector<std::string>> telling;
    std::atomic<float> share = 0.0f; // of the writing
    std::atomic<bool> stop = false;
    std::future<std::string> writing;          // waits for its end before this goes
    std::map<std::string, WidgetPlace> places; // of the last frame
};

// What a brush, or a hand on a ring or a collider, does between press and release.
struct Stroke
{
    std::optional<glm::vec3> last; // where it was, in the head's frame, m before head.scale
    StrandShapes rest;             // of the hair when it began
    bool changed = false;          // the style, since it was last applied
    double next = 0.0;             // s of the window's clock, before which it is not applied again
};

// The editor: one window, one hairstyle that lives in it. frame() does one round of events, steps and drawing; tests
// drive it the same way as edit() does.
class Editor
{
  public:
    explicit Editor(const Options& options); // throws Error
    ~Editor();
    Editor(const Editor&) = delete;

    bool frame(); // false when the window has been closed for good

    // What a menu, a key or a dropped file asks for. Errors come to the screen, and the last good state stays.
    void open(const std::filesystem::path& file); // asks first if there are unsaved changes
    bool save(const std::filesystem::path& file);
    std::filesystem::path screenshot(); // returns the file written, or an empty path
    void play(const std::string& motion);
    void put_beside(const std::filesystem::path& file); // empty: the style as it was saved

    const Simulation& simulation() const { return *simulation_; }
    const Hairstyle& style() const { return style_; }
    const Camera& camera() const { return camera_; }
    const PanelState& panel() const { return panel_; }
    bool unsaved() const { return unsaved_; }
    bool paused() const { return paused_; }
    double frame_ms() const { return frame_ms_; }
    const std::string& message() const { return message_; }
    const History& history() const { return history_; }
    const std::vector<Recovery>& recoveries() const { return recoveries_; }
    const std::map<std::string, WidgetPlace>& file_places() const { return file_places_; } // buttons, as last drawn
    const StrandColors& legend() const { return legend_; }
    const Beside& beside() const { return beside_; }
    const Browser& browser() const { return browser_; }
    Brush& brush() { return brush_; }
    const std::map<std::string, WidgetPlace>& brush_places() const { return brush_places_; } // buttons, as last drawn
    const Hairstyle* theirs() const { return theirs_ ? &*theirs_ : nullptr; }
    const std::string& bad_strand() const { return bad_strand_; }
    SDL_Window* window() const { return window_.sdl(); }
    int view_width() const { return view_width_; }
    Leeway& leeway() { return leeway_; }
    int refined() const { return refined_; } // pictures that the one on screen is the mean of
    const Waiting& waiting() const { return *waiting_; }
    const Exporting& exporting() const { return exporting_; }
    std::vector<Light> lights() const; // as they shine
    glm::dvec2 light_place(size_t light) const { return place_of(globe(), lights().at(light).direction); }

  private:
    struct Close
    {
    };
    struct Recover
    {
        size_t which; // of recoveries_
    };
    using Intent = std::variant<std::monostate, Close, std::filesystem::path, Recover>; // waits for unsaved changes

    static constexpr float kMessageRoom = 44.0f; // pixels at the bottom of the view that windows leave to the message
    static constexpr float kBacking = 0.8f; // how opaque the dark under figures is: they are read over white hair too
    static constexpr int kRedraw = 3;       // frames after an event: a window of the panel needs two to find its size

    void measure_quality();
    void handle(const SDL_Event& event);
    void handle_key(const SDL_Keysym& key);
    void handle_mouse(const SDL_Event& event);
    void advance(double seconds);
    void draw_ui();
    void draw_tools();
    void draw_dialogs();
    void draw_status();
    void draw_history();
    void draw_quality(float top);
    void take(const std::filesystem::path& file); // opens without asking
    void import_hair(const std::filesystem::path& file);
    void show(const Hairstyle& fresh, const Hairstyle& saved);
    void recover(size_t which);
    void look_at_files();
    void reload_style();
    void take_theirs(const Hairstyle& theirs);
    std::vector<std::filesystem::path> watched_files();
    void note_unsaved(); // and keep it in case of a crash
    void say(const std::string& message, bool error = false);
    void draw_files();
    void draw_beside();
    void show_beside(bool on); // its window; without it there is only A
    void split(bool on);
    std::string half_name(bool b) const;
    void mark_halves(Image& both, int half) const;
    void follow(); // B goes on to A's time
    void morph(float at);
    int picture_width() const { return beside_.simulation ? std::max(1, view_width_ / 2) : view_width_; }
    void draw_legend();
    void draw_browser();
    void draw_browser_dialog();
    void browse(bool on);
    void change_preset(); // as browser_.asked says
    bool draw_thumbnail(const std::filesystem::path& file);
    std::optional<glm::vec3> on_scalp(double x, double y) const;
    glm::dvec3 in_world(glm::vec3 on_head) const;
    bool press_brush(double x, double y);
    void stroke(double x, double y, bool begins);
    void apply_strokes();
    void cut_along(double x0, double y0, double x1, double y1);
    void freeze();
    void settle_hair();
    void draw_brushes();
    void draw_brush_aim();
    void draw_region_aim();
    void end_stroke(); // what the mouse held is let go: one edit, with a name of its own
    LightGlobe globe() const;
    void change_light(size_t light, const std::function<void(Light&)>& change); // of the style, with its lights its own
    std::optional<size_t> light_under(double x, double y) const;
    bool press_light(double x, double y);
    void drag_light(double x, double y);
    void brighten_light(size_t light, double notches);
    void show_lights(bool on); // while the key is held
    void take_own_lights();    // of the file that look.lights names
    void draw_lights();
    void tell_of_look();
    void draw_lights_dialog();
    void save_lights_as(const std::string& file); // in the folder `lights` beside the style
    void show_export(bool on);
    void draw_export();
    void ask_export_words();
    void start_export();
    void look_at_export();
    void draw_ring();
    void draw_variants();
    void take_settings();
    void keep_settings();
    void reset_hair();
    void note_resets();
    void refine(FrameInput& input, bool still);
    void give_way(double ms);
    void keep_view();
    void apply();          // what changed in style_
    void compare(bool on); // with the style as saved
    void undo_last();
    void go_back(size_t edit); // or forth, to that state of history_
    void carry_out(const Intent& intent);
    void guarded(const std::function<void()>& action);         // errors become the message
    std::unique_ptr<Simulation> alive(const Hairstyle& style); // with a word to who waits for it to fall

    ProgramKeeper programs_;
    Window window_;
    Device device_;
    Hairstyle style_, saved_; // as edited; as last read or written
    History history_;
    size_t history_seen_ = 0; // edits in its window
    std::unique_ptr<Waiting> waiting_;
    std::unique_ptr<Simulation> simulation_;
    std::unique_ptr<Renderer> renderer_;
    MethodTrial trial_; // of the ways to draw strands
    LookProbe look_probe_;
    Leeway leeway_;                              // while something is dragged
    long followed_ = 0;                          // LookCost::followed as of the last frame
    std::filesystem::file_time_type known_time_; // of the style's file when it was last read or written
    Autosave autosave_;
    std::vector<Recovery> recoveries_; // that are still offered
    Watch watch_;
    double next_look_ = 0.0;                             // s, of the window's clock
    std::map<std::string, std::filesystem::path> named_; // files that the style names, where they were last found
    std::optional<Hairstyle> theirs_; // the file as another program has written it, where there are unsaved changes
    bool gone_ = false;               // the style's file has vanished
    std::map<std::string, WidgetPlace> file_places_;
    Browser browser_;
    Beside beside_;
    StrandColors legend_;                    // without its values
    std::unique_ptr<Thumbnails> thumbnails_; // once the browser has been open
    std::string device_wish_;
    Settings settings_; // as they were last read or kept
    double next_keep_ = 0.0;
    bool settings_told_ = false;
    Camera camera_;
    PanelState panel_;
    Mouse mouse_;
    Grab held_;
    Brush brush_;
    Stroke stroke_;
    bool brushing_ = false, cutting_ = false;         // the window of brushes; scissors instead of one
    bool lights_shown_ = false;                       // for the mouse to take
    bool brightened_ = false;                         // by the wheel, which is one edit until the key is let go
    std::string lights_name_;                         // to save them by
    char variant_name_[64] = "";                      // for a snapshot
    std::map<std::string, WidgetPlace> brush_places_; // of the last frame
    int held_left_ = 0;                               // pixel that the picture which is held begins at
    Pose hand_;                                       // where the mouse has brought the head
    PassTimes pass_ms_;
    Health health_;
    std::vector<int> resets_seen_;           // of each guide
    long healed_ = 0;                        // strands, each time
    std::string bad_strand_;                 // the last that was reset: which, when and why
    std::string motion_ = "shake";           // that is played, or was last
    std::string measured_, measured_motion_; // the choice, and the motion, that time_error_ is of
    double time_error_ = 0.0;                // of the substeps, as a fraction of the length
    std::string message_, save_as_;
    std::string screenshot_size_ = "as shown", screenshot_name_; // the style's if empty; a number follows
    Intent intent_;
    bool unsaved_ = false, paused_ = false, step_once_ = false, closed_ = false;
    int refined_ = 0; // pictures of what stands still, that are shown as one
    int redraw_ = 1;  // frames that are still to be drawn though time may stand still
    bool show_panel_ = true, show_times_ = false, show_help_ = false, show_history_ = false, comparing_ = false,
         ask_save_as_ = false, ask_open_ = false, transparent_ = false;
    bool message_is_error_ = false;
    double frame_ms_ = 0.0;
    Uint64 last_tick_ = 0;
    long frames_ = 0;
    int view_width_ = 1, view_height_ = 1; // of the picture, beside the panel, in window units
    glm::dvec3 jumped_{0.0};
    Exporting exporting_; // goes first: what it has begun reads the rest
};

} // namespace coif
