#include "app/skin.h"

#include "app/solids.h"
#include "sim/scatter.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

std::vector<SkinPlace> skin_places(const Assets& assets, const HairParams& params, const std::vector<float>& roots)
{
    const Mesh& mesh = assets.head;
    if (mesh.triangles.empty())
        return {};
    const glm::vec3 offset(params.head_offset.x, params.head_offset.y, params.head_offset.z);
    std::vector<SkinPlace> places;
    for (const Between& place : spread_places(mesh, kSkinPlaces, 1))
    {
        const auto mean = [&](const auto& of)
        { return place.shares.x * of[place.of.x] + place.shares.y * of[place.of.y] + place.shares.z * of[place.of.z]; };
        places.push_back({mean(mesh.positions) * params.head_mesh_scale + offset, mean(mesh.normals), mean(roots)});
    }
    return places;
}

std::vector<LookSurface> skin_now(const std::vector<SkinPlace>& places, const HairParams& params,
                                  const glm::dquat& turn)
{
    const glm::mat3 turned(glm::mat3_cast(turn));
    std::vector<LookSurface> surfaces;
    for (const SkinPlace& place : places)
    {
        const glm::vec3 at = turned * (place.at * params.head_scale), n = turned * place.normal;
        const glm::vec3 albedo = skin_albedo(params, place.roots);
        surfaces.push_back(
            {F4(at.x, at.y, at.z, 1.0f), F4(n.x, n.y, n.z, 0.0f), F4(albedo.x, albedo.y, albedo.z, 1.0f)});
    }
    return surfaces;
}

SkinInVoxels skin_in_voxels(const std::vector<LookSurface>& skin, const LookVolume& volume)
{
    SkinInVoxels found;
    found.in_voxel.assign(size_t(volume.x) * size_t(volume.y) * size_t(volume.z), -1);
    std::vector<LookSurface>& points = found.points; // position.w: of so many
    const auto add = [](float4& sum, const float4& value)
    { sum = F4(sum.x + value.x, sum.y + value.y, sum.z + value.z, sum.w + value.w); };
    const glm::vec3 corner(volume.corner.x, volume.corner.y, volume.corner.z), end(volume.x, volume.y, volume.z);
    for (const LookSurface& s : skin)
    {
        const glm::vec3 at =
            glm::floor((glm::vec3(s.position.x, s.position.y, s.position.z) - corner) / volume.corner.w);
        if (!(glm::all(glm::greaterThanEqual(at, glm::vec3(0.0f))) && glm::all(glm::lessThan(at, end))))
            continue;
        cl_int& point =
            found.in_voxel[(size_t(at.z) * size_t(volume.y) + size_t(at.y)) * size_t(volume.x) + size_t(at.x)];
        if (point < 0)
        {
            point = cl_int(points.size());
            points.push_back({});
        }
        add(points[size_t(point)].position, F4(s.position.x, s.position.y, s.position.z, 1.0f));
        add(points[size_t(point)].normal, F4(s.normal.x, s.normal.y, s.normal.z, 0.0f));
        add(points[size_t(point)].albedo, s.albedo);
    }
    for (LookSurface& p : points)
    {
        const auto scaled = [](const float4& v, float by) { return F4(v.x * by, v.y * by, v.z * by, v.w * by); };
        const float each = 1.0f / p.position.w;
        p.position = scaled(p.position, each);
        p.position.w = SENDS_ABOVE;
        p.normal = scaled(p.normal, 1.0f / std::max(std::hypot(p.normal.x, p.normal.y, p.normal.z), 1e-6f));
        p.albedo = scaled(p.albedo, each);
    }
    return found;
}

} // namespace coif
