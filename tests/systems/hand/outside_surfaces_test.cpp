#include "systems/hand/shared/outside_surfaces.hpp"

#include <numbers>

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

// Two metres wide, in the plane y = `height_m`.
Mesh make_sheet_mesh(double height_m) {
    Mesh mesh;
    for (int corner = 0; corner < 4; ++corner) {
        mesh.positions.emplace_back((corner & 1) != 0 ? 1.0 : -1.0, height_m,
                                    (corner & 2) != 0 ? 1.0 : -1.0);
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
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

// Heights of the lowest and highest axes of a hand's capsules.
std::array<double, 2> heights_m(const FittedHand& hand, const Pose& wrist) {
    std::array<double, 2> ends = {1.0, -1.0};
    test::visit_axis_ends(hand, wrist, [&](const Vec3& end, double) {
        ends = {std::min(ends[0], end.y()), std::max(ends[1], end.y())};
    });
    return ends;
}
double lowest_m(FittedHand& hand, const Pose& wrist) { return heights_m(hand, wrist)[0]; }
double lowest_m(FittedHand& hand) { return lowest_m(hand, hand.shown_bs()); }
double highest_m(FittedHand& hand) { return heights_m(hand, hand.wrist_bs())[1]; }

// A hand that grips a mesh, seen from `eye_bs`.
struct SeenHand : FittedHand {
    SeenHand(const GripMesh& mesh, const Pose& wrist_bs, const Vec3& eye_bs,
             HandSide side = HandSide::right)
        : FittedHand(mesh, wrist_bs, side) {
        hands.front().eye_bs = eye_bs;
    }
    bool is_fist() const { return surface.at(k_right).triangle == GripSurface::k_none; }
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

// Every frame of a grip, in a closed wall and behind an open one, whatever its winding. A hand at
// its fit is not moved, and may touch more deeply by the fit's own tolerances.
TEST(OutsideSurfaces, HandThatBeginsToGripInAWallNeverDisappearsInIt) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Mesh sheet = test::make_floor_mesh();
    const std::array meshes = {make_block_mesh(), sheet, turned_inside_out(sheet)};
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const GripMesh wall = build_grip_mesh(meshes[m]);
        Random random(4904);
        int fitted = 0;
        int fitted_from_behind = 0;
        int fists = 0;
        for (int i = 0; i < 100; ++i) {
            const Pose wrist = buried_wrist(random, rig, 0.08);
            SeenHand hand(wall, wrist, eye_above(random));
            for (int frame = 0; frame < 30; ++frame) {
                hand.frame(k_frame_s);
                EXPECT_GT(lowest_m(hand), -1e-3) << m << ", " << i << ", frame " << frame;
            }
            (hand.is_fist() ? fists : fitted) += 1;
            const bool is_behind = transform_point(wrist, rig.palm_center_hs).y() < 0.0;
            fitted_from_behind += is_behind && !hand.is_fist() ? 1 : 0;
        }
        EXPECT_GT(fitted, 20) << m;
        EXPECT_GT(fitted_from_behind, 5) << m;
        EXPECT_GT(fists, 20) << m;
    }
}

// A hand behind a sheet holds its rim if a tip of its open fingers is in sight past it. Others are
// fists: with the fingers away from the rim, or too far from it.
TEST(OutsideSurfaces, HandBehindASheetHoldsItsRimIfFingersReachPastIt) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Quat palm_up = rotation_about(Vec3::UnitZ(), std::numbers::pi);  // fingers along -z
    const Quat turned_round = rotation_about(Vec3::UnitY(), std::numbers::pi);
    const Mesh mesh = make_sheet_mesh(0.0);
    for (const Mesh& wound : {mesh, turned_inside_out(mesh)}) {
        const GripMesh sheet = build_grip_mesh(wound);
        Random random(4914);
        for (int i = 0; i < 100; ++i) {
            const double x = random.between(-0.2, 0.2);
            const Vec3 palm(x, -0.03, -1.0 + random.between(0.0, 0.05));
            const Quat rotation = rotation_from_vector(random.vector(0.2)) * palm_up;
            const auto is_fist = [&](const Vec3& at, const Quat& turn) {
                const Vec3 eye = at + Vec3(0.0, 0.6, 0.2);
                SeenHand hand(sheet, {at - turn * rig.palm_center_hs, turn}, eye);
                hand.frame(k_frame_s);
                return hand.is_fist();
            };
            EXPECT_FALSE(is_fist(palm, rotation)) << i;
            EXPECT_TRUE(is_fist(palm + Vec3(0.0, 0.0, 0.05), turned_round * rotation)) << i;
            EXPECT_TRUE(is_fist(palm + Vec3(0.0, 0.0, 0.3), rotation)) << i;
        }
    }
}

