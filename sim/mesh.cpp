#include "sim/mesh.h"

#include "sim/error.h"
#include "sim/hairstyle.h"
#include "sim/shown.h"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cfloat>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>
#include <utility>

namespace coif
{

static constexpr float kFurthest = 1e6f; // of a mesh: a head in micrometres is within it

static bool is_finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// A whole word that is a number; OBJ writers may put a + before it.
template <typename Number> static bool read_number(std::string_view word, Number& number)
{
    if (word.size() > 1 && word[0] == '+')
        word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size();
}

// The vertices and triangles of an OBJ as tinyobjloader is to read them, one statement a line, without what else an OBJ
// may hold. Strict, because tinyobjloader is not: it reads 0 for what is no number, passes over faces of two corners,
// counts corners modulo 256, takes indices out of range and stumbles over a comment behind a statement, and a scalp
// that lost one vertex would carry other guides.
static std::string checked_obj(const std::string& text, const std::string& name)
{
    std::string clean;
    std::vector<std::pair<int, long>> named; // line and greatest vertex of each face, from 1
    long vertices = 0;
    int number = 0;
    for (size_t begin = 0; begin < text.size();)
    {
        const size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
        const std::string_view line = std::string_view(text).substr(begin, end - begin);
        begin = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
        ++number;
        std::vector<std::string_view> words;
        for (size_t i = 0; i < line.size() && line[i] != '#' && words.size() < 1000;)
        {
            const size_t stop = std::min(line.find_first_of(" \t#", i), line.size());
            if (stop > i)
                words.push_back(line.substr(i, stop - i));
            i = stop + (stop < line.size() && line[stop] != '#');
        }
        if (words.empty())
            continue;
        if (words[0] == "v")
        {
            double v[3];
            bool good = words.size() >= 4;
            for (size_t k = 0; k < 3 && good; ++k)
                good = read_number(words[k + 1], v[k]) && std::abs(v[k]) <= 1e4; // a NaN is not
            if (!good)
                throw fail("{}:{}: a vertex must be three finite numbers within 10 km, in metres", name, number);
            clean += fmt::format("v {} {} {}\n", v[0], v[1], v[2]);
            ++vertices;
        }
        else if (words[0] == "f")
        {
            if (words.size() != 4)
                throw fail("{}:{}: a scalp must be triangles, but this face has {} corners; triangulate it on export",
                           name, number, words.size() - 1);
            long corners[3];
            for (size_t k = 0; k < 3; ++k)
            {
                int corner = 0; // v, v/vt, v//vn or v/vt/vn; counted from 1, or back from the last vertex
                if (!read_number(words[k + 1].substr(0, words[k + 1].find('/')), corner))
                    throw fail("{}:{}: a face must name three vertices by number", name, number);
                corners[k] = corner < 0 ? vertices + 1 + corner : corner;
                if (corners[k] < 1)
                    throw fail("{}:{}: this face names vertex {}, but there are {}", name, number, corner, vertices);
            }
            clean += fmt::format("f {} {} {}\n", corners[0], corners[1], corners[2]);
            named.emplace_back(number, std::max({corners[0], corners[1], corners[2]}));
        }
        else if ((words[0] == "g" || words[0] == "o") && words.size() > 1)
            clean += fmt::format("g {}\n", words[1].substr(0, 200));
    }
    for (const auto& [line, greatest] : named) // at the end: a face may come before its vertices
        if (greatest > vertices)
            throw fail("{}:{}: this face names vertex {}, but there are {}", name, line, greatest, vertices);
    if (vertices < 3)
        throw fail("{}:1: a scalp needs at least three vertices (v x y z) and a triangle (f a b c)", name);
    if (size_t(vertices) > kMostVertices)
        throw fail("{}: {} vertices are more guides than the {} that coif takes", name, vertices, kMostVertices);
    if (named.empty())
        throw fail("{}: a scalp needs triangles (f a b c), but has none", name);
    return clean;
}

// Least-squares sphere: |p|^2 = 2 c.p + (r^2 - |c|^2) is linear in c and the bracket. Solved by Gauss elimination with
// pivoting; a flat scalp has no sphere, and then its centroid stands in for the centre.
static void fit_sphere(Scalp& scalp)
{
    glm::dvec3 mean(0.0);
    for (const glm::vec3& p : scalp.positions)
        mean += glm::dvec3(p);
    mean /= double(scalp.positions.size());
    double m[4][5] = {};
    for (const glm::vec3& v : scalp.positions)
    {
        const glm::dvec3 p = (glm::dvec3(v) - mean) / double(scalp.extent);
        const double row[5] = {2.0 * p.x, 2.0 * p.y, 2.0 * p.z, 1.0, glm::dot(p, p)};
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 5; ++j)
                m[i][j] += row[i] * row[j];
    }
    bool solved = true;
    for (int k = 0; k < 4 && solved; ++k)
    {
        int pivot = k;
        for (int i = k + 1; i < 4; ++i)
            if (std::abs(m[i][k]) > std::abs(m[pivot][k]))
                pivot = i;
        std::swap(m[k], m[pivot]);
        solved = std::abs(m[k][k]) > 1e-6 * double(scalp.positions.size());
        for (int i = 0; i < 4 && solved; ++i)
            for (int j = 4; i != k && j >= k; --j)
                m[i][j] -= m[k][j] * m[i][k] / m[k][k];
    }
    const glm::dvec3 c = solved ? glm::dvec3(m[0][4] / m[0][0], m[1][4] / m[1][1], m[2][4] / m[2][2]) : glm::dvec3(0.0);
    const double r2 = solved ? m[3][4] / m[3][3] + glm::dot(c, c) : 0.25;
    scalp.center = glm::vec3(mean + c * double(scalp.extent));
    scalp.radius = float(std::sqrt(std::max(r2, 0.0)) * double(scalp.extent));
}

