#include "app/gl_sharing.h"

#include "sim/error.h"

#include <SDL.h>
#include <epoxy/egl.h>
#include <epoxy/glx.h> // last: it brings X11's macros

#include <string_view>

namespace coif
{

// The context that is current, as an OpenCL context is told of it; nothing where there is none.
static std::vector<cl_context_properties> current_gl()
{
    const auto told = [](auto* context, cl_context_properties kind, auto* display)
    {
        return std::vector<cl_context_properties>{CL_GL_CONTEXT_KHR, reinterpret_cast<cl_context_properties>(context),
                                                  kind, reinterpret_cast<cl_context_properties>(display)};
    };
    const char* driver = SDL_GetCurrentVideoDriver();
    if (!driver)
        return {};
    if (epoxy_has_egl() && eglGetCurrentContext())
        return told(eglGetCurrentContext(), CL_EGL_DISPLAY_KHR, eglGetCurrentDisplay());
    if (std::string_view(driver) == "x11" && glXGetCurrentContext())
        return told(glXGetCurrentContext(), CL_GLX_DISPLAY_KHR, glXGetCurrentDisplay());
    return {};
}

bool shares_gl(const Device& device)
{
    const std::vector<cl_context_properties> own = device.context.getInfo<CL_CONTEXT_PROPERTIES>();
    for (size_t i = 0; i + 1 < own.size(); i += 2)
        if (own[i] == CL_GL_CONTEXT_KHR)
        {
            const std::vector<cl_context_properties> of_gl = current_gl();
            return !of_gl.empty() && own[i + 1] == of_gl[1];
        }
    return false;
}

// Some drivers share in name only: another card may draw than the one that computes.
static bool arrives(const Device& device)
{
    const std::vector<uint32_t> sent = {0x636f6966, 1, 2, 3};
    std::vector<uint32_t> received(sent.size());
    const cl::Buffer from = allocate(device, sent.size() * sizeof(uint32_t), "trying out shared memory");
    write(device, from, sent);
    SharedBuffer to;
    if (!to.take(device, from, sent.size() * sizeof(uint32_t)))
        return false;
    glBindBuffer(GL_COPY_READ_BUFFER, to.id());
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, GLsizeiptr(sent.size() * sizeof(uint32_t)), received.data());
    return received == sent;
}

Device shared_with_gl(const Device& device)
{
    const std::vector<cl_context_properties> of_gl = current_gl();
    if (of_gl.empty() || device.device.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_gl_sharing") == std::string::npos)
        return device;
    try
    {
        const Device shared = in_context(device, of_gl);
        if (arrives(shared))
            return shared;
    }
    catch (const cl::Error&)
    {
    }
    catch (const Error&)
    {
    }
    return device;
}

SharedBuffer::SharedBuffer() { glGenBuffers(1, &id_); }

SharedBuffer::~SharedBuffer()
{
    view_ = {};
    glDeleteBuffers(1, &id_);
}

// False where the device shares no memory with GL. GL's memory must not be replaced as long as OpenCL has a view of it.
bool SharedBuffer::make_room(const Device& device, size_t bytes)
try
{
    if (!shares_gl(device))
    {
        view_ = {};
        return false;
    }
    if (bytes == 0 || (view_() && bytes <= bytes_ && view_.getInfo<CL_MEM_CONTEXT>() == device.context))
        return true; // OpenCL makes no buffer of nothing
    view_ = {};
    glBindBuffer(GL_COPY_WRITE_BUFFER, id_);
    glBufferData(GL_COPY_WRITE_BUFFER, GLsizeiptr(bytes), nullptr, GL_STREAM_DRAW);
    view_ = cl::BufferGL(device.context, CL_MEM_READ_WRITE, id_);
    bytes_ = bytes;
    return true;
}
catch (const cl::Error& e)
{
    throw fail("{} shares no {} MB with OpenGL: OpenCL error {} from {}", device.name, bytes >> 20, e.err(), e.what());
}

// One of them is the view.
void SharedBuffer::copy(const Device& device, const cl::Buffer& from, const cl::Buffer& to, size_t bytes)
try
{
    if (bytes == 0)
        return;
    const std::vector<cl::Memory> views = {view_};
    glFinish(); // it may be drawing from what was there
    device.queue.enqueueAcquireGLObjects(&views);
    device.queue.enqueueCopyBuffer(from, to, 0, 0, bytes);
    device.queue.enqueueReleaseGLObjects(&views);
    device.queue.finish();
}
catch (const cl::Error& e)
{
    view_ = {};
    throw fail("OpenCL error {} from {} in memory that {} shares with OpenGL", e.err(), e.what(), device.name);
}

bool SharedBuffer::take(const Device& device, const cl::Buffer& from, size_t bytes)
{
    if (!make_room(device, bytes))
        return false;
    copy(device, from, view_, bytes);
    return true;
}

bool SharedBuffer::pack(const Device& device, const cl::Buffer& to, size_t bytes,
                        const std::function<void()>& read_pixels)
{
    if (!make_room(device, bytes))
        return false;
    glBindBuffer(GL_PIXEL_PACK_BUFFER, id_);
    read_pixels();
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    copy(device, view_, to, bytes);
    return true;
}

void SharedBuffer::unpack(const Device& device, const cl::Buffer& from, size_t bytes,
                          const std::function<void(uintptr_t)>& upload)
{
    if (!take(device, from, bytes))
    {
        const Mapped mapped(device, from, bytes);
        upload(reinterpret_cast<uintptr_t>(mapped.as<char>()));
        return;
    }
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, id_);
    upload(0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

} // namespace coif