// A fist at its target returns to its tracked wrist at the palm's rate when it lets go, and does
// not jump.
TEST(OutsideSurfaces, FistInAWallThatLetsGoDoesNotJump) {
    const GripMesh block = build_grip_mesh(make_block_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    constexpr double k_share = 1.0 / (1.0 + k_palm_settle_s / k_frame_s);
    Random random(4912);
    int moved = 0;
    for (int i = 0; i < 100; ++i) {
        const Pose wrist = buried_wrist(random, rig);
        const Vec3 eye = eye_above(random);
        SeenHand hand(block, wrist, eye);
        for (int frame = 0; frame < 60; ++frame) {
            hand.frame(k_frame_s);
        }
        const double lifted_m = (hand.shown_bs().position - wrist.position).norm();
        if (!hand.is_fist() || lifted_m < 0.01) {
            continue;
        }
        ++moved;
        HandSurroundings& empty = hand.hands.front();
        empty.eye_bs.reset();
        empty.body = k_no_entity;
        empty.meshes.clear();
        empty.is_gripping = false;
        Vec3 last = hand.shown_bs().position;
        for (int frame = 0; frame < 60; ++frame) {
            hand.frame(k_frame_s);
            const Vec3 shown = hand.shown_bs().position;
            EXPECT_LT(
                (shown - last).norm(),
                std::max(hand.tuning.palm.rate_mps * k_frame_s, k_share * lifted_m) + k_same_m)
                << i << ", frame " << frame;
            last = shown;
        }
        EXPECT_EQ(last, wrist.position) << i;
    }
    EXPECT_GT(moved, 20);
}

// Fists of both hands, and in bodies and meshes at any place. The hand's metres are the world's
// over the player's scale, whatever it is.
TEST(OutsideSurfaces, FistIsShownAlikeOnEitherSideAndAtAnyPlace) {
    const Mesh block = make_block_mesh();
    const GripMesh wall = build_grip_mesh(block);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    constexpr double k_near_m = 1e-9;
    Random random(4913);
    int moved = 0;
    int lowered = 0;
    for (int i = 0; i < 100; ++i) {
        const Pose wrist = buried_wrist(random, rig, 0.12);
        const Vec3 eye = eye_above(random);
        SeenHand hand(wall, wrist, eye);
        hand.frame(k_unlimited_s);
        if (!hand.is_fist()) {
            continue;
        }
        lowered += hand.shown_bs().position.y() < wrist.position.y() - 1e-3 ? 1 : 0;
        moved += (hand.shown_bs().position - wrist.position).norm() > 0.01 ? 1 : 0;

        const Vec3 mirrored_eye = mirror_hand_pose({eye, Quat::Identity()}).position;
        SeenHand left(wall, mirror_hand_pose(wrist), mirrored_eye, HandSide::left);
        left.frame(k_unlimited_s);
        EXPECT_TRUE(left.is_fist()) << i;
        EXPECT_LT((mirror_hand_pose(left.shown_bs()).position - hand.shown_bs().position).norm(),
                  k_near_m)
            << i;

        const Pose mesh_bs = random.pose();
        Mesh shifted = block;
        for (Vec3& position : shifted.positions) {
            position = inverse_transform_point(mesh_bs, position);
        }
        const GripMesh shifted_wall = build_grip_mesh(shifted);
        SeenHand elsewhere(shifted_wall, wrist, eye);
        HandSurroundings& around = elsewhere.hands.front();
        around.meshes.front().pose = mesh_bs;
        around.body_ws = random.pose();
        around.scale = random.between(0.5, 2.0);
        elsewhere.frame(k_unlimited_s);
        EXPECT_TRUE(elsewhere.is_fist()) << i;
        const Vec3 scaled_bs = around.scale * hand.shown_bs().position;
        EXPECT_LT((elsewhere.shown_bs().position - scaled_bs).norm(), k_near_m) << i;
    }
    EXPECT_GT(moved, 20);
    EXPECT_GT(lowered, 10);
}

// Above a wall that it grips, with a board of another body before it.
TEST(OutsideSurfaces, FistDoesNotPassABoardToTouchWhatItGrips) {
    const GripMesh wall = build_grip_mesh(make_block_mesh());
    const GripMesh board = build_grip_mesh(make_sheet_mesh(0.02));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4914);
    int free = 0;
    for (int i = 0; i < 200; ++i) {
        Pose wrist = buried_wrist(random, rig);
        wrist.position.y() += 0.19;
        SeenHand hand(wall, wrist, eye_above(random));
        hand.frame(k_unlimited_s);
        const double alone_m = lowest_m(hand);
        hand.hands.front().meshes.push_back({&board, {}});
        hand.frame(k_unlimited_s);
        if (hand.is_fist() && lowest_m(hand, wrist) > 0.02) {
            free += alone_m < 0.02 ? 1 : 0;
            EXPECT_GT(lowest_m(hand), 0.02) << i;
        }
    }
    EXPECT_GT(free, 20);
}

