// Makes the scalps, the head and the head's collision spheres that coif ships: `generate FOLDER`.
//
// Metres; the cranium is a sphere of radius kCranium about the origin; +y is up, the face looks to +z and +x is the
// head's left. Everything is mirror-symmetric in x, and the same program always writes the same bytes.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace
{

struct Vec
{
    double x = 0, y = 0, z = 0;
};

Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(Vec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
Vec operator/(Vec a, Vec b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double length(Vec a) { return std::sqrt(dot(a, a)); }
Vec normalize(Vec a) { return a * (1 / length(a)); }

using Triangle = std::array<int, 3>;
using Field = std::function<double(Vec)>;

struct Mesh
{
    std::vector<Vec> points;
    std::vector<Vec> normals; // one a point, or none at all
    std::vector<Triangle> triangles;
};

using Edges = std::map<std::pair<int, int>, size_t>; // the triangle to the left of each directed edge

Edges edges_of(const Mesh& mesh)
{
    Edges edges;
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k)
            edges[{mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]}] = i;
    return edges;
}

constexpr double kCranium = 0.1; // radius of the sphere that the roots stand on
constexpr double kSkin = 0.099;  // the skin lies below it: a flat scalp triangle sags 0.6 mm into its sphere
constexpr double kDegree = std::numbers::pi / 180;

// By differences over `h` metres to each side.
Vec gradient(const Field& field, Vec p, double h = 2e-5)
{
    return Vec{field({p.x + h, p.y, p.z}) - field({p.x - h, p.y, p.z}),
               field({p.x, p.y + h, p.z}) - field({p.x, p.y - h, p.z}),
               field({p.x, p.y, p.z + h}) - field({p.x, p.y, p.z - h})} *
           (0.5 / h);
}

// One Newton step towards field = 0; at most `limit` metres, since a field may have creases.
Vec step_to_zero(const Field& field, Vec p, double limit)
{
    const Vec g = gradient(field, p);
    const Vec step = g * (field(p) / std::max(dot(g, g), 1e-6));
    return p - step * std::min(1.0, limit / std::max(length(step), 1e-12));
}

// ---- scalps ----------------------------------------------------------------------------------------------------

// The elevation of the hairline over the horizontal, in degrees, at an azimuth of 0 (face) to 180 (back) degrees:
// forehead, temple, sideburn, over the ear, behind it, nape.
double hairline(double azimuth)
{
    constexpr std::array<double, 13> kAt{0, 20, 38, 51, 60, 67, 74, 82, 91, 103, 120, 140, 180};
    constexpr std::array<double, 13> kHeight{49, 49, 47, 40, 27, 10, -2, -1, 11, 9, -13, -32, -37};
    size_t i = 0;
    while (i + 2 < kAt.size() && azimuth > kAt[i + 1])
        ++i;
    // Cubic Hermite, with the slopes of the neighbours' chords: smooth, and flat where the two sides meet.
    const auto slope = [&](size_t k)
    {
        const bool end = k == 0 || k + 1 == kAt.size();
        return end ? 0.0 : (kHeight[k + 1] - kHeight[k - 1]) / (kAt[k + 1] - kAt[k - 1]);
    };
    const double width = kAt[i + 1] - kAt[i], t = (azimuth - kAt[i]) / width;
    return std::lerp(kHeight[i], kHeight[i + 1], (3 - 2 * t) * t * t) +
           width * t * (1 - t) * (slope(i) * (1 - t) - slope(i + 1) * t);
}

// How far p lies inside the hairline, as an arc on the cranium in metres measured up and down; negative outside.
double inside_hairline(Vec p)
{
    const double azimuth = std::atan2(std::abs(p.x), p.z) / kDegree;
    const double elevation = std::atan2(p.y, std::hypot(p.x, p.z)) / kDegree;
    return (elevation - hairline(azimuth)) * kDegree * kCranium;
}

// The icosahedron with each edge cut into `frequency`, blown up to the cranium: 10 frequency^2 + 2 points. In this
// orientation the icosahedron is its own mirror image in x.
Mesh geodesic_sphere(int frequency)
{
    const double phi = std::numbers::phi;
    std::vector<Vec> corners;
    for (const double one : {-1.0, 1.0})
        for (const double golden : {-phi, phi})
            corners.insert(corners.end(), {{0, one, golden}, {one, golden, 0}, {golden, 0, one}});
    const auto adjacent = [&](Vec a, Vec b) { return length(a - b) < 2.1; };

    Mesh sphere;
    std::map<std::array<long, 3>, int> known; // points on the edges of faces are met more than once
    const auto point = [&](Vec p)
    {
        p = normalize(p);
        const auto [place, fresh] =
            known.try_emplace({std::lround(p.x * 1e6), std::lround(p.y * 1e6), std::lround(p.z * 1e6)},
                              static_cast<int>(sphere.points.size()));
        if (fresh)
            sphere.points.push_back(p * kCranium);
        return place->second;
    };
    const auto face = [&](Vec a, Vec b, Vec c)
    {
        const Vec u = (b - a) * (1.0 / frequency), v = (c - a) * (1.0 / frequency);
        const auto at = [&](int i, int j) { return point(a + u * i + v * j); };
        for (int i = 0; i < frequency; ++i)
            for (int j = 0; i + j < frequency; ++j)
            {
                sphere.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
                if (i + j + 1 < frequency)
                    sphere.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
            }
    };
    for (const Vec a : corners)
        for (const Vec b : corners)
            for (const Vec c : corners)
            {
                const bool counterclockwise = dot(a, cross(b, c)) > 0;
                const bool first = std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z) &&
                                   std::tie(a.x, a.y, a.z) < std::tie(c.x, c.y, c.z);
                if (first && counterclockwise && adjacent(a, b) && adjacent(b, c) && adjacent(c, a))
                    face(a, b, c);
            }
    return sphere;
}

