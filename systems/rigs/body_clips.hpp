#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "components/spine.hpp"
#include "engine/math/math.hpp"

// Additive clips: small turns of bones that an animator adds to the estimated body. They depend on
// time, on the look direction, or on how far a hand reaches. An asset;
// docs/reference/body_clips.md describes the file.
namespace handhold {

// Order of the bones: links of the spine from the top down, left leg, right leg, clavicle. The
// clavicle's turns are those of the right one; they are mirrored for the left.
inline constexpr std::size_t k_clip_legs = k_spine_links;
inline constexpr std::size_t k_leg_bones = 3;  // thigh, shin, foot
inline constexpr std::size_t k_clip_clavicle = k_clip_legs + k_hand_count * k_leg_bones;
inline constexpr std::size_t k_clip_bones = k_clip_clavicle + 1;
using ClipTurns = std::array<Vec3, k_clip_bones>;  // rotation vectors in the bones' frames, radians
ClipTurns no_turns();

// The clips. Each comment says what ClipKey::at means in that clip.
enum class BodyClipName : std::uint8_t {
    idle,        // time, seconds; loops, so the last key equals the first
    push_off,    // time since the last gripping hand let go, seconds
    look_yaw,    // yaw of the head relative to the chest, positive to the left, radians
    look_pitch,  // pitch of the head, positive upwards, radians
    clavicle,    // elevation of the hand seen from the shoulder, radians
    count
};
inline constexpr std::size_t k_body_clip_count = static_cast<std::size_t>(BodyClipName::count);

struct ClipKey {
    double at = 0.0;
    ClipTurns turns = no_turns();
};
struct BodyClip {
    std::vector<ClipKey> keys;  // sorted by `at`; empty: the clip has no effect
};
// A point of the function from the hand's distance, in arm lengths, to the weight of the clavicle
// clip.
struct ClavicleReach {
    double distance = 0.0;
    double weight = 0.0;
};
struct BodyClips {
    std::array<BodyClip, k_body_clip_count> clips;  // indexed by BodyClipName
    std::vector<ClavicleReach> reach;               // sorted by distance; empty: weight 1

    const BodyClip& at(BodyClipName name) const { return clips[static_cast<std::size_t>(name)]; }
};

// Interpolation between two keys: linear (straight), or with zero slope at the keys (eased).
enum class ClipBlend : std::uint8_t { straight, eased };
// Adds `weight` times the clip's turns at `at` to `turns`. Before the first and after the last key
// the clip's turns are constant.
void add_turns(const BodyClip& clip, double at, double weight, ClipBlend blend, ClipTurns& turns);
// Interpolates BodyClips::reach linearly.
double reach_weight(const BodyClips& clips, double distance);

}  // namespace handhold
