// Memory that OpenCL and GL share (cl_khr_gl_sharing): what is worked out on a graphics card is drawn there without a
// way over the host. Where device or GL context does not allow it, the host maps what GL is then given.
#pragma once
#include "sim/device.h"

#include <epoxy/gl.h>

#include <cstdint>
#include <functional>

namespace coif
{

// The device in a context that shares memory with the current GL context, which must outlive it; the device as it is
// where that cannot be had, or where a few bytes that are sent that way do not arrive. For a device on which nothing
// is built or allocated yet.
Device shared_with_gl(const Device& device);

// Does it share memory with the GL context that is current?
bool shares_gl(const Device& device);

// A buffer of GL that is filled from buffers of OpenCL, or the other way round.
class SharedBuffer
{
  public:
    SharedBuffer(); // needs a current GL context
    ~SharedBuffer();
    SharedBuffer(const SharedBuffer&) = delete;

    // Copies on the device. False, with nothing done, where it shares no memory with GL: the buffer may then be filled
    // with glBufferData. Waits for both. Throws Error.
    bool take(const Device& device, const cl::Buffer& from, size_t bytes);

    // Calls back with what glTexImage and its like are to be given as where their pixels begin: an offset into this
    // buffer, which is bound to unpack from, or an address of the host's. Throws Error.
    void unpack(const Device& device, const cl::Buffer& from, size_t bytes,
                const std::function<void(uintptr_t)>& upload);

    // Calls back for glReadPixels to put so many bytes into this buffer, which is bound to pack into, and copies them
    // on the device. False, with nothing done, where it shares no memory with GL. Throws Error.
    bool pack(const Device& device, const cl::Buffer& to, size_t bytes, const std::function<void()>& read_pixels);

    GLuint id() const { return id_; }

  private:
    bool make_room(const Device& device, size_t bytes);
    void copy(const Device& device, const cl::Buffer& from, const cl::Buffer& to, size_t bytes);

    GLuint id_ = 0;
    cl::BufferGL view_; // OpenCL's, of as much as there is; none as long as nothing was taken
    size_t bytes_ = 0;
};

} // namespace coif
