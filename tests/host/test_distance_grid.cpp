#include "sim/distance_grid.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace coif::test
{
namespace
{

// A sphere of rings and sectors about `center`, wound outwards. Corners lie on it, so its faces lie inside by at most
// `sag`.
struct Ball
{
    Mesh mesh;
    double sag;
};
Ball ball(glm::dvec3 center, double radius, int rings, double lowest = -1.0)
{
    Ball ball;
    const int sectors = 2 * rings;
    const auto at = [&](int ring, int sector)
    {
        const double polar = glm::pi<double>() * ring / rings, turn = 2.0 * glm::pi<double>() * sector / sectors;
        return glm::vec3(center + radius * glm::dvec3(std::sin(polar) * std::sin(turn), std::cos(polar),
                                                      std::sin(polar) * std::cos(turn)));
    };
    const auto add = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c)
    {
        // Corners of their own: files split them, and nothing may hang on that.
        if ((double(a.y + b.y + c.y) / 3.0 - center.y) / radius < lowest || a == b || b == c || c == a)
            return;
        const unsigned first = unsigned(ball.mesh.positions.size());
        ball.mesh.positions.insert(ball.mesh.positions.end(), {a, b, c});
        ball.mesh.triangles.push_back({first, first + 1, first + 2});
    };
    for (int ring = 0; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector)
        {
            const int next = (sector + 1) % sectors;
            add(at(ring, sector), at(ring + 1, sector), at(ring + 1, next));
            add(at(ring, sector), at(ring + 1, next), at(ring, next));
        }
    const double half = glm::pi<double>() / rings;
    ball.sag = radius * (1.0 - std::pow(std::cos(0.5 * half), 2.0));
    return ball;
}

void append(Mesh& mesh, const Mesh& other)
{
    const unsigned first = unsigned(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (const glm::uvec3& t : other.triangles)
        mesh.triangles.push_back(t + first);
}

glm::dvec3 sample_at(const DistanceGrid& grid, size_t i)
{
    const size_t x = i % size_t(grid.size.x), y = i / size_t(grid.size.x) % size_t(grid.size.y),
                 z = i / size_t(grid.size.x) / size_t(grid.size.y);
    return glm::dvec3(grid.corner) + double(grid.voxel) * glm::dvec3(x, y, z);
}

void expect_finite(const DistanceGrid& grid)
{
    ASSERT_EQ(grid.distance.size(), size_t(grid.size.x) * size_t(grid.size.y) * size_t(grid.size.z));
    EXPECT_TRUE(std::all_of(grid.distance.begin(), grid.distance.end(), [](float d) { return std::isfinite(d); }));
}

// Worst difference from the distance to a sphere, and samples of the wrong sign further than `clear` from it.
struct Errors
{
    double worst = 0.0, near = 0.0; // anywhere, and within a voxel of the surface
    int wrong = 0;
};
Errors against_sphere(const DistanceGrid& grid, glm::dvec3 center, double radius, double clear)
{
    Errors errors;
    for (size_t i = 0; i < grid.distance.size(); ++i)
    {
        const double exact = glm::distance(sample_at(grid, i), center) - radius,
                     error = std::abs(grid.distance[i] - exact);
        errors.worst = std::max(errors.worst, error);
        if (std::abs(exact) < double(grid.voxel))
            errors.near = std::max(errors.near, error);
        errors.wrong += std::abs(exact) > clear && (exact < 0.0) != (grid.distance[i] < 0.0f);
    }
    return errors;
}

TEST(DistanceGrid, is_a_spheres_distance_to_within_its_facets)
{
    const glm::dvec3 center(0.3, -1.0, 0.1);
    const Ball sphere = ball(center, 0.1, 60);
    const DistanceGrid grid = compute_distance_grid(sphere.mesh, 40);
    expect_finite(grid);
    EXPECT_GT(grid.corner.x, 0.3f - 0.1f - 0.03f);
    EXPECT_LE(grid.corner.x, 0.3f - 0.1f - 0.02f) << "the margin";
    const Errors errors = against_sphere(grid, center, 0.1, sphere.sag);
    EXPECT_LE(errors.near, 1.001 * sphere.sag + 1e-6);
    EXPECT_LE(errors.worst, 0.25 * double(grid.voxel)) << "where facets are nearest to less than a voxel";
    EXPECT_EQ(errors.wrong, 0);
}

TEST(DistanceGrid, any_scale_and_place_gives_the_same_voxels)
{
    const DistanceGrid one = compute_distance_grid(ball({0, 0, 0}, 1.0, 20).mesh, 24);
    for (const double scale : {1e-20, 1e-6, 1e6, 1e20})
    {
        const DistanceGrid other = compute_distance_grid(ball({0, 0, 0}, scale, 20).mesh, 24);
        expect_finite(other);
        ASSERT_EQ(other.size, one.size);
        double worst = 0.0;
        for (size_t i = 0; i < one.distance.size(); ++i)
            if (std::abs(one.distance[i]) < one.voxel) // further away rounding chooses among what is about as near
                worst = std::max(worst, std::abs(double(other.distance[i]) / scale - double(one.distance[i])));
        EXPECT_LE(worst, 1e-4) << scale;
    }
}

TEST(DistanceGrid, sign_holds_with_flipped_doubled_and_loose_triangles)
{
    const Ball sphere = ball({0, 0, 0}, 0.1, 30);
    std::mt19937 random(1);
    Mesh flipped = sphere.mesh, inside_out = sphere.mesh, doubled = sphere.mesh;
    for (glm::uvec3& t : flipped.triangles)
        if (random() % 2)
            std::swap(t.y, t.z);
    for (glm::uvec3& t : inside_out.triangles)
        std::swap(t.y, t.z);
    append(doubled, inside_out);
    Mesh crumbs = sphere.mesh;
    for (int i = 0; i < 50; ++i) // without area, and on the surface
    {
        const glm::uvec3 t = crumbs.triangles[random() % crumbs.triangles.size()];
        crumbs.triangles.push_back({t.x, t.x, t.y});
        crumbs.triangles.push_back({t.z, t.z, t.z});
    }
    for (const Mesh& mesh : {flipped, inside_out, doubled, crumbs})
    {
        const DistanceGrid grid = compute_distance_grid(mesh, 32);
        expect_finite(grid);
        const Errors errors = against_sphere(grid, {0, 0, 0}, 0.1, sphere.sag);
        EXPECT_EQ(errors.wrong, 0);
        EXPECT_LE(errors.near, 1.001 * sphere.sag + 1e-6);
    }
}

TEST(DistanceGrid, an_open_neck_is_closed_with_a_lid)
{
    const Ball open = ball({0, 0, 0}, 0.1, 40, -0.7);
    const DistanceGrid grid = compute_distance_grid(open.mesh, 40);
    expect_finite(grid);
    int wrong = 0;
    for (size_t i = 0; i < grid.distance.size(); ++i)
    {
        const glm::dvec3 p = sample_at(grid, i);
        if (p.y > -0.05)
            wrong +=
                (glm::length(p) < 0.1 - 1e-3) != (grid.distance[i] < 0.0f) && std::abs(glm::length(p) - 0.1) > 1e-3;
        if (p.y < -0.09)
            wrong += grid.distance[i] < 0.0f;
    }
    EXPECT_EQ(wrong, 0);
    // Distances do not leap anywhere, through the opening least of all.
    double steepest = 0.0;
    for (float y = -0.12f; y < 0.1f; y += 0.0005f)
        steepest = std::max(steepest, std::abs(double(distance_at(grid, {0.01f, y + 0.0005f, 0.0f}).distance -
                                                      distance_at(grid, {0.01f, y, 0.0f}).distance)) /
                                          0.0005);
    EXPECT_LE(steepest, 1.8); // of the lid's steps
}

TEST(DistanceGrid, several_shells_are_one_body)
{
    Mesh mesh = ball({0, 0, 0}, 0.1, 30).mesh;
    append(mesh, ball({0.08, 0, 0}, 0.05, 20).mesh); // overlaps
    append(mesh, ball({0, 0, 0.05}, 0.02, 20).mesh); // an eye, within
    append(mesh, ball({0, 0.3, 0}, 0.05, 20).mesh);  // apart
    const DistanceGrid grid = compute_distance_grid(mesh, 40);
    expect_finite(grid);
    const auto depth = [](glm::dvec3 p, glm::dvec3 center, double radius) { return glm::distance(p, center) - radius; };
    int wrong = 0;
    for (size_t i = 0; i < grid.distance.size(); ++i)
    {
        const glm::dvec3 p = sample_at(grid, i);
        const double exact =
            std::min({depth(p, {0, 0, 0}, 0.1), depth(p, {0.08, 0, 0}, 0.05), depth(p, {0, 0.3, 0}, 0.05)});
        wrong += std::abs(exact) > 1e-3 && (exact < 0.0) != (grid.distance[i] < 0.0f);
    }
    EXPECT_EQ(wrong, 0);
}

TEST(DistanceGrid, what_has_no_inside_or_no_extent_does_no_harm)
{
    Mesh flat;
    flat.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    flat.triangles = {{0, 1, 2}, {0, 2, 3}};
    const DistanceGrid plate = compute_distance_grid(flat, 24);
    expect_finite(plate);
    EXPECT_GE(*std::min_element(plate.distance.begin(), plate.distance.end()), 0.0f);
    EXPECT_NEAR(distance_at(plate, {0.5f, 0.5f, 0.1f}).distance, 0.1f, 1e-3f);

    Mesh line = flat, point = flat, lost = flat;
    line.triangles = {{0, 1, 1}, {0, 0, 1}};
    expect_finite(compute_distance_grid(line, 16));
    point.triangles = {{2, 2, 2}};
    EXPECT_TRUE(compute_distance_grid(point, 16).empty());
    lost.positions[1].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(compute_distance_grid(lost, 16).empty());
    EXPECT_TRUE(compute_distance_grid(Mesh{}, 16).empty());
    EXPECT_EQ(distance_at(DistanceGrid{}, {0, 0, 0}).distance, kFarOutside);
}

TEST(DistanceGrid, its_gradient_is_that_of_what_it_says)
{
    const DistanceGrid grid = compute_distance_grid(ball({0, 0, 0}, 0.1, 40).mesh, 32);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> anywhere(-0.11f, 0.11f);
    for (int i = 0; i < 500; ++i)
    {
        const glm::vec3 p(anywhere(random), anywhere(random), anywhere(random));
        const DistanceAt at = distance_at(grid, p);
        if (std::abs(at.distance) < 0.5f * grid.voxel)
        {
            EXPECT_NEAR(at.distance, glm::length(p) - 0.1f, 4e-4f);
            EXPECT_NEAR(glm::dot(at.gradient, glm::normalize(p)), 1.0f, 0.05f);
        }
        for (int axis = 0; axis < 3; ++axis)
        {
            // Within a voxel it changes evenly along each axis.
            glm::vec3 a = p, b = p;
            const float place = (p[axis] - grid.corner[axis]) / grid.voxel, within = place - std::floor(place);
            a[axis] -= 0.5f * within * grid.voxel;
            b[axis] += 0.5f * (1.0f - within) * grid.voxel;
            EXPECT_NEAR((distance_at(grid, b).distance - distance_at(grid, a).distance) / (b[axis] - a[axis]),
                        at.gradient[axis], 2e-3f);
        }
    }
    const glm::vec3 corner = grid.corner;
    EXPECT_NEAR(distance_at(grid, corner - glm::vec3(3.0f, 0.0f, 4.0f)).distance,
                distance_at(grid, corner).distance + 5.0f, 1e-5f);
    for (const float bad : {NAN, INFINITY, -INFINITY})
        EXPECT_EQ(distance_at(grid, {0.0f, bad, 0.0f}).distance, kFarOutside);
}

TEST(BodyGrid, leaves_what_bulges_and_fills_what_no_ball_enters)
{
    const DistanceGrid one = compute_distance_grid(ball({0, 0, 0}, 0.1, 40).mesh, 40);
    const DistanceGrid same = body_grid(one, 0.03f); // as large as the margin leaves it
    double most = 0.0;
    for (size_t i = 0; i < one.distance.size(); ++i)
        most = std::max(most, std::abs(double(one.distance[i] - same.distance[i])));
    EXPECT_LE(most, 0.25 * double(one.voxel));

    Mesh two = ball({-0.05, 0, 0}, 0.05, 40).mesh; // which touch: a crease all round
    append(two, ball({0.05, 0, 0}, 0.05, 40).mesh);
    const DistanceGrid bare = compute_distance_grid(two, 40), body = body_grid(bare, 0.02f);
    expect_finite(body);
    // The ball rests on both at a height of sqrt(0.07^2 - 0.05^2) and reaches 0.02 down.
    const float filled_to = std::sqrt(0.07f * 0.07f - 0.05f * 0.05f) - 0.02f;
    EXPECT_GT(distance_at(bare, {0, filled_to, 0}).distance, 0.005f);
    EXPECT_NEAR(distance_at(body, {0, filled_to, 0}).distance, 0.0f, 0.3f * body.voxel);
    const glm::ivec3 ways = body.size / 2 + 1;
    ASSERT_EQ(body.way.size(), size_t(ways.x * ways.y * ways.z));
    for (int i = 0; i < int(body.way.size()); ++i)
    {
        ASSERT_NEAR(glm::length(body.way[size_t(i)]), 1.0f, 1e-5f);
        const glm::vec3 p =
            body.corner + 2.0f * body.voxel * glm::vec3(i % ways.x, i / ways.x % ways.y, i / ways.x / ways.y);
        if (std::abs(p.x) < 0.03f && std::abs(p.z) < 0.005f && p.y > 0.02f && p.y < 0.05f)
        {
            EXPECT_GT(body.way[size_t(i)].y, 0.7f) << "between the two as above them";
        }
    }
}

bool equal(const DistanceGrid& a, const DistanceGrid& b)
{
    return a.size == b.size && a.corner == b.corner && a.voxel == b.voxel && a.distance.size() == b.distance.size() &&
           !memcmp(a.distance.data(), b.distance.data(), a.distance.size() * sizeof(float));
}

TEST(DistanceCache, gives_back_what_was_computed_and_computes_what_is_damaged)
{
    const Scratch scratch;
    const fs::path folder = scratch / "deep/cache";
    const Mesh mesh = ball({0, 0, 0}, 0.1, 20).mesh;
    const DistanceGrid grid = compute_distance_grid(mesh, 20);
    EXPECT_TRUE(equal(cached_distance_grid(mesh, folder, 20), grid));
    ASSERT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
    const fs::path file = fs::directory_iterator(folder)->path();
    const std::string good = bytes_of(file);

    // That it is read: an older time would change if it were written.
    const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1000);
    fs::last_write_time(file, long_ago);
    EXPECT_TRUE(equal(cached_distance_grid(mesh, folder, 20), grid));
    EXPECT_EQ(fs::last_write_time(file), long_ago);

    std::vector<std::string> damaged = {"",
                                        "coif",
                                        good.substr(0, 71),
                                        good.substr(0, good.size() - 1),
                                        good + "x",
                                        std::string(good.size(), '\0'),
                                        std::string(good.size(), '\xff')};
    for (const size_t at : {0, 8, 12, 16, 24, 36, 40, 56, 72, 100})
    {
        damaged.push_back(good);
        damaged.back()[at] ^= 0x40;
    }
    for (const std::string& bytes : damaged)
    {
        std::ofstream(file, std::ios::binary) << bytes;
        EXPECT_TRUE(equal(cached_distance_grid(mesh, folder, 20), grid));
        EXPECT_EQ(bytes_of(file), good) << "mended";
    }

    Mesh moved = mesh;
    moved.positions[5].x += 1e-6f;
    cached_distance_grid(moved, folder, 20);
    cached_distance_grid(mesh, folder, 21);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 3) << "another mesh, another resolution";
}

