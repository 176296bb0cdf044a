// Solver, contact: overlaps that a sweep cannot see, found by a query without sweeps.

#pragma once

#include <cstdint>
#include <vector>

#include "engine/solver/contact/moving_contacts.hpp"

namespace handhold {

// The deepest overlap of one body; depth 0 and the body itself if there is none.
struct Overlap {
    double depth_m = 0.0;
    std::uint32_t with = 0;  // into ConstraintGraph::bodies
};

struct MissedOverlaps {
    std::vector<Overlap> of_body;          // out
    std::vector<std::uint32_t> deep;       // out: bodies with an overlap, ascending
    std::vector<std::uint8_t> is_marked;   // scratch, by body; all 0 between calls
    std::vector<std::uint8_t> is_suspect;  // the same

    // Makes `count` bodies without an overlap.
    void clear(std::size_t count);
};

// A sweep reports only the first touch of a pair. A body that leans on another and rotates can
// therefore end with its far side inside the same body. Queries the bodies of all pairs that touch
// and moved by more than `limits.sweep_m` relative to each other, at their current poses; other
// pairs were not swept or did not touch. Call after contacts have been refreshed at these poses.
// Afterwards the collision world still holds the query's proxies, and moving.displaced lists their
// bodies.
void find_missed_overlaps(const MovingContacts& moving, const ContactLimits& limits,
                          MissedOverlaps& missed);

}  // namespace handhold