Scalp load_scalp(const std::filesystem::path& file)
{
    const std::string name = shown_file(file);
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    tinyobj::ObjReader reader;
    if (!reader.ParseFromString(checked_obj(read_file(file, 64 << 20), name), "", config))
        throw fail("{}: is no OBJ: {}", name, reader.Error());
    Scalp scalp;
    const std::vector<float>& v = reader.GetAttrib().vertices;
    for (size_t i = 0; i + 2 < v.size(); i += 3)
        scalp.positions.push_back({v[i], v[i + 1], v[i + 2]});
    for (const tinyobj::shape_t& shape : reader.GetShapes())
        for (size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3)
        {
            scalp.triangles.push_back({shape.mesh.indices[i].vertex_index, shape.mesh.indices[i + 1].vertex_index,
                                       shape.mesh.indices[i + 2].vertex_index});
            for (int k = 0; k < 3 && !shape.name.empty(); ++k)
                scalp.groups[shape.name].push_back(scalp.triangles.back()[k]);
        }
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const glm::vec3& p : scalp.positions)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 size = high - low;
    scalp.extent = std::max({size.x, size.y, size.z});
    if (!(scalp.extent > 1e-5f))
        throw fail("{}: all vertices of the scalp lie in one place", name);
    fit_sphere(scalp);
    scalp.normals = vertex_normals(scalp, scalp.center);
    return scalp;
}

