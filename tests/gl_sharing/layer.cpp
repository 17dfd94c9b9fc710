// An OpenCL layer (OPENCL_LAYERS) that lends cl_khr_gl_sharing to devices which do not have it, so that the way over
// shared memory is tested where no graphics card is. OpenCL's view of a GL buffer is a buffer of its own here, which is
// filled from GL's when it is acquired; what it holds when it is released reaches GL's when the queue is finished. It
// is strict where drivers leave undefined what happens: a view that is used without being acquired, GL's memory
// replaced under a view, or acquired without a glFinish() since GL was last given it, are errors.
//
// COIF_LAYER_REFUSES=contexts or buffers: neither can be had. =data: what is released never arrives.
// COIF_LAYER_LOG: a file that gets a line for each buffer that was given to GL.
#define CL_TARGET_OPENCL_VERSION 300
#include <CL/cl_layer.h>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <epoxy/glx.h> // last: it brings X11's macros

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace
{

struct View
{
    GLuint name;
    size_t bytes;
    bool acquired = false, finished = false; // finished: by glFinish(), since GL was last given it
};

struct Given // to GL, when the queue is finished
{
    GLuint name;
    std::vector<char> bytes;
};

const cl_icd_dispatch* next = nullptr;
std::mutex mutex; // of what follows
std::map<cl_context, std::vector<cl_context_properties>> contexts;
std::map<cl_mem, View> views;
std::map<cl_kernel, std::map<cl_uint, cl_mem>> arguments; // that are views
std::map<cl_command_queue, std::vector<Given>> given;

bool refuses(std::string_view what)
{
    const char* refused = std::getenv("COIF_LAYER_REFUSES");
    return refused && refused == what;
}

// May a command use it?
bool usable(cl_mem memory)
{
    const std::lock_guard lock(mutex);
    const auto found = views.find(memory);
    return found == views.end() || found->second.acquired;
}

// Binds a buffer for as long as it lives.
class Bound
{
  public:
    explicit Bound(GLuint name)
    {
        glGetIntegerv(GL_COPY_READ_BUFFER_BINDING, &before_);
        glBindBuffer(GL_COPY_READ_BUFFER, name);
    }
    ~Bound() { glBindBuffer(GL_COPY_READ_BUFFER, GLuint(before_)); }
    Bound(const Bound&) = delete;
    static size_t size()
    {
        GLint bytes = 0;
        glGetBufferParameteriv(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &bytes);
        return size_t(bytes);
    }

  private:
    GLint before_ = 0;
};

void (*real_finish)() = nullptr;
void finish_hook()
{
    real_finish();
    const std::lock_guard lock(mutex);
    for (auto& [memory, view] : views)
        view.finished = true;
}

// Answers as the clGet...Info functions do.
cl_int answer(const void* value, size_t bytes, size_t room, void* to, size_t* told)
{
    if (told)
        *told = bytes;
    if (!to)
        return CL_SUCCESS;
    if (room < bytes)
        return CL_INVALID_VALUE;
    std::memcpy(to, value, bytes);
    return CL_SUCCESS;
}

cl_int CL_API_CALL get_device_info(cl_device_id device, cl_device_info what, size_t room, void* to, size_t* told)
{
    if (what != CL_DEVICE_EXTENSIONS)
        return next->clGetDeviceInfo(device, what, room, to, told);
    size_t bytes = 0;
    if (const cl_int error = next->clGetDeviceInfo(device, what, 0, nullptr, &bytes))
        return error;
    std::string names(bytes, '\0');
    if (const cl_int error = next->clGetDeviceInfo(device, what, bytes, names.data(), nullptr))
        return error;
    const std::string all = std::string(names.c_str()) + " cl_khr_gl_sharing";
    return answer(all.c_str(), all.size() + 1, room, to, told);
}

// Is it the GL context that is current, and its display?
bool is_current(cl_context_properties context, cl_context_properties egl, cl_context_properties glx)
{
    const auto same = [](cl_context_properties a, void* b) { return b && a == reinterpret_cast<intptr_t>(b); };
    return egl ? same(context, eglGetCurrentContext()) && same(egl, eglGetCurrentDisplay())
               : glx && same(context, glXGetCurrentContext()) && same(glx, glXGetCurrentDisplay());
}

using Notify = void(CL_CALLBACK*)(const char*, const void*, size_t, void*);

cl_context CL_API_CALL create_context(const cl_context_properties* properties, cl_uint count,
                                      const cl_device_id* devices, Notify notify, void* data, cl_int* error)
{
    std::vector<cl_context_properties> all, others;
    cl_context_properties gl = 0, egl = 0, glx = 0;
    for (const cl_context_properties* p = properties; p && *p; p += 2)
    {
        all.insert(all.end(), {p[0], p[1]});
        if (p[0] == CL_GL_CONTEXT_KHR)
            gl = p[1];
        else if (p[0] == CL_EGL_DISPLAY_KHR)
            egl = p[1];
        else if (p[0] == CL_GLX_DISPLAY_KHR)
            glx = p[1];
        else
            others.insert(others.end(), {p[0], p[1]});
    }
    if (gl && (refuses("contexts") || !is_current(gl, egl, glx)))
    {
        if (error)
            *error = CL_INVALID_GL_SHAREGROUP_REFERENCE_KHR;
        return nullptr;
    }
    all.push_back(0);
    others.push_back(0);
    const cl_context context =
        next->clCreateContext(properties ? others.data() : nullptr, count, devices, notify, data, error);
    const std::lock_guard lock(mutex);
    contexts.erase(context); // another that is no more may have had the same handle
    if (context && gl)
        contexts[context] = all;
    return context;
}

cl_int CL_API_CALL get_context_info(cl_context context, cl_context_info what, size_t room, void* to, size_t* told)
{
    if (what == CL_CONTEXT_PROPERTIES)
    {
        const std::lock_guard lock(mutex);
        if (const auto found = contexts.find(context); found != contexts.end())
            return answer(found->second.data(), found->second.size() * sizeof(cl_context_properties), room, to, told);
    }
    return next->clGetContextInfo(context, what, room, to, told);
}

void CL_CALLBACK forget(cl_mem memory, void*)
{
    const std::lock_guard lock(mutex);
    views.erase(memory);
}

cl_mem CL_API_CALL create_from_gl_buffer(cl_context context, cl_mem_flags flags, cl_GLuint name, cl_int* error)
{
    cl_int other;
    cl_int& said = error ? *error : other;
    {
        const std::lock_guard lock(mutex);
        if (!contexts.contains(context))
        {
            said = CL_INVALID_CONTEXT;
            return nullptr;
        }
    }
    if (!real_finish)
    {
        glFinish(); // epoxy looks a function up when it is first called
        real_finish = std::exchange(epoxy_glFinish, finish_hook);
    }
    size_t bytes = 0;
    if (glIsBuffer(name))
    {
        const Bound bound(name);
        bytes = bound.size();
    }
    if (bytes == 0 || refuses("buffers"))
    {
        said = CL_INVALID_GL_OBJECT;
        return nullptr;
    }
    const cl_mem memory = next->clCreateBuffer(context, flags, bytes, nullptr, &said);
    if (!memory)
        return nullptr;
    next->clSetMemObjectDestructorCallback(memory, forget, nullptr);
    const std::lock_guard lock(mutex);
    views[memory] = {name, bytes};
    return memory;
}

cl_int with_event(cl_command_queue queue, cl_uint count, const cl_event* wait, cl_event* event)
{
    return event ? next->clEnqueueMarkerWithWaitList(queue, count, wait, event) : CL_SUCCESS;
}

cl_int CL_API_CALL acquire(cl_command_queue queue, cl_uint count, const cl_mem* memories, cl_uint waits,
                           const cl_event* wait, cl_event* event)
{
    for (cl_uint i = 0; i < count; ++i)
    {
        View view;
        {
            const std::lock_guard lock(mutex);
            const auto found = views.find(memories[i]);
            if (found == views.end())
                return CL_INVALID_GL_OBJECT;
            if (found->second.acquired || !found->second.finished)
                return CL_INVALID_OPERATION;
            view = found->second;
        }
        if (!glIsBuffer(view.name))
            return CL_INVALID_GL_OBJECT;
        const Bound bound(view.name);
        if (bound.size() != view.bytes)
            return CL_INVALID_GL_OBJECT;
        std::vector<char> bytes(view.bytes);
        glGetBufferSubData(GL_COPY_READ_BUFFER, 0, GLsizeiptr(bytes.size()), bytes.data());
        if (const cl_int error = next->clEnqueueWriteBuffer(queue, memories[i], CL_TRUE, 0, bytes.size(), bytes.data(),
                                                            waits, wait, nullptr))
            return error;
        const std::lock_guard lock(mutex);
        views.at(memories[i]).acquired = true;
    }
    return with_event(queue, waits, wait, event);
}

cl_int CL_API_CALL release(cl_command_queue queue, cl_uint count, const cl_mem* memories, cl_uint waits,
                           const cl_event* wait, cl_event* event)
{
    for (cl_uint i = 0; i < count; ++i)
    {
        Given to;
        {
            const std::lock_guard lock(mutex);
            const auto found = views.find(memories[i]);
            if (found == views.end())
                return CL_INVALID_GL_OBJECT;
            if (!found->second.acquired)
                return CL_INVALID_OPERATION;
            found->second.acquired = found->second.finished = false;
            to = {found->second.name, std::vector<char>(found->second.bytes)};
        }
        if (const cl_int error = next->clEnqueueReadBuffer(queue, memories[i], CL_TRUE, 0, to.bytes.size(),
                                                           to.bytes.data(), waits, wait, nullptr))
            return error;
        const std::lock_guard lock(mutex);
        given[queue].push_back(std::move(to));
    }
    return with_event(queue, waits, wait, event);
}

cl_int CL_API_CALL finish(cl_command_queue queue)
{
    const cl_int error = next->clFinish(queue);
    std::vector<Given> all;
    {
        const std::lock_guard lock(mutex);
        all.swap(given[queue]);
        given.erase(queue);
    }
    const char* log = std::getenv("COIF_LAYER_LOG");
    std::FILE* file = log && !all.empty() ? std::fopen(log, "a") : nullptr;
    for (const Given& to : all)
    {
        if (refuses("data"))
            continue;
        const Bound bound(to.name);
        glBufferSubData(GL_COPY_READ_BUFFER, 0, GLsizeiptr(to.bytes.size()), to.bytes.data());
        if (file)
            std::fprintf(file, "%zu bytes\n", to.bytes.size());
    }
    if (file)
        std::fclose(file);
    return error;
}

cl_int CL_API_CALL set_kernel_arg(cl_kernel kernel, cl_uint index, size_t bytes, const void* value)
{
    {
        const std::lock_guard lock(mutex);
        arguments[kernel].erase(index);
        cl_mem memory = nullptr;
        if (value && bytes == sizeof memory)
            std::memcpy(&memory, value, sizeof memory);
        if (views.contains(memory))
            arguments[kernel][index] = memory;
    }
    return next->clSetKernelArg(kernel, index, bytes, value);
}

cl_int CL_API_CALL run_kernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
                              const size_t* items, const size_t* group, cl_uint waits, const cl_event* wait,
                              cl_event* event)
{
    {
        const std::lock_guard lock(mutex);
        for (const auto& [index, memory] : arguments[kernel])
            if (const auto found = views.find(memory); found != views.end() && !found->second.acquired)
                return CL_INVALID_GL_OBJECT;
    }
    return next->clEnqueueNDRangeKernel(queue, kernel, dimensions, offset, items, group, waits, wait, event);
}

