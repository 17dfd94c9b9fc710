#include "app/viewport.h"

#define GLM_ENABLE_EXPERIMENTAL
#include <glm/geometric.hpp>
#include <glm/gtx/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

namespace
{
struct Axes
{
    glm::dvec3 forward, right, up;
};
} // namespace

static Axes axes_of(const Camera& camera)
{
    const glm::dvec3 forward = glm::normalize(camera.target - camera.position());
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
    return {forward, right, glm::cross(right, forward)};
}

Ray ray_through(const Camera& camera, double x, double y, int width, int height)
{
    const Axes axes = axes_of(camera);
    const double pixel = 2.0 * std::tan(0.5 * camera.fov) / std::max(height, 1);
    return {camera.position(), glm::normalize(axes.forward + axes.right * ((x - 0.5 * width) * pixel) -
                                              axes.up * ((y - 0.5 * height) * pixel))};
}

std::optional<double> hit(const Ray& ray, glm::dvec3 center, double radius)
{
    const glm::dvec3 from = ray.origin - center;
    const double b = glm::dot(from, ray.direction), d = b * b - glm::dot(from, from) + radius * radius;
    if (d < 0.0 || -b - std::sqrt(d) < 0.0)
        return std::nullopt;
    return -b - std::sqrt(d);
}

// Where the ray first meets what `distance` measures how far it is from, or less (Hart. Sphere tracing. 1996).
template <typename Distance> static std::optional<double> traced(const Ray& ray, double near_enough, Distance distance)
{
    double t = 0.0;
    for (int i = 0; i < 400 && t < 1e4; ++i)
    {
        const double d = distance(ray.origin + ray.direction * t);
        if (d < near_enough)
            return t > 0.0 ? std::optional(t) : std::nullopt; // from within one looks through
        t += d;
    }
    return std::nullopt;
}

// Where the ray first comes this near to the head's grid, m.
static std::optional<double> hit_body(const Ray& ray, const PlacedGrid& body, const Pose& head, double near = 0.0)
{
    if (!body.grid)
        return std::nullopt;
    const DistanceGrid& grid = *body.grid;
    const double voxel = double(grid.voxel) * body.scale;
    const glm::dvec3 low = glm::dvec3(grid.corner) * double(body.scale) + glm::dvec3(body.offset);
    const glm::dvec3 high = low + voxel * glm::dvec3(grid.size - 1);
    return traced(ray, 0.05 * voxel,
                  [&](glm::dvec3 world)
                  {
                      const glm::dvec3 p = glm::conjugate(head.turn) * (world - head.origin);
                      // Outside of the grid its distances are too long to go by.
                      const double outside = glm::distance(p, glm::clamp(p, low, high));
                      return outside > 0.0 ? outside + 0.5 * voxel : double(distance_to(body, glm::vec3(p))) - near;
                  });
}

static std::optional<double> hit_collider(const Ray& ray, const Capsule& c, glm::dvec3 origin)
{
    const glm::dvec3 center = origin + glm::dvec3(c.center.x, c.center.y, c.center.z);
    const glm::dvec3 axis(c.axis.x, c.axis.y, c.axis.z);
    if (c.axis.w == 0.0f)
        return hit(ray, center, c.center.w);
    return traced(ray, 1e-3 * c.center.w,
                  [&](glm::dvec3 p)
                  {
                      const double share = std::clamp(glm::dot(p - center, axis) * double(c.axis.w), 0.0, 1.0);
                      return glm::distance(p, center + axis * share) - c.center.w;
                  });
}

// A ring is easier to take hold of than it is thick.
static std::optional<double> hit_ring(const Ray& ray, const Tie& tie, double scale, const Pose& head)
{
    const glm::dvec3 center = head.origin + head.turn * (glm::dvec3(tie.at) * scale);
    const glm::dvec3 axis = head.turn * glm::normalize(glm::dvec3(tie.axis));
    return traced(ray, 1e-4,
                  [&](glm::dvec3 p)
                  {
                      const double along = glm::dot(p - center, axis);
                      const double out = glm::length(p - center - along * axis);
                      const double inside = std::max(0.0, out - double(tie.radius)); // the hair in it counts as well
                      return std::hypot(along, inside) - double(tie.thickness) - 0.003;
                  });
}

glm::dvec3 on_facing_plane(const Ray& ray, const Camera& camera, glm::dvec3 point)
{
    const glm::dvec3 forward = axes_of(camera).forward;
    const double speed = glm::dot(ray.direction, forward);
    const double far = glm::dot(point - ray.origin, forward) / std::max(speed, 1e-6);
    return ray.origin + ray.direction * far;
}

