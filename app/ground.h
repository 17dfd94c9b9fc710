// The plain ground under head and hair, for whatever draws or traces it.
#pragma once
#include <glm/vec3.hpp>

#include <optional>

namespace coif
{

struct FrameInput;

// A disc that faces up, and fades towards its rim. From below there is nothing.
struct Ground
{
    float height = 0.0f,
          radius = 0.0f;    // m, in the world as long as the head has not leapt, with its middle at x = z = 0
    glm::vec3 moved{0.0f};  // m: from there to the head's origin
    glm::vec3 albedo{0.0f}; // linear: the backdrop's
};

// None where the style asks for none.
std::optional<Ground> ground_of(const FrameInput& frame);

// How much of what lies behind it is hidden, at a share of its radius. shaders/ground.vert says it again.
double ground_cover(double share_of_radius);

} // namespace coif
