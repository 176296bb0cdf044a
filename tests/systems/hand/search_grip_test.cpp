#include "systems/hand/search_grip.hpp"

#include <gtest/gtest.h>

#include "components/authored_grip.hpp"
#include "engine/geometry/chain_fit.hpp"
#include "engine/geometry/closest_point.hpp"
#include "fitted_hand.hpp"
#include "held_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/finger_clearance.hpp"
#include "systems/hand/shared/palm_fit.hpp"
#include "systems/rigs/authored_hand.hpp"
#include "tests/engine/geometry/surface_cuts.hpp"

namespace handhold::search_grip_test {
namespace {

// A floor with a block in front of the palm: the fingers penetrate it in every sample pose.
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
    ChainPatch patch;

    double penetration_m(FittedHand& hand) {
        return find_finger_clearance(hand.hands.front(), hand.surface.at(k_right).fitted_wrist_bs,
                                     patch)
            .penetration_m;
    }
};

TEST(SearchGrip, ChoosesSurfaceWithFingerClearance) {
    FloorAndBlock scene;
    FittedHand hand(scene.mesh, scene.before_block);
    // The surface under the palm has none.
    GripSurface under;
    under.normal_bs = Vec3::UnitY();
    const auto near = scene.mesh.search_bvh.closest_point({0.0, 0.0, 0.0}, 0.1);
    ASSERT_TRUE(near);
    under.triangle = near->triangle;
    const Pose fitted_wrist_bs = fit_palm(hand.hands.front(), under, hand.tuning.palm).wrist_bs;
    ASSERT_GT(find_finger_clearance(hand.hands.front(), fitted_wrist_bs, scene.patch).penetration_m,
              0.005);
    hand.search();
    EXPECT_LE(scene.penetration_m(hand), k_finger_penetration_tolerance_m);
}

// A gripping hand jumps into a block, farther than its clearance was known to reach. The same frame
// must depenetrate it: the small query radius of a clear palm applies only within the known
// clearance.
TEST(SearchGrip, JumpIntoABlockIsDepenetratedInTheSameFrame) {
    constexpr double k_dt_s = 1.0 / 90.0;
    constexpr double k_beside_x_m = -0.27;
    FloorAndBlock scene;
    for (const double jump_m : {0.03, 0.04, 0.05, 0.06}) {
        const auto beside_block = [&](double x_m) {
            return wrist_with_palm_at(scene.rig, {x_m, 0.02, -0.15}, Vec3::UnitY());
        };
        FittedHand hand(scene.mesh, beside_block(k_beside_x_m));
        hand.search(k_dt_s);
        ASSERT_TRUE(hand.surface.at(k_right).evaluated_this_frame) << jump_m;
        ASSERT_LE(palm_penetration_m(hand), 1e-4) << jump_m;
        hand.wrist_bs() = beside_block(k_beside_x_m + jump_m);
        hand.search(k_dt_s);
        EXPECT_LE(palm_penetration_m(hand), 2e-3) << jump_m;
    }
}

// The same for a block that moves into a hand at rest.
TEST(SearchGrip, HandAtRestIsDepenetratedFromAMovedBody) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const GripMesh block = build_grip_mesh(*test::make_box_mesh({0.1, 0.06, 0.1}));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    for (const double shift_m : {0.03, 0.04, 0.05}) {
        FittedHand hand(floor, wrist_with_palm_at(rig, {0.013, 0.02, 0.007}, Vec3::UnitY()));
        HandSurroundings& around = hand.hands.front();
        around.meshes.push_back({&block, {Vec3(-0.16, 0.06, 0.0), Quat::Identity()}});
        hand.search(k_dt_s);
        ASSERT_LE(palm_penetration_m(hand), 1e-4);
        around.meshes.back().pose.position.x() += shift_m;
        ++around.signature;
        for (int frame = 0; frame < 4; ++frame) {
            hand.search(k_dt_s);
        }
        EXPECT_LE(palm_penetration_m(hand), 1e-3) << shift_m;
    }
}

