// Scalps, heads in every format that coif promises, and distances to triangles.
#include "sim/mesh.h"

#include "app/stress/random_style.h"
#include "tests/host/scratch.h"

#include <assimp/Exporter.hpp>
#include <assimp/scene.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

// assimp's reader of FBX leaks where a file ends too early; that is not coif's to mend.
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp\n"; }

namespace coif
{
namespace
{

using test::between;
using test::bytes_of;
using test::error_of;
using test::Scratch;
using test::shipped;
using test::TimeLimit;

TEST(Scalp, each_shipped_one_has_its_guides_in_file_order)
{
    for (const auto& [name, guides] :
         {std::pair{"scalp.obj", 252u}, {"scalp_top.obj", 242u}, {"scalp_strip.obj", 234u}})
    {
        const Scalp scalp = load_scalp(shipped(name));
        EXPECT_EQ(scalp.positions.size(), guides) << name;
        EXPECT_EQ(scalp.normals.size(), guides) << name;
        std::istringstream in(bytes_of(shipped(name)));
        std::string line;
        size_t vertex = 0, face = 0;
        while (std::getline(in, line))
        {
            float v[3];
            unsigned f[3];
            if (sscanf(line.c_str(), "v %f %f %f", v, v + 1, v + 2) == 3)
            {
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_NEAR(scalp.positions.at(vertex)[axis], v[axis], 1e-7) << name << " vertex " << vertex;
                ++vertex;
            }
            else if (sscanf(line.c_str(), "f %u%*[/0-9] %u%*[/0-9] %u", f, f + 1, f + 2) == 3 ||
                     sscanf(line.c_str(), "f %u %u %u", f, f + 1, f + 2) == 3)
            {
                EXPECT_EQ(scalp.triangles.at(face), glm::uvec3(f[0] - 1, f[1] - 1, f[2] - 1)) << name;
                ++face;
            }
        }
        EXPECT_EQ(vertex, guides);
        EXPECT_EQ(face, scalp.triangles.size());
    }
}

TEST(Scalp, refined_has_a_vertex_more_for_each_side)
{
    for (const char* name : {"scalp.obj", "scalp_strip.obj"})
    {
        const Scalp coarse = load_scalp(shipped(name));
        std::set<std::pair<unsigned, unsigned>> sides;
        for (const glm::uvec3& t : coarse.triangles)
            for (int k = 0; k < 3; ++k)
                sides.insert(std::minmax(t[k], t[(k + 1) % 3]));
        const Scalp fine = refined(coarse, 1);
        ASSERT_EQ(fine.positions.size(), coarse.positions.size() + sides.size());
        ASSERT_EQ(fine.normals.size(), fine.positions.size());
        EXPECT_EQ(fine.triangles.size(), 4 * coarse.triangles.size());
        for (size_t v = 0; v < coarse.positions.size(); ++v)
        {
            EXPECT_EQ(fine.positions[v], coarse.positions[v]);
            EXPECT_EQ(fine.normals[v], coarse.normals[v]);
        }
        // As far from one end as from the other, and not far from the middle between them.
        size_t found = 0;
        for (size_t v = coarse.positions.size(); v < fine.positions.size(); ++v)
            found += size_t(std::count_if(sides.begin(), sides.end(),
                                          [&](const auto& side)
                                          {
                                              const glm::vec3 a = coarse.positions[side.first],
                                                              b = coarse.positions[side.second], p = fine.positions[v];
                                              return glm::distance(p, 0.5f * (a + b)) < 0.1f * glm::distance(a, b) &&
                                                     std::abs(glm::distance(p, a) - glm::distance(p, b)) <
                                                         0.05f * glm::distance(a, b);
                                          }));
        EXPECT_EQ(found, sides.size());
        // Seen from the same side.
        for (const glm::uvec3& t : fine.triangles)
        {
            const glm::vec3 a = fine.positions[t.x];
            const glm::vec3 n = glm::normalize(glm::cross(fine.positions[t.y] - a, fine.positions[t.z] - a));
            for (int k = 0; k < 3; ++k)
                EXPECT_GT(glm::dot(n, fine.normals[t[k]]), 0.9f);
        }
        EXPECT_EQ(refined(coarse, 2).positions, refined(fine, 1).positions);
        EXPECT_EQ(refined(coarse, 2).normals, refined(fine, 1).normals);
    }
}

// Else what grows from a refined scalp starts inside the head.
TEST(Scalp, refined_stays_on_the_sphere_that_it_is_a_part_of)
{
    const auto deepest = [](const Scalp& scalp)
    {
        float most = 0.0f;
        for (const glm::vec3& p : scalp.positions)
            most = std::max(most, std::abs(glm::distance(p, scalp.center) - scalp.radius));
        return most / scalp.radius;
    };
    const Scratch scratch;
    // An octahedron's sides span a right angle: 3/8 t^4 is not small there, but the chords' middles are at 0.29.
    const fs::path eight = scratch.write("eight.obj", "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
                                                      "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\n"
                                                      "f 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
    EXPECT_LT(deepest(refined(load_scalp(eight), 1)), 0.12f);
    EXPECT_LT(deepest(refined(load_scalp(eight), 3)), 0.16f);
    // Sides of up to 0.83; their chords are at 0.085.
    const fs::path half = scratch.write("half.obj", stress::small_scalp());
    EXPECT_LT(deepest(refined(load_scalp(half), 1)), 0.015f);
    EXPECT_LT(deepest(refined(load_scalp(half), 3)), 0.015f);
}

// The shipped ones are no spheres: what is refined lies on the head's skin as what it was made of does.
TEST(Scalp, refined_stays_on_the_head)
{
    const Mesh head = load_mesh(shipped("head.obj"));
    const auto off = [&](glm::vec3 p)
    {
        float least = INFINITY;
        for (const glm::uvec3& t : head.triangles)
            if (const glm::vec3 a = head.positions[t.x]; glm::distance(p, a) < 0.02f)
                least = std::min(least, triangle_distance(p, a, head.positions[t.y], head.positions[t.z]));
        return least;
    };
    for (const char* name : {"scalp.obj", "scalp_top.obj", "scalp_strip.obj"})
    {
        const Scalp scalp = load_scalp(shipped(name)), fine = refined(scalp, 1);
        float curved = 0.0f, straight = 0.0f;
        for (size_t v = scalp.positions.size(); v < fine.positions.size(); v += 7)
        {
            const glm::uvec3 between = fine.between[v - scalp.positions.size()].of;
            curved = std::max(curved, off(fine.positions[v]));
            straight = std::max(straight, off(0.5f * (scalp.positions[between.x] + scalp.positions[between.y])));
        }
        EXPECT_LT(curved, 1.0e-3f) << name;
        EXPECT_LT(curved, straight) << name;
    }
}

TEST(Scalp, refined_keeps_what_is_flat_flat_and_what_is_straight_straight)
{
    const Scratch scratch;
    const fs::path file = scratch.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nf 1 3 2\nf 1 4 3\n");
    const Scalp fine = refined(load_scalp(file), 2);
    for (size_t v = 5; v < fine.positions.size(); ++v)
    {
        EXPECT_EQ(fine.positions[v].y, 0.0f);
        for (const int axis : {0, 2})
            EXPECT_EQ(std::fmod(fine.positions[v][axis], 0.25f), 0.0f);
    }
    // However sharp a fold, no middle is further from its chord than a quarter of that.
    const fs::path sharp = scratch.write("sharp.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0.01 0\nf 1 2 3\nf 1 3 4\n");
    for (const glm::vec3& p : refined(load_scalp(sharp), 2).positions)
        EXPECT_LT(std::abs(p.y), 0.2f);
}

TEST(Scalp, is_refined_until_it_carries_as_many_guides_as_coif_takes)
{
    const Scalp scalp = load_scalp(shipped("scalp.obj"));
    const int most = most_refinements(scalp);
    EXPECT_GE(most, 3);
    EXPECT_LE(refined(scalp, most).positions.size(), 65536u);
    EXPECT_NE(error_of([&] { refined(scalp, most + 1); }).find("interpolation.refine"), std::string::npos);
}

double distance_to(const Mesh& mesh, glm::vec3 p)
{
    double nearest = INFINITY;
    for (const glm::uvec3& t : mesh.triangles)
        nearest = std::min(nearest,
                           double(triangle_distance(p, mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z])));
    return nearest;
}

TEST(Scalp, each_shipped_one_lies_on_the_shipped_head_and_looks_outwards)
{
    const Mesh head = load_mesh(shipped("head.obj"));
    for (const char* name : {"scalp.obj", "scalp_top.obj", "scalp_strip.obj"})
    {
        const Scalp scalp = load_scalp(shipped(name));
        EXPECT_LT(glm::length(scalp.center), 0.03f) << name;
        EXPECT_NEAR(scalp.radius, 0.09f, 0.015f) << name;
        for (size_t i = 0; i < scalp.positions.size(); ++i)
        {
            EXPECT_LT(distance_to(head, scalp.positions[i]), 0.0002) << name << " " << i;
            EXPECT_NEAR(glm::length(scalp.normals[i]), 1.0f, 1e-5f);
            EXPECT_GT(glm::dot(scalp.normals[i], glm::normalize(scalp.positions[i])), 0.6f) << name << " " << i;
        }
    }
}

TEST(Scalp, the_shipped_ones_cover_the_head_evenly)
{
    for (const char* name : {"scalp.obj", "scalp_top.obj", "scalp_strip.obj"})
    {
        const Scalp scalp = load_scalp(shipped(name));
        std::vector<double> areas;
        for (const glm::uvec3& t : scalp.triangles)
        {
            const glm::vec3 a = scalp.positions[t.x], u = scalp.positions[t.y] - a, v = scalp.positions[t.z] - a;
            areas.push_back(0.5 * double(glm::length(glm::cross(u, v))));
        }
        std::ranges::sort(areas);
        const double middle = areas[areas.size() / 2];
        EXPECT_GT(areas[areas.size() / 20], 0.4 * middle) << name;
        EXPECT_LT(areas[areas.size() - 1 - areas.size() / 20], 2.0 * middle) << name;
    }
}

std::string grid_obj(int side, float size, float bend)
{
    std::string text;
    for (int z = 0; z < side; ++z)
        for (int x = 0; x < side; ++x)
            text += fmt::format("v {} {} {}\n", size * float(x), 3.0f + bend * float(x * x + z * z), size * float(z));
    for (int z = 0; z + 1 < side; ++z)
        for (int x = 0; x + 1 < side; ++x)
        {
            const int a = side * z + x + 1;
            text += fmt::format("f {} {} {}\nf {} {} {}\n", a, a + side, a + 1, a + 1, a + side, a + side + 1);
        }
    return text;
}

TEST(Scalp, a_flat_one_has_its_centroid_for_a_centre_and_normals_that_stand_on_it)
{
    const Scratch scratch;
    const Scalp scalp = load_scalp(scratch.write("flat.obj", grid_obj(3, 0.1f, 0.0f)));
    EXPECT_NEAR(glm::length(scalp.center - glm::vec3(0.1f, 3.0f, 0.1f)), 0.0f, 1e-5f);
    EXPECT_TRUE(std::isfinite(scalp.radius) && scalp.radius > 0.0f);
    EXPECT_NEAR(scalp.extent, 0.2f, 1e-6f);
    for (const glm::vec3& n : scalp.normals)
        EXPECT_NEAR(glm::dot(n, glm::vec3(0, 1, 0)), 1.0f, 1e-5f);
}

TEST(Scalp, the_sphere_fits_wherever_the_head_is_and_whatever_its_size)
{
    std::mt19937 random(3);
    const Scratch scratch;
    for (const double radius : {0.001, 0.1, 50.0})
    {
        const glm::dvec3 center = glm::dvec3(3.0, -2.0, 5.0) * radius;
        std::string text;
        for (int i = 0; i < 60; ++i)
        {
            const glm::dvec3 d =
                glm::normalize(glm::dvec3(between(random, -1, 1), between(random, 0.1, 1), between(random, -1, 1)));
            const glm::dvec3 p = center + radius * d;
            text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
        }
        for (int i = 1; i < 59; ++i)
            text += fmt::format("f {} {} {}\n", i, i + 1, i + 2);
        const Scalp scalp = load_scalp(scratch.write("ball.obj", text));
        EXPECT_NEAR(glm::length(glm::dvec3(scalp.center) - center) / radius, 0.0, 1e-4) << radius;
        EXPECT_NEAR(scalp.radius / radius, 1.0, 1e-4) << radius;
    }
}

TEST(Scalp, names_normals_texture_and_materials_beside_the_triangles_are_passed_over)
{
    const Scratch scratch;
    const std::string text = "# made by hand\r\nmtllib none.mtl\r\no cap\r\nv 0 0 0 1 0 0\r\nv +.1 0 0\r\n"
                             "  v 0 0 1e-1\r\nvt 0 0\r\nvn 0 1 0\r\nusemtl skin\r\ns 1\r\ng top\r\nf 1/1/1 3//1 2/1\r\n"
                             "g side\r\nf -3 -2 -1 # wound the other way\r\nl 1 2\r\np 1\r\n";
    const Scalp scalp = load_scalp(scratch.write("dressed.obj", text));
    ASSERT_EQ(scalp.positions.size(), 3u);
    EXPECT_EQ(scalp.positions[1], glm::vec3(0.1f, 0, 0));
    EXPECT_EQ(scalp.positions[2], glm::vec3(0, 0, 0.1f));
    ASSERT_EQ(scalp.triangles.size(), 2u);
    EXPECT_EQ(scalp.triangles[0], glm::uvec3(0, 2, 1));
    EXPECT_EQ(scalp.triangles[1], glm::uvec3(0, 1, 2));
}

TEST(Scalp, vertices_that_no_triangle_uses_look_away_from_the_centre)
{
    const Scratch scratch;
    const Scalp scalp =
        load_scalp(scratch.write("loose.obj", "v 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nv 0 -0.1 0\nv 0 0 -0.1\nf 1 2 3\n"));
    EXPECT_NEAR(glm::dot(scalp.normals[3], glm::vec3(0, -1, 0)), 1.0f, 1e-4f);
    EXPECT_NEAR(glm::dot(scalp.normals[4], glm::vec3(0, 0, -1)), 1.0f, 1e-4f);
}

// In double and by cases: the foot of the perpendicular if it lies inside, else the nearest point of an edge.
double exact_distance(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c)
{
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double wb = glm::dot(glm::cross(p - a, c - a), n) / glm::dot(n, n);
    const double wc = glm::dot(glm::cross(b - a, p - a), n) / glm::dot(n, n);
    if (wb >= 0.0 && wc >= 0.0 && wb + wc <= 1.0)
        return std::abs(glm::dot(p - a, n)) / glm::length(n);
    const auto to_edge = [&](glm::dvec3 from, glm::dvec3 to)
    {
        const double t = glm::dot(p - from, to - from) / glm::dot(to - from, to - from);
        return glm::length(p - from - (to - from) * std::min(std::max(t, 0.0), 1.0));
    };
    return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

// The nearest of many points of the triangle: never nearer than the truth, and not much farther.
double sampled_distance(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c)
{
    constexpr int kSteps = 60;
    double least = INFINITY;
    for (int i = 0; i <= kSteps; ++i)
        for (int j = 0; i + j <= kSteps; ++j)
            least =
                std::min(least, glm::length(p - a - (b - a) * (double(i) / kSteps) - (c - a) * (double(j) / kSteps)));
    return least;
}

TEST(Mesh, distance_to_a_triangle_is_that_to_its_nearest_point)
{
    std::mt19937 random(17);
    const auto point = [&](double size)
    { return glm::vec3(between(random, -size, size), between(random, -size, size), between(random, -size, size)); };
    for (int trial = 0; trial < 300; ++trial)
    {
        const glm::vec3 a = point(1), b = point(1), c = point(1), p = point(trial % 2 ? 3 : 0.5);
        const double expected = exact_distance(p, a, b, c), sampled = sampled_distance(p, a, b, c);
        EXPECT_NEAR(triangle_distance(p, a, b, c), expected, 2e-5 + 1e-5 * expected) << trial;
        EXPECT_GE(sampled, expected - 1e-12) << trial;
        EXPECT_LE(sampled, expected + 0.06) << trial; // the side of a cell
    }
}

TEST(Mesh, distance_to_a_triangle_without_area_is_finite_and_no_less_than_to_its_nearest_point)
{
    const glm::vec3 a(0, 0, 0), b(1, 0, 0), p(0.5f, 2, 0);
    EXPECT_NEAR(triangle_distance(p, a, a, a), glm::length(p), 1e-6f);
    EXPECT_NEAR(triangle_distance(p, a, b, a), 2.0f, 1e-6f);
    EXPECT_NEAR(triangle_distance(p, a, a, b), 2.0f, 1e-6f);
    EXPECT_NEAR(triangle_distance(p, a, b, b), 2.0f, 1e-6f);
    EXPECT_NEAR(triangle_distance(p, a, b, glm::vec3(2, 0, 0)), 2.0f, 1e-6f);
    EXPECT_NEAR(triangle_distance({-3, 0, 0}, a, b, glm::vec3(2, 0, 0)), 3.0f, 1e-6f);
}

// A tetrahedron in a node that turns, scales and moves it.
aiScene* tetrahedron()
{
    auto* scene = new aiScene;
    scene->mMaterials = new aiMaterial* [1] { new aiMaterial };
    scene->mNumMaterials = 1;
    auto* mesh = new aiMesh;
    mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    mesh->mName = "tetrahedron";
    mesh->mNumVertices = 4;
    mesh->mVertices = new aiVector3D[4]{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh->mNumFaces = 4;
    mesh->mFaces = new aiFace[4];
    const unsigned corners[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    for (int f = 0; f < 4; ++f)
    {
        mesh->mFaces[f].mNumIndices = 3;
        mesh->mFaces[f].mIndices = new unsigned[3]{corners[f][0], corners[f][1], corners[f][2]};
    }
    scene->mMeshes = new aiMesh* [1] { mesh };
    scene->mNumMeshes = 1;
    scene->mRootNode = new aiNode("root");
    auto* child = new aiNode("child");
    child->mNumMeshes = 1;
    child->mMeshes = new unsigned[1]{0};
    // A quarter turn about y, twice the size, and aside.
    child->mTransformation = aiMatrix4x4(0, 0, 2, 10, 0, 2, 0, 20, -2, 0, 0, 30, 0, 0, 0, 1);
    scene->mRootNode->addChildren(1, &child);
    return scene;
}

std::vector<glm::vec3> sorted(std::vector<glm::vec3> points)
{
    std::sort(points.begin(), points.end(),
              [](glm::vec3 a, glm::vec3 b)
              {
                  return std::lround(a.x) != std::lround(b.x)   ? a.x < b.x
                         : std::lround(a.y) != std::lround(b.y) ? a.y < b.y
                                                                : a.z < b.z;
              });
    return points;
}

fs::path exported(const Scratch& scratch, const std::string& format, const std::string& suffix)
{
    const fs::path file = scratch / (format + "." + suffix);
    const std::unique_ptr<aiScene> scene(tetrahedron());
    Assimp::Exporter exporter;
    EXPECT_EQ(exporter.Export(scene.get(), format, file.string()), aiReturn_SUCCESS) << exporter.GetErrorString();
    return file;
}

// FBX as text: assimp 5.2 writes binary FBX that it cannot read back.
const std::pair<const char*, const char*> kFormats[] = {{"obj", "obj"},    {"ply", "ply"},  {"plyb", "ply"},
                                                        {"gltf2", "gltf"}, {"glb2", "glb"}, {"fbxa", "fbx"}};

TEST(Mesh, obj_ply_gltf_and_fbx_give_the_same_triangles_with_their_nodes_applied)
{
    const Scratch scratch;
    const std::vector<glm::vec3> expected = {{10, 20, 28}, {10, 20, 30}, {10, 22, 30}, {12, 20, 30}};
    for (const auto& [format, suffix] : kFormats)
    {
        const Mesh mesh = load_mesh(exported(scratch, format, suffix));
        const std::vector<glm::vec3> points = sorted(mesh.positions);
        ASSERT_EQ(points.size(), 4u) << format;
        EXPECT_EQ(mesh.triangles.size(), 4u) << format;
        ASSERT_EQ(mesh.normals.size(), 4u) << format;
        for (size_t i = 0; i < 4; ++i)
        {
            EXPECT_NEAR(glm::length(points[i] - expected[i]), 0.0f, 1e-4f) << format << " " << i;
            EXPECT_NEAR(glm::length(mesh.normals[i]), 1.0f, 1e-5f) << format;
            const glm::vec3 out = mesh.positions[i] - glm::vec3(10.5f, 20.5f, 29.5f);
            EXPECT_GT(glm::dot(mesh.normals[i], out), 0.0f) << format; // a turn keeps what is outside
        }
    }
}

TEST(Mesh, an_fbx_says_its_unit_and_a_choice_overrules_it)
{
    const Scratch scratch;
    const fs::path fbx = exported(scratch, "fbxa", "fbx");
    std::string text = bytes_of(fbx);
    const size_t at = text.find("\"UnitScaleFactor\"");
    ASSERT_NE(at, text.npos);
    const size_t begin = text.rfind(',', text.find('\n', at)) + 1;
    for (const auto& [factor, unit] : {std::pair{"1", 0.01f}, {"100", 1.0f}, {"2.54", 0.0254f}})
    {
        const std::string said = text.substr(0, begin) + factor + text.substr(text.find('\n', at));
        const FileMesh mesh = load_mesh(scratch.write("said.fbx", said));
        EXPECT_NEAR(mesh.unit, unit, 1e-6f) << factor;
        const Mesh by_file = upright(mesh, 0, 0), metres = upright(mesh, 1, 0), inches = upright(mesh, 4, 0);
        for (size_t i = 0; i < mesh.positions.size(); ++i)
        {
            EXPECT_NEAR(glm::length(by_file.positions[i] - mesh.positions[i] * unit), 0.0f, 1e-5f);
            EXPECT_EQ(metres.positions[i], mesh.positions[i]);
            EXPECT_NEAR(glm::length(inches.positions[i] - mesh.positions[i] * 0.0254f), 0.0f, 1e-5f);
        }
    }
    EXPECT_EQ(load_mesh(exported(scratch, "obj", "obj")).unit, 1.0f);
}

TEST(Mesh, one_whose_z_points_up_is_stood_up_with_its_face_to_z)
{
    FileMesh mesh;
    mesh.positions = {{1, -2, 3}};
    mesh.normals = {{0, -1, 0}};
    const Mesh stood = upright(mesh, 3, 1);
    EXPECT_NEAR(glm::length(stood.positions[0] - glm::vec3(0.001f, 0.003f, 0.002f)), 0.0f, 1e-8f);
    EXPECT_EQ(stood.normals[0], glm::vec3(0, 0, 1)) << "the face";
    EXPECT_EQ(upright(mesh, 1, 0).positions[0], glm::vec3(1, -2, 3));
}

TEST(Mesh, the_shipped_head_loads_with_unit_normals)
{
    const Mesh head = load_mesh(shipped("head.obj"));
    EXPECT_GT(head.triangles.size(), 1000u);
    for (const glm::vec3& n : head.normals)
        ASSERT_NEAR(glm::length(n), 1.0f, 1e-4f);
    for (const glm::uvec3& t : head.triangles)
        for (int k = 0; k < 3; ++k)
            ASSERT_LT(t[k], head.positions.size());
}

TEST(Mesh, the_shipped_head_is_closed_and_light)
{
    const Mesh head = load_mesh(shipped("head.obj"));
    EXPECT_LE(head.triangles.size(), 40000u);
    EXPECT_LT(fs::file_size(shipped("head.obj")), 2'500'000u);
    std::set<std::pair<unsigned, unsigned>> edges;
    for (const glm::uvec3& t : head.triangles)
        for (int k = 0; k < 3; ++k)
            EXPECT_TRUE(edges.insert({t[k], t[(k + 1) % 3]}).second);
    for (const auto& [a, b] : edges)
        EXPECT_TRUE(edges.contains({b, a}));
    EXPECT_EQ(head.positions.size() + head.triangles.size() - edges.size() / 2, 2u) << "a ball, without handles";
}

TEST(Mesh, the_shipped_head_scalps_and_spheres_are_what_their_generator_makes)
{
    const Scratch scratch;
    const std::string command = fmt::format("'{}/generate' '{}'", COIF_BUILD_FOLDER, scratch.folder().string());
    ASSERT_EQ(std::system(command.c_str()), 0);
    for (const char* name : {"head.obj", "scalp.obj", "scalp_top.obj", "scalp_strip.obj", "head_spheres.toml"})
        EXPECT_TRUE(bytes_of(scratch / name) == bytes_of(shipped(name)))
            << name << " is not what assets/generate makes; see assets/README.md";
}

TEST(Mesh, quads_are_cut_and_lines_and_points_left_out)
{
    const Scratch scratch;
    const Mesh mesh =
        load_mesh(scratch.write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nl 1 3\np 2\n"));
    EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(Mesh, what_is_no_mesh_is_told_and_never_crashes)
{
    const TimeLimit limit(60);
    const Scratch scratch;
    std::mt19937 random(23);
    std::string junk;
    for (int i = 0; i < 5000; ++i)
        junk += char(random());
    for (const char* suffix : {"obj", "ply", "gltf", "glb", "fbx", "stl", "xyz", ""})
        for (const std::string& bytes : {std::string(), junk, std::string("hello\n"), std::string(1000, '\0')})
        {
            const fs::path file = scratch.write(std::string("bad.") + suffix, bytes);
            const std::string error = error_of([&] { load_mesh(file); });
            EXPECT_EQ(error.rfind(file.string() + ": ", 0), 0u) << suffix << ": " << error;
        }
    EXPECT_EQ(error_of([&] { load_mesh(scratch / "none.obj"); }),
              (scratch / "none.obj").string() + ": there is no such file");
    EXPECT_NE(error_of([&] { load_mesh(scratch.folder()); }), "no error");
    EXPECT_NE(error_of([&] { load_mesh(scratch.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")); }), "no error");
}

TEST(Mesh, a_file_cut_short_is_an_error_or_a_smaller_mesh)
{
    const TimeLimit limit(60);
    const Scratch scratch;
    for (const auto& [format, suffix] : kFormats)
    {
        const std::string whole = bytes_of(exported(scratch, format, suffix));
        for (int i = 0; i < 20; ++i)
        {
            const std::string name = std::string("cut.") + suffix;
            const fs::path file = scratch.write(name, whole.substr(0, whole.size() * size_t(i) / 20));
            error_of([&] { load_mesh(file); });
        }
    }
    const std::string glb = bytes_of(exported(scratch, "glb2", "glb"));
    const fs::path cut = scratch.write("cut.glb", glb.substr(0, glb.size() / 2));
    EXPECT_NE(error_of([&] { load_mesh(cut); }), "no error");
}

TEST(Mesh, corners_that_are_not_there_and_numbers_that_are_none_are_told)
{
    const Scratch scratch;
    const std::string ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                            "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::pair<const char*, std::string> broken[] = {
        {"far.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 99\n"},   {"below.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -7\n"},
        {"none.ply", ply + "0 0 0\n1 0 0\n0 1 0\n0\n"},         {"nan.ply", ply + "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n"},
        {"nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},  {"inf.obj", "v 0 0 0\nv 1 -inf 0\nv 0 1 0\nf 1 2 3\n"},
        {"inf.ply", ply + "0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n"},  {"far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999\n"},
        {"below.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -7\n"},
    };
    for (const auto& [name, text] : broken)
    {
        const fs::path file = scratch.write(name, text);
        EXPECT_EQ(error_of([&] { load_mesh(file); }).rfind(file.string() + ": ", 0), 0u) << name;
    }
    // glTF: the same, in the buffer beside it. These bytes are large positions and indices that are not there.
    const fs::path gltf = exported(scratch, "gltf2", "gltf");
    const fs::path buffer = scratch / "gltf2.bin";
    std::string bytes = bytes_of(buffer);
    ASSERT_GT(bytes.size(), 24u);
    std::fill(bytes.begin(), bytes.end(), '\x7f');
    scratch.write("gltf2.bin", bytes);
    EXPECT_EQ(error_of([&] { load_mesh(gltf); }).rfind(gltf.string() + ": ", 0), 0u);
}

TEST(Mesh, one_whose_triangles_have_no_area_is_told)
{
    const Scratch scratch;
    const auto told = [&](const std::string& vertices, const std::string& faces = "f 1 2 3\n")
    {
        const fs::path file = scratch.write("thin.obj", vertices + faces);
        const std::string error = error_of([&] { load_mesh(file); });
        return error.substr(std::min(error.size(), error.rfind(file.string(), 0) == 0 ? file.string().size() : 0));
    };
    const char* fault = ": all of its triangles are without area, so that there is nothing to see or to touch; "
                        "export it with its faces as they are on screen";
    EXPECT_EQ(told("v 0 0 0\nv 1 0 0\nv 2 0 0\n"), fault) << "in a line";
    EXPECT_EQ(told("v 0.1 0.1 0.1\nv 0.2 0.2 0.2\nv 0.7 0.7 0.7\n"), fault) << "in a line, but for rounding";
    EXPECT_EQ(told("v 1 2 3\nv 1 2 3\nv 1 2 3\n"), fault) << "in a point";
    EXPECT_EQ(told("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "f 1 1 2\nf 3 2 3\n"), fault) << "named twice";
    EXPECT_EQ(told("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\n", "f 1 2 3\nf 1 2 4\n"), "no error") << "one is enough";
    EXPECT_EQ(told("v 0 0 0\nv 1e-3 0 0\nv 0 1e-3 0\n"), "no error") << "small: head.unit may be anything";
    EXPECT_EQ(told("v 0 0 0\nv 1 0 0\nv 0 1e-4 0\n"), "no error") << "thin";
}

} // namespace
} // namespace coif