static void append(Mesh& mesh, const aiScene& scene, const aiNode& node, glm::mat4 parent, int depth, const char* file)
{
    if (depth > 200)
        throw fail("{}: its nodes are nested deeper than 200", file);
    const aiMatrix4x4& a = node.mTransformation; // row by row, GLM's is column by column
    const glm::mat4 local(a.a1, a.b1, a.c1, a.d1, a.a2, a.b2, a.c2, a.d2, a.a3, a.b3, a.c3, a.d3, a.a4, a.b4, a.c4,
                          a.d4);
    const glm::mat4 world = parent * local;
    for (unsigned m = 0; m < node.mNumMeshes; ++m)
    {
        const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
        const unsigned first = unsigned(mesh.positions.size());
        for (unsigned i = 0; i < part.mNumVertices; ++i)
        {
            const aiVector3D& p = part.mVertices[i];
            const glm::vec3 position(world * glm::vec4(p.x, p.y, p.z, 1.0f));
            if (!is_finite(position))
                throw fail("{}: vertex {} is not finite", file, i);
            if (glm::length(position) > kFurthest)
                throw fail("{}: vertex {} is further than {} from the origin; scale the mesh on export", file, i,
                           kFurthest);
            mesh.positions.push_back(position);
        }
        for (unsigned f = 0; f < part.mNumFaces; ++f)
        {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices != 3)
                continue; // points and lines, which assimp sorts out beside the triangles
            mesh.triangles.push_back({first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
        }
        if (mesh.triangles.size() > 5'000'000 || mesh.positions.size() > 15'000'000)
            throw fail("{}: has more than the five million triangles that coif takes; simplify it", file);
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c)
        append(mesh, scene, *node.mChildren[c], world, depth + 1, file);
}

// assimp 5.2 reads for ever at a PLY whose header does not end.
static void check_ply(const std::filesystem::path& file)
{
    std::string head(1 << 16, '\0');
    std::ifstream(file, std::ios::binary).read(head.data(), std::streamsize(head.size()));
    const size_t end = head.find("\nend_header");
    if (head.starts_with("ply") && (end == head.npos || head.find_first_of(" \r\n", end + 1) != end + 11))
        throw fail("{}: is no mesh that coif can read: its header has no end_header", shown_file(file));
}

// Nor does it look whether a file's corners are there before it reads them, and it aborts at a face without any.
static void check_corners(const aiScene& scene, const std::string& name)
{
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned f = 0; f < mesh.mNumFaces; ++f)
        {
            if (mesh.mFaces[f].mNumIndices == 0)
                throw fail("{}: a face has no corners", name);
            for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k)
                if (mesh.mFaces[f].mIndices[k] >= mesh.mNumVertices)
                    throw fail("{}: a face names vertex {}, but there are {}", name, mesh.mFaces[f].mIndices[k] + 1,
                               mesh.mNumVertices);
        }
    }
}

// FBX counts in multiples of a centimetre and says so. glTF is in metres, Collada is brought to them by assimp, and the
// others say nothing.
static float unit_of(const aiScene& scene)
{
    float centimetres = 0.0f;
    const bool said = scene.mMetaData && scene.mMetaData->Get("UnitScaleFactor", centimetres);
    return said && std::isfinite(centimetres) && centimetres > 0.0f ? 0.01f * centimetres : 1.0f;
}

// More of it than rounding gives to three points in a line?
static bool has_area(const Mesh& mesh, const glm::uvec3& triangle)
{
    const glm::dvec3 a = mesh.positions[triangle.x], b = mesh.positions[triangle.y], c = mesh.positions[triangle.z];
    const double furthest = std::max({glm::length(a), glm::length(b), glm::length(c)});
    const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const double across = glm::length(glm::cross(b - a, c - a)); // longest times the height above it
    return across > 4.0 * double(FLT_EPSILON) * furthest * longest;
}

