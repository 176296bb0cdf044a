#include "systems/rigs/hand_limits.hpp"

#include <gtest/gtest.h>

#include "engine/geometry/closest_point.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "tests/random.hpp"

namespace handhold::hand_limits_test {
namespace {

using test::Random;

// A hand whose digits differ in length and thickness from the built-in ones.
HandRig random_hand(Random& random, HandSide side) {
    HandRig rig = builtin_hand_rig(side);
    for (FingerRig& finger : rig.fingers) {
        const double size = random.between(0.88, 1.12);
        const double thickness = random.between(0.85, 1.1);
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            finger.length_m[i] *= size * random.between(0.94, 1.06);
            finger.radius_m[i] *= thickness;
        }
    }
    return rig;
}

// Least distance between the skins of the thumb's links from `first_link` on and the fingers.
double thumb_gap_m(const HandRig& rig, std::size_t first_link) {
    double gap_m = 1.0;
    const FingerRig& thumb = rig.fingers[0];
    const auto on_thumb = finger_points(thumb, thumb.fist);
    for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
        const FingerRig& finger = rig.fingers[f];
        const auto on_finger = finger_points(finger, finger.fist);
        for (std::size_t i = first_link; i < thumb.link_count; ++i) {
            for (std::size_t k = 0; k < finger.link_count; ++k) {
                const auto [a, b] = closest_between_segments({on_thumb[i], on_thumb[i + 1]},
                                                             {on_finger[k], on_finger[k + 1]});
                gap_m = std::min(gap_m, (a - b).norm() - thumb.radius_m[i] - finger.radius_m[k]);
            }
        }
    }
    return gap_m;
}

// One pose serves hands of different proportions. The claim is the side on which the thumb lies.
// The depth is a record, not a goal: 10.1 mm among these hands, 17.0 mm in the fist before decision
// 168.
TEST(Fist, ThumbLiesAcrossTheFingersWithinItsLimits) {
    constexpr double k_most_deep_m = 0.013;
    Random random(5001);
    for (int i = 0; i < 300; ++i) {
        const HandRig rig = random_hand(random, i % 2 == 0 ? HandSide::right : HandSide::left);
        EXPECT_GT(thumb_gap_m(rig, 0), -k_most_deep_m) << i;
        EXPECT_LT(thumb_gap_m(rig, 2), 0.012) << i;
        // On the palm's side of the fingers beside it.
        const double thumb_m = finger_points(rig.fingers[0], rig.fingers[0].fist)[2].y();
        const auto index = finger_points(rig.fingers[1], rig.fingers[1].fist);
        const auto middle = finger_points(rig.fingers[2], rig.fingers[2].fist);
        EXPECT_LT(thumb_m, 0.5 * (index[1] + index[2]).y()) << i;
        EXPECT_LT(thumb_m, 0.5 * (middle[1] + middle[2]).y()) << i;
        for (const FingerRig& finger : rig.fingers) {
            for (std::size_t k = 0; k < finger.link_count; ++k) {
                EXPECT_GE(finger.fist.curl_rad[k], finger.lower_rad[k]);
                EXPECT_LE(finger.fist.curl_rad[k], finger.upper_rad[k]);
            }
            EXPECT_GE(finger.fist.opposition_rad, finger.lower_opposition_rad);
            EXPECT_LE(finger.fist.opposition_rad, finger.upper_opposition_rad);
        }
    }
}

}  // namespace
}  // namespace handhold::hand_limits_test
