#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "components/hand_rig.hpp"
#include "engine/geometry/hinge_chain.hpp"
#include "systems/hand/shared/hand_spheres.hpp"

// Clearance between a hand's own thumb and fingers. Neighbouring fingers are not tested:
// k_max_converging_rad (hand_fit.hpp) keeps them apart.
namespace handhold {

using DigitCapsules = std::array<std::array<Capsule, k_max_links>, k_finger_count>;

// Capsules of all links, in the frame of `frames`.
DigitCapsules digit_capsules(const HandRig& rig, const HandLinkFrames& frames);

// A thumb's link and a finger's link.
struct DigitGap {
    std::size_t thumb = 0;  // index into HandRig::fingers, like `finger`
    std::size_t thumb_link = 0;
    std::size_t finger = 0;
    std::size_t finger_link = 0;
    Vec3 on_thumb = Vec3::Zero();  // the axes' nearest points
    Vec3 on_finger = Vec3::Zero();
    Vec3 away = Vec3::Zero();  // unit, from the finger to the thumb
    double gap_m = 0.0;        // negative: depth of the overlap
};

inline constexpr std::size_t k_max_digit_gaps = k_max_links * k_max_links * (k_finger_count - 1);

// Writes the pairs of a thumb's link and another digit's link whose gap is at most `within_m`, in
// order of the rig, and returns their number. Pairs whose axes cross have no direction and are left
// out.
std::size_t find_digit_gaps(const HandRig& rig, const DigitCapsules& capsules, double within_m,
                            std::span<DigitGap, k_max_digit_gaps> gaps);

// Largest depth by which one of the thumb's capsules overlaps one of the fingers'; 0 if none does.
double thumb_overlap_m(const HandRig& rig, const DigitCapsules& fingers,
                       std::span<const Capsule> thumb);

}  // namespace handhold
