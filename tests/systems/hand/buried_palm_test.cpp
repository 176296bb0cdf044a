#include "systems/hand/shared/buried_palm.hpp"

#include <gtest/gtest.h>

#include "beam.hpp"
#include "held_hand.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/hand_limits.hpp"

namespace handhold::search_grip_test {
namespace {

using test::k_unlimited_s;

// A block of two metres with its top in the plane y = 0.
GripMesh make_block() {
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.positions.emplace_back((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 0.0 : -0.5,
                                    (corner & 4) != 0 ? 1.0 : -1.0);
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 4, 2}, {2, 4, 6},
                      {1, 3, 5}, {3, 7, 5}, {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7}};
    return build_grip_mesh(mesh);
}

Pose buried_wrist(Random& random, const HandRig& rig, double highest_m = 0.005) {
    const double x = random.between(-0.5, 0.5);
    const double y = random.between(-0.08, highest_m);
    const Vec3 palm(x, y, random.between(-0.5, 0.5));
    const Quat rotation = random.rotation();
    return {palm - rotation * rig.palm_center_hs, rotation};
}

enum class Part { axes, surfaces };

// Height of the lowest axis, or of the lowest surface, of the shown hand's capsules.
double lowest_m(FittedHand& hand, Part part = Part::surfaces) {
    const Pose wrist = hand.shown_bs();
    double lowest = 1.0;
    const auto add = [&](const Vec3& at_hs, double radius_m) {
        lowest = std::min(
            lowest, transform_point(wrist, at_hs).y() - (part == Part::surfaces ? radius_m : 0.0));
    };
    for (const PalmCapsule& capsule : hand.rig.palm) {
        add(capsule.a_hs, capsule.radius_m);
        add(capsule.b_hs, capsule.radius_m);
    }
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const FingerRig& finger = hand.rig.fingers[f];
        const auto points = finger_points(finger, hand.pose().shown[f]);
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            add(points[i], finger.radius_m[i]);
            add(points[i + 1], finger.radius_m[i]);
        }
    }
    return lowest;
}

// Whatever way the palm faces. Without this a hand in a wall cannot be seen.
TEST(BuriedPalm, HandTrackedInsideAWallIsShownOutside) {
    const GripMesh block = make_block();
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4903);
    int without_surface = 0;
    for (int i = 0; i < 300; ++i) {
        FittedHand hand(block, buried_wrist(random, rig));
        for (int frame = 0; frame < 30; ++frame) {
            hand.frame(k_unlimited_s);
        }
        EXPECT_GT(lowest_m(hand), -2e-3) << i;
        without_surface += hand.surface.at(k_right).triangle == GripSurface::k_none ? 1 : 0;
    }
    EXPECT_GT(without_surface, 60);
}

// The palm is outside, or not: fingers that would close into the wall take the hand with them. The
// axes of all capsules are outside; their sides may touch the wall.
TEST(BuriedPalm, FistBesideAWallIsOutsideOfIt) {
    const GripMesh block = make_block();
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4907);
    int fists = 0;
    for (int i = 0; i < 300; ++i) {
        FittedHand hand(block, buried_wrist(random, rig, 0.08));
        for (int frame = 0; frame < 30; ++frame) {
            hand.frame(k_unlimited_s);
        }
        if (hand.surface.at(k_right).triangle == GripSurface::k_none) {
            EXPECT_GT(lowest_m(hand, Part::axes), -1e-6) << i;
            ++fists;
        }
    }
    EXPECT_GT(fists, 60);
}

// A prism along z that leaves the quarter x > 0, y > 0 free.
Mesh make_inner_corner() {
    constexpr std::array<std::array<double, 2>, 6> k_outline = {
        {{-0.5, -0.5}, {1.0, -0.5}, {1.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}, {-0.5, 1.0}}};
    constexpr std::uint32_t k_count = k_outline.size();
    Mesh mesh;
    for (const double z : {-1.0, 1.0}) {
        for (const auto& [x, y] : k_outline) {
            mesh.positions.emplace_back(x, y, z);
        }
    }
    for (std::uint32_t a = 0; a < k_count; ++a) {
        const std::uint32_t b = (a + 1) % k_count;
        mesh.triangles.push_back({a, b, a + k_count});
        mesh.triangles.push_back({b, b + k_count, a + k_count});
    }
    for (std::uint32_t i = 0; i < 4; ++i) {  // fans about the inner corner
        const std::uint32_t a = (4 + i) % k_count;
        const std::uint32_t b = (5 + i) % k_count;
        mesh.triangles.push_back({3, b, a});
        mesh.triangles.push_back({3 + k_count, a + k_count, b + k_count});
    }
    return mesh;
}

TEST(BuriedPalm, HandTrackedInsideACornerIsShownOutsideOfBothFaces) {
    const Mesh mesh = make_inner_corner();
    const GripMesh corner = build_grip_mesh(mesh);
    Random random(4906);
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        for (int i = 0; i < 100; ++i) {
            const HandRig rig = builtin_hand_rig(side);
            const double x = -random.between(0.02, 0.05);
            const double y = -random.between(0.02, 0.05);
            const Quat rotation = random.rotation();
            FittedHand hand(corner, {Vec3(x, y, 0.0) - rotation * rig.palm_center_hs, rotation},
                            side);
            const Pose outside = wrist_outside_bs(hand.hands.front(), hand.tuning.palm);
            const Vec3 palm = transform_point(outside, rig.palm_center_hs);
            EXPECT_TRUE(palm.x() > -1e-3 && palm.y() > -1e-3) << i << ": " << palm.transpose();
        }
    }
}

TEST(BuriedPalm, HandOutsideOrBehindASheetStaysWhereItIsTracked) {
    const GripMesh block = make_block();
    const GripMesh sheet = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4904);
    for (int i = 0; i < 300; ++i) {
        Pose wrist = buried_wrist(random, rig);
        const FittedHand behind_sheet(sheet, wrist);
        EXPECT_EQ(wrist_outside_bs(behind_sheet.hands.front(), behind_sheet.tuning.palm).position,
                  wrist.position);
        double lowest = 1.0;
        for (const PalmCapsule& capsule : rig.palm) {
            for (const Vec3& end_hs : {capsule.a_hs, capsule.b_hs}) {
                lowest = std::min(lowest, transform_point(wrist, end_hs).y());
            }
        }
        for (const FingerRig& finger : rig.fingers) {
            for (const Vec3& joint_hs :
                 finger_points(finger, coupled_angles(finger, k_fist_curl))) {
                lowest = std::min(lowest, transform_point(wrist, joint_hs).y());
            }
        }
        wrist.position.y() += random.between(1e-4, 0.05) - lowest;
        const FittedHand above(block, wrist);
        EXPECT_EQ(wrist_outside_bs(above.hands.front(), above.tuning.palm).position,
                  wrist.position);
    }
}

}  // namespace
}  // namespace handhold::search_grip_test
