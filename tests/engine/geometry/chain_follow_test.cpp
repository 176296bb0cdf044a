#include "engine/geometry/chain_follow.hpp"

#include <gtest/gtest.h>

#include "engine/geometry/chain_fit.hpp"
#include "surface_cuts.hpp"
#include "tests/engine/geometry/three_link_chain.hpp"

// Oracle: find_penetration, which gathers again for each query and is itself tested against an
// oracle (FindPenetration).
namespace handhold::chain_follow_test {
namespace {

using test::chain_fit_settings;
using test::three_link_chain;

// A bar along x, 35 mm thick, with its top at height 0.
struct FollowChain : testing::Test {
    GripMesh bar = build_grip_mesh(test::make_tube(0.0175, 0.4, 48, 40));
    std::vector<PlacedMesh> meshes{{&bar, {Vec3(0.0, -0.0175, -0.03), Quat::Identity()}}};
    ChainFitScratch scratch;
    ChainFollowSettings settings;

    std::optional<FollowedChain> follow(const HingeChain& chain, const ChainAngles& from_rad) {
        ChainReach reach =
            chain_reach(chain, chain.open_rad, chain.closed_rad, settings.query_gap_m);
        reach.half_width_m = half_width_m(chain, chain_fit_settings().plane_offset);
        scratch.patch.gather(reach, meshes);
        const ChainDepth depth =
            chain_depth(chain, from_rad, scratch.patch, {.extra_radius_m = settings.query_gap_m});
        return follow_chain(chain, from_rad, depth, scratch.patch, settings);
    }
    double depth_m(const HingeChain& chain, const ChainAngles& angle_rad,
                   double extra_radius_m) const {
        double deepest_m = 0.0;
        for (Capsule capsule : chain_capsules(chain, angle_rad)) {
            capsule.radius_m += extra_radius_m;
            deepest_m = std::max(deepest_m, find_penetration(capsule, meshes).depth_m);
        }
        return deepest_m;
    }
};

TEST_F(FollowChain, KeepsContactWithSurfaceThatMovesMillimetres) {
    int followed = 0;
    int moves = 0;
    test::Random random(41);
    for (int i = 0; i < 200; ++i) {
        const Vec3 place = Vec3(0.0, 0.017, 0.0) + random.vector(0.003);
        const HingeChain chain = three_link_chain(place);
        const ChainAngles from_rad =
            fit_chain(chain, meshes, {}, chain_fit_settings(), scratch).angle_rad;
        const HingeChain moved = three_link_chain(place + random.vector(0.0012));
        const auto found = follow(moved, from_rad);
        if (!found) {
            continue;
        }
        ++followed;
        moves += found->angle_rad != from_rad ? 1 : 0;
        const double depth = depth_m(moved, found->angle_rad, 0.0);
        EXPECT_LE(depth, settings.touch_depth_m + 1e-9) << i;
        EXPECT_NEAR(depth, found->depth_m, 1e-9) << i;
        EXPECT_GT(depth_m(moved, found->angle_rad, settings.touch_gap_m), 0.0) << i;
        for (std::size_t hinge = 0; hinge < chain.link_count; ++hinge) {
            EXPECT_GE(found->angle_rad[hinge], chain.open_rad[hinge]);
            EXPECT_LE(found->angle_rad[hinge], chain.closed_rad[hinge]);
        }
    }
    EXPECT_GT(followed, 150);  // the others would be fitted from scratch
    EXPECT_GT(moves, 100);
}

TEST_F(FollowChain, LeavesChainInContactUnchanged) {
    const HingeChain chain = three_link_chain(Vec3{0.0, 0.017, 0.0});
    const ChainAngles from_rad =
        fit_chain(chain, meshes, {}, chain_fit_settings(), scratch).angle_rad;
    const auto found = follow(three_link_chain(Vec3{0.0, 0.0171, 0.0}), from_rad);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->angle_rad, from_rad);
}

TEST_F(FollowChain, FailsIfNothingIsNear) {
    EXPECT_FALSE(follow(three_link_chain(Vec3{0.0, 0.3, 0.0}), {}));
}

TEST_F(FollowChain, FailsIfSurfaceCrossesAxis) {
    const HingeChain chain = three_link_chain(Vec3{0.0, -0.01, 0.02});
    ASSERT_GE(depth_m(chain, {}, 0.0), chain.radius_m[0]);
    EXPECT_FALSE(follow(chain, {}));
}

TEST_F(FollowChain, FailsBeyondMaxOpening) {
    const HingeChain chain = three_link_chain(Vec3{0.0, 0.017, 0.0});
    const ChainAngles from_rad =
        fit_chain(chain, meshes, {}, chain_fit_settings(), scratch).angle_rad;
    const HingeChain moved = three_link_chain(Vec3{0.0, 0.0155, 0.0});
    ASSERT_TRUE(follow(moved, from_rad));
    settings.max_opening = 1e-3;
    EXPECT_FALSE(follow(moved, from_rad));
}

}  // namespace
}  // namespace handhold::chain_follow_test
