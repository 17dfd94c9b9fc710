#pragma once
#include <epoxy/gl.h>

#include <filesystem>
#include <string>

struct SDL_Window;

namespace coif
{

// A window with a GL 3.2 core context. A hidden one needs no display: it is all that a headless picture asks for.
class Window
{
  public:
    enum Visibility
    {
        HIDDEN,
        SHOWN
    };
    Window(int width, int height, Visibility visibility); // throws Error
    ~Window();
    Window(const Window&) = delete;

    SDL_Window* sdl() const { return window_; }
    void* context() const { return context_; }

  private:
    SDL_Window* window_ = nullptr;
    void* context_ = nullptr;
};

// Is there a display that a window could open on?
bool has_display();

// Does a processor, rather than a graphics card, draw? Asks the current context.
bool is_software_renderer();

// shaders/<name>.vert (or <vertex>.vert), <name>.geom if there is one, and <name>.frag, linked, with the blocks Frame
// and HairParams bound. `#include "params"` is answered with the parameters' block.
class ShaderProgram
{
  public:
    ShaderProgram(const std::filesystem::path& folder, const std::string& name, const std::string& vertex = {});
    ~ShaderProgram();
    ShaderProgram(const ShaderProgram&) = delete;

    GLuint id() const { return id_; }
    GLint uniform(const char* name) const { return glGetUniformLocation(id_, name); }

  private:
    GLuint id_ = 0;
};

enum BlockBinding
{
    kFrameBinding,
    kParamsBinding
};

} // namespace coif
