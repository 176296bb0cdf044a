#include "systems/hand/search_grip.hpp"

#include <gtest/gtest.h>

#include "components/authored_grip.hpp"
#include "engine/geometry/chain_fit.hpp"
#include "engine/geometry/closest_point.hpp"
#include "fitted_hand.hpp"
#include "held_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/palm_fit.hpp"
#include "systems/hand/shared/palm_fitter.hpp"
#include "systems/rigs/authored_hand.hpp"
#include "tests/engine/geometry/surface_cuts.hpp"

namespace handhold::search_grip_test {
namespace {

// A floor with a block in front of the palm: the open fingers penetrate it.
GripMesh make_floor_and_block() {
    constexpr double k_front_m = -0.05;
    constexpr double k_back_m = -0.25;
    constexpr double k_top_m = 0.12;
    Mesh mesh = test::make_floor_mesh();
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const double y : {-0.01, k_top_m}) {
        for (const auto& [x, z] : {std::array{-0.2, k_front_m}, std::array{0.2, k_front_m},
                                   std::array{0.2, k_back_m}, std::array{-0.2, k_back_m}}) {
            mesh.positions.emplace_back(x, y, z);
        }
    }
    for (std::uint32_t side = 0; side < 4; ++side) {
        const std::uint32_t a = first + side;
        const std::uint32_t b = first + (side + 1) % 4;
        mesh.triangles.push_back({a, b, b + 4});
        mesh.triangles.push_back({a, b + 4, a + 4});
    }
    mesh.triangles.push_back({first + 4, first + 5, first + 6});
    mesh.triangles.push_back({first + 4, first + 6, first + 7});
    return build_grip_mesh(mesh);
}

struct FloorAndBlock {
    const GripMesh mesh = make_floor_and_block();
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Pose before_block = wrist_with_palm_at(rig, {0.0, 0.02, 0.0}, Vec3::UnitY());
};

TEST(SearchGrip, ChoosesSurfaceWithFingerClearance) {
    FloorAndBlock scene;
    FittedHand hand(scene.mesh, scene.before_block);
    ASSERT_GT(finger_penetration_m(hand, scene.before_block), 0.005);
    hand.search();
    EXPECT_LE(finger_penetration_m(hand, hand.surface.at(k_right).fitted_wrist_bs),
              k_finger_penetration_tolerance_m);
}

// A gripping hand jumps into a block.
TEST(SearchGrip, JumpIntoABlockIsDepenetratedInTheSameFrame) {
    constexpr double k_beside_x_m = -0.27;
    FloorAndBlock scene;
    for (const double jump_m : {0.03, 0.04, 0.05, 0.06}) {
        const auto beside_block = [&](double x_m) {
            return wrist_with_palm_at(scene.rig, {x_m, 0.02, -0.15}, Vec3::UnitY());
        };
        FittedHand hand(scene.mesh, beside_block(k_beside_x_m));
        hand.search();
        ASSERT_LE(palm_penetration_m(hand), 1e-4) << jump_m;
        hand.wrist_bs() = beside_block(k_beside_x_m + jump_m);
        hand.search();
        EXPECT_LE(palm_penetration_m(hand), 1e-3) << jump_m;
    }
}

// A block moves into a hand at rest.
TEST(SearchGrip, HandAtRestIsDepenetratedFromAMovedBody) {
    const GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const GripMesh block = build_grip_mesh(*test::make_box_mesh({0.1, 0.06, 0.1}));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    for (const double shift_m : {0.03, 0.04, 0.05}) {
        FittedHand hand(floor, wrist_with_palm_at(rig, {0.013, 0.02, 0.007}, Vec3::UnitY()));
        HandSurroundings& around = hand.hands.front();
        around.meshes.push_back({&block, {Vec3(-0.16, 0.06, 0.0), Quat::Identity()}});
        hand.search();
        ASSERT_LE(palm_penetration_m(hand), 1e-4);
        around.meshes.back().pose.position.x() += shift_m;
        ++around.search_signature;
        hand.search();
        EXPECT_LE(palm_penetration_m(hand), 1e-3) << shift_m;
    }
}

// The fingers point into an endless floor, so there is no other surface. The palm, which would be
// clear alone, must turn and move until the fingers are clear too.
TEST(SearchGrip, MovesPalmUntilFingersAreClear) {
    const GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    // Tilted more than depenetrating the palm's own capsules needs.
    const Vec3 up = rotation_about(Vec3::UnitX(), -0.4) * Vec3::UnitY();
    FittedHand hand(floor, wrist_with_palm_at(rig, {0.013, 0.012, 0.007}, up));
    ASSERT_GT(finger_penetration_m(hand, hand.wrist_bs()), 0.003);
    hand.search();
    EXPECT_LE(finger_penetration_m(hand, hand.surface.at(k_right).fitted_wrist_bs),
              k_finger_penetration_tolerance_m);
}

// Wrists at random near a ring. A hand searches again after 3 cm of travel, where 0.1 rad counts
// 1 cm, and if its surroundings change; in between its surface stays.
TEST(SearchGrip, SurfaceStaysUntilTheHandOrItsSurroundingsHaveMoved) {
    const GripMesh ring = build_grip_mesh(test::make_torus(0.12, 0.02, 60, 24));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(2220);
    for (int i = 0; i < 60; ++i) {
        const Vec3 palm = Vec3(0.0, 0.028, 0.12) + random.vector(0.01);
        const Vec3 up = (Vec3::UnitY() + random.vector(0.3)).normalized();
        const Pose start = wrist_with_palm_at(rig, palm, up);
        FittedHand hand(ring, start);
        hand.search();
        const GripSurface found = hand.surface.at(k_right);
        ASSERT_NE(found.triangle, GripSurface::k_none);
        const double share = random.between(0.0, 1.0);  // translation / travel
        const double travel_m = random.between(0.0, 0.06);
        const Vec3 move_m = share * travel_m * random.direction();
        const double turn_rad = (1.0 - share) * travel_m / 0.1;
        hand.wrist_bs() = {
            start.position + move_m,
            (rotation_about(random.direction(), turn_rad) * start.rotation).normalized()};
        hand.search();
        const bool is_same =
            hand.surface.at(k_right).wrist_bs.position == start.position &&
            hand.surface.at(k_right).fitted_wrist_bs.position == found.fitted_wrist_bs.position;
        if (std::abs(travel_m - 0.03) > 1e-6) {
            EXPECT_EQ(is_same, travel_m < 0.03) << i << ": " << travel_m;
        }
        ++hand.hands.front().search_signature;
        hand.search();
        EXPECT_EQ(hand.surface.at(k_right).wrist_bs.position, hand.wrist_bs().position) << i;
    }
}

// Compares a kept surface with one searched from scratch, along a ring. The kept one needs at most
// the palm's movement since its search more: sync(now, kept) <= since + sync(then, kept) by the
// triangle inequality. By the ring's symmetry, a search from scratch needs the same sync
// everywhere; only the mesh's facets make a difference.
TEST(SearchGrip, KeptSurfaceNeedsAtMostTheTravelMoreSync) {
    const GripMesh ring = build_grip_mesh(test::make_torus(0.12, 0.02, 60, 24));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const auto on_ring = [&](double turn_rad) {
        const Quat turn = rotation_about(Vec3::UnitY(), turn_rad);
        return Pose{Vec3::Zero(), turn} *
               wrist_with_palm_at(rig, {0.0, 0.028, 0.12}, Vec3::UnitY());
    };
    constexpr double k_facets_m = GripMeshSettings{}.search.deviation_m;
    FittedHand hand(ring, on_ring(0.0));
    int kept = 0;
    for (int frame = 0; frame < 150; ++frame) {
        hand.wrist_bs() = on_ring(0.018 * frame);
        hand.search();
        const GripSurface& surface = hand.surface.at(k_right);
        ASSERT_NE(surface.triangle, GripSurface::k_none) << frame;
        FittedHand from_scratch(ring, hand.wrist_bs());
        from_scratch.search();
        const auto sync_m = [&](const GripSurface& found) {
            return grip_sync(hand.wrist_bs(), found.fitted_wrist_bs, rig.palm_center_hs).palm_m;
        };
        const double since_m =
            grip_sync(hand.wrist_bs(), surface.wrist_bs, rig.palm_center_hs).palm_m;
        EXPECT_LE(sync_m(surface), sync_m(from_scratch.surface.at(k_right)) + since_m + k_facets_m)
            << frame;
        kept += surface.wrist_bs.position != hand.wrist_bs().position ? 1 : 0;
    }
    EXPECT_GT(kept, 75);
    EXPECT_LT(kept, 149);
}

TEST(SearchGrip, PrefersOuterSideOfPlate) {
    // Two sheets 6 mm apart, the upper facing up and the lower facing down. A palm above the plate
    // is almost equally far from both.
    Mesh plate = test::make_floor_mesh();
    const auto count = static_cast<std::uint32_t>(plate.positions.size());
    const std::size_t triangles = plate.triangles.size();
    for (std::uint32_t v = 0; v < count; ++v) {
        plate.positions.push_back(plate.positions[v] - Vec3(0.0, 0.006, 0.0));
    }
    for (std::size_t t = 0; t < triangles; ++t) {
        const auto [a, b, c] = plate.triangles[t];
        plate.triangles.push_back({count + a, count + c, count + b});
    }
    const GripMesh mesh = build_grip_mesh(plate);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    for (const double height_m : {-0.004, 0.001, 0.01, 0.05}) {
        FittedHand hand(mesh, wrist_with_palm_at(rig, {0.011, height_m, 0.004}, Vec3::UnitY()));
        hand.search();
        const GripSurface& surface = hand.surface.at(k_right);
        EXPECT_NEAR(surface.point_bs.y(), 0.0, 1e-9) << height_m;
        EXPECT_GT(surface.normal_bs.y(), 0.99);
    }
}

TEST(SearchGrip, HandOutOfReachHasNoSurfaceAndIsCounted) {
    const GripMesh mesh = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    FittedHand hand(mesh, wrist_with_palm_at(rig, {0.0, 0.4, 0.0}, Vec3::UnitY()));
    hand.search();
    EXPECT_EQ(hand.surface.at(k_right).triangle, GripSurface::k_none);
    EXPECT_EQ(test::count_of(hand.stats, Fallback::palm_no_surface), 1U);
    hand.hands.front().body = k_no_entity;
    hand.hands.front().meshes.clear();
    hand.search();
    EXPECT_EQ(test::count_of(hand.stats, Fallback::palm_no_surface),
              1U);  // an empty hand is no fallback
}

}  // namespace
}  // namespace handhold::search_grip_test
