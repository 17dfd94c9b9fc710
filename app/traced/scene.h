// What a traced still depends on, in plain numbers: strands as round curves, solids as triangles, the
// ground, lights, the camera.
#pragma once
#include "app/renderer.h"
#include "app/traced/fibre_near.h"
#include "sim/hash.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <vector>

namespace coif
{

// Places are relative to the head's origin along the world's axes, m; light is linear.
struct TracedScene
{
    // Strands as they are drawn, with waves, curls, frizz and braids in their points, each the control point of a
    // Catmull-Rom curve. One that is half opaque is half as wide instead, which covers as much.
    size_t points = 0;                 // of a strand, at least 2
    std::vector<glm::vec4> curve;      // [strand][points + 2]: w is the radius; the outer two only bend the ends
    std::vector<glm::vec3> absorption; // [strand][points], per radius
    FibreLook fibre;

    std::vector<glm::vec3> position, normal, albedo; // of the solids' corners
    std::vector<float> gloss;                        // of each as well, 0 to 1; or none, where all are matt
    std::vector<glm::uvec3> triangles;

    struct
    {
        glm::dvec3 middle{0.0};
        double radius = 0.0; // 0: no ground
        glm::dvec3 albedo{0.0};
    } ground; // app/ground.h

    Lighting lighting;

    glm::dvec3 eye{0.0}, right{0.0}, up{0.0}, forward{0.0}; // unit length but for the eye
    double tangent = 0.0;                                   // of half the vertical angle of view
    double lens = 0.0, focus = 1.0;                         // radius of the opening, and what is sharp, m

    size_t strands() const { return curve.size() / (points + 2); }
};

TracedScene traced_scene(const FrameInput& frame);

// Of all that the light in the picture depends on.
Hash hash_of(const TracedScene& scene);

} // namespace coif
