#include "engine/geometry/hinge_chain.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "engine/geometry/chain_patch.hpp"
#include "surface_cuts.hpp"

namespace handhold::hinge_chain_test {
namespace {

using test::full_mesh;
using test::Random;

TEST(ChainDepth, StoppedQueryFindsSufficientDepth) {
    Random random(1509);
    const GripMesh mesh = full_mesh(test::make_torus(0.08, 0.03, 90, 48));
    const std::vector<PlacedMesh> placed = {{&mesh, {}}};
    int penetrating = 0;
    for (int i = 0; i < 500; ++i) {
        HingeChain chain;
        chain.base = {random.vector(0.1), random.rotation()};
        chain.length_m = {0.045, 0.026, 0.022};
        chain.radius_m = {0.009, 0.008, 0.007};
        const ChainAngles angle_rad = {random.between(0.0, 1.0), random.between(0.0, 1.0),
                                       random.between(0.0, 1.0)};
        ChainPatch patch;
        patch.gather({chain.base, reach_m(chain) + 1e-3, 0.01}, placed);
        const ChainDepth expected = chain_depth(chain, angle_rad, patch);
        const ChainDepth enough =
            chain_depth(chain, angle_rad, patch, {.sufficient_depth_m = 0.5 * expected.depth_m});
        EXPECT_GE(enough.depth_m, 0.5 * expected.depth_m);
        EXPECT_LE(enough.depth_m, expected.depth_m);
        penetrating += expected.depth_m > 0.0 ? 1 : 0;
    }
    EXPECT_GT(penetrating, 50);
}

// More poses of the first link than are cached, in any order.
TEST(ChainDepths, EqualDepthOfEachPoseAlone) {
    Random random(1512);
    const GripMesh mesh = full_mesh(test::make_torus(0.08, 0.03, 90, 48));
    const std::vector<PlacedMesh> placed = {{&mesh, {}}};
    int penetrating = 0;
    int crossed = 0;
    for (int i = 0; i < 200; ++i) {
        HingeChain chain;
        chain.base = {random.vector(0.1), random.rotation()};
        chain.length_m = {0.045, 0.026, 0.022};
        chain.radius_m = {0.009, 0.008, 0.007};
        ChainPatch patch;
        patch.gather({chain.base, reach_m(chain) + 1e-3, 0.01}, placed);
        ChainDepths depths(chain, patch);
        for (int pose = 0; pose < 40; ++pose) {
            const double first_rad = 0.15 * std::floor(random.between(0.0, 8.0));
            const ChainAngles angle_rad = {first_rad, random.between(0.0, 1.0),
                                           random.between(0.0, 1.0)};
            const ChainDepth expected = chain_depth(chain, angle_rad, patch);
            const double sufficient_depth_m =
                pose % 4 == 0 ? std::numeric_limits<double>::infinity() : random.between(0.0, 0.01);
            const double found_m = depths.depth_m(angle_rad, sufficient_depth_m);
            if (expected.depth_m < sufficient_depth_m) {
                ASSERT_EQ(found_m, expected.depth_m) << i << ", " << pose;
            } else {
                ASSERT_GE(found_m, sufficient_depth_m) << i << ", " << pose;
                ASSERT_LE(found_m, expected.depth_m) << i << ", " << pose;
            }
            penetrating += expected.depth_m > 0.0 ? 1 : 0;
            crossed += expected.is_crossed ? 1 : 0;
        }
    }
    EXPECT_GT(penetrating, 500);
    EXPECT_GT(crossed, 50);
}

}  // namespace
}  // namespace handhold::hinge_chain_test
