#include "engine/geometry/chain_refit.hpp"

#include <gtest/gtest.h>

#include "surface_cuts.hpp"
#include "tests/engine/allocation_count.hpp"

namespace handhold::chain_refit_test {
namespace {

constexpr double k_rad_per_deg = M_PI / 180.0;
constexpr double k_turn_rad = 0.1;

// An index finger, stretched along -Z, that curls down.
HingeChain finger_at(const Vec3& position) {
    HingeChain chain;
    chain.base.position = position;
    chain.length_m = {0.045, 0.026, 0.022};
    chain.radius_m = {0.009, 0.008, 0.007};
    chain.closed_rad = {75.0 * k_rad_per_deg, 105.0 * k_rad_per_deg, 75.0 * k_rad_per_deg};
    chain.rest_rad = {20.0 * k_rad_per_deg, 30.0 * k_rad_per_deg, 15.0 * k_rad_per_deg};
    return chain;
}

double most_turned_rad(const ChainAngles& from, const ChainAngles& to) {
    double max_rad = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        max_rad = std::max(max_rad, std::abs(to[i] - from[i]));
    }
    return max_rad;
}

// A bar along x, 35 mm thick, its top at the height 0.
struct RefitChain : testing::Test {
    GripMesh bar = build_grip_mesh(test::make_tube(0.0175, 0.4, 48, 40));
    std::vector<PlacedMesh> meshes{{&bar, {Vec3(0.0, -0.0175, -0.03), Quat::Identity()}}};
    ChainFitScratch scratch;

    ChainFit fit(const HingeChain& chain) { return fit_chain(chain, meshes, {}, {}, scratch); }
    ChainFit refit(const HingeChain& chain, const ChainAngles& last_rad,
                   double max_turn_rad = k_turn_rad) {
        ChainRefitSettings settings;
        settings.max_turn_rad = max_turn_rad;
        return refit_chain(chain, last_rad, meshes, {}, settings, scratch);
    }
    // By the code that has an oracle of its own (FindSunk).
    double depth_m(const HingeChain& chain, const ChainAngles& angle_rad) const {
        double deepest_m = 0.0;
        for (const Capsule& capsule : chain_capsules(chain, angle_rad)) {
            deepest_m = std::max(deepest_m, find_penetration(capsule, meshes).depth_m);
        }
        return deepest_m;
    }
};

TEST_F(RefitChain, WhatStillTouchesStays) {
    const HingeChain chain = finger_at({0.0, 0.015, 0.0});
    const ChainFit first = fit(chain);
    ASSERT_NE(first.contact_link, DiscClosure::k_none);
    HingeChain moved = chain;
    moved.base.position.y() += 1e-4;
    const ChainFit kept = refit(moved, first.angle_rad);
    EXPECT_EQ(kept.angle_rad, first.angle_rad);
    EXPECT_NE(kept.contact_link, DiscClosure::k_none);
}

TEST_F(RefitChain, FollowsASurfaceWithoutSinkingOrLeavingIt) {
    HingeChain chain = finger_at({0.0, 0.017, 0.0});
    ChainAngles angle_rad = fit(chain).angle_rad;
    for (int step = 0; step < 200; ++step) {
        chain.base.position.y() = 0.017 + 0.006 * std::sin(0.1 * step);
        chain.base.position.z() = 0.01 * std::sin(0.07 * step);
        const ChainFit kept = refit(chain, angle_rad);
        const double depth = depth_m(chain, kept.angle_rad);
        EXPECT_LE(depth, 8e-4) << "step " << step;
        EXPECT_NE(kept.contact_link, DiscClosure::k_none) << "step " << step;
        EXPECT_LE(most_turned_rad(angle_rad, kept.angle_rad), k_turn_rad + 1e-9);
        angle_rad = kept.angle_rad;
    }
}

TEST_F(RefitChain, OpensOutOfWhatItIsSunkIn) {
    HingeChain chain = finger_at({0.0, 0.02, 0.0});
    const ChainAngles before = fit(chain).angle_rad;
    chain.base.position.y() -= 0.002;
    ASSERT_GT(depth_m(chain, before), 1e-3);
    const ChainFit kept = refit(chain, before);
    EXPECT_LE(depth_m(chain, kept.angle_rad), 8e-4);
    EXPECT_LT(kept.angle_rad[0], before[0]);
}

TEST_F(RefitChain, SaysThatItStaysSunkWhereOpeningALittleDoesNotDo) {
    HingeChain chain = finger_at({0.0, 0.02, 0.0});
    const ChainAngles before = fit(chain).angle_rad;
    chain.base.position.y() -= 0.025;  // its first link goes into the bar, however far it opens
    EXPECT_GT(refit(chain, before).depth_m, 8e-4);
}

TEST_F(RefitChain, ClosesStepByStepOnWhatIsFarAndIsRelaxedStepByStepWhereNothingIs) {
    const HingeChain chain = finger_at({0.0, 0.015, 0.0});
    const ChainFit first = fit(chain);
    ChainAngles angle_rad = chain.open_rad;
    int steps = 0;
    for (bool is_turn_limited = true; is_turn_limited && steps < 100; ++steps) {
        const ChainFit kept = refit(chain, angle_rad);
        EXPECT_LE(most_turned_rad(angle_rad, kept.angle_rad), k_turn_rad + 1e-9);
        is_turn_limited = kept.is_turn_limited;
        angle_rad = kept.angle_rad;
    }
    EXPECT_GT(steps, 3);
    EXPECT_LT(most_turned_rad(angle_rad, first.angle_rad), 0.05);  // as if closed at once
    meshes.front().pose.position.y() -= 1.0;
    for (steps = 0; angle_rad != chain.rest_rad && steps < 100; ++steps) {
        const ChainFit kept = refit(chain, angle_rad);
        EXPECT_EQ(kept.fallback, ChainFallback::rest_pose);
        EXPECT_LE(most_turned_rad(angle_rad, kept.angle_rad), k_turn_rad + 1e-9);
        angle_rad = kept.angle_rad;
    }
    EXPECT_GT(steps, 1);
    EXPECT_LT(steps, 30);
}

TEST_F(RefitChain, AllocatesNothingOnceWarm) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "the sanitizers bring operators of their own";
    }
    std::size_t before = 0;
    for (int round = 0; round < 2; ++round) {
        HingeChain chain = finger_at({0.0, 0.015, 0.0});
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
