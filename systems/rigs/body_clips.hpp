#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "components/spine.hpp"
#include "engine/math/math.hpp"

// What an animator lays on top of the body that is estimated (talk row 24): small turns of bones by
// time, by where one looks, by how a hand reaches. An asset; docs/reference/body_clips.md has the
// file.
namespace handhold {

// Links of the spine from the top down, left leg, right leg; then the clavicle, as a right one.
inline constexpr std::size_t k_clip_legs = k_spine_links;
inline constexpr std::size_t k_leg_bones = 3;  // thigh, shin, foot
inline constexpr std::size_t k_clip_clavicle = k_clip_legs + k_hand_count * k_leg_bones;
inline constexpr std::size_t k_clip_bones = k_clip_clavicle + 1;
using ClipTurns = std::array<Vec3, k_clip_bones>;  // rotation vectors in the bones' frames, radians
ClipTurns no_turns();

// The parameter of each clip.
enum class BodyClipName : std::uint8_t {
    idle,        // seconds; loops: the last key equals the first
    push_off,    // seconds since the last gripping hand let go
    look_yaw,    // yaw of the head to the left of the chest, radians
    look_pitch,  // pitch of the head, upwards, radians
    clavicle,    // elevation of the hand from the shoulder, radians; scaled by ClavicleReach
    count
};
inline constexpr std::size_t k_body_clip_count = static_cast<std::size_t>(BodyClipName::count);

struct ClipKey {
    double at = 0.0;
    ClipTurns turns = no_turns();
};
struct BodyClip {
    std::vector<ClipKey> keys;  // by increasing `at`; empty: the clip has no effect
};
// Weight of the clavicle clip by the hand's distance in arm lengths.
struct ClavicleReach {
    double distance = 0.0;
    double weight = 0.0;
};
struct BodyClips {
    std::array<BodyClip, k_body_clip_count> clips;  // by BodyClipName
    std::vector<ClavicleReach> reach;               // by increasing distance

    const BodyClip& at(BodyClipName name) const { return clips[static_cast<std::size_t>(name)]; }
};

// Adds `weight` times the clip's turns at `at`. Before the first and after the last key the turns
// are constant; between two keys they are interpolated linearly, or, if eased, with zero slope at
// keys.
enum class ClipBlend : std::uint8_t { straight, eased };
void add_turns(const BodyClip& clip, double at, double weight, ClipBlend blend, ClipTurns& turns);
double reach_weight(const BodyClips& clips, double distance);

}  // namespace handhold
