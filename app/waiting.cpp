#include "app/waiting.h"

#include <SDL.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace coif
{

static constexpr double kSoon = 0.7; // s

static double clock_seconds() { return double(SDL_GetPerformanceCounter()) / double(SDL_GetPerformanceFrequency()); }

Waiting::Waiting(const Window& window) : window_(window)
{
    ImGuiContext* other = ImGui::GetCurrentContext();
    context_ = ImGui::CreateContext(ImGui::GetIO().Fonts);
    ImGui::SetCurrentContext(context_);
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::StyleColorsDark();
    ImGui_ImplOpenGL3_Init("#version 150");
    ImGui::SetCurrentContext(other);
}

Waiting::~Waiting()
{
    ImGuiContext* other = ImGui::GetCurrentContext();
    ImGui::SetCurrentContext(context_);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::SetCurrentContext(other);
    ImGui::DestroyContext(context_);
}

void Waiting::say(const std::string& doing, double share)
{
    if (share <= 0.0)
        begin_ = clock_seconds();
    if (share >= 1.0 || clock_seconds() - begin_ < kSoon)
        return;
    SDL_PumpEvents(); // or the window system takes the program for dead
    int width = 0, height = 0, pixels_wide = 0, pixels_high = 0;
    SDL_GetWindowSize(window_.sdl(), &width, &height);
    SDL_GL_GetDrawableSize(window_.sdl(), &pixels_wide, &pixels_high);

    ImGuiContext* other = ImGui::GetCurrentContext();
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(float(width), float(height));
    if (width > 0 && height > 0)
        io.DisplayFramebufferScale = ImVec2(float(pixels_wide) / float(width), float(pixels_high) / float(height));
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    ImGui::SetNextWindowPos(ImVec2(0.5f * float(width), 0.5f * float(height)), 0, ImVec2(0.5f, 0.5f));
    ImGui::Begin("waiting", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::TextUnformatted(doing.c_str());
    ImGui::ProgressBar(float(share), ImVec2(320.0f, 0.0f));
    ImGui::End();
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, pixels_wide, pixels_high);
    glClearColor(0.1f, 0.1f, 0.1f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    SDL_GL_SwapWindow(window_.sdl());
    ImGui::SetCurrentContext(other);
    ++shown_;
}

} // namespace coif
