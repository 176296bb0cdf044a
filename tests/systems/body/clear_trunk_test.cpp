#include "systems/body/shared/clear_trunk.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"

namespace handhold::clear_trunk_test {
namespace {

using test::Random;

constexpr double k_upper_m = 0.30;
constexpr double k_forearm_m = 0.28;

// An arm of the right side: the hand somewhere in reach, the elbow somewhere on its circle.
struct Arm {
    Vec3 hand = Vec3::Zero();
    ElbowCircle circle;
    Vec3 bend = Vec3::UnitZ();
    TrunkCapsule trunk = trunk_capsule(Vec3(-0.19, 0.0, 0.0), -Vec3::UnitY(), 1.0);

    explicit Arm(Random& random) {
        hand = random.arm(0.15, 0.55);
        const double length = hand.norm();
        circle = elbow_circle(length, hand * (1.0 / length), k_upper_m, k_forearm_m);
        const Vec3 any = random.direction();
        bend = (any - circle.axis_ts * circle.axis_ts.dot(any)).normalized();
    }
    double depth(const Vec3& direction) const {
        return depth_in_trunk(circle.middle_ts + circle.radius_m * direction, hand, trunk);
    }
    Vec3 out() const {
        const Vec3 aside = Vec3::UnitX() - circle.axis_ts * circle.axis_ts.dot(Vec3(Vec3::UnitX()));
        return aside.normalized();
    }
    Vec3 cleared() const { return bend_clear_of_trunk(circle, bend, hand, HandSide::right, trunk); }
};

// Clear arms are not changed. Others end as clear as an elbow that points outwards, if that is a
// gain.
RC_GTEST_PROP(ClearTrunk, ElbowsLeaveTheTrunkWhereTheyCan, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    int entered = 0;
    int deeper = 0;
    for (int i = 0; i < 200; ++i) {
        const Arm arm(random);
        const double before_m = arm.depth(arm.bend);
        const Vec3 after = arm.cleared();
        RC_ASSERT(std::abs(after.norm() - 1.0) < 1e-9);
        RC_ASSERT(std::abs(after.dot(arm.circle.axis_ts)) < 1e-9);
        if (before_m <= 0.0) {
            RC_ASSERT(after == arm.bend);
            continue;
        }
        ++entered;
        const double best_m = std::max(0.0, arm.depth(arm.out()));
        if (before_m - best_m > k_trunk_gain_m) {
            RC_ASSERT(arm.depth(after) <= best_m + 1e-3);
        } else if (arm.depth(after) > before_m + k_trunk_gain_m) {
            ++deeper;  // on the way to a place that is hardly better
        }
    }
    RC_ASSERT(entered > 5);
    RC_ASSERT(deeper * 5 < entered);
}

RC_GTEST_PROP(ClearTrunk, MirroredArmsAreMirrored, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const Arm arm(random);
    const auto mirrored = [](const Vec3& v) { return Vec3(-v.x(), v.y(), v.z()); };
    const ElbowCircle circle{mirrored(arm.circle.axis_ts), mirrored(arm.circle.middle_ts),
                             arm.circle.radius_m};
    const TrunkCapsule trunk{mirrored(arm.trunk.top_ts), mirrored(arm.trunk.bottom_ts),
                             arm.trunk.radius_m};
    const Vec3 other =
        bend_clear_of_trunk(circle, mirrored(arm.bend), mirrored(arm.hand), HandSide::left, trunk);
    RC_ASSERT((mirrored(other) - arm.cleared()).norm() < 1e-9);
}

}  // namespace
}  // namespace handhold::clear_trunk_test
