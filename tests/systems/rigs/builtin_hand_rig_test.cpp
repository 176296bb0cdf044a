#include "systems/rigs/builtin_hand_rig.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "systems/rigs/hand_kinematics.hpp"

namespace handhold::builtin_hand_rig_test {
namespace {

Vec3 mirrored(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }

double to_segment(const Vec3& point, const Vec3& a, const Vec3& b) {
    const double t = std::clamp((point - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (point - a - t * (b - a)).norm();
}

TEST(BuiltinHandRig, HasAnAdultsSize) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    ASSERT_EQ(rig.fingers.size(), k_finger_count);
    const FingerRig& middle = rig.fingers[2];
    const double tip_m = finger_points(middle, {})[3].norm() + middle.radius_m[2];
    EXPECT_NEAR(tip_m, 0.180, 0.010);
    for (std::size_t i = 0; i < k_finger_count; ++i) {
        const FingerRig& finger = rig.fingers[i];
        EXPECT_EQ(finger.name, static_cast<FingerName>(i));
        EXPECT_EQ(finger.link_count, 3U);
        for (std::size_t link = 0; link < 3; ++link) {
            EXPECT_GE(finger.radius_m[link], 0.006) << finger_text(finger.name);
            EXPECT_LE(finger.radius_m[link], 0.010) << finger_text(finger.name);
            EXPECT_GT(finger.length_m[link], finger.radius_m[link]);
            EXPECT_LE(finger.lower_rad[link], 0.0);
            EXPECT_GT(finger.upper_rad[link], finger.rest_rad[link]);
        }
    }
}

TEST(BuiltinHandRig, FingersOfAnOpenHandDoNotTouch) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    for (std::size_t i = 1; i + 1 < rig.fingers.size(); ++i) {
        const FingerRig& a = rig.fingers[i];
        const FingerRig& b = rig.fingers[i + 1];
        const auto points_a = finger_points(a, {});
        const auto points_b = finger_points(b, {});
        for (std::size_t link = 0; link < 3; ++link) {
            for (const Vec3& point : points_b) {
                EXPECT_GT(to_segment(point, points_a[link], points_a[link + 1]),
                          a.radius_m[link] + b.radius_m[link] - 1e-3);
            }
        }
    }
}

TEST(BuiltinHandRig, PalmCentreLiesOnTheSkin) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    double height_m = 1.0;  // height of the palm's centre above the capsules
    for (const PalmCapsule& capsule : rig.palm) {
        height_m = std::min(height_m, to_segment(rig.palm_center_hs, capsule.a_hs, capsule.b_hs) -
                                          capsule.radius_m);
    }
    EXPECT_NEAR(height_m, 0.0, 1e-9);
    EXPECT_NEAR(rig.palm_normal_hs.norm(), 1.0, 1e-12);
}

// Thumb and index or middle finger meet at an opposition within 10 degrees of the range's middle.
TEST(BuiltinHandRig, CurledThumbMeetsIndexAndMiddleAtTenDegreesOfOpposition) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const FingerRig& thumb = rig.fingers[0];
    const double middle_rad = 10.0 * k_degree;
    for (const std::size_t finger : {1U, 2U}) {
        const FingerRig& other = rig.fingers[finger];
        std::vector<Vec3> tips;
        for (int i = 0; i <= 100; ++i) {
            tips.push_back(finger_points(other, coupled_angles(other, 0.01 * i))[3]);
        }
        double least_gap_m = 1.0;
        for (int turn = -10; turn <= 10; turn += 2) {
            for (int i = 0; i <= 100; ++i) {
                FingerAngles angles = coupled_angles(thumb, 0.01 * i);
                angles.opposition_rad = middle_rad + turn * k_degree;
                const Vec3 thumb_tip = finger_points(thumb, angles)[3];
                for (const Vec3& tip : tips) {
                    const double gap_m =
                        (tip - thumb_tip).norm() - thumb.radius_m[2] - other.radius_m[2];
                    least_gap_m = std::min(least_gap_m, std::abs(gap_m));
                }
            }
        }
        EXPECT_LT(least_gap_m, 5e-4) << finger_text(other.name);
    }
}

