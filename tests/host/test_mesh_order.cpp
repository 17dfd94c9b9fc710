#include "app/mesh_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <limits>
#include <random>

namespace coif
{
namespace
{

struct Shape
{
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
};

Shape tetrahedron()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

// A sheet of `side` by `side` squares, its triangles in any order.
Shape shuffled_sheet(unsigned side)
{
    Shape sheet;
    for (unsigned y = 0; y <= side; ++y)
        for (unsigned x = 0; x <= side; ++x)
            sheet.positions.emplace_back(float(x), 2.0f, float(y));
    for (unsigned y = 0; y < side; ++y)
        for (unsigned x = 0; x < side; ++x)
        {
            const unsigned a = y * (side + 1) + x, b = a + side + 1;
            sheet.triangles.emplace_back(a, b, a + 1);
            sheet.triangles.emplace_back(a + 1, b, b + 1);
        }
    std::shuffle(sheet.triangles.begin(), sheet.triangles.end(), std::mt19937(7));
    return sheet;
}

// Vertices worked out by something that remembers the last `kept`, for each triangle.
double worked_out(const std::vector<glm::uvec3>& triangles, size_t kept)
{
    std::deque<unsigned> known;
    int count = 0;
    for (const glm::uvec3& t : triangles)
        for (int i = 0; i < 3; ++i)
            if (std::find(known.begin(), known.end(), t[i]) == known.end())
            {
                ++count;
                known.push_back(t[i]);
                if (known.size() > kept)
                    known.pop_front();
            }
    return double(count) / double(triangles.size());
}

std::vector<std::array<unsigned, 3>> as_set(const std::vector<glm::uvec3>& triangles)
{
    std::vector<std::array<unsigned, 3>> set;
    for (const glm::uvec3& t : triangles)
        set.push_back({t.x, t.y, t.z});
    std::sort(set.begin(), set.end());
    return set;
}

TEST(MeshOrder, TheCurveKeepsAllTrianglesAndBringsTheirVerticesTogether)
{
    const Shape sheet = shuffled_sheet(40);
    const std::vector<glm::uvec3> sorted = along_curve(sheet.positions, sheet.triangles);
    EXPECT_EQ(as_set(sorted), as_set(sheet.triangles));
    EXPECT_GT(worked_out(sheet.triangles, 32), 2.5);
    EXPECT_LT(worked_out(sorted, 32), 1.0);
}

TEST(MeshOrder, AnyPositionsHaveAnOrder)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    for (const float odd : {nan, infinite, -infinite, 3e38f})
    {
        Shape shape = shuffled_sheet(4);
        shape.positions[7].y = odd;
        EXPECT_EQ(as_set(along_curve(shape.positions, shape.triangles)), as_set(shape.triangles)) << odd;
    }
    const std::vector<glm::vec3> point(3, glm::vec3(1.0f));
    EXPECT_EQ(along_curve(point, {{0, 1, 2}}).size(), 1u);
    EXPECT_TRUE(along_curve({}, {}).empty());
}

TEST(MeshOrder, AClosedMeshFacesOneWay)
{
    Shape shape = tetrahedron();
    EXPECT_EQ(facing(shape.positions, shape.triangles), 1);
    for (glm::uvec3& t : shape.triangles)
        std::swap(t.y, t.z);
    EXPECT_EQ(facing(shape.positions, shape.triangles), -1);
}

TEST(MeshOrder, WhatIsNotClosedFacesNowhere)
{
    const Shape whole = tetrahedron();
    Shape open = whole, turned = whole, twice = whole;
    open.triangles.pop_back();
    EXPECT_EQ(facing(open.positions, open.triangles), 0);
    std::swap(turned.triangles[1].y, turned.triangles[1].z);
    EXPECT_EQ(facing(turned.positions, turned.triangles), 0);
    twice.triangles.insert(twice.triangles.end(), whole.triangles.begin(), whole.triangles.end());
    EXPECT_EQ(facing(twice.positions, twice.triangles), 0);
    EXPECT_EQ(facing({}, {}), 0);
}

} // namespace
} // namespace coif