TEST(DistanceCache, does_without_where_it_cannot_write)
{
    const Scratch scratch;
    const Mesh mesh = ball({0, 0, 0}, 0.1, 10).mesh;
    const DistanceGrid grid = compute_distance_grid(mesh, 16);
    scratch.write("file", "in the way");
    EXPECT_TRUE(equal(cached_distance_grid(mesh, scratch / "file", 16), grid));
    EXPECT_TRUE(equal(cached_distance_grid(mesh, scratch / "file/below", 16), grid));
    EXPECT_TRUE(equal(cached_distance_grid(mesh, "/proc/none", 16), grid));
    EXPECT_TRUE(equal(cached_distance_grid(mesh, "", 16), grid));
    // A folder where the file would be.
    cached_distance_grid(mesh, scratch / "cache", 16);
    const fs::path file = fs::directory_iterator(scratch / "cache")->path();
    fs::remove(file);
    fs::create_directories(file / "more");
    EXPECT_TRUE(equal(cached_distance_grid(mesh, scratch / "cache", 16), grid));
    // A link to somebody's file is replaced, not followed.
    fs::remove_all(file);
    fs::create_symlink(scratch.write("theirs", "theirs"), file);
    EXPECT_TRUE(equal(cached_distance_grid(mesh, scratch / "cache", 16), grid));
    EXPECT_EQ(bytes_of(scratch / "theirs"), "theirs");
}

TEST(DistanceCache, does_not_grow_for_ever)
{
    const Scratch scratch;
    Mesh mesh = ball({0, 0, 0}, 0.1, 4).mesh;
    for (int i = 0; i < 70; ++i)
    {
        mesh.positions[0].y += 1e-5f;
        cached_distance_grid(mesh, scratch.folder(), 4);
    }
    EXPECT_LE(std::distance(fs::directory_iterator(scratch.folder()), {}), 64);
}

} // namespace
} // namespace coif::test