TEST(BuiltinHandRig, OppositionMovesTheThumbFromBesideThePalmToBelowIt) {
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const HandRig rig = builtin_hand_rig(side);
        const double outward = side == HandSide::right ? -1.0 : 1.0;
        const FingerRig& thumb = rig.fingers[0];
        FingerAngles angles;
        angles.opposition_rad = thumb.lower_opposition_rad;
        const Vec3 beside = finger_points(thumb, angles)[3];
        angles.opposition_rad = thumb.upper_opposition_rad;
        const Vec3 below = finger_points(thumb, angles)[3];
        EXPECT_GT(outward * beside.x(), 0.07);
        EXPECT_LT(outward * below.x(), 0.0);
        EXPECT_LT(below.y(), beside.y() - 0.03);
    }
}

TEST(BuiltinHandRig, LeftIsTheExactMirrorOfRight) {
    const HandRig right = builtin_hand_rig(HandSide::right);
    const HandRig left = builtin_hand_rig(HandSide::left);
    ASSERT_EQ(left.fingers.size(), right.fingers.size());
    EXPECT_EQ(left.side, HandSide::left);
    EXPECT_EQ(left.palm_center_hs, mirrored(right.palm_center_hs));
    for (std::size_t i = 0; i < right.fingers.size(); ++i) {
        for (const double share : {0.0, 0.3, 0.7, 1.0}) {
            for (const double opposition_rad : {-0.8, 0.0, 0.5, 1.2}) {
                FingerAngles angles = coupled_angles(right.fingers[i], share);
                angles.opposition_rad = opposition_rad;
                const auto points_right = finger_points(right.fingers[i], angles);
                const auto points_left = finger_points(left.fingers[i], angles);
                for (std::size_t k = 0; k < points_right.size(); ++k) {
                    EXPECT_NEAR((points_left[k] - mirrored(points_right[k])).norm(), 0.0, 1e-15);
                }
            }
        }
    }
    for (std::size_t i = 0; i < right.palm.size(); ++i) {
        EXPECT_EQ(left.palm[i].a_hs, mirrored(right.palm[i].a_hs));
        EXPECT_EQ(left.palm[i].b_hs, mirrored(right.palm[i].b_hs));
        EXPECT_EQ(left.palm[i].radius_m, right.palm[i].radius_m);
    }
}

TEST(BuiltinHandRig, NamesEveryWebXrJointOnce) {
    const HandRig rig = builtin_hand_rig(HandSide::left);
    std::set<std::string> names;
    for (const RigJoint& joint : rig.joints) {
        names.insert(joint.name);
    }
    EXPECT_EQ(rig.joints.size(), 25U);  // the WebXR Hand Input Module's table
    EXPECT_EQ(names.size(), 25U);
    EXPECT_TRUE(names.contains("pinky-finger-phalanx-intermediate"));
}

// A positive curl turns from -Z towards -Y: a hinge at 90 degrees points its link to the palm's
// side.
TEST(FingerLinkFrames, CurlTurnsTowardsThePalm) {
    FingerRig finger;
    finger.link_count = 2;
    finger.length_m = {0.04, 0.03, 0.0};
    FingerAngles angles;
    angles.curl_rad = {90.0 * k_degree, 90.0 * k_degree, 0.0};
    const auto points = finger_points(finger, angles);
    EXPECT_NEAR((points[1] - Vec3(0.0, -0.04, 0.0)).norm(), 0.0, 1e-15);
    EXPECT_NEAR((points[2] - Vec3(0.0, -0.04, 0.03)).norm(), 0.0, 1e-15);
}

TEST(MirrorHandRig, MirroringTwiceReturnsTheRig) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const HandRig twice = mirror_hand_rig(mirror_hand_rig(rig));
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        EXPECT_EQ(twice.fingers[i].base_hs.position, rig.fingers[i].base_hs.position);
        EXPECT_EQ(twice.fingers[i].base_hs.rotation.coeffs(),
                  rig.fingers[i].base_hs.rotation.coeffs());
        EXPECT_EQ(twice.fingers[i].opposition_axis_hs, rig.fingers[i].opposition_axis_hs);
    }
}

}  // namespace
}  // namespace handhold::builtin_hand_rig_test
