#include "game/devices/play_space_changes.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

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
    changes.add(100, {Vec3(1.0, 0.0, 0.0), Quat::Identity()});
    EXPECT_EQ(changes.space_at(99).position, Vec3(Vec3::Zero()));
    EXPECT_EQ(changes.space_at(100).position, Vec3(1.0, 0.0, 0.0));
}

TEST(PlaySpaceChanges, ChangeWithoutAValidPoseIsIgnored) {
    PlaySpaceChanges changes;
    changes.add(100, {Vec3::Zero(), Quat(0.0, 0.0, 0.0, 0.0)});
    changes.add(100, {Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), Quat::Identity()});
    EXPECT_EQ(changes.space_at(200).position, Vec3(Vec3::Zero()));
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
        changes.add(at_ns, new_in_old);
        RC_ASSERT(distance(changes.space_at(at_ns - 1) * reading, device) < 1e-9);
        reading = inverse(new_in_old) * reading;
        RC_ASSERT(distance(changes.space_at(at_ns) * reading, device) < 1e-9);
        time_ns = at_ns;
    }
}

}  // namespace
}  // namespace handhold::play_space_changes_test
