#include "systems/hand/shared/digit_gaps.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "engine/geometry/closest_point.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "tests/random.hpp"

// Oracle: the axes' nearest points of all pairs of links.
namespace handhold::digit_gaps_test {
namespace {

using test::Random;

HandPose random_pose(const HandRig& rig, Random& random) {
    HandPose pose;
    pose.wrist_bs = {random.vector(2.0), rotation_from_vector(random.vector(3.0))};
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const FingerRig& finger = rig.fingers[f];
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            pose.fingers[f].curl_rad[i] = random.between(finger.lower_rad[i], finger.upper_rad[i]);
        }
        pose.fingers[f].opposition_rad =
            random.between(finger.lower_opposition_rad, finger.upper_opposition_rad);
    }
    return pose;
}

double gap_between_m(const Capsule& a, const Capsule& b) {
    const auto [on_a, on_b] = closest_between_segments(a.ends, b.ends);
    return (on_a - on_b).norm() - a.radius_m - b.radius_m;
}

TEST(DigitGaps, FindExactlyThePairsWithinReach) {
    Random random(91);
    std::size_t found = 0;
    std::size_t left_out = 0;
    for (int round = 0; round < 300; ++round) {
        const HandRig rig = builtin_hand_rig(round % 2 == 0 ? HandSide::left : HandSide::right);
        const auto capsules = digit_capsules(rig, link_frames(rig, random_pose(rig, random)));
        const double within_m = random.between(0.0, 0.06);
        std::array<DigitGap, k_max_digit_gaps> gaps;
        const std::size_t count = find_digit_gaps(rig, capsules, within_m, gaps);
        std::size_t next = 0;
        for (std::size_t t = 0; t < rig.fingers.size(); ++t) {
            for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
                if (rig.fingers[t].name != FingerName::thumb || t == f) {
                    continue;
                }
                for (std::size_t i = 0; i < rig.fingers[t].link_count; ++i) {
                    for (std::size_t k = 0; k < rig.fingers[f].link_count; ++k) {
                        const double gap_m = gap_between_m(capsules[t][i], capsules[f][k]);
                        if (gap_m > within_m) {
                            ++left_out;
                            continue;
                        }
                        ASSERT_LT(next, count);
                        EXPECT_EQ(gaps.at(next).gap_m, gap_m);
                        EXPECT_EQ(gaps.at(next).thumb_link, i);
                        EXPECT_EQ(gaps.at(next).finger, f);
                        EXPECT_EQ(gaps.at(next).finger_link, k);
                        ++next;
                    }
                }
            }
        }
        EXPECT_EQ(next, count);
        found += count;
    }
    EXPECT_GT(found, 1000U);
    EXPECT_GT(left_out, 1000U);
}

TEST(DigitGaps, OverlapIsThatOfTheDeepestPair) {
    Random random(92);
    int overlaps = 0;
    for (int round = 0; round < 500; ++round) {
        const HandRig rig = builtin_hand_rig(round % 2 == 0 ? HandSide::left : HandSide::right);
        const auto fingers = digit_capsules(rig, link_frames(rig, random_pose(rig, random)));
        const std::vector<Capsule> thumb(fingers.front().begin(), fingers.front().end());
        ASSERT_EQ(rig.fingers.front().name, FingerName::thumb);
        double deepest_m = 0.0;
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            for (std::size_t k = 0; k < rig.fingers[f].link_count; ++k) {
                for (const Capsule& link : thumb) {
                    deepest_m = std::max(deepest_m, -gap_between_m(link, fingers[f][k]));
                }
            }
        }
        EXPECT_NEAR(thumb_overlap_m(rig, fingers, thumb), deepest_m, 1e-15);
        overlaps += deepest_m > 0.0 ? 1 : 0;
    }
    EXPECT_GT(overlaps, 20);
}

}  // namespace
}  // namespace handhold::digit_gaps_test
