#include "app/gl.h"

#include "sim/error.h"
#include "sim/params.h"
#include "sim/source.h"

#include <SDL.h>

#include <cstdlib>
#include <cstring>

namespace coif
{

static bool start_video()
{
    SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1"); // ctrl-c in the terminal ends coif, and is no wish to close a window
    return SDL_Init(SDL_INIT_VIDEO) == 0;
}

Window::Window(int width, int height, Visibility visibility)
{
    if (visibility == HIDDEN)
        SDL_SetHint(SDL_HINT_VIDEODRIVER, "offscreen");
    if (!start_video())
        throw fail("no picture can be drawn: {}", SDL_GetError());
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 2);
    const Uint32 flags = visibility == SHOWN ? SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI : SDL_WINDOW_HIDDEN;
    window_ = SDL_CreateWindow("coif", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, width, height,
                               SDL_WINDOW_OPENGL | flags);
    if (window_)
        context_ = SDL_GL_CreateContext(window_);
    if (!context_)
    {
        const std::string reason = SDL_GetError();
        SDL_Quit();
        throw fail("coif needs OpenGL 3.2 core, and this machine does not give it: {}", reason);
    }
    SDL_GL_SetSwapInterval(visibility == SHOWN ? 1 : 0);
}

Window::~Window()
{
    SDL_GL_DeleteContext(context_);
    SDL_DestroyWindow(window_);
    SDL_Quit();
}

bool has_display()
{
    const auto set = [](const char* name)
    {
        const char* value = std::getenv(name);
        return value && *value;
    };
    if (!set("DISPLAY") && !set("WAYLAND_DISPLAY"))
        return false;
    if (!start_video())
        return false;
    // Where the server that DISPLAY names does not answer, SDL takes a driver whose windows nobody sees.
    const std::string driver = SDL_GetCurrentVideoDriver();
    if (driver != "offscreen" && driver != "dummy" && driver != "evdev")
        return true; // stays connected: a server whose last client leaves starts anew, and is deaf meanwhile
    SDL_QuitSubSystem(SDL_INIT_VIDEO);
    return false;
}

bool is_software_renderer()
{
    const std::string name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    for (const char* software : {"llvmpipe", "softpipe", "SwiftShader", "Software"})
        if (name.find(software) != name.npos)
            return true;
    return false;
}

static GLuint compile_stage(const std::filesystem::path& file, GLenum stage)
{
    const std::string source = load_source(file, data_folder() / "kernels", glsl_params_block());
    const char* text = source.c_str();
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok)
        return shader;
    char log[4096] = {};
    glGetShaderInfoLog(shader, sizeof log - 1, nullptr, log);
    glDeleteShader(shader);
    throw fail("{} does not compile:\n{}", file.string(), log);
}

ShaderProgram::ShaderProgram(const std::filesystem::path& folder, const std::string& name, const std::string& vertex)
{
    const struct
    {
        std::string file;
        GLenum stage;
    } stages[] = {{(vertex.empty() ? name : vertex) + ".vert", GL_VERTEX_SHADER},
                  {name + ".geom", GL_GEOMETRY_SHADER},
                  {name + ".frag", GL_FRAGMENT_SHADER}};
    id_ = glCreateProgram();
    try
    {
        for (const auto& stage : stages)
        {
            if (stage.stage == GL_GEOMETRY_SHADER && !std::filesystem::exists(folder / stage.file))
                continue;
            const GLuint shader = compile_stage(folder / stage.file, stage.stage);
            glAttachShader(id_, shader);
            glDeleteShader(shader); // freed with the program
        }
        // The same places in every program, so that one vertex array serves.
        glBindAttribLocation(id_, 0, "position");
        glBindAttribLocation(id_, 1, "normal");
        glBindAttribLocation(id_, 2, "roots");
        glBindAttribLocation(id_, 3, "along");
        glBindAttribLocation(id_, 4, "value");
        glBindAttribLocation(id_, 5, "color");
        glLinkProgram(id_);
        GLint ok = 0;
        glGetProgramiv(id_, GL_LINK_STATUS, &ok);
        if (!ok)
        {
            char log[4096] = {};
            glGetProgramInfoLog(id_, sizeof log - 1, nullptr, log);
            throw fail("shaders/{} does not link:\n{}", name, log);
        }
    }
    catch (...)
    {
        glDeleteProgram(id_);
        throw;
    }
    const struct
    {
        const char* name;
        BlockBinding binding;
    } blocks[] = {{"Frame", kFrameBinding}, {"HairParams", kParamsBinding}};
    for (const auto& block : blocks)
        if (const GLuint index = glGetUniformBlockIndex(id_, block.name); index != GL_INVALID_INDEX)
            glUniformBlockBinding(id_, index, block.binding);
}

ShaderProgram::~ShaderProgram() { glDeleteProgram(id_); }

} // namespace coif
