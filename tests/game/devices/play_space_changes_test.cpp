#include "game/devices/play_space_changes.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/math.hpp>
#include <rapidcheck/gtest.h>

#include "systems/host/host_columns.hpp"
#include "tests/random.hpp"

namespace handhold::play_space_changes_test {
namespace {

using test::Random;

double distance(const Pose& a, const Pose& b) {
    return (a.position - b.position).norm() +
           rotation_to_vector((a.rotation.conjugate() * b.rotation).normalized()).norm();
}

TEST(PlaySpaceChanges, SpaceIsTheFirstOneUntilTheFirstChange) {
    PlaySpaceChanges changes;
    changes.add(100, hh::pose_at({1.0, 0.0, 0.0}));
    EXPECT_TRUE(changes.space_at(99).position == hh::Vec3{});
    EXPECT_TRUE(changes.space_at(100).position == hh::k_x);
}

TEST(PlaySpaceChanges, ChangeWithoutAValidPoseIsIgnored) {
    PlaySpaceChanges changes;
    changes.add(100, hh::Pose{});
    changes.add(100, hh::pose_at({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}));
    EXPECT_TRUE(changes.space_at(200).position == hh::Vec3{});
}

// A device at rest in the room keeps its corrected reading over any number of recentrings.
RC_GTEST_PROP(PlaySpaceChanges, DeviceAtRestStaysWhereItIs, (std::uint64_t seed)) {
    Random random(seed);
    PlaySpaceChanges changes;
    const Pose device = random.pose();
    Pose reading = device;
    std::int64_t time_ns = 0;
    for (int i = 0; i < 20; ++i) {
        const Pose new_in_old = random.pose();
        const std::int64_t at_ns = time_ns + 10;
        changes.add(at_ns, to_host(new_in_old));
        RC_ASSERT(distance(from_host(changes.space_at(at_ns - 1)) * reading, device) < 1e-9);
        reading = inverse(new_in_old) * reading;
        RC_ASSERT(distance(from_host(changes.space_at(at_ns)) * reading, device) < 1e-9);
        time_ns = at_ns;
    }
}

}  // namespace
}  // namespace handhold::play_space_changes_test