// The fingers point into an endless floor, so there is no other surface. The palm, which would be
// clear alone, must turn and move until the fingers are clear too, unbudgeted and spread over
// frames.
TEST(SearchGrip, MovesPalmUntilFingersAreClear) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    // Tilted more than depenetrating the palm's own capsules needs.
    const Vec3 up = rotation_about(Vec3::UnitX(), -0.4) * Vec3::UnitY();
    const Pose wrist_bs = wrist_with_palm_at(rig, {0.013, 0.012, 0.007}, up);
    ChainPatch patch;
    const auto finger_penetration_m = [&](const FittedHand& hand) {
        return find_finger_clearance(hand.hands.front(), hand.surface.at(k_right).fitted_wrist_bs,
                                     patch)
            .penetration_m;
    };
    FittedHand unbudgeted(floor, wrist_bs);
    GripSurface palm_alone;
    palm_alone.triangle = floor.search_bvh.closest_point({0.013, 0.0, 0.007}, 0.1)->triangle;
    const Pose alone_bs =
        fit_palm(unbudgeted.hands.front(), palm_alone, unbudgeted.tuning.palm).wrist_bs;
    ASSERT_GT(find_finger_clearance(unbudgeted.hands.front(), alone_bs, patch).penetration_m,
              0.003);
    unbudgeted.search();
    EXPECT_LE(finger_penetration_m(unbudgeted), k_finger_penetration_tolerance_m);
    // With a budget, the palm alone is evaluated first, then with its fingers: two frames at most.
    FittedHand hand(floor, wrist_bs);
    hand.search(k_dt_s);
    constexpr int k_evaluated_frame = 2;
    for (int frame = 1; frame < 60; ++frame) {
        hand.search(k_dt_s);
        if (frame >= k_evaluated_frame) {
            EXPECT_LE(finger_penetration_m(hand), k_finger_penetration_tolerance_m) << frame;
        }
    }
}

// A cheap surface with clearance is taken in the first frame, as an unbudgeted search takes it, and
// kept.
TEST(SearchGrip, EndsInFirstFrameOnPlainFloor) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Pose wrist_bs = wrist_with_palm_at(rig, {0.013, 0.01, 0.007}, Vec3::UnitY());
    FittedHand unbudgeted(floor, wrist_bs);
    unbudgeted.search();
    const GripSurface& whole = unbudgeted.surface.at(k_right);
    FittedHand hand(floor, wrist_bs);
    for (int frame = 0; frame < 30; ++frame) {
        hand.search(k_dt_s);
        const GripSurface& found = hand.surface.at(k_right);
        EXPECT_EQ(found.triangle, whole.triangle) << frame;
        EXPECT_LT((found.fitted_wrist_bs.position - whole.fitted_wrist_bs.position).norm(), 1e-5)
            << frame;
    }
}

// Spread over frames, the search of a hand at rest converges to the unbudgeted result.
TEST(SearchGrip, BudgetedSearchReachesUnbudgetedResult) {
    constexpr double k_dt_s = 1.0 / 90.0;
    FloorAndBlock scene;
    FittedHand unbudgeted(scene.mesh, scene.before_block);
    unbudgeted.search();
    // First candidate, first candidate with its fingers, listing, second candidate.
    constexpr std::int32_t k_sufficient_budget = 4;
    for (const std::int32_t budget : {1, 2, 3, k_sufficient_budget}) {
        FittedHand hand(scene.mesh, scene.before_block);
        hand.tuning.palm.evaluations_per_frame = budget;
        hand.search(k_dt_s);
        EXPECT_EQ(scene.penetration_m(hand) <= k_finger_penetration_tolerance_m,
                  budget >= k_sufficient_budget)
            << budget;
        for (int frame = 0; frame < 60; ++frame) {
            hand.constrain();
            hand.search(k_dt_s);
        }
        const GripSurface found = hand.surface.at(k_right);
        hand.constrain();
        EXPECT_LT((hand.shown_bs().position - found.fitted_wrist_bs.position).norm(), 1e-9);
        EXPECT_LE(scene.penetration_m(hand), k_finger_penetration_tolerance_m);
        EXPECT_LT((found.fitted_wrist_bs.position -
                   unbudgeted.surface.at(k_right).fitted_wrist_bs.position)
                      .norm(),
                  5e-3);
        hand.search(k_dt_s);
        EXPECT_EQ(hand.surface.at(k_right).fitted_wrist_bs.position,
                  found.fitted_wrist_bs.position);
    }
}

