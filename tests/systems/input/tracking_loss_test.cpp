// Hands that jump or lose tracking, and samples of wrong times and numbers.
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/core/check.hpp"
#include "tracked_devices.hpp"

namespace handhold::tracking_loss_test {
namespace {

using namespace test;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

// --- What a hand can do --------------------------------------------------------------------------

// Two readings in a row must agree, and the hand must have had the time: 0.4 m at 8 m/s are 50 ms.
TEST(ReadTracking, HandThatJumpsIsBelievedOnceItCouldHaveComeThere) {
    Devices devices;
    devices.tuning.tracking.max_hand_speed_mps = 8.0;
    devices.step({sample_at(0.005, Vec3(1.0, 0.0, 0.0))});
    std::uint64_t ignored = 0;
    double believed_s = 0.0;
    for (double t_s = 0.015; t_s < 0.2 && believed_s == 0.0; t_s += 0.01) {
        TrackingSample jumped = sample_at(t_s, Vec3(1.0, 0.0, 0.0));
        jumped.controllers[0].controller_ps.position.y() = 0.4;
        devices.step({jumped});
        EXPECT_EQ(devices.left().state, TrackingState::tracked);
        if (devices.left().resumed) {
            believed_s = t_s;
            continue;
        }
        EXPECT_EQ(devices.left().pose_ps.position, Vec3(1.0, 0.0, 0.0)) << t_s;
        ignored += count_of(devices.stats, Fallback::hand_implausible);
    }
    // 20 mm less, for noise: after 47.5 ms.
    EXPECT_NEAR(believed_s, 0.055, 1e-9);
    EXPECT_EQ(ignored, 4U);
    EXPECT_EQ(devices.left().start_ps.position, Vec3(1.0, 0.4, 0.0));
    EXPECT_EQ(devices.left().pose_ps.position, Vec3(1.0, 0.4, 0.0));
    EXPECT_EQ(devices.right().pose_ps.position, Vec3(1.0, 0.0, 0.0));
}

// Readings that do not agree with each other are never believed, however long they last.
RC_GTEST_PROP(ReadTracking, ReadingsAtRandomAreNeverBelieved, (std::uint64_t seed)) {
    Random random(seed);
    Devices devices;
    devices.tuning.tracking.max_hand_speed_mps = 8.0;
    devices.step({sample_at(0.005, Vec3(1.0, 0.0, 0.0))});
    double side = 1.0;
    while (devices.t_s < 1.0) {
        side = -side;  // 0.4 m at least from one reading to the next
        TrackingSample wrong = sample_at(devices.t_s + 0.005, Vec3(1.0, 0.0, 0.0));
        wrong.controllers[1].controller_ps.position +=
            Vec3{side * random.between(0.2, 0.8), random.between(-0.5, 0.5), 0.0};
        devices.step({wrong});
        RC_ASSERT(devices.right().pose_ps.position == Vec3(1.0, 0.0, 0.0));
        RC_ASSERT(!devices.right().resumed);
    }
}

// A hand that accelerates smoothly over several samples is never ignored as a tracking error,
// whatever its speed and the rate of samples.
RC_GTEST_PROP(ReadTracking, SmoothHandOfAnySpeedIsBelieved, (std::uint64_t seed)) {
    Random random(seed);
    Devices devices;
    devices.tuning.tracking.max_hand_speed_mps = 8.0;
    devices.tuning.hand.max_arm_m = 100.0;
    const double sample_s = 1.0 / random.between(60.0, 1000.0);
    const Vec3 swing = random.arm(0.1, 0.8);
    const double rate = random.between(1.0, 20.0);  // up to 16 m/s and 320 m/s^2
    const double noise_m = random.between(0.0, 0.002);
    double next_s = 0.0;
    while (devices.t_s < 1.0) {
        std::vector<TrackingSample> samples;
        for (; next_s <= devices.t_s + k_frame_s; next_s += sample_s * random.between(0.7, 1.3)) {
            samples.push_back(sample_at(next_s, Vec3(0.0, 1.0, 0.0)));
            samples.back().controllers[1].controller_ps.position +=
                sine(rate * next_s + k_half_pi) * swing + random.vector(noise_m);  // from rest
        }
        devices.step(samples);
        RC_ASSERT(count_of(devices.stats, Fallback::hand_implausible) == 0U);
        RC_ASSERT(!devices.right().resumed);
    }
}

TEST(ReadTracking, ControllerAtExactlyZeroIsAsleep) {
    Devices devices;
    TrackingSample asleep = sample_at(0.005);
    asleep.controllers[1].controller_ps.position.setZero();
    asleep.controllers[1].grab = true;
    devices.step({asleep});
    EXPECT_EQ(count_of(devices.stats, Fallback::device_asleep), 1U);
    EXPECT_EQ(devices.right().state, TrackingState::never);
    EXPECT_FALSE(devices.right().pressed);
    EXPECT_EQ(devices.left().state, TrackingState::tracked);
}

TEST(ReadTracking, HandThatClosesAndJumpsClosesWhereItJumpedTo) {
    Devices devices;
    TrackingSample sample = sample_at(0.005, Vec3(1.0, 0.0, 0.0));
    devices.step({sample});
    sample.t_s = 0.012;
    sample.controllers[0].grab = true;
    TrackingSample missing = sample;
    missing.t_s = 0.014;
    missing.controllers[0].controller_ps.position.x() = k_nan;
    TrackingSample jumped = sample;
    jumped.t_s = 0.016;
    jumped.controllers[0].controller_ps.position.x() = 1.1;
    devices.step({sample, missing, jumped});
    EXPECT_EQ(devices.left().edge, GrabEdge::onset);
    EXPECT_EQ(devices.left().edge_t_s, 0.016);
    EXPECT_EQ(devices.left().edge_ps.position, Vec3(1.1, 0.0, 0.0));
    EXPECT_TRUE(devices.left().resumed);
}

TEST(ReadTracking, HeadThatComesBackFarAwayStaysWhereItWas) {
    Devices devices;
    devices.step({sample_at(0.01)});
    devices.step({}, 0.5);
    devices.step({sample_at(0.515, Vec3(3.0, 0.0, 0.0))});
    EXPECT_EQ(count_of(devices.stats, Fallback::head_recentred), 1U);
    EXPECT_EQ(devices.player_head().pose_ps.position, k_rest);
    EXPECT_EQ(devices.right().pose_ps.position, k_rest);
}

TEST(ReadTracking, HeadThatLeapsWithinItsBoundIsFollowed) {
    Devices devices;
    devices.step({sample_at(0.005, Vec3(1.0, 0.0, 0.0))});
    const Vec3 leap(devices.tuning.tracking.max_jump_m - 0.001, 0.0, 0.0);
    devices.step({sample_at(0.015, Vec3(1.0, 0.0, 0.0) + leap)});
    EXPECT_EQ(count_of(devices.stats, Fallback::head_recentred), 0U);
    EXPECT_EQ(devices.player_head().pose_ps.position, Vec3(1.0, 0.0, 0.0) + leap);
}

TEST(ReadTracking, DeviceThatWasNeverSeenIsNeitherTrackedNorLost) {
    Devices devices;
    TrackingSample bad = sample_at(0.005);
    bad.controllers[1].controller_ps.position.x() = k_nan;
    bad.controllers[1].grab = true;
    for (int frame = 0; frame < 100; ++frame) {
        devices.step({bad});
        bad.t_s += k_frame_s;
        EXPECT_EQ(count_of(devices.stats, Fallback::tracking_lost), 0U);
    }
    EXPECT_EQ(devices.right().state, TrackingState::never);
    EXPECT_FALSE(devices.right().pressed);
    EXPECT_EQ(devices.left().state, TrackingState::tracked);
}

// --- Lost and found ------------------------------------------------------------------------------

TEST(ReadTracking, SilentDevicesAreLostOnceEachAndFrozen) {
    Devices devices;
    devices.step({sample_at(0.01, Vec3(1.0, 0.0, 0.0))});
    std::uint64_t lost = 0;
    while (devices.t_s < 0.5) {
        devices.step({});
        lost += count_of(devices.stats, Fallback::tracking_lost);
        const bool is_lost = devices.right().state == TrackingState::lost;
        // The sample was at 0.01; lost_after_s is 0.25. Next to the limit either is right.
        if (std::abs(devices.t_s - 0.26) > 1e-6) {
            EXPECT_EQ(is_lost, devices.t_s > 0.26) << devices.t_s;
        }
    }
    EXPECT_EQ(lost, 3U);
    EXPECT_EQ(devices.player_head().state, TrackingState::lost);
    EXPECT_EQ(devices.right().pose_ps.position, Vec3(1.0, 0.0, 0.0));
}

TEST(ReadTracking, PlayerWithoutInputIsSilentToo) {
    Devices devices;
    PlayerInput input{k_player, {}, {}};
    const std::vector<TrackingSample> samples = {sample_at(0.004),
                                                 sample_at(0.01, Vec3(1.0, 0.0, 0.0))};
    input.samples = samples;
    input.commands = {0.5, 1, 1.0, Vec3::UnitX()};
    devices.step_inputs(std::span(&input, 1));
    EXPECT_EQ(devices.commands.at(k_player).snap_turns, 1);
    devices.step_inputs({});
    EXPECT_EQ(devices.player_head().start_ps.position, Vec3(1.0, 0.0, 0.0));
    const PlayerCommands& commands = devices.commands.at(k_player);
    EXPECT_EQ(commands.snap_turns, 0);
    EXPECT_EQ(commands.smooth_turn, 0.0);
    EXPECT_EQ(commands.brake, 0.0);
    EXPECT_EQ(commands.thrust_ps, Vec3(Vec3::Zero()));
    devices.step_inputs({}, 1.0);
    EXPECT_EQ(count_of(devices.stats, Fallback::tracking_lost), 3U);
    EXPECT_EQ(devices.player_head().state, TrackingState::lost);
}

TEST(ReadTracking, DeviceThatComesBackSaysSoAndDoesNotSweepAcrossItsJump) {
    Devices devices;
    devices.step({sample_at(0.01)});
    devices.step({}, 0.5);
    devices.step({sample_at(0.515, Vec3(1.5, 0.0, 0.0))});
    EXPECT_TRUE(devices.right().resumed);
    EXPECT_EQ(devices.right().start_ps.position, Vec3(1.5, 0.0, 0.0));
    EXPECT_EQ(devices.right().state, TrackingState::tracked);
    devices.step({sample_at(0.525, Vec3(1.5, 0.0, 0.0))});
    EXPECT_FALSE(devices.right().resumed);
}

TEST(ReadTracking, HandThatCannotBeSeenMayOpen) {
    Devices devices;
    devices.step({sample_at(0.005, Vec3(1.0, 0.0, 0.0), true)});
    TrackingSample unseen = sample_at(0.015);
    unseen.controllers[1].controller_ps.position.x() = k_nan;
    devices.step({unseen});
    EXPECT_EQ(devices.right().edge, GrabEdge::release);
    EXPECT_EQ(devices.right().edge_ps.position, Vec3(1.0, 0.0, 0.0));
}

TEST(ReadTracking, HandThatCannotBeSeenWaitsWithClosingUntilItIs) {
    Devices devices;
    devices.step({sample_at(0.005)});
    TrackingSample unseen = sample_at(0.015, k_rest, true);
    unseen.controllers[1].controller_ps.position.x() = k_nan;
    devices.step({unseen});
    EXPECT_EQ(devices.right().edge, GrabEdge::none);
    EXPECT_EQ(devices.left().edge, GrabEdge::onset);
    devices.step({sample_at(0.025, Vec3(2.0, 0.0, 0.0), true)});
    EXPECT_EQ(devices.right().edge, GrabEdge::onset);
}

}  // namespace
}  // namespace handhold::tracking_loss_test