void orbit(Camera& camera, double dx, double dy)
{
    camera.yaw -= 0.008 * dx;
    camera.pitch = std::clamp(camera.pitch + 0.008 * dy, -1.55, 1.55);
}

void pan(Camera& camera, double dx, double dy, int height)
{
    const Axes axes = axes_of(camera);
    const double pixel = 2.0 * std::tan(0.5 * camera.fov) * camera.distance / std::max(height, 1);
    camera.target += (axes.up * dy - axes.right * dx) * pixel;
}

void zoom(Camera& camera, double notches)
{
    camera.distance = std::clamp(camera.distance * std::pow(0.88, notches), 0.02, 100.0);
}

void frame_head(Camera& camera, const Simulation& simulation)
{
    const Groom& groom = simulation.solver().groom();
    const Pose& head = simulation.solver().head();
    // Hair hangs: the middle of what is to be seen lies below the head's own.
    const double reach = 0.55 * double(groom.extent) + 0.35 * double(groom.longest);
    camera.target =
        head.origin + head.turn * glm::dvec3(groom.center) - glm::dvec3(0.0, 0.25 * double(groom.longest), 0.0);
    camera.distance = std::clamp(1.35 * reach / std::sin(0.5 * camera.fov), 0.02, 100.0);
}

Grab grab(const Simulation& simulation, const Camera& camera, double x, double y, int width, int height, bool turn)
{
    Grab held;
    held.what = Grab::ORBIT;
    held.x = x;
    held.y = y;
    const Ray ray = ray_through(camera, x, y, width, height);
    const glm::dvec3 origin = simulation.solver().head().origin;
    const std::vector<Capsule> placed = simulation.solver().placed_colliders();
    const size_t of_head = placed.size() - simulation.style().host.colliders.size();
    double nearest = INFINITY;
    const auto take = [&](std::optional<double> at, bool of_style, size_t collider, glm::dvec3 from)
    {
        if (!at || *at >= nearest)
            return;
        nearest = *at;
        held.start = ray.origin + ray.direction * *at;
        held.what = of_style ? Grab::COLLIDER : turn ? Grab::TURN_HEAD : Grab::MOVE_HEAD;
        held.collider = collider;
        held.origin_before = from;
    };
    take(hit_body(ray, simulation.solver().body(), simulation.solver().head()), false, 0, simulation.hand().origin);
    for (size_t i = 0; i < placed.size(); ++i)
    {
        const float4 c = placed[i].center;
        take(hit_collider(ray, placed[i], origin), i >= of_head, i - of_head,
             i >= of_head ? origin + glm::dvec3(c.x, c.y, c.z) : simulation.hand().origin);
    }
    held.turn_before = simulation.hand().turn;
    const Pose& head = simulation.solver().head();
    const std::vector<Tie>& ties = simulation.style().host.ties;
    for (size_t i = 0; i < ties.size(); ++i)
    {
        const double scale = double(simulation.params().head_scale);
        const std::optional<double> at = hit_ring(ray, ties[i], scale, head);
        if (!at || *at >= nearest)
            continue;
        nearest = *at;
        held.what = Grab::TIE;
        held.tie = i;
        held.tie_before = ties[i];
        held.start = head.origin + head.turn * (glm::dvec3(ties[i].at) * scale);
        held.aside = glm::normalize(held.start - ray.origin) - ray.direction;
    }
    return held;
}

std::optional<glm::dvec2> project(const Camera& camera, glm::dvec3 point, int width, int height)
{
    const Axes axes = axes_of(camera);
    const glm::dvec3 to = point - camera.position();
    const double ahead = glm::dot(to, axes.forward);
    if (!(ahead > 1e-6))
        return std::nullopt;
    const double pixel = 2.0 * std::tan(0.5 * camera.fov) / std::max(height, 1);
    return glm::dvec2(0.5 * width + glm::dot(to, axes.right) / (ahead * pixel),
                      0.5 * height - glm::dot(to, axes.up) / (ahead * pixel));
}

