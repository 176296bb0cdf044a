// Solver, contact: overlaps that a sweep cannot see.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "engine/solver/model/islands.hpp"

namespace handhold {

// The deepest overlap of one body; depth 0 and the body itself if there is none.
struct Overlap {
    double depth_m = 0.0;
    std::uint32_t with = 0;  // index into ConstraintGraph::bodies
};

struct MissedOverlaps {
    std::vector<Overlap> of_body;     // out
    std::vector<std::uint32_t> deep;  // out: bodies with an overlap, ascending

    // Resets the result to `count` bodies, none of which has an overlap.
    void clear(std::size_t count);
};

// A sweep reports only the first touch of a pair. A body that leans on another and rotates can
// therefore end with its far side inside the same body. Tests every pair that has a contact and
// moved by more than `sweep_m` relative to each other, at the end poses of `proxies`; other pairs
// were not swept or did not touch. Pairs within heaps are not tested. `proxies`: by body. Call
// after contacts have been refreshed at these poses.
void find_missed_overlaps(const CollisionWorld& collision, std::span<const ColliderProxy> proxies,
                          const ConstraintGraph& graph, double sweep_m, MissedOverlaps& missed);

}  // namespace handhold