cl_int CL_API_CALL copy(cl_command_queue queue, cl_mem from, cl_mem to, size_t at, size_t there, size_t bytes,
                        cl_uint waits, const cl_event* wait, cl_event* event)
{
    if (!usable(from) || !usable(to))
        return CL_INVALID_GL_OBJECT;
    return next->clEnqueueCopyBuffer(queue, from, to, at, there, bytes, waits, wait, event);
}

cl_int CL_API_CALL read(cl_command_queue queue, cl_mem from, cl_bool blocking, size_t at, size_t bytes, void* to,
                        cl_uint waits, const cl_event* wait, cl_event* event)
{
    if (!usable(from))
        return CL_INVALID_GL_OBJECT;
    return next->clEnqueueReadBuffer(queue, from, blocking, at, bytes, to, waits, wait, event);
}

cl_int CL_API_CALL write(cl_command_queue queue, cl_mem to, cl_bool blocking, size_t at, size_t bytes, const void* from,
                         cl_uint waits, const cl_event* wait, cl_event* event)
{
    if (!usable(to))
        return CL_INVALID_GL_OBJECT;
    return next->clEnqueueWriteBuffer(queue, to, blocking, at, bytes, from, waits, wait, event);
}

cl_int CL_API_CALL fill(cl_command_queue queue, cl_mem to, const void* pattern, size_t pattern_bytes, size_t at,
                        size_t bytes, cl_uint waits, const cl_event* wait, cl_event* event)
{
    if (!usable(to))
        return CL_INVALID_GL_OBJECT;
    return next->clEnqueueFillBuffer(queue, to, pattern, pattern_bytes, at, bytes, waits, wait, event);
}

