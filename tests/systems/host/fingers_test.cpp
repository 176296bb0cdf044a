// Curls of fingers, from gloves or joints, shape the empty hand.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_fingers_test {
namespace {

using test::HostScene;
using test::Random;
using Joints = std::array<hh_hand_joint, HH_HAND_JOINT_COUNT>;

Joints shown_joints(HostScene& scene, const hh_finger_curls& curls, hh::Side side) {
    for (int i = 0; i < 60; ++i) {
        hh::Sample now = scene.sample();
        now.curls[side] = curls;
        EXPECT_TRUE(scene.world.step(test::k_step_s, hh::input(scene.player, {&now, 1})));
    }
    return *scene.world.hand_joints(scene.player, side, HH_SPACE_WORLD);
}

// The shown fingers have the curl that was given, as their own joints say; unknown ones rest. Hands
// of either side, at any curls.
RC_GTEST_PROP(HostFingers, ShownFingersHaveTheCurlsThatWereGiven, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const hh::Side side = *rc::gen::element(HH_LEFT, HH_RIGHT);
    hh_finger_curls given{};
    for (double& curl : given.fingers) {
        curl = random.between(0.0, 1.0);
    }
    HostScene scene;
    const Joints shown = shown_joints(scene, given, side);
    hh_finger_curls read{};
    RC_ASSERT(hh_finger_curls_of(shown.data(), &read) == HH_OK);
    for (std::size_t f = 1; f < 5; ++f) {
        RC_ASSERT(std::abs(read.fingers[f] - given.fingers[f]) < 0.06);
    }
    RC_ASSERT(std::abs(read.fingers[0] - given.fingers[0]) < 0.15);
}

// Joints that are not valid say nothing of their finger, and nothing of the others.
RC_GTEST_PROP(HostFingers, JointsThatAreNotValidAreNotRead, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    HostScene scene;
    Joints joints = shown_joints(scene, {{0.3, 0.3, 0.3, 0.3, 0.3}}, HH_RIGHT);
    hh_finger_curls all{};
    RC_ASSERT(hh_finger_curls_of(joints.data(), &all) == HH_OK);
    const auto finger = static_cast<std::size_t>(random.between(0.0, 5.0));
    const std::size_t first = finger == 0 ? 2 : 1 + 5 * finger;
    const std::size_t count = finger == 0 ? 4 : 5;
    const auto lost =
        first + static_cast<std::size_t>(random.between(0.0, 1.0) * static_cast<double>(count));
    joints[lost].is_valid = 0;
    joints[lost].pose.position = {};
    hh_finger_curls read{};
    RC_ASSERT(hh_finger_curls_of(joints.data(), &read) == HH_OK);
    for (std::size_t f = 0; f < 5; ++f) {
        RC_ASSERT(read.fingers[f] == (f == finger ? -1.0 : all.fingers[f]));
    }
}

// Curls shape a closed hand too, which squeeze alone makes a fist; unknown fingers follow squeeze.
TEST(HostFingers, PointingHandPointsWhateverItsButton) {
    HostScene scene;
    scene.closed[1] = true;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    const Joints shown = shown_joints(scene, {{unknown, 0.0, 1.0, unknown, -1.0}}, HH_RIGHT);
    hh_finger_curls read{};
    ASSERT_EQ(hh_finger_curls_of(shown.data(), &read), HH_OK);
    EXPECT_LT(read.fingers[1], 0.06);
    EXPECT_GT(read.fingers[2], 0.9);
    EXPECT_GT(read.fingers[3], 0.9);  // a fist
    EXPECT_GT(read.fingers[4], 0.9);
}

TEST(HostFingers, NullPointersAreErrors) {
    Joints joints{};
    hh_finger_curls read{};
    EXPECT_EQ(hh_finger_curls_of(nullptr, &read), HH_ERROR_NULL);
    EXPECT_EQ(hh_finger_curls_of(joints.data(), nullptr), HH_ERROR_NULL);
    ASSERT_EQ(hh_finger_curls_of(joints.data(), &read), HH_OK);
    EXPECT_EQ(read.fingers[3], -1.0);
}

}  // namespace
}  // namespace handhold::host_fingers_test
