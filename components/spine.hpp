#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

// Spine and legs: a chain of links below the chest that trails behind the player's motion. For
// display only. Each bone's frame has -Y along the bone, downwards, and -Z to the front.
namespace handhold {

inline constexpr std::size_t k_spine_links = 3;  // the last link ends at the pelvis
// Order of the links: spine from the top down, left thigh, left shin, right thigh, right shin.
inline constexpr std::size_t k_body_links = k_spine_links + 2 * k_hand_count;
using BodyLinkVectors = std::array<Vec3, k_body_links>;
inline BodyLinkVectors zero_vectors() {
    BodyLinkVectors zero;
    zero.fill(Vec3::Zero());
    return zero;
}

// Parts of the body that are kept outside of surfaces: the trunk, left thigh, left shin, right
// thigh, right shin.
inline constexpr std::size_t k_body_parts = 1 + 2 * k_hand_count;
// Also searched: the line along which trunk and thighs would hang in empty space.
inline constexpr std::size_t k_free_body = k_body_parts;
inline constexpr std::size_t k_body_searches = k_body_parts + 1;
inline constexpr std::size_t body_part_of(std::size_t link) {
    return link < k_spine_links ? 0 : link - k_spine_links + 1;
}

// A surface that a part of the body must not cross: a plane. Let p be the position of a link's
// lower end relative to the chest at the end of the last frame, in play-space axes. The links of
// the part keep normal_ps . p >= surface_m. The surface moves with the reference velocity
// (SpineMemory::reference_ws_mps).
struct BodyContact {
    bool touches = false;
    Vec3 normal_ps = Vec3::UnitY();  // unit, out of the surface
    double surface_m = 0.0;          // includes the part's thickness
};

// The last search for a surface along a part of the body, and its result. Written by
// find_body_contacts, which repeats it when the part or a surface near it has moved.
struct BodySearch {
    bool known = false;           // false: no result yet, so the next search must cast
    Vec3 from_ws = Vec3::Zero();  // cast from here to to_ws
    Vec3 to_ws = Vec3::Zero();
    std::uint64_t near = 0;  // hash of the cast's radius and of SurfaceQuery::hash_near
    bool hits = false;
    Vec3 point_ws = Vec3::Zero();    // point on the surface
    Vec3 normal_ws = Vec3::UnitY();  // unit, towards the cast
};

// How strongly and in which direction the gripping hands pull the trunk. Play-space axes.
struct BodyPull {
    Vec3 now = Vec3::Zero();  // pull at the last tick; follows `hands` with a lag; length in [0, 1)
    Vec3 before = Vec3::Zero();      // one tick earlier
    Vec3 rate_per_s = Vec3::Zero();  // rate of change of `now`
    // In the last frame: sum of the vectors from the chest to the gripping hands, in arm lengths,
    // and the pull of a surface below the body (surface_pull).
    Vec3 hands = Vec3::Zero();
    Vec3 hands_before = Vec3::Zero();  // one frame earlier
};

// The pelvis or a foot as it was shown last, relative to the chest in play-space axes. Written by
// limit_pelvis and limit_feet; reset by propagate_spine when the chain starts from rest.
struct ShownJoint {
    bool known = false;                // false: the next frame shows the joint where it is wanted
    Vec3 wanted_m = Vec3::Zero();      // where the earlier stages put it
    Vec3 shown_m = Vec3::Zero();       // where it was shown
    Vec3 velocity_mps = Vec3::Zero();  // velocity of the shown joint
};

// State of propagate_spine, limit_pelvis (`pelvis`) and limit_feet (`feet`, `hips_m`): the hanging
// chain, before pose_spine folds it for a crouch. Offsets lead from the chest to each link's lower
// end, in play-space axes. Velocities and displacements are relative to the reference velocity
// `reference_ws_mps`. The chain advances in fixed time steps, called ticks (k_spine_tick_s).
struct SpineMemory {
    bool known = false;           // false: the next frame starts from rest
    double since_tick_s = 0.0;    // time since the last tick; [0, k_spine_tick_s)
    Vec3 moved_m = Vec3::Zero();  // neck's displacement since the last tick
    Pose chest_ps;                // chest at the end of the last frame
    // Neck at the end of the last frame: the chest's position minus ArmEstimate::from_neck_m.
    Vec3 neck_ps = Vec3::Zero();
    Quat head_ps = Quat::Identity();        // head's rotation at the end of the last frame
    Vec3 rate_mps = Vec3::Zero();           // velocity of the neck in the last frame
    double rate_span_s = 1.0;               // duration of the last frame; > 0
    Quat tick_chest_ps = Quat::Identity();  // chest rotation at the last tick
    Vec3 reference_ws_mps = Vec3::Zero();  // reference velocity (see ReferenceVelocity), last frame
    BodyLinkVectors offset_m = zero_vectors();  // value at the last tick
    BodyLinkVectors before_m = zero_vectors();  // one tick earlier; frames interpolate between both
    BodyLinkVectors velocity_mps = zero_vectors();
    // Twist of each spine link relative to the link above.
    std::array<double, k_spine_links> twist_rad{};
    // Angle of each link from its rest direction; shins: from the thigh's line.
    std::array<double, k_body_links> angle_rad{};
    std::array<BodyContact, k_body_searches> contacts;  // indexed by body_part_of, then k_free_body
    std::array<BodySearch, k_body_searches> searches;   // likewise
    BodyPull pull;
    ShownJoint pelvis;
    std::array<ShownJoint, k_hand_count> feet;  // indexed by HandSide
    // Hips relative to the chest as shown last, play-space axes; valid if `feet` are known.
    std::array<Vec3, k_hand_count> hips_m = {Vec3::Zero(), Vec3::Zero()};
};

// World poses of trunk and legs. Written by propagate_spine; layer_additives adds the
// clips, limit_pelvis and limit_feet slow pelvis and feet.
struct SpinePose {
    struct Leg {
        Pose thigh_ws;  // origin: hip
        Pose shin_ws;   // origin: knee
        Pose foot_ws;   // origin: ankle; -Z towards the toes
    };
    Pose chest_ws;                             // leans with the head and the pull
    std::array<Pose, k_spine_links> spine_ws;  // origin: upper end of each link
    Pose pelvis_ws;                            // origin: lower end of the last link
    std::array<Leg, k_hand_count> legs;        // indexed by HandSide
};

}  // namespace handhold
