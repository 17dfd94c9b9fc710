#pragma once
#include "app/renderer.h"

#include <optional>

namespace coif
{

// A line of sight in the world; direction of unit length.
struct Ray
{
    glm::dvec3 origin, direction;
};

// Through the pixel (x, y) of a view, y from the top.
Ray ray_through(const Camera& camera, double x, double y, int width, int height);

// Where the ray first meets a sphere in front of it, m along the ray.
std::optional<double> hit(const Ray& ray, glm::dvec3 center, double radius);

// Where the ray meets the plane through `point` that faces the camera.
glm::dvec3 on_facing_plane(const Ray& ray, const Camera& camera, glm::dvec3 point);

// The pixel that a point of the world is seen at, x from the left and y from the top; none behind the camera.
std::optional<glm::dvec2> project(const Camera& camera, glm::dvec3 point, int width, int height);

// Where the line of sight through a pixel meets the head's mesh, its spheres or, without either, the scalp's sphere.
std::optional<glm::dvec3> point_on_head(const Simulation& simulation, const Camera& camera, double x, double y,
                                        int width, int height);

// The point of the head's surface that is nearest to a point beside it, as its distance grid knows it.
glm::dvec3 surface_below(const Simulation& simulation, glm::dvec3 point);

// By pixels of the mouse.
void orbit(Camera& camera, double dx, double dy);
void pan(Camera& camera, double dx, double dy, int height);
void zoom(Camera& camera, double notches);

// Looks at the head from the side that the camera is on, near enough to fill the view with the hair.
void frame_head(Camera& camera, const Simulation& simulation);

// What the mouse has hold of, from press to release.
struct Grab
{
    enum What
    {
        NONE,
        ORBIT,
        PAN,
        MOVE_HEAD,
        TURN_HEAD,
        COLLIDER,
        TIE,
        BRUSH,
        CUT,
        LIGHT
    } what = NONE;
    size_t collider = 0; // of the style
    size_t tie = 0;      // of the style
    size_t light = 0;    // of the style
    Tie tie_before;
    glm::dvec3 aside{0.0};         // from the line of sight through the press to that through the ring's middle; of a
                                   // light, pixels
    glm::dvec3 start{0.0};         // where it was taken, world
    glm::dvec3 origin_before{0.0}; // of the head or the collider, world
    glm::dquat turn_before{1, 0, 0, 0};
    double x = 0, y = 0; // of the press, pixels
};

// What lies under the pixel: a tie's ring, a collider of the style, the head, or nothing (then the drag orbits).
Grab grab(const Simulation& simulation, const Camera& camera, double x, double y, int width, int height, bool turn);

// The head's pose for the mouse at (x, y) while MOVE_HEAD or TURN_HEAD.
Pose dragged_head(const Grab& held, const Camera& camera, double x, double y, int width, int height);

// The collider's centre in its own frame for the mouse at (x, y) while COLLIDER.
glm::vec3 dragged_collider(const Grab& held, const Simulation& simulation, const Camera& camera, double x, double y,
                           int width, int height);

// The tie with its ring over the head under the mouse at (x, y) while TIE, as high above it and leaning against it as
// it was. Never inside: at least as high as its thickness.
Tie dragged_tie(const Grab& held, const Simulation& simulation, const Camera& camera, double x, double y, int width,
                int height);

} // namespace coif
