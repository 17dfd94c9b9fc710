// An editor in a real window, with mouse and keys from the X server, as a person's would come.
#pragma once
#include "app/editor.h"
#include "sim/source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace coif::test
{
namespace fs = std::filesystem;

class EditorWindow : public testing::Test
{
  protected:
    void SetUp() override
    {
        if (!std::getenv("DISPLAY"))
            GTEST_SKIP() << "there is no display: run under xvfb-run";
        before = fs::current_path();
        folder = fs::temp_directory_path() / ("coif_editor_" + std::to_string(getpid()));
        fs::create_directories(folder);
        fs::current_path(folder); // screenshots go to the caller's folder
        std::ofstream("style.toml") << "# mine\n[strand]\nlength = 0.2 # short\n[interpolation]\nstrands = 300\n";
        for (const auto& [variable, name] : {std::pair("XDG_STATE_HOME", "state"), {"XDG_CONFIG_HOME", "config"}})
            setenv(variable, (folder / name).c_str(), 1);
        // The window is to open under its own driver, not the headless one of other tests.
        unsetenv("SDL_VIDEODRIVER");
        SDL_SetHint(SDL_HINT_VIDEODRIVER, nullptr);
        start();
    }
    // Anew on the same file, as another run.
    void start()
    {
        editor.reset();
        Options options;
        options.style = "style.toml";
        editor = std::make_unique<Editor>(options);
        frames(3);
        // Without a window manager nobody gives the window the keyboard.
        // A window that has just gone may still be found.
        const char* focus = "xdotool windowfocus $(xdotool search --onlyvisible --name coif 2> /dev/null | tail -n 1)"
                            " > /dev/null 2>&1";
        bool focused = false;
        for (int i = 0; i < 20 && !(focused = std::system(focus) == 0); ++i)
            frames(3);
        frames(2);
    }
    // A moment worth looking at: COIF_TEST_SHOOT, if set, is a command that is told its name.
    void shoot(const std::string& name)
    {
        const char* command = std::getenv("COIF_TEST_SHOOT");
        frames(2);
        if (command && std::system((std::string(command) + " " + name).c_str()) != 0)
            ADD_FAILURE() << command << " " << name;
    }
    void TearDown() override
    {
        editor.reset();
        if (!folder.empty())
        {
            fs::current_path(before);
            fs::remove_all(folder);
        }
    }

    void frames(int count)
    {
        for (int i = 0; i < count; ++i)
            open = editor->frame();
    }
    // Waits for the X server to have passed the events on.
    template <typename Condition> bool until(Condition&& condition)
    {
        for (int i = 0; i < 100; ++i)
        {
            frames(1);
            if (condition())
                return true;
        }
        return false;
    }
    void xdotool(const std::string& command)
    {
        ASSERT_EQ(std::system(("xdotool " + command + " > /dev/null").c_str()), 0) << command;
    }
    // Window pixels to the screen's.
    std::string at(double x, double y)
    {
        int left = 0, top = 0;
        SDL_GetWindowPosition(editor->window(), &left, &top);
        return std::to_string(left + int(x)) + " " + std::to_string(top + int(y));
    }
    // The mouse goes there, or presses and lets go; what is done has arrived when these return, however busy the
    // machine.
    void point(double x, double y)
    {
        xdotool("mousemove " + at(x, y));
        int now_x = 0, now_y = 0;
        until(
            [&]
            {
                SDL_GetMouseState(&now_x, &now_y);
                return std::abs(now_x - int(x)) <= 1 && std::abs(now_y - int(y)) <= 1;
            });
        frames(2);
    }
    void press(const std::string& button = "1")
    {
        xdotool("mousedown " + button);
        until([] { return SDL_GetMouseState(nullptr, nullptr) != 0; });
        frames(2);
    }
    void release(const std::string& button = "1")
    {
        xdotool("mouseup " + button);
        until([] { return SDL_GetMouseState(nullptr, nullptr) == 0; });
        frames(3);
    }
    void drag(double x0, double y0, double x1, double y1, const std::string& button = "1")
    {
        point(x0, y0);
        press(button);
        for (int i = 1; i <= 5; ++i)
            point(x0 + (x1 - x0) * i / 5, y0 + (y1 - y0) * i / 5);
    }
    void click(const WidgetPlace& place)
    {
        point(0.5 * (place.left + place.right), 0.5 * (place.top + place.bottom));
        press();
        release();
    }
    // By the mouse, from one share of a widget to another.
    void slide(const std::string& path, double from, double to)
    {
        const WidgetPlace place = editor->panel().places.at(path);
        const double y = 0.5 * (place.top + place.bottom), width = place.right - place.left;
        drag(place.left + from * width, y, place.left + to * width, y);
        release();
    }
    // Until it is so, or the time is up.
    template <typename Condition> bool within(double seconds, Condition&& condition)
    {
        const Uint64 end = SDL_GetTicks64() + Uint64(1000.0 * seconds);
        while (SDL_GetTicks64() < end)
        {
            frames(1);
            if (condition())
                return true;
        }
        return false;
    }
    static std::string contents(const fs::path& file)
    {
        std::ifstream in(file);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    fs::path before, folder;
    std::unique_ptr<Editor> editor;
    bool open = true;
};

} // namespace coif::test
