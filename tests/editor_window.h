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
        xdotool("windowfocus $(xdotool search --onlyvisible --name coif | tail -n 1)");
        frames(2);
    }
    // The whole window into a folder that is asked for, to be looked at.
    void shoot(const std::string& name)
    {
        const char* wanted = std::getenv("COIF_TEST_PICTURES");
        if (!wanted)
            return;
        frames(2);
        int width = 0, height = 0;
        SDL_GL_GetDrawableSize(editor->window(), &width, &height);
        std::vector<unsigned char> rows(size_t(4) * size_t(width) * size_t(height));
        glReadBuffer(GL_FRONT);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rows.data());
        glReadBuffer(GL_BACK);
        Image image{width, height, std::vector<unsigned char>(rows.size())};
        for (int y = 0; y < height; ++y) // GL's first row is the lowest
            for (int i = 0; i < 4 * width; ++i)
                image.pixels[size_t(4 * width) * size_t(height - 1 - y) + size_t(i)] =
                    i % 4 == 3 ? 255 : rows[size_t(4 * width) * size_t(y) + size_t(i)];
        fs::create_directories(wanted);
        save_png(fs::path(wanted) / (name + ".png"), image);
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
    void drag(double x0, double y0, double x1, double y1, const std::string& button = "1")
    {
        xdotool("mousemove " + at(x0, y0));
        frames(3);
        xdotool("mousedown " + button);
        frames(3);
        for (int i = 1; i <= 5; ++i)
        {
            xdotool("mousemove " + at(x0 + (x1 - x0) * i / 5, y0 + (y1 - y0) * i / 5));
            frames(2);
        }
    }
    void release(const std::string& button = "1")
    {
        xdotool("mouseup " + button);
        frames(3);
    }
    void click(const WidgetPlace& place)
    {
        xdotool("mousemove " + at(0.5 * (place.left + place.right), 0.5 * (place.top + place.bottom)));
        frames(3);
        xdotool("mousedown 1");
        frames(3);
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
