#pragma once

#include <array>

#include "components/spine.hpp"
#include "engine/math/math.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/fold_body.hpp"

// Geometry of the chain of spine and legs: rest directions of the links, and forward kinematics.
namespace handhold {

inline constexpr double k_spine_tick_s = 1.0 / 120.0;

inline constexpr std::size_t k_chest_link = k_body_links;  // SpineLink::parent of the first link
enum class SpineLinkKind { spine, thigh, shin };

// A link in the frame of its parent link. Lengths are for a player with an eye height of
// k_scale_eye_m.
struct SpineLink {
    SpineLinkKind kind;
    std::size_t parent;
    double length_m;
    Vec3 base_m;  // upper end, relative to the parent's lower end
    Vec3 rest;    // unit direction at rest
};
// Indexed by link. At rest, hips and knees are slightly bent, as in zero-G.
const std::array<SpineLink, k_body_links>& spine_links();

// A rotation as quaternion and as matrix, because both are used often.
struct SpineFrame {
    Quat rotation;
    Mat3 axes;
};
inline SpineFrame frame_at(const Quat& rotation) { return {rotation, rotation.toRotationMatrix()}; }

// Rotations of the chest and of all links at one time, in play-space or world axes.
struct SpineChain {
    SpineFrame chest;
    std::array<SpineFrame, k_body_links> links;
};
inline const SpineFrame& frame_above_link(const SpineChain& chain, const SpineLink& link) {
    return link.parent == k_chest_link ? chain.chest : chain.links[link.parent];
}

// Returns the upper end of a link relative to the chest. `above`: rotation of its parent.
// `offset_m`: lower ends of the links above, relative to the chest.
Vec3 link_base(const SpineFrame& above, const BodyLinkVectors& offset_m, const SpineLink& link,
               double scale);

// Returns the rotation of a link that points along the unit vector `towards` in its parent's frame:
// the shortest rotation from -Y, then a twist about the link. `above`: rotation of the parent.
Quat link_frame(const Quat& above, const Vec3& towards, double twist_rad);

inline double link_twist_rad(const SpineMemory& memory, std::size_t link) {
    return link < k_spine_links ? memory.twist_rad[link] : 0.0;
}

}  // namespace handhold