TEST(OutsideSurfaces, NothingBeyondReachIsTouched) {
    const GripMesh wall = build_grip_mesh(make_block_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4915);
    for (int i = 0; i < 100; ++i) {
        Pose wrist = buried_wrist(random, rig);
        wrist.position.y() += 0.3;
        SeenHand hand(wall, wrist, eye_above(random));
        const HandPose pose = {wrist, hand.pose().shown};
        const double gap_m = -displacement_to_touch(hand.hands.front(), pose, 1.0).y();
        ASSERT_GT(gap_m, 0.0) << i;
        EXPECT_LT(displacement_to_touch(hand.hands.front(), pose, 1.001 * gap_m).y(), 0.0) << i;
        EXPECT_EQ(displacement_to_touch(hand.hands.front(), pose, 0.999 * gap_m), Vec3::Zero());
        EXPECT_EQ(displacement_to_touch(hand.hands.front(), pose, 0.0), Vec3::Zero()) << i;
    }
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

// A hand behind a board is not in it: the line from the eye enters and leaves. Behind a sheet it
// is.
TEST(OutsideSurfaces, HandBehindABoardStays) {
    const GripMesh board = build_grip_mesh(make_block_mesh(0.02));
    const GripMesh sheet = build_grip_mesh(make_sheet_mesh(0.0));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4908);
    int before_the_sheet = 0;
    for (int i = 0; i < 100; ++i) {
        Pose wrist = buried_wrist(random, rig);
        wrist.position.y() -= 0.1;
        const Vec3 eye = wrist.position + Vec3(0.05, 0.6, 0.05);
        SeenHand behind_sheet(sheet, wrist, eye);
        if (highest_m(behind_sheet) > -0.03) {
            continue;  // partly in the board
        }
        before_the_sheet += behind_sheet.outside_bs().position != wrist.position ? 1 : 0;
        SeenHand behind_board(board, wrist, eye);
        EXPECT_EQ(behind_board.outside_bs().position, wrist.position) << i;
    }
    EXPECT_GT(before_the_sheet, 20);
}

// The line from the eye crosses the sheet, far from the wall beside the hand.
TEST(OutsideSurfaces, SheetFarFromTheHandDoesNotMoveIt) {
    Mesh mesh = make_block_mesh();
    const Mesh sheet = make_sheet_mesh(0.6);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), sheet.positions.begin(), sheet.positions.end());
    for (const auto& [a, b, c] : sheet.triangles) {
        mesh.triangles.push_back({first + a, first + b, first + c});
    }
    const GripMesh level = build_grip_mesh(mesh);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4910);
    for (int i = 0; i < 200; ++i) {
        Pose wrist = buried_wrist(random, rig);
        const Vec3 eye = eye_above(random) + 0.6 * Vec3::UnitY();
        SeenHand buried(level, wrist, eye);
        buried.outside_bs();
        wrist.position.y() += random.between(1e-4, 0.05) - lowest_m(buried, wrist);
        SeenHand seen(level, wrist, eye);
        EXPECT_EQ(seen.outside_bs().position, wrist.position) << i;
    }
}

// Fingers go round the rim of a sheet, where the player does not see them: the hand is not lifted
// off while they close. Without the rule, hands here are moved by up to centimetres.
TEST(OutsideSurfaces, HandThatReachesRoundARimFollowsItsFit) {
    const GripMesh sheet = build_grip_mesh(make_sheet_mesh(0.0));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(4911);
    int reaching = 0;
    for (int i = 0; i < 100; ++i) {
        const Vec3 up = (Vec3::UnitY() + random.vector(0.4)).normalized();
        const double past_rim_m = random.between(0.0, 0.03);
        const Vec3 palm(random.between(-0.2, 0.2), 0.02, -1.0 + past_rim_m);
        SeenHand hand(sheet, wrist_with_palm_at(rig, palm, up), Vec3(0.0, 0.6, -0.8));
        for (int frame = 0; frame < 20; ++frame) {
            hand.frame(k_frame_s);
            const PalmOffset& offset = hand.offset.at(k_right);
            const Pose target{offset.target_m, rotation_from_vector(offset.target_turn_rad)};
            if (is_null(hand.pose().fitted_body) ||
                is_outside(hand.hands.front(), {hand.wrist_bs() * target, hand.pose().target})) {
                continue;
            }
            ++reaching;
            const Vec3 followed = transform_point(hand.wrist_bs(), offset.shown_m);
            EXPECT_LT((hand.shown_bs().position - followed).norm(), 1e-12) << i << ", " << frame;
        }
    }
    EXPECT_GT(reaching, 100);
}

// A hand before an open wall with its back to it once passed the wall to hold it from behind.
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
