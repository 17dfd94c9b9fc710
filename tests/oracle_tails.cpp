// The twin of kernels/tails.h.
#include "tests/oracle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif::oracle
{

// On the curve through a guide's nodes, in nodes from its first.
static Vec on_guide(const Strands& guides, int guide, double at)
{
    const int n = guides.nodes, i = std::clamp(int(at), 1, n - 2);
    double w[4];
    curve_weights(3, at - i, w);
    Vec p(0.0);
    for (int j = 0; j < 4; ++j)
        p += w[j] * guides.position[size_t(guide * n + std::min(i - 1 + j, n - 1))];
    return p;
}

void hang_in_tail(std::vector<Vec>& node, Vec shift, const Strands& guides, const Besides& besides,
                  const StepInfo& info)
{
    const TiedStrand& tied = *besides.tied;
    const Tail& tail = *besides.tail;
    const int n = guides.nodes;
    const double ring = tied.ring;
    // What a strand's own root is off those of its guides it has lost at the ring.
    for (int k = 2; k < n; ++k)
    {
        const double t = std::min(1.0, (k - 1.0) / (ring - 1.0));
        node[size_t(k)] -= (3.0 * t * t - 2.0 * t * t * t) * shift;
    }
    // Behind it, where it is as far as a share of the tail says: about the line that the tail's guide goes.
    Vec tangent = to_world(info, xyz(tail.axis)), normal = to_world(info, xyz(tail.side));
    Vec before = on_guide(guides, tail.guide, tail.ring);
    for (int k = int(std::floor(ring)) + 1; k < n; ++k)
    {
        const double share = (k - ring) / (n - 1.0 - ring);
        const Vec middle = on_guide(guides, tail.guide, tail.ring + share * (n - 1.0 - tail.ring));
        const Vec next = glm::normalize(middle - before);
        normal = carried_over(normal, tangent, next);
        tangent = next;
        before = middle;
        if (tail.axis.w > 0.0f)
        {
            node[size_t(k)] = glm::mix(node[size_t(k)], middle, braid_share(share * tail.length, tail.axis.w));
            continue;
        }
        // Widest after a third, half as wide at the tips, which draw in over the last five eighths.
        const double closed = 1.0 - std::min(1.0, 3.0 * share), thin = std::max(0.0, (8.0 * share - 3.0) / 5.0);
        const double wide =
            glm::mix(double(tail.fullest), double(tail.radius), closed * closed) * (1.0 - 0.5 * thin * thin);
        const Vec place =
            middle + wide * (double(tied.place.x) * normal + double(tied.place.y) * glm::cross(tangent, normal));
        const double apart = 1.0 - std::min(1.0, 4.0 * share);
        node[size_t(k)] = glm::mix(node[size_t(k)], place, tail.together * (1.0 - apart * apart));
    }
}

} // namespace coif::oracle