// The search of a hand that drifts on meanwhile comes to its end nevertheless: soon the fingers are
// clear, and they stay so.
TEST(SearchGrip, SearchOfADriftingHandComesToItsEnd) {
    constexpr double k_dt_s = 1.0 / 90.0;
    constexpr int k_found_frame = 20;
    FloorAndBlock scene;
    FittedHand hand(scene.mesh, scene.before_block);
    hand.tuning.palm.evaluations_per_frame = 1;
    for (int frame = 0; frame < 60; ++frame) {
        hand.wrist_bs().position.x() += 2e-4;
        hand.search(k_dt_s);
        if (frame == 0) {
            EXPECT_GT(scene.penetration_m(hand), k_finger_penetration_tolerance_m);
        }
        if (frame >= k_found_frame) {
            EXPECT_LE(scene.penetration_m(hand), k_finger_penetration_tolerance_m) << frame;
        }
    }
}

// Along a ring, a followed surface, with a full search only every few frames, needs hardly more
// palm movement than a search from scratch in every frame.
TEST(SearchGrip, FollowedSurfaceNeedsHardlyMoreSyncThanSearchedOne) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const GripMesh ring = build_grip_mesh(test::make_torus(0.12, 0.02, 60, 24));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const auto on_ring = [&](double turn_rad) {
        const Quat turn = rotation_about(Vec3::UnitY(), turn_rad);
        return Pose{Vec3::Zero(), turn} *
               wrist_with_palm_at(rig, {0.0, 0.028, 0.12}, Vec3::UnitY());
    };
    FittedHand hand(ring, on_ring(0.0));
    int followed = 0;
    for (int frame = 0; frame < 150; ++frame) {
        hand.wrist_bs() = on_ring(0.018 * frame);
        const double full_search_in_m = hand.surface.at(k_right).full_search_in_m;
        hand.search(k_dt_s);
        const GripSurface& surface = hand.surface.at(k_right);
        ASSERT_NE(surface.triangle, GripSurface::k_none) << frame;
        followed += surface.full_search_in_m < full_search_in_m ? 1 : 0;
        FittedHand from_scratch(ring, hand.wrist_bs());
        from_scratch.search();
        const auto sync_m = [&](const GripSurface& found) {
            return grip_sync(hand.wrist_bs(), found.fitted_wrist_bs, rig.palm_center_hs).palm_m;
        };
        EXPECT_LE(sync_m(surface), sync_m(from_scratch.surface.at(k_right)) + 3e-3) << frame;
    }
    EXPECT_GT(followed, 30);
    EXPECT_LT(followed, 120);  // with full searches in between
}

// A followed palm gets one iteration per frame. At rest it continues until it is as clear as a fit
// from scratch, and then stays constant.
TEST(SearchGrip, PalmAtRestConverges) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const GripMesh ring = build_grip_mesh(test::make_torus(0.12, 0.02, 60, 24));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    test::Random random(7);
    int compared = 0;
    for (int i = 0; i < 60; ++i) {
        const double around_rad = random.between(0.0, 6.2);
        const double about_rad = random.between(0.0, 3.0);
        const Vec3 out(std::cos(around_rad), 0.0, std::sin(around_rad));
        const Vec3 up = std::cos(about_rad) * out + std::sin(about_rad) * Vec3::UnitY();
        FittedHand hand(ring, wrist_with_palm_at(rig, 0.12 * out + 0.035 * up, up));
        for (int frame = 0; frame < 60; ++frame) {
            hand.search(k_dt_s);
        }
        hand.wrist_bs().position += random.vector(0.01);
        for (int frame = 0; frame < 60; ++frame) {
            hand.search(k_dt_s);
        }
        FittedHand from_scratch(ring, hand.wrist_bs());
        from_scratch.search();
        if (hand.surface.at(k_right).triangle == GripSurface::k_none ||
            palm_penetration_m(from_scratch) > 1e-4) {
            continue;
        }
        ++compared;
        EXPECT_LE(palm_penetration_m(hand), 2e-4) << i;
        const Vec3 held = hand.surface.at(k_right).fitted_wrist_bs.position;
        hand.search(k_dt_s);
        EXPECT_EQ(hand.surface.at(k_right).fitted_wrist_bs.position, held) << i;
    }
    EXPECT_GT(compared, 30);
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
