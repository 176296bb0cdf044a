#include "systems/hand/shared/outside_surfaces.hpp"

#include <gtest/gtest.h>

#include "beam.hpp"
#include "held_hand.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/hand_limits.hpp"

namespace handhold::search_grip_test {
namespace {

using test::k_unlimited_s;

constexpr double k_frame_s = 1.0 / 90.0;
constexpr double k_same_m = 1e-6;

// A block two metres wide and `thick_m` thick with its top in the plane y = 0.
Mesh make_block_mesh(double thick_m = 0.5) {
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.positions.emplace_back((corner & 1) != 0 ? 1.0 : -1.0,
                                    (corner & 2) != 0 ? 0.0 : -thick_m,
                                    (corner & 4) != 0 ? 1.0 : -1.0);
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 4, 2}, {2, 4, 6},
                      {1, 3, 5}, {3, 7, 5}, {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7}};
    return mesh;
}

Mesh turned_inside_out(Mesh mesh) {
    for (auto& triangle : mesh.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
    return mesh;
}

// A wrist with the palm up to 8 cm below the plane y = 0, or up to `highest_m` above it.
Pose buried_wrist(Random& random, const HandRig& rig, double highest_m = 0.005) {
    const double x = random.between(-0.3, 0.3);
    const double y = random.between(-0.08, highest_m);
    const Vec3 palm(x, y, random.between(-0.3, 0.3));
    const Quat rotation = random.rotation();
    return {palm - rotation * rig.palm_center_hs, rotation};
}

Vec3 eye_above(Random& random) {
    const double x = random.between(-0.3, 0.3);
    const double y = random.between(0.3, 0.7);
    return {x, y, random.between(-0.3, 0.3)};
}

// Height of the lowest axis of the shown hand's capsules.
double lowest_m(FittedHand& hand) {
    const Pose wrist = hand.shown_bs();
    double lowest = 1.0;
    const auto add = [&](const Vec3& at_hs) {
        lowest = std::min(lowest, transform_point(wrist, at_hs).y());
    };
    for (const PalmCapsule& capsule : hand.rig.palm) {
        add(capsule.a_hs);
        add(capsule.b_hs);
    }
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const FingerRig& finger = hand.rig.fingers[f];
        const auto points = finger_points(finger, hand.pose().shown[f]);
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            add(points[i + 1]);
        }
    }
    return lowest;
}

// A hand that grips a mesh, seen from `eye_bs`.
struct SeenHand : FittedHand {
    SeenHand(const GripMesh& mesh, const Pose& wrist_bs, const Vec3& eye_bs)
        : FittedHand(mesh, wrist_bs) {
        hands.front().eye_bs = eye_bs;
    }
    // Draws a relaxed hand.
    Pose outside_bs() {
        HandPose relaxed{wrist_bs(), {}};
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            relaxed.fingers[f] = relaxed_angles(rig.fingers[f]);
        }
        fingers.at(k_right).shown = relaxed.fingers;
        palm.at(k_right).pose_ws = wrist_outside_bs(hands.front(), relaxed);
        return palm.at(k_right).pose_ws;
    }
};

// Closed or an open sheet, whatever its winding.
TEST(OutsideSurfaces, HandInAWallIsShownBeforeIt) {
    const Mesh block = make_block_mesh();
    const Mesh sheet = test::make_floor_mesh();
    const HandRig rig = builtin_hand_rig(HandSide::right);
    for (const Mesh& mesh : {block, sheet, turned_inside_out(block), turned_inside_out(sheet)}) {
        const GripMesh wall = build_grip_mesh(mesh);
        Random random(4903);
        for (int i = 0; i < 200; ++i) {
            const Pose wrist = buried_wrist(random, rig);
            SeenHand hand(wall, wrist, eye_above(random));
            hand.outside_bs();
            EXPECT_GT(lowest_m(hand), -k_same_m) << i;
        }
    }
}