// Keeps each point that a triangle uses, in the old order.
Mesh without_loose_points(const Mesh& mesh)
{
    std::vector<int> place(mesh.points.size(), -1);
    for (const Triangle& t : mesh.triangles)
        for (int i : t)
            place[i] = 0;
    Mesh kept;
    for (size_t i = 0; i < place.size(); ++i)
        if (place[i] == 0)
        {
            place[i] = static_cast<int>(kept.points.size());
            kept.points.push_back(mesh.points[i]);
        }
    for (const Triangle& t : mesh.triangles)
        kept.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
    return kept;
}

// The part of a geodesic sphere where inside > 0. A bare cut has teeth as large as a triangle, so the rim is moved
// onto inside = 0 and the points are evened out along the sphere.
Mesh scalp(int frequency, const Field& inside)
{
    Mesh mesh = geodesic_sphere(frequency);
    const auto outside = [&](const Triangle& t)
    { return inside((mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) * (1.0 / 3)) < -0.002; };
    std::erase_if(mesh.triangles, outside);

    for (bool changed = true; changed;) // a triangle that hangs by one edge would be squashed onto the rim
    {
        const Edges edges = edges_of(mesh);
        const auto hangs = [&](const Triangle& t) {
            return edges.count({t[1], t[0]}) + edges.count({t[2], t[1]}) + edges.count({t[0], t[2]}) < 2;
        };
        changed = std::erase_if(mesh.triangles, hangs) > 0;
    }
    mesh = without_loose_points(mesh);

    std::vector<std::vector<int>> near(mesh.points.size()), along_rim(mesh.points.size());
    const Edges edges = edges_of(mesh);
    for (const auto& [edge, triangle] : edges)
    {
        const auto [a, b] = edge;
        near[a].push_back(b);
        if (edges.count({b, a}))
            continue;
        along_rim[a].push_back(b);
        along_rim[b].push_back(a);
    }
    for (int round = 0; round < 60; ++round)
    {
        std::vector<Vec> moved = mesh.points;
        for (size_t i = 0; i < moved.size(); ++i)
        {
            const bool rim = !along_rim[i].empty();
            const std::vector<int>& others = rim ? along_rim[i] : near[i];
            Vec sum;
            double weight = 0; // long edges pull harder, so that all become alike
            for (int k : others)
            {
                const double pull = length(mesh.points[k] - mesh.points[i]);
                sum = sum + mesh.points[k] * pull;
                weight += pull;
            }
            Vec p = normalize(mesh.points[i] + (sum * (1 / weight) - mesh.points[i]) * 0.5) * kCranium;
            if (rim)
                p = step_to_zero(inside, p, 0.003);
            moved[i] = normalize(p) * kCranium;
        }
        mesh.points = moved;
    }
    return mesh;
}

