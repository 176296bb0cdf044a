#pragma once

#include <array>

#include "components/spine.hpp"
#include "engine/math/math.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/body/shared/fold_body.hpp"

// Geometry of the chain of spine and legs: its links at rest and forward kinematics.
namespace handhold {

inline constexpr double k_spine_tick_s = 1.0 / 120.0;

inline constexpr std::size_t k_chest_link = k_body_links;  // SpineLink::parent of the first link
enum class SpineLinkKind { spine, thigh, shin };

// A link in the frame of its parent link. Lengths of a player whose eyes are at k_scale_eye_m.
struct SpineLink {
    SpineLinkKind kind;
    std::size_t parent;
    double length_m;
    Vec3 base_m;  // upper end, from the parent's lower end
    Vec3 rest;    // unit: direction at rest
};
// By link. At rest hips and knees are slightly bent, as in zero-G.
const std::array<SpineLink, k_body_links>& spine_links();

// A frame as quaternion and as matrix: both are used often.
struct SpineFrame {
    Quat rotation;
    Mat3 axes;
};
inline SpineFrame frame_at(const Quat& rotation) { return {rotation, rotation.toRotationMatrix()}; }

// Frames of the chest and of all links at one time, in play-space or world axes.
struct SpineChain {
    SpineFrame chest;
    std::array<SpineFrame, k_body_links> links;
};
inline const SpineFrame& frame_above_link(const SpineChain& chain, const SpineLink& link) {
    return link.parent == k_chest_link ? chain.chest : chain.links[link.parent];
}

// Upper end of a link, from the chest. `above`: frame of its parent; offset_m: lower ends of the
// links above, from the chest.
Vec3 link_base(const SpineFrame& above, const BodyLinkVectors& offset_m, const SpineLink& link,
               double scale);

// Rotation of a link that points along the unit vector `towards` in its parent's frame: the
// shortest rotation from -Y, then a twist about the link.
Quat link_frame(const Quat& above, const Vec3& towards, double twist_rad);

inline double link_twist_rad(const SpineMemory& memory, std::size_t link) {
    return link < k_spine_links ? memory.twist_rad[link] : 0.0;
}

}  // namespace handhold
