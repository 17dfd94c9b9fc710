// The repulsion of hair as it hangs, node by node: what the voxel grid is judged by.
#pragma once
#include "app/measure/measure.h"
#include "sim/groom.h"

#include <glm/vec3.hpp>

#include <vector>

namespace coif
{

struct Hair // as it hangs
{
    HairParams params;
    Groom groom;
    std::vector<float> position; // in blocks, as the device has it
};

using Forces = std::vector<glm::dvec3>; // m/s^2, strand after strand, nodes 1 and outwards

struct Probe
{
    Forces forces;
    std::vector<glm::dvec3> nodes; // where they act, m
    StepInfo info;
};

// A style's guides after a second at rest.
Hair hair_of(const Device& device, const Hairstyle& style);

// The repulsion of every node in a grid as `hair.params` ask for, moved by a part of a voxel along each axis.
Probe probe_repulsion(const Device& device, const Hair& hair, glm::vec3 offset);

// Root mean square, as a share of the mean size of `reference`.
double difference(const Forces& forces, const Forces& reference);

} // namespace coif
