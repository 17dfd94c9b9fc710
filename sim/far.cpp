#include "sim/far.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

using Vec = glm::dvec3;

static constexpr int kFewest = 6;         // nodes: two thin links
static constexpr double kComesBack = 0.8; // of the tolerance, below which a near block becomes far
static constexpr double kWidest = 0.5;    // cosine of the angle off the view's middle that a picture may still show

bool may_thin(const Groom& groom)
{
    return groom.nodes >= kFewest && groom.nodes % 2 == 0 && groom.held.empty() && std::isfinite(groom.tip_mass);
}

static std::vector<float> every_other(const std::vector<float>& from, const Groom& groom, int thin)
{
    std::vector<float> to(from.empty() ? 0 : size_t(groom.blocks) * LANES * size_t(thin) * 3);
    for (int s = 0; s < (from.empty() ? 0 : groom.blocks * LANES); ++s)
    {
        const Vec root = vector_at(from.data(), s, 1, groom.nodes);
        put_vector(to, s, 0, thin, root + 2.0 * (vector_at(from.data(), s, 0, groom.nodes) - root));
        for (int k = 1; k < thin; ++k)
            put_vector(to, s, k, thin, vector_at(from.data(), s, 2 * k - 1, groom.nodes));
    }
    return to;
}

Groom thinned(const Groom& groom)
{
    Groom few = groom;
    few.drawn.clear();
    few.looks.clear();
    few.drawn_multi = 0;
    const int thin = few.nodes = thin_nodes(groom.nodes);
    for (float& length : few.segment_length)
        length *= 2.0f;
    few.natural_position = every_other(groom.natural_position, groom, thin);
    few.rest_position = every_other(groom.rest_position, groom, thin);
    if (groom.rest_multiplier.empty())
        return few;
    // Tension over mass and length, of nodes and segments that are twice as much: a quarter of the two's mean.
    few.rest_multiplier.assign(size_t(groom.blocks) * size_t(thin) * LANES, 0.0f);
    for (int block = 0; block < groom.blocks; ++block)
        for (int k = 2; k < thin; ++k)
            for (int lane = 0; lane < LANES; ++lane)
            {
                const float* two = &groom.rest_multiplier[size_t((block * groom.nodes + 2 * k - 2) * LANES + lane)];
                few.rest_multiplier[size_t((block * thin + k) * LANES + lane)] = 0.125f * (two[0] + two[LANES]);
            }
    return few;
}

std::vector<Vec> filled_in(const std::vector<Vec>& thin, double rest)
{
    std::vector<Vec> x = {0.5 * (thin[0] + thin[1]), thin[1]};
    for (size_t k = 2; k < thin.size(); ++k)
    {
        // Beyond the tip the parabola through the last three goes on.
        const Vec beyond = k + 1 < thin.size() ? thin[k + 1] : thin[k - 2] + 3.0 * (thin[k] - thin[k - 1]);
        x.push_back(0.5625 * (thin[k - 1] + thin[k]) - 0.0625 * (thin[k - 2] + beyond));
        x.push_back(thin[k]);
    }
    const std::vector<Vec> laid = x;
    for (size_t i = 2; i < x.size(); ++i)
    {
        const Vec d = laid[i] - x[i - 1];
        x[i] = x[i - 1] + d * (rest / std::max(glm::length(d), 1e-6 * rest));
    }
    return x;
}

Groom some_blocks(const Groom& groom, int most)
{
    Groom few = groom;
    few.blocks = std::min(groom.blocks, most);
    few.guides = std::min(groom.guides, few.blocks * LANES);
    few.drawn.clear();
    few.looks.clear();
    few.drawn_multi = 0;
    const auto pick = [&](std::vector<float>& of)
    {
        const size_t each = of.size() / size_t(std::max(groom.blocks, 1));
        for (int b = 0; b < few.blocks; ++b)
        {
            const size_t from = size_t(long(b) * groom.blocks / few.blocks) * each;
            std::copy_n(of.begin() + long(from), each, of.begin() + long(size_t(b) * each));
        }
        of.resize(size_t(few.blocks) * each);
    };
    for (std::vector<float>* of : {&few.root_position, &few.root_direction, &few.segment_length, &few.natural_position,
                                   &few.rest_position, &few.rest_multiplier, &few.bend_factor})
        pick(*of);
    return few;
}

std::vector<FarBlock> far_blocks(const HairParams& params, const Groom& groom)
{
    std::vector<FarBlock> blocks;
    for (int first = 0; first < groom.guides; first += LANES)
    {
        const int end = std::min(first + LANES, groom.guides); // the lanes beyond are copies
        FarBlock block;
        const auto root = [&](int s) { return vector_at(groom.root_position.data(), s, 0, 1); };
        for (int s = first; s < end; ++s)
            block.middle += root(s) / double(end - first);
        for (int s = first; s < end; ++s)
        {
            const double length = double(groom.segment_length[size_t(s)]) * params.strand_spacing * (groom.nodes - 2);
            block.length = std::max(block.length, length);
            block.reach = std::max(block.reach, glm::distance(root(s), block.middle) + length);
        }
        blocks.push_back(block);
    }
    return blocks;
}

double far_error(const FarBlock& block, double error, const View& view, const Pose& head)
{
    const Vec way = head.origin + head.turn * block.middle - view.eye;
    // How far ahead; what is beside or behind the picture counts as if it might come in.
    const double ahead = std::max(glm::dot(way, view.forward), kWidest * glm::length(way)) - block.reach;
    return ahead > 0.0 ? error * block.length * view.pixels / ahead : INFINITY;
}

bool is_far(const FarBlock& block, double error, const View& view, const Pose& head, double tolerance, bool was)
{
    return far_error(block, error, view, head) < tolerance * (was ? 1.0 : kComesBack);
}

} // namespace coif
