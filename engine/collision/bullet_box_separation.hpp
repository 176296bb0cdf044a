#pragma once

#include <optional>

#include "engine/collision/bullet_separation.hpp"

// Signed distance of two boxes in closed form: the fifteen separating axes (Gottschalk, Lin and
// Manocha, OBBTree, 1996), then the features that the best axis meets. All values are in near space
// (suffix _ns): b's axes with the origin at a's position.
namespace handhold {

inline bool are_boxes(const Convex& a, const Convex& b) {
    return a.box_half_m != nullptr && b.box_half_m != nullptr;
}

struct BoxAxis {
    Vec3 normal = Vec3::UnitY();  // unit, from b towards a
    // Gap of the boxes along `normal`: never more than their distance. If the boxes overlap, their
    // depth, negative.
    double separation_m = 0.0;
};
// The axis with the largest separation. Stops at the first axis whose separation exceeds
// `enough_m`. Precondition here and below: are_boxes(a, b).
BoxAxis find_box_axis(const Convex& a, const Convex& b, double enough_m);

// separate() for two boxes. If they overlap equally deep through a face and across two edges, takes
// the face. nullopt only if the distance exceeds `limit_m`, as soon as an axis shows it.
std::optional<CoreSeparation> separate_boxes(const Convex& a, const Convex& b, double limit_m);

}  // namespace handhold