std::optional<glm::dvec3> point_on_head(const Simulation& simulation, const Camera& camera, double x, double y,
                                        int width, int height)
{
    const Solver& solver = simulation.solver();
    const Ray ray = ray_through(camera, x, y, width, height);
    std::optional<double> nearest = hit_body(ray, solver.body(), solver.head());
    const std::vector<Capsule> placed = solver.placed_colliders();
    const size_t of_head = placed.size() - simulation.style().host.colliders.size();
    for (size_t i = 0; i < of_head; ++i)
        if (const auto at = hit_collider(ray, placed[i], solver.head().origin); at && (!nearest || *at < *nearest))
            nearest = at;
    if (!solver.body().grid && of_head == 0)
    {
        const Groom& groom = solver.groom();
        nearest = hit(ray, solver.head().origin + solver.head().turn * glm::dvec3(groom.center),
                      double(simulation.assets().scalp.radius * simulation.params().head_scale));
    }
    if (!nearest)
        return std::nullopt;
    return ray.origin + ray.direction * *nearest;
}

glm::dvec3 surface_below(const Simulation& simulation, glm::dvec3 point)
{
    const Solver& solver = simulation.solver();
    const PlacedGrid& body = solver.body();
    const Pose& head = solver.head();
    const glm::dvec3 center = head.origin + head.turn * glm::dvec3(solver.groom().center);
    if (!body.grid)
    {
        const glm::dvec3 out = point - center;
        const double radius = double(simulation.assets().scalp.radius * simulation.params().head_scale);
        return center + out * (radius / std::max(glm::length(out), 1e-6));
    }
    const glm::dvec3 inward = glm::normalize(center - point);
    for (int i = 0; i < 3; ++i)
    {
        const glm::dvec3 local = glm::conjugate(head.turn) * (point - head.origin);
        point += inward * double(distance_to(body, glm::vec3(local)));
    }
    return point;
}

Pose dragged_head(const Grab& held, const Camera& camera, double x, double y, int width, int height)
{
    if (held.what == Grab::TURN_HEAD)
    {
        const glm::dquat yaw = glm::angleAxis(0.008 * (x - held.x), glm::dvec3(0, 1, 0));
        const glm::dquat pitch = glm::angleAxis(0.008 * (y - held.y), axes_of(camera).right);
        return {held.origin_before, glm::normalize(yaw * pitch * held.turn_before), glm::dvec3(0.0)};
    }
    const glm::dvec3 now = on_facing_plane(ray_through(camera, x, y, width, height), camera, held.start);
    return {held.origin_before + now - held.start, held.turn_before, glm::dvec3(0.0)};
}

glm::vec3 dragged_collider(const Grab& held, const Simulation& simulation, const Camera& camera, double x, double y,
                           int width, int height)
{
    const glm::dvec3 now = on_facing_plane(ray_through(camera, x, y, width, height), camera, held.start);
    const glm::dvec3 center = held.origin_before + now - held.start;
    const Pose& head = simulation.solver().head();
    const bool on_head = simulation.style().host.colliders.at(held.collider).on_head;
    // What a file may say: near the horizon a pixel is very far.
    return glm::clamp(glm::vec3(on_head ? glm::conjugate(head.turn) * (center - head.origin) : center), -100.0f,
                      100.0f);
}

Tie dragged_tie(const Grab& held, const Simulation& simulation, const Camera& camera, double x, double y, int width,
                int height)
{
    const Pose& head = simulation.solver().head();
    const PlacedGrid& body = simulation.solver().body();
    const TieGround ground = tie_ground(simulation.style(), simulation.assets(), body);
    Ray ray = ray_through(camera, x, y, width, height);
    ray.direction = glm::normalize(ray.direction + held.aside);
    Tie tie = held.tie_before;
    const float scale = simulation.params().head_scale;
    const float high = std::max(height_above(ground, tie.at * scale), tie.thickness);
    // Where one looks at that height over the head; beside it, what of it is nearest.
    std::optional<double> at = hit_body(ray, body, head, double(high));
    const std::vector<Capsule> placed = simulation.solver().placed_colliders(); // the head's own come first
    for (size_t i = 0; i < ground.spheres.size(); ++i)
    {
        Capsule around = placed[i];
        around.center.w += high;
        if (const std::optional<double> on = hit_collider(ray, around, head.origin); on && (!at || *on < *at))
            at = on;
    }
    const glm::dvec3 seen = at ? ray.origin + ray.direction * *at : on_facing_plane(ray, camera, held.start);
    const RingPlace before = ring_place(ground, tie.at * scale, high);
    const RingPlace now = ring_place(ground, glm::vec3(glm::conjugate(head.turn) * (seen - head.origin)), high);
    tie.at = glm::clamp(now.at / scale, -100.0f, 100.0f);
    tie.axis = glm::rotation(before.out, now.out) * tie.axis;
    return tie;
}

} // namespace coif