// Every frame, from before the grip on. A hand at its fit is not moved, and may touch more deeply
// by the fit's own tolerances.
TEST(OutsideSurfaces, HandThatBeginsToGripInAWallNeverDisappearsInIt) {
    const GripMesh block = build_grip_mesh(make_block_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4904);
    int with_surface = 0;
    int without = 0;
    for (int i = 0; i < 100; ++i) {
        const Pose wrist = buried_wrist(random, rig, 0.08);
        SeenHand hand(block, wrist, eye_above(random));
        for (int frame = 0; frame < 30; ++frame) {
            hand.frame(k_frame_s);
            EXPECT_GT(lowest_m(hand), -1e-3) << i << ", frame " << frame;
        }
        const bool has_surface = hand.surface.at(k_right).triangle != GripSurface::k_none;
        (has_surface ? with_surface : without) += 1;
    }
    EXPECT_GT(with_surface, 20);
    EXPECT_GT(without, 20);
}

// The quarter x > 0, y > 0 is free, between two walls that meet at the origin.
TEST(OutsideSurfaces, HandInACornerIsShownOutsideOfBothWalls) {
    Mesh mesh;
    constexpr std::array<std::array<double, 2>, 6> k_outline = {
        {{-0.5, -0.5}, {1.0, -0.5}, {1.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}, {-0.5, 1.0}}};
    constexpr std::uint32_t k_count = k_outline.size();
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
    const GripMesh corner = build_grip_mesh(mesh);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4906);
    for (int i = 0; i < 200; ++i) {
        const double x = -random.between(0.02, 0.05);
        const double y = -random.between(0.02, 0.05);
        const Quat rotation = random.rotation();
        SeenHand hand(corner, {Vec3(x, y, 0.0) - rotation * rig.palm_center_hs, rotation},
                      Vec3(0.5, 0.5, 0.0));
        const Pose outside = hand.outside_bs();
        for (const PalmCapsule& capsule : rig.palm) {
            for (const Vec3& end_hs : {capsule.a_hs, capsule.b_hs}) {
                const Vec3 end = transform_point(outside, end_hs);
                EXPECT_TRUE(end.x() > -k_same_m && end.y() > -k_same_m)
                    << i << ": " << end.transpose();
            }
        }
    }
}

TEST(OutsideSurfaces, HandThatIsSeenOrWhoseEyeIsUnknownStays) {
    const GripMesh block = build_grip_mesh(make_block_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4907);
    for (int i = 0; i < 200; ++i) {
        Pose wrist = buried_wrist(random, rig);
        SeenHand unknown(block, wrist, {});
        unknown.hands.front().eye_bs.reset();
        EXPECT_EQ(unknown.outside_bs().position, wrist.position);
        wrist.position.y() += random.between(1e-4, 0.05) - lowest_m(unknown);
        SeenHand seen(block, wrist, eye_above(random));
        EXPECT_EQ(seen.outside_bs().position, wrist.position) << i;
    }
}

// A hand behind a board is not in it: the line from the eye enters and leaves.
TEST(OutsideSurfaces, HandBehindABoardStays) {
    const GripMesh board = build_grip_mesh(make_block_mesh(0.02));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4908);
    for (int i = 0; i < 100; ++i) {
        Pose wrist = buried_wrist(random, rig);
        wrist.position.y() -= 0.35;
        SeenHand hand(board, wrist, eye_above(random));
        EXPECT_EQ(hand.outside_bs().position, wrist.position) << i;
    }
}

// A hand before an open wall with its back to it once passed the wall to hold it from behind. A
// wall that is wound the other way gets no less.
TEST(OutsideSurfaces, HandWithItsBackToAnOpenWallStaysBeforeIt) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    for (const Mesh& mesh : {test::make_floor_mesh(), turned_inside_out(test::make_floor_mesh())}) {
        const GripMesh sheet = build_grip_mesh(mesh);
        Random random(4909);
        for (int i = 0; i < 200; ++i) {
            const Vec3 up = -(Vec3::UnitY() + random.vector(0.5)).normalized();
            const Vec3 palm(random.between(-0.2, 0.2), 0.025, 0.0);
            SeenHand hand(sheet, wrist_with_palm_at(rig, palm, up), eye_above(random));
            for (int frame = 0; frame < 3; ++frame) {
                hand.frame(k_unlimited_s);
            }
            EXPECT_GT(hand.palm_center_bs().y(), 0.0) << i;
        }
    }
}

}  // namespace
}  // namespace handhold::search_grip_test
