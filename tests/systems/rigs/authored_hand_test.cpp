#include "systems/rigs/authored_hand.hpp"

#include <array>

#include <gtest/gtest.h>

#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "tests/random.hpp"

namespace handhold::authored_hand_test {
namespace {

using test::Random;

// Expected: the reflection of every joint of the hand.
TEST(AuthoredGrip, MirroredHandHasMirroredPoints) {
    Random random(77);
    const HandRig right = builtin_hand_rig(HandSide::right);
    const HandRig left = builtin_hand_rig(HandSide::left);
    for (int axis = 0; axis < 3; ++axis) {
        AuthoredHand hand;
        hand.is_there = true;
        hand.wrist_bs = random.pose();
        const AuthoredHand image = mirror_authored_hand(hand, axis);
        for (std::size_t f = 0; f < right.fingers.size(); ++f) {
            const FingerAngles angles = coupled_angles(right.fingers[f], 0.4);
            const auto points = finger_points(right.fingers[f], angles);
            const auto images = finger_points(left.fingers[f], angles);
            for (std::size_t i = 0; i < points.size(); ++i) {
                Vec3 expected = transform_point(hand.wrist_bs, points[i]);
                expected[axis] = -expected[axis];
                EXPECT_LT((transform_point(image.wrist_bs, images[i]) - expected).norm(), 1e-12);
            }
        }
        const AuthoredHand again = mirror_authored_hand(image, axis);
        EXPECT_EQ(again.wrist_bs.position, hand.wrist_bs.position);
        EXPECT_EQ(again.wrist_bs.rotation.coeffs(), hand.wrist_bs.rotation.coeffs());
    }
}

TEST(AuthoredGrip, AnglesOfLinksInvertsLinkFrames) {
    Random random(78);
    const HandRig rig = builtin_hand_rig(HandSide::left);
    for (int turn = 0; turn < 50; ++turn) {
        for (const FingerRig& finger : rig.fingers) {
            FingerAngles angles = coupled_angles(finger, random.between(0.0, 1.0));
            angles.curl_rad[1] += random.between(-0.2, 0.2);
            angles.opposition_rad =
                random.between(finger.lower_opposition_rad, finger.upper_opposition_rad);
            const auto frames = finger_link_frames(finger, angles);
            std::array<Quat, k_max_links> links;
            for (std::size_t i = 0; i < finger.link_count; ++i) {
                links[i] = frames[i].rotation;
            }
            const FingerAngles found = angles_of_links(finger, {links.data(), finger.link_count});
            EXPECT_NEAR(found.opposition_rad, angles.opposition_rad, 1e-12);
            for (std::size_t i = 0; i < finger.link_count; ++i) {
                EXPECT_NEAR(found.curl_rad[i], angles.curl_rad[i], 1e-12);
            }
        }
    }
}

}  // namespace
}  // namespace handhold::authored_hand_test
