// Programs as the driver has compiled them, on disk: PoCL takes 30 ms to find that it knows a source, and under one to
// take its own binary back. There are some 35 of them before the first picture.
#pragma once
#include "sim/device.h"

#include <atomic>
#include <optional>
#include <thread>

namespace coif
{

// What of a program decides what it becomes.
struct ProgramSource
{
    std::string text, options;
};

// The program, built, from what cache_folder() keeps; none where that has nothing of this source, these options, this
// device and this driver, or where it is not as it was written.
std::optional<cl::Program> stored_program(const Device& device, const ProgramSource& source);

// Built from source; throws Error with the compiler's words. Remembered, while there is a ProgramKeeper.
cl::Program compiled_program(const Device& device, const ProgramSource& source);

// Stores the program; what cannot be written is not. For PoCL that means to compile it once more.
void store_program(const Device& device, const ProgramSource& source, const cl::Program& program);

// While one lives, programs that are compiled are remembered; from begin() on they are stored, in a thread of its own.
// One at a time.
class ProgramKeeper
{
  public:
    ProgramKeeper();
    ~ProgramKeeper(); // waits for the program at hand
    void begin();
    void finish(); // stores those that are left, here and now

  private:
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

} // namespace coif
