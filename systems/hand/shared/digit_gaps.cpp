#include "systems/hand/shared/digit_gaps.hpp"

#include <algorithm>
#include <tuple>

#include "engine/geometry/closest_point.hpp"

namespace handhold {
namespace {

// True if the gap between two capsules is surely larger than `gap_m`: the balls around them are
// farther apart. `length_m`: sum of the lengths of both axes.
bool are_apart(const Capsule& a, const Capsule& b, double length_m, double gap_m) {
    constexpr double k_rounding_m = 1e-6;
    const Vec3 twice = (a.ends[0] + a.ends[1]) - (b.ends[0] + b.ends[1]);
    const double most_m = length_m + 2.0 * (a.radius_m + b.radius_m + gap_m + k_rounding_m);
    return twice.squaredNorm() > most_m * most_m;
}

}  // namespace

DigitCapsules digit_capsules(const HandRig& rig, const HandLinkFrames& frames) {
    DigitCapsules capsules;
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const FingerRig& finger = rig.fingers[f];
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            const Vec3 end_ls(0.0, 0.0, -finger.length_m[i]);
            capsules[f][i] = {{frames[f][i].position, transform_point(frames[f][i], end_ls)},
                              finger.radius_m[i]};
        }
    }
    return capsules;
}

std::size_t find_digit_gaps(const HandRig& rig, const DigitCapsules& capsules, double within_m,
                            std::span<DigitGap, k_max_digit_gaps> gaps) {
    constexpr double k_crossing_m = 1e-6;
    std::size_t count = 0;
    const auto add = [&](DigitGap pair) {
        const Capsule& thumb = capsules[pair.thumb][pair.thumb_link];
        const Capsule& finger = capsules[pair.finger][pair.finger_link];
        if (are_apart(thumb, finger,
                      rig.fingers[pair.thumb].length_m[pair.thumb_link] +
                          rig.fingers[pair.finger].length_m[pair.finger_link],
                      within_m)) {
            return;
        }
        std::tie(pair.on_thumb, pair.on_finger) = closest_between_segments(thumb.ends, finger.ends);
        const Vec3 offset = pair.on_thumb - pair.on_finger;
        const double distance_m = offset.norm();
        pair.gap_m = distance_m - thumb.radius_m - finger.radius_m;
        if (pair.gap_m <= within_m && distance_m > k_crossing_m && count < gaps.size()) {
            pair.away = offset / distance_m;
            gaps[count++] = pair;
        }
    };
    for (std::size_t t = 0; t < rig.fingers.size(); ++t) {
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            if (rig.fingers[t].name != FingerName::thumb || f == t) {
                continue;
            }
            for (std::size_t i = 0; i < rig.fingers[t].link_count; ++i) {
                for (std::size_t k = 0; k < rig.fingers[f].link_count; ++k) {
                    add({.thumb = t, .thumb_link = i, .finger = f, .finger_link = k});
                }
            }
        }
    }
    return count;
}

double thumb_overlap_m(const HandRig& rig, const DigitCapsules& fingers,
                       std::span<const Capsule> thumb) {
    double depth_m = 0.0;
    for (const Capsule& other : thumb) {
        const double other_m = (other.ends[1] - other.ends[0]).norm();
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            for (std::size_t k = 0; k < rig.fingers[f].link_count; ++k) {
                const Capsule& link = fingers[f][k];
                if (rig.fingers[f].name != FingerName::thumb &&
                    !are_apart(other, link, other_m + rig.fingers[f].length_m[k], -depth_m)) {
                    const auto [a, b] = closest_between_segments(other.ends, link.ends);
                    depth_m = std::max(depth_m, other.radius_m + link.radius_m - (a - b).norm());
                }
            }
        }
    }
    return depth_m;
}

}  // namespace handhold
