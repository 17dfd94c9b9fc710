#pragma once
#include "sim/device.h"

#include <string>

namespace coif
{

// What the machine can do at most, as measured just now.
struct Machine
{
    std::string device, processor, system; // names
    int compute_units = 0;
    int width = 0;           // strands a work-item moves at once
    double bandwidth = 0.0;  // bytes a second, those read and those written
    double operations = 0.0; // on single-precision numbers a second
};

// Takes about a second and 512 MB.
Machine measure_machine(const Device& device);

// The same device with only so many of its compute units. Throws Error where it cannot be divided.
Device part_of(const Device& device, int compute_units);

} // namespace coif
