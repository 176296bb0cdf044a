#include "engine/geometry/chain_refit.hpp"

#include <gtest/gtest.h>

#include "surface_cuts.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/engine/geometry/three_link_chain.hpp"

namespace handhold::chain_refit_test {
namespace {

using test::chain_fit_settings;
using test::three_link_chain;

constexpr double k_turn_rad = 0.1;

double max_turn_between(const ChainAngles& from, const ChainAngles& to) {
    double max_rad = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        max_rad = std::max(max_rad, std::abs(to[i] - from[i]));
    }
    return max_rad;
}

// A bar along x, 35 mm thick, with its top at height 0.
struct RefitChain : testing::Test {
    GripMesh bar = build_grip_mesh(test::make_tube(0.0175, 0.4, 48, 40));
    std::vector<PlacedMesh> meshes{{&bar, {Vec3(0.0, -0.0175, -0.03), Quat::Identity()}}};
    ChainFitScratch scratch;

    ChainFit fit(const HingeChain& chain) {
        return fit_chain(chain, meshes, {}, chain_fit_settings(), scratch);
    }
    ChainFit refit(const HingeChain& chain, const ChainAngles& last_rad,
                   double max_turn_rad = k_turn_rad) {
        ChainRefitSettings settings;
        settings.max_turn_rad = max_turn_rad;
        return refit_chain(chain, last_rad, meshes, chain_fit_settings(), settings, scratch);
    }
    // find_penetration is itself tested against an oracle (FindPenetration).
    double depth_m(const HingeChain& chain, const ChainAngles& angle_rad) const {
        double deepest_m = 0.0;
        for (const Capsule& capsule : chain_capsules(chain, angle_rad)) {
            deepest_m = std::max(deepest_m, find_penetration(capsule, meshes).depth_m);
        }
        return deepest_m;
    }
};

TEST_F(RefitChain, ChainInContactStays) {
    const HingeChain chain = three_link_chain(Vec3{0.0, 0.015, 0.0});
    const ChainFit first = fit(chain);
    ASSERT_NE(first.contact_link, DiscClosure::k_none);
    HingeChain moved = chain;
    moved.base.position.y() += 1e-4;
    const ChainFit kept = refit(moved, first.angle_rad);
    EXPECT_EQ(kept.angle_rad, first.angle_rad);
    EXPECT_NE(kept.contact_link, DiscClosure::k_none);
}

TEST_F(RefitChain, FollowsSurfaceWithoutPenetratingOrLosingContact) {
    HingeChain chain = three_link_chain(Vec3{0.0, 0.017, 0.0});
    ChainAngles angle_rad = fit(chain).angle_rad;
    for (int step = 0; step < 200; ++step) {
        chain.base.position.y() = 0.017 + 0.006 * std::sin(0.1 * step);
        chain.base.position.z() = 0.01 * std::sin(0.07 * step);
        const ChainFit kept = refit(chain, angle_rad);
        const double depth = depth_m(chain, kept.angle_rad);
        EXPECT_LE(depth, 8e-4) << "step " << step;
        EXPECT_NE(kept.contact_link, DiscClosure::k_none) << "step " << step;
        EXPECT_LE(max_turn_between(angle_rad, kept.angle_rad), k_turn_rad + 1e-9);
        angle_rad = kept.angle_rad;
    }
}

TEST_F(RefitChain, OpensUntilClear) {
    HingeChain chain = three_link_chain(Vec3{0.0, 0.02, 0.0});
    const ChainAngles before = fit(chain).angle_rad;
    chain.base.position.y() -= 0.002;
    ASSERT_GT(depth_m(chain, before), 1e-3);
    const ChainFit kept = refit(chain, before);
    EXPECT_LE(depth_m(chain, kept.angle_rad), 8e-4);
    EXPECT_LT(kept.angle_rad[0], before[0]);
}

TEST_F(RefitChain, ReportsDepthThatOpeningCannotRemove) {
    HingeChain chain = three_link_chain(Vec3{0.0, 0.02, 0.0});
    const ChainAngles before = fit(chain).angle_rad;
    chain.base.position.y() -= 0.025;  // the first link penetrates the bar however far it opens
    EXPECT_GT(refit(chain, before).depth_m, 8e-4);
}

TEST_F(RefitChain, ClosesAndReturnsToRestWithinTurnLimit) {
    const HingeChain chain = three_link_chain(Vec3{0.0, 0.015, 0.0});
    const ChainFit first = fit(chain);
    ChainAngles angle_rad = chain.open_rad;
    int steps = 0;
    for (bool is_turn_limited = true; is_turn_limited && steps < 100; ++steps) {
        const ChainFit kept = refit(chain, angle_rad);
        EXPECT_LE(max_turn_between(angle_rad, kept.angle_rad), k_turn_rad + 1e-9);
        is_turn_limited = kept.is_turn_limited;
        angle_rad = kept.angle_rad;
    }
    EXPECT_GT(steps, 3);
    EXPECT_LT(max_turn_between(angle_rad, first.angle_rad), 0.05);  // as if closed in one step
    meshes.front().pose.position.y() -= 1.0;
    for (steps = 0; angle_rad != chain.rest_rad && steps < 100; ++steps) {
        const ChainFit kept = refit(chain, angle_rad);
        EXPECT_EQ(kept.fallback, ChainFallback::rest_pose);
        EXPECT_LE(max_turn_between(angle_rad, kept.angle_rad), k_turn_rad + 1e-9);
        angle_rad = kept.angle_rad;
    }
    EXPECT_GT(steps, 1);
    EXPECT_LT(steps, 30);
}

TEST_F(RefitChain, AllocatesNothingOnceWarm) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "sanitizers replace operator new";
    }
    std::size_t before = 0;
    for (int round = 0; round < 2; ++round) {
        HingeChain chain = three_link_chain(Vec3{0.0, 0.015, 0.0});
        ChainAngles angle_rad = fit(chain).angle_rad;
        before = allocation_count();
        for (int step = 0; step < 100; ++step) {
            chain.base.position.y() = 0.015 + 0.04 * std::sin(0.1 * step);
            angle_rad = refit(chain, angle_rad).angle_rad;
        }
    }
    EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace handhold::chain_refit_test