// ---- the head --------------------------------------------------------------------------------------------------

// Signed distances and their smooth unions after Inigo Quilez, https://iquilezles.org/articles/distfunctions and
// /smin. k is how far, in metres, a blend reaches.
double smooth_min(double a, double b, double k)
{
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * k / 4;
}
double smooth_max(double a, double b, double k) { return -smooth_min(-a, -b, k); }

double ellipsoid(Vec p, Vec centre, Vec radii)
{
    const Vec q = (p - centre) / radii;
    return length(q) * (length(q) - 1) / length(q / radii);
}

// A capsule from a to b whose radius goes from ra to rb.
double capsule(Vec p, Vec a, double ra, Vec b, double rb)
{
    const Vec ab = b - a;
    const double t = std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0);
    return length(p - a - ab * t) - (ra + (rb - ra) * t);
}

double ramp(double from, double to, double value)
{
    const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// The functions below add a feature to the distance d. They take p, or p mirrored to the left as `side`.

// An ear lies in the plane of its local x (backwards) and y (up); z points away from the head. `yaw` makes it stand off
// the head, `pitch` follows the cranium's slope.
double with_ear(double d, Vec side)
{
    const double yaw = 68 * kDegree, pitch = 9 * kDegree, lean = 0.22;
    const Vec p = side - Vec{0.0935, -0.033, -0.013};
    const double out = std::sin(yaw) * p.x + std::cos(yaw) * p.z;
    const double up = std::cos(pitch) * p.y + std::sin(pitch) * out;
    const Vec q{std::cos(yaw) * p.x - std::sin(yaw) * p.z - lean * up, up,
                std::cos(pitch) * out - std::sin(pitch) * p.y};
    // The rim follows an ellipse; its nearest point is taken to be the one in the same stretched direction.
    constexpr double kAcross = 0.0140, kAlong = 0.0255;
    const Vec stretched{q.x / kAcross, q.y / kAlong, 0};
    const double round = std::max(length(stretched), 1e-3);
    const Vec rim{q.x / round, q.y / round, 0.0008};
    double ear = length(q - rim) - 0.0036;
    // Solid behind, or it would be too thin for the net.
    const double plate = smooth_max((round - 1.2) * kAcross, std::abs(q.z + 0.0065) - 0.0073, 0.006);
    ear = smooth_min(ear, plate, 0.004);
    ear = smooth_min(ear, capsule(q, {0.002, 0.013, 0.0}, 0.0026, {0.0055, -0.003, 0.0}, 0.0034), 0.004); // inner fold
    ear = smooth_min(ear, capsule(q, {0.0055, -0.003, 0.0}, 0.0034, {-0.002, -0.013, 0.0}, 0.0030), 0.004);
    ear = smooth_min(ear, ellipsoid(q, {-0.003, -0.023, 0.000}, {0.0085, 0.0090, 0.0050}), 0.008); // lobe
    ear = smooth_min(ear, ellipsoid(q, {-0.0125, -0.006, 0.001}, {0.0045, 0.0065, 0.0045}), 0.006);
    return smooth_min(d, ear, 0.006);
}

double with_eye(double d, Vec side)
{
    d = smooth_max(d, -ellipsoid(side, {0.032, -0.013, 0.103}, {0.021, 0.0115, 0.0165}), 0.016);
    const Vec eye{0.0315, -0.0165, 0.0735};
    d = smooth_min(d, ellipsoid(side, eye, {0.0165, 0.0125, 0.0145}), 0.006);
    // The closed lids meet in an arc that hangs a little, engraved as a soft line.
    const Vec p = side - eye;
    const double across = p.x / 0.0155;
    const double line = p.y + 0.0062 - 0.0035 * across * across;
    const double depth = 0.0013 * (1 - ramp(0.7, 1.05, std::abs(across))) * ramp(0.002, 0.008, p.z);
    return d + depth * std::exp(-line * line / (0.0020 * 0.0020));
}

double with_nose(double d, Vec p, Vec side)
{
    double nose = capsule(p, {0, -0.010, 0.0880}, 0.0070, {0, -0.049, 0.1060}, 0.0080);
    nose = smooth_min(nose, ellipsoid(p, {0, -0.0525, 0.1080}, {0.0100, 0.0090, 0.0095}), 0.008);
    nose = smooth_min(nose, ellipsoid(side, {0.0108, -0.0560, 0.0980}, {0.0062, 0.0066, 0.0095}), 0.006);
    const Vec nostril = (side - Vec{0.0060, -0.0605, 0.1080}) / Vec{0.0026, 0.0030, 0.0038};
    return smooth_min(d, nose, 0.010) + 0.0014 * std::exp(-dot(nostril, nostril));
}

double with_mouth(double d, Vec p)
{
    d = smooth_min(d, ellipsoid(p, {0, -0.081, 0.070}, {0.030, 0.024, 0.0235}), 0.022);
    const double across = p.x / 0.025;
    const double smile = 0.0018 * across * across;                            // how far the corners are raised
    const double bow = 0.0012 * std::cos(p.x / 0.024 * 2 * std::numbers::pi); // cupid's bow
    const Vec q{p.x, p.y - smile, p.z + 23 * p.x * p.x};                      // lips lie round the teeth
    d = smooth_min(d, ellipsoid(q, {0, -0.0765 - bow, 0.0963}, {0.0235, 0.0050, 0.0062}), 0.006);
    d = smooth_min(d, ellipsoid(q, {0, -0.0862, 0.0962}, {0.0195, 0.0058, 0.0072}), 0.006);
    const double line = q.y + 0.0810;
    const double slit = 0.0014 * (1 - ramp(0.6, 1.1, std::abs(across))) * ramp(0.06, 0.08, p.z);
    return d + slit * std::exp(-line * line / (0.0020 * 0.0020));
}

double with_neck_and_shoulders(double d, Vec p, Vec side)
{
    double neck = capsule(p, {0, -0.070, -0.014}, 0.050, {0, -0.200, -0.030}, 0.047);
    // The muscles from behind the ears to the pit of the throat.
    neck = smooth_min(neck, capsule(side, {0.050, -0.075, -0.022}, 0.012, {0.014, -0.200, 0.012}, 0.007), 0.03);
    double bust = capsule(side, {0.0, -0.175, -0.040}, 0.038, {0.112, -0.226, -0.034}, 0.034);
    bust = smooth_min(bust, ellipsoid(p, {0, -0.262, -0.022}, {0.130, 0.066, 0.066}), 0.05);
    bust = smooth_min(bust, capsule(side, {0.018, -0.210, 0.018}, 0.005, {0.110, -0.216, -0.012}, 0.005), 0.03);
    bust = smooth_max(bust, ellipsoid(p, {0, -0.185, -0.025}, {0.175, 0.104, 0.300}), 0.025); // cut in a curve
    return smooth_min(d, smooth_min(neck, bust, 0.05), 0.03);
}

// Signed distance to the bust, about true near the skin.
double head(Vec p)
{
    // The left half, mirrored; rounded at the middle, so that what crosses it has no crease there.
    const double soft = 0.002;
    const Vec side{std::sqrt(p.x * p.x + soft * soft) - soft, p.y, p.z};

    const double cranium = length(p) - kSkin;
    double d = smooth_min(cranium, ellipsoid(p, {0, -0.050, 0.030}, {0.064, 0.078, 0.063}), 0.03);
    d = smooth_min(d, capsule(side, {0.048, -0.082, 0.006}, 0.016, {0.011, -0.112, 0.063}, 0.014), 0.035); // jaw
    d = smooth_min(d, ellipsoid(p, {0, -0.115, 0.076}, {0.0165, 0.015, 0.0165}), 0.022);                   // chin
    d = smooth_min(d, ellipsoid(side, {0.042, -0.046, 0.058}, {0.022, 0.022, 0.022}), 0.025);              // cheekbone
    d = smooth_min(d, ellipsoid(side, {0.034, -0.076, 0.048}, {0.024, 0.024, 0.026}), 0.025);              // cheek
    d = with_neck_and_shoulders(d, p, side);
    d = with_eye(d, side);
    d = with_mouth(d, p);
    d = with_nose(d, p, side);
    // Under the hair it is the cranium and nothing else; the ears keep clear of it.
    d = std::lerp(d, cranium, ramp(-0.018 - 0.016 * ramp(0, -0.06, p.z), -0.001, inside_hairline(p)));
    return with_ear(d, side);
}

// Surface nets (Gibson 1998) on a grid of `step` metres: a point for each cell that the surface crosses, a quad, cut in
// two, for each edge that it crosses. The points are then evened out along it. The box is symmetric in x.
Mesh surface_net(const Field& field, Vec low, Vec high, double step)
{
    // An even number of grid points across, so that a row of cells, and so of points, lies on the midline.
    const int nx = 2 * static_cast<int>(std::ceil(high.x / step));
    const int ny = static_cast<int>(std::ceil((high.y - low.y) / step)) + 1;
    const int nz = static_cast<int>(std::ceil((high.z - low.z) / step)) + 1;
    const std::array<int, 3> stride{1, nx, nx * ny};
    const auto place = [&](int index) {
        return Vec{(index % nx - (nx - 1) * 0.5) * step, low.y + index / nx % ny * step,
                   low.z + index / (nx * ny) * step};
    };
    std::vector<double> value(static_cast<size_t>(nx) * ny * nz);
    for (size_t i = 0; i < value.size(); ++i)
        value[i] = field(place(static_cast<int>(i)));

    Mesh mesh;
    std::vector<int> cell(value.size(), -1); // its point
    const int cells = static_cast<int>(value.size()) - stride[0] - stride[1] - stride[2];
    for (int i = 0; i < cells; ++i)
    {
        Vec sum;
        int crossings = 0;
        for (int corner = 0; corner < 8; ++corner)
            for (int axis = 0; axis < 3; ++axis)
            {
                if (corner >> axis & 1)
                    continue;
                const int a = i + (corner & 1) + (corner >> 1 & 1) * stride[1] + (corner >> 2) * stride[2];
                const int b = a + stride[axis];
                if ((value[a] < 0) == (value[b] < 0))
                    continue;
                sum = sum + place(a) + (place(b) - place(a)) * (value[a] / (value[a] - value[b]));
                ++crossings;
            }
        if (crossings == 0)
            continue;
        cell[i] = static_cast<int>(mesh.points.size());
        mesh.points.push_back(sum * (1.0 / crossings));
    }

    std::vector<std::array<int, 4>> quads;
    std::vector<std::vector<int>> near(mesh.points.size());
    for (int i = stride[2]; i < cells; ++i)
        for (int axis = 0; axis < 3; ++axis)
        {
            const bool within = value[i] < 0;
            if (within == (value[i + stride[axis]] < 0))
                continue;
            const int u = stride[(axis + 1) % 3], v = stride[(axis + 2) % 3];
            std::array<int, 4> quad{cell[i], cell[i - u], cell[i - u - v], cell[i - v]};
            if (!within)
                std::swap(quad[1], quad[3]);
            quads.push_back(quad);
            for (int k = 0; k < 4; ++k)
                near[quad[k]].push_back(quad[(k + 1) % 4]);
        }

    for (int round = 0; round < 3; ++round)
    {
        std::vector<Vec> moved = mesh.points;
        for (size_t i = 0; i < moved.size(); ++i)
        {
            Vec mean;
            for (int other : near[i])
                mean = mean + mesh.points[other] * (1.0 / near[i].size());
            // Along the skin only: inwards, a thin rim would close up.
            const Vec p = step_to_zero(field, mesh.points[i], step / 2), out = normalize(gradient(field, p));
            const Vec shift = mean - p;
            moved[i] = p + (shift - out * dot(shift, out)) * 0.4;
        }
        mesh.points = moved;
    }
    for (Vec& p : mesh.points)
        p = step_to_zero(field, p, step / 2);
    for (const auto& q : quads) // along the shorter diagonal, which keeps the two halves alike
    {
        const auto diagonal = [&](int k) { return length(mesh.points[q[k]] - mesh.points[q[k + 2]]); };
        const int s = diagonal(0) <= diagonal(1) ? 0 : 1;
        mesh.triangles.push_back({q[s], q[s + 1], q[s + 2]});
        mesh.triangles.push_back({q[s], q[s + 2], q[(s + 3) % 4]});
    }
    return mesh;
}

// Halves the longest edge of triangles (Rivara 1984) until along each edge the skin turns by less than `turn` (radians,
// given a place) or the edge is shorter than `finest` metres: lids, lips and ears get many points, the cranium none.
Mesh refined(Mesh mesh, const Field& field, const Field& turn, double finest)
{
    const auto normal = [&](Vec p) { return normalize(gradient(field, p, 3e-4)); };
    for (Vec p : mesh.points)
        mesh.normals.push_back(normal(p));
    const auto edge_length = [&](int a, int b) { return length(mesh.points[a] - mesh.points[b]); };

    for (int round = 0; round < 12; ++round)
    {
        const Edges left_of = edges_of(mesh);
        std::vector<std::pair<double, std::pair<int, int>>> wanted;
        for (const Triangle& t : mesh.triangles)
        {
            int longest = 0;
            bool coarse = false;
            for (int k = 0; k < 3; ++k)
            {
                const int a = t[k], b = t[(k + 1) % 3];
                coarse |=
                    edge_length(a, b) > finest && length(mesh.normals[a] - mesh.normals[b]) > turn(mesh.points[a]);
                if (edge_length(a, b) > edge_length(t[longest], t[(longest + 1) % 3]))
                    longest = k;
            }
            const std::pair edge = std::minmax({t[longest], t[(longest + 1) % 3]});
            if (coarse)
                wanted.push_back({-edge_length(edge.first, edge.second), edge});
        }
        std::sort(wanted.begin(), wanted.end());

        std::vector<bool> touched(mesh.triangles.size());
        for (const auto& [key, edge] : wanted)
        {
            const auto [a, b] = edge;
            const size_t left = left_of.at({a, b}), right = left_of.at({b, a});
            if (touched[left] || touched[right])
                continue;
            touched[left] = touched[right] = true;
            const int middle = static_cast<int>(mesh.points.size());
            const Vec p = step_to_zero(field, (mesh.points[a] + mesh.points[b]) * 0.5, finest);
            mesh.points.push_back(p);
            mesh.normals.push_back(normal(p));
            for (const size_t i : {left, right})
            {
                Triangle other_half = mesh.triangles[i];
                std::replace(mesh.triangles[i].begin(), mesh.triangles[i].end(), a, middle);
                std::replace(other_half.begin(), other_half.end(), b, middle);
                mesh.triangles.push_back(other_half);
            }
        }
    }
    return mesh;
}

// ---- files -----------------------------------------------------------------------------------------------------

struct Sphere
{
    Vec centre;
    double radius;
};

// What hair slides over, fitted to the skin by a random search: the skin sticks out by less than 1 mm where hair grows,
// 3 mm at the neck and 6 mm elsewhere, the spheres by less than 9 mm; but for the first they keep clear of the scalp.
// Those off the middle stand for two, one on each side.
const std::vector<Sphere> kSpheres{{{0, 0, 0}, kCranium},
                                   {{0, -0.0484, 0.0688}, 0.0379},
                                   {{0, -0.0816, 0.08}, 0.0232},
                                   {{0, -0.1029, 0.0628}, 0.0344},
                                   {{0, -0.0503, 0.1026}, 0.015},
                                   {{0, -0.0288, 0.0869}, 0.0203},
                                   {{0.0258, -0.0406, 0.0391}, 0.0552},
                                   {{0.004, -0.0754, 0.0371}, 0.0592},
                                   {{0.0136, -0.0635, 0.0326}, 0.061},
                                   {{0.0137, -0.0528, 0.0004}, 0.0708},
                                   {{0.0892, -0.0171, -0.0195}, 0.0188},
                                   {{0.0955, -0.0369, -0.0228}, 0.0102},
                                   {{0.078, -0.0451, -0.0104}, 0.0223},
                                   {{0, -0.0767, 0.0015}, 0.072},
                                   {{0, -0.13, -0.0182}, 0.057},
                                   {{0, -0.1666, -0.0263}, 0.0637},
                                   {{0, -0.1847, -0.0269}, 0.0666},
                                   {{0, -0.2255, -0.027}, 0.0726},
                                   {{0.0415, -0.2078, -0.0301}, 0.058},
                                   {{0.0456, -0.2441, -0.0449}, 0.0462},
                                   {{0.066, -0.245, -0.0042}, 0.0413},
                                   {{0.0222, -0.2536, 0.01}, 0.0387},
                                   {{0.0958, -0.2276, -0.0307}, 0.049}};

std::string number(double value, int decimals)
{
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
    const std::string number = text.data();
    return number.find_first_not_of("-0.") == std::string::npos && number[0] == '-' ? number.substr(1) : number;
}

void write(const std::string& path, const std::string& text)
{
    std::ofstream file(path, std::ios::binary);
    file << text << std::flush;
    if (!file)
        throw std::runtime_error("cannot write " + path);
}

std::string obj(const Mesh& mesh, const std::string& what, int decimals)
{
    std::string text = "# " + what + "; made by assets/generate.cpp\n";
    const auto line = [](const char* key, Vec v, int digits) {
        return std::string(key) + " " + number(v.x, digits) + " " + number(v.y, digits) + " " + number(v.z, digits) +
               "\n";
    };
    for (const Vec& p : mesh.points)
        text += line("v", p, decimals);
    for (const Vec& n : mesh.normals)
        text += line("vn", n, 3);
    for (const Triangle& t : mesh.triangles)
    {
        text += "f";
        for (int i : t)
        {
            const std::string one_based = std::to_string(i + 1);
            text += " " + one_based + (mesh.normals.empty() ? "" : "//" + one_based);
        }
        text += "\n";
    }
    return text;
}

std::string toml(const std::vector<Sphere>& spheres)
{
    std::string text =
        "# The collision spheres of head.obj in metres, made by assets/generate.cpp. The first is the cranium.\n";
    const auto collider = [&](Vec c, double radius)
    {
        text += "\n[[collider]]\ncenter = [" + number(c.x, 4) + ", " + number(c.y, 4) + ", " + number(c.z, 4) +
                "]\nradius = " + number(radius, 4) + "\n";
    };
    for (const Sphere& s : spheres)
    {
        collider(s.centre, s.radius);
        if (s.centre.x != 0)
            collider({-s.centre.x, s.centre.y, s.centre.z}, s.radius);
    }
    return text;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::cerr << "usage: generate FOLDER\n";
        return 2;
    }
    const std::string folder = std::string(argv[1]) + "/";
    const auto top = [](Vec p) { return smooth_min(inside_hairline(p), p.y - 0.050 + 0.15 * p.z, 0.02); };
    const auto strip = [](Vec p) { return smooth_min(inside_hairline(p), 0.0175 - std::abs(p.x), 0.01); };
    const auto turn = [](Vec p) { return p.z > 0.07 ? 0.25 : 0.55; }; // the face is what one looks at
    try
    {
        const Mesh bust =
            refined(surface_net(head, {-0.17, -0.30, -0.12}, {0.17, 0.11, 0.13}, 0.0059), head, turn, 0.0016);
        write(folder + "scalp.obj", obj(scalp(7, inside_hairline), "the whole scalp, a guide a vertex", 6));
        write(folder + "scalp_top.obj", obj(scalp(10, top), "the top of the scalp, for an undercut", 6));
        write(folder + "scalp_strip.obj", obj(scalp(15, strip), "a strip along the midline, for a mohawk", 6));
        write(folder + "head.obj", obj(bust, "a mannequin's bust for the scalps beside it", 5));
        write(folder + "head_spheres.toml", toml(kSpheres));
    }
    catch (const std::runtime_error& error)
    {
        std::cerr << "generate: " << error.what() << "\n";
        return 1;
    }
}