FileMesh load_mesh(const std::filesystem::path& file)
{
    check_regular(file);
    const std::string name = shown_file(file);
    std::error_code error;
    const auto size = std::filesystem::file_size(file, error);
    if (size == 0 || error) // as what is read to no end in /proc has it too
        throw fail("{}: is no mesh that coif can read: it is empty", name);
    if (size > (size_t(1) << 30))
        throw fail("{}: is larger than the 1 GB that coif reads of a mesh", name);
    Assimp::Importer importer;
    // Positions alone are kept and joined, so that normals computed here are smooth whatever the file's corners say.
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                            aiComponent_COLORS | aiComponent_TEXCOORDS |
                                                            aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                                            aiComponent_TEXTURES | aiComponent_LIGHTS |
                                                            aiComponent_CAMERAS | aiComponent_MATERIALS);
    check_ply(file);
    const aiScene* scene = importer.ReadFile(file.string(), 0);
    if (scene)
    {
        check_corners(*scene, name);
        scene = importer.ApplyPostProcessing(aiProcess_RemoveComponent | aiProcess_JoinIdenticalVertices |
                                             aiProcess_Triangulate | aiProcess_SortByPType);
    }
    if (!scene || !scene->mRootNode || scene->mNumMeshes == 0)
        throw fail("{}: is no mesh that coif can read: {}", name, importer.GetErrorString());
    FileMesh mesh;
    mesh.unit = unit_of(*scene);
    append(mesh, *scene, *scene->mRootNode, glm::mat4(1.0f), 0, name.c_str());
    if (mesh.triangles.empty())
        throw fail("{}: has no triangles", name);
    if (std::ranges::none_of(mesh.triangles, [&](const glm::uvec3& t) { return has_area(mesh, t); }))
        throw fail("{}: all of its triangles are without area, so that there is nothing to see or to touch; export it "
                   "with its faces as they are on screen",
                   name);
    mesh.normals = vertex_normals(mesh, glm::vec3(0.0f));
    return mesh;
}

Mesh upright(FileMesh mesh, int unit, int up)
{
    static constexpr float kUnits[] = {0.0f, 1.0f, 0.01f, 0.001f, 0.0254f, 0.3048f}; // m, as params.def lists them
    const float metres = unit == 0 ? mesh.unit : kUnits[unit];
    const auto turned = [up](glm::vec3 v) { return up == 0 ? v : glm::vec3(v.x, v.z, -v.y); };
    for (glm::vec3& p : mesh.positions)
        p = turned(p) * metres;
    for (glm::vec3& n : mesh.normals)
        n = turned(n);
    return mesh;
}

glm::vec3 from_triangle(glm::vec3 p, glm::vec3 a, glm::vec3 b, glm::vec3 c)
{
    const glm::vec3 ab = b - a, ac = c - a, ap = p - a;
    const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0f && d2 <= 0.0f)
        return ap;
    const glm::vec3 bp = p - b;
    const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0f && d4 <= d3)
        return bp;
    const glm::vec3 cp = p - c;
    const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0f && d5 <= d6)
        return cp;
    const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f && d1 - d3 > 0.0f)
        return ap - ab * (d1 / (d1 - d3));
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f && d2 - d6 > 0.0f)
        return ap - ac * (d2 / (d2 - d6));
    const float e = d4 - d3, f = d5 - d6;
    if (va <= 0.0f && e >= 0.0f && f >= 0.0f && e + f > 0.0f)
        return bp - (c - b) * (e / (e + f));
    const float sum = va + vb + vc;
    if (!(sum > 0.0f))
        return ap; // no area
    return ap - ab * (vb / sum) - ac * (vc / sum);
}

float triangle_distance(glm::vec3 p, glm::vec3 a, glm::vec3 b, glm::vec3 c)
{
    return glm::length(from_triangle(p, a, b, c));
}

glm::vec3 unit_or(glm::vec3 v, glm::vec3 otherwise, float least)
{
    const float length = glm::length(v);
    return length > least ? v / length : otherwise;
}

std::vector<glm::vec3> vertex_normals(const Mesh& mesh, glm::vec3 center)
{
    std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0f));
    for (const glm::uvec3& t : mesh.triangles)
    {
        const glm::vec3 a = mesh.positions[t.x];
        const glm::vec3 n = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a); // twice the area long
        for (int k = 0; k < 3; ++k)
            normals[t[k]] += n;
    }
    for (size_t i = 0; i < normals.size(); ++i)
    {
        glm::vec3 n = normals[i];
        if (!(glm::dot(n, n) > 0.0f))
            n = mesh.positions[i] - center;
        normals[i] = unit_or(n, {0.0f, 1.0f, 0.0f}, 0.0f);
    }
    return normals;
}

} // namespace coif
