#include "sim/clumps.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace coif
{

static constexpr int kOrder = 900; // the random numbers' channel: sim/groom.cpp and sim/wave.cpp have others

namespace
{
// Leaders found so far, by cells as wide as they are apart.
class Leaders
{
  public:
    Leaders(const std::vector<DrawnStrand>& drawn, const std::vector<glm::vec3>& directions,
            const std::vector<Sides>& sides, float apart)
        : drawn_(drawn), directions_(directions), sides_(sides), apart_(apart)
    {
    }

    void add(int strand)
    {
        const glm::ivec3 c = cell(strand);
        by_cell_[{c.x, c.y, c.z}].push_back(strand);
    }

    // How much further along the way of its leader a strand begins, m, by the direction that the hair there takes.
    float ahead(int strand, int leader) const { return glm::dot(root(strand) - root(leader), direction(leader)); }

    // The nearest one within reach that leaves the head the same way and on the same side, or -1.
    int nearest(int strand) const
    {
        int best = -1;
        float least = apart_;
        const glm::ivec3 c = cell(strand);
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x)
                {
                    const auto found = by_cell_.find({c.x + x, c.y + y, c.z + z});
                    if (found == by_cell_.end())
                        continue;
                    for (const int leader : found->second)
                    {
                        const float away = glm::distance(root(leader), root(strand));
                        if (away < least && glm::dot(direction(leader), direction(strand)) >= kSameWay &&
                            (sides_.empty() || may_mix(sides_[size_t(leader)], sides_[size_t(strand)])))
                        {
                            least = away;
                            best = leader;
                        }
                    }
                }
        return best;
    }

  private:
    glm::vec3 root(int strand) const
    {
        const float4 at = drawn_[size_t(strand)].root;
        return {at.x, at.y, at.z};
    }
    glm::vec3 direction(int strand) const { return directions_[size_t(drawn_[size_t(strand)].guide0)]; }
    glm::ivec3 cell(int strand) const { return glm::ivec3(glm::floor(root(strand) / apart_)); }

    const std::vector<DrawnStrand>& drawn_;
    const std::vector<glm::vec3>& directions_;
    const std::vector<Sides>& sides_;
    float apart_; // m
    std::map<std::tuple<int, int, int>, std::vector<int>> by_cell_;
};
} // namespace

// Dart throwing (Cook. Stochastic sampling in computer graphics. 1986): each strand leads that no leader is near to, in
// an order that has nothing to do with where they stand but begins with the longest, or others would reach beyond their
// leader's tip. None is left without one.
void gather_clumps(std::vector<DrawnStrand>& drawn, const HairParams& p, const std::vector<glm::vec3>& directions,
                   const std::vector<Sides>& sides)
{
    // Darts that keep r from each other come to lie 1.25 r from their neighbours, on the mean.
    Leaders leaders(drawn, directions, sides, 0.8f * p.clump_size);
    std::vector<std::pair<float, int>> order;
    for (int i = 0; i < int(drawn.size()); ++i)
        order.emplace_back(0.1f * random01(p.interpolation_seed, i, kOrder) - drawn[size_t(i)].root.w, i);
    std::sort(order.begin(), order.end());
    for (const auto& [chance, strand] : order)
        if (leaders.nearest(strand) < 0)
            leaders.add(strand);
    for (int i = 0; i < int(drawn.size()); ++i)
    {
        DrawnStrand& strand = drawn[size_t(i)];
        strand.leader = leaders.nearest(i); // a leader is its own: nothing is nearer
        strand.weights.w = leaders.ahead(i, strand.leader);
    }
}

} // namespace coif