void* CL_API_CALL map(cl_command_queue queue, cl_mem memory, cl_bool blocking, cl_map_flags flags, size_t at,
                      size_t bytes, cl_uint waits, const cl_event* wait, cl_event* event, cl_int* error)
{
    if (usable(memory))
        return next->clEnqueueMapBuffer(queue, memory, blocking, flags, at, bytes, waits, wait, event, error);
    if (error)
        *error = CL_INVALID_GL_OBJECT;
    return nullptr;
}

} // namespace

extern "C" cl_int CL_API_CALL clGetLayerInfo(cl_layer_info what, size_t room, void* to, size_t* told)
{
    constexpr cl_layer_api_version kVersion = CL_LAYER_API_VERSION_100;
    constexpr char kName[] = "coif's test of cl_khr_gl_sharing";
    switch (what)
    {
    case CL_LAYER_API_VERSION:
        return answer(&kVersion, sizeof kVersion, room, to, told);
    case CL_LAYER_NAME:
        return answer(kName, sizeof kName, room, to, told);
    default:
        return CL_INVALID_VALUE;
    }
}

// The loader hands on itself what a layer leaves out.
extern "C" cl_int CL_API_CALL clInitLayer(cl_uint, const cl_icd_dispatch* target, cl_uint* count,
                                          const cl_icd_dispatch** layer)
{
    static cl_icd_dispatch own = {};
    next = target;
    own.clGetDeviceInfo = get_device_info;
    own.clCreateContext = create_context;
    own.clGetContextInfo = get_context_info;
    own.clCreateFromGLBuffer = create_from_gl_buffer;
    own.clEnqueueAcquireGLObjects = acquire;
    own.clEnqueueReleaseGLObjects = release;
    own.clFinish = finish;
    own.clSetKernelArg = set_kernel_arg;
    own.clEnqueueNDRangeKernel = run_kernel;
    own.clEnqueueCopyBuffer = copy;
    own.clEnqueueReadBuffer = read;
    own.clEnqueueWriteBuffer = write;
    own.clEnqueueFillBuffer = fill;
    own.clEnqueueMapBuffer = map;
    *count = sizeof own / sizeof(void*);
    *layer = &own;
    return CL_SUCCESS;
}
