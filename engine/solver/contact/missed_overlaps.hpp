#pragma once

#include <cstdint>
#include <vector>

#include "engine/solver/contact/moving_contacts.hpp"

namespace handhold {

// What one body lies in deepest: 0 and itself where that is nothing.
struct Overlap {
    double depth_m = 0.0;
    std::uint32_t with = 0;  // into ConstraintGraph::bodies
};

struct MissedOverlaps {
    std::vector<Overlap> of_body;          // out
    std::vector<ColliderProxy> proxies;    // scratch
    std::vector<std::uint8_t> is_suspect;  // scratch, by body
};

// What was swept is met where its way first touches a thing, and no other part of that thing
// counts; what it only grazes on the way counts nowhere. A bag that leans on a rack and turns may
// end up with its far end in the same rack. Looks at what moved by more than is swept, against the
// world or what it touches, where it is now. Call once contacts have been refreshed at the bodies'
// poses.
void find_missed_overlaps(const MovingContacts& moving, const ContactLimits& limits,
                          MissedOverlaps& hidden);

}  // namespace handhold
