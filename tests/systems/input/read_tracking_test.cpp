#include "systems/input/read_tracking.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/core/check.hpp"
#include "tracked_devices.hpp"

namespace handhold::read_tracking_test {
namespace {

using namespace test;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_infinity = std::numeric_limits<double>::infinity();

// --- Poses ---------------------------------------------------------------------------------------

TEST(ReadTracking, PosesAreInterpolatedToTheFramesEnd) {
    Devices devices;
    // The end at 0.010 lies half way between the samples.
    devices.step({sample_at(0.008, Vec3(0.0, 1.0, 0.0)), sample_at(0.012, Vec3(1.0, 1.0, 1.0))});
    EXPECT_LT((devices.player_head().pose_ps.position - Vec3(0.5, 1.0, 0.5)).norm(), 1e-12);
    EXPECT_LT((devices.right().pose_ps.position - Vec3(0.5, 1.0, 0.5)).norm(), 1e-12);
    EXPECT_EQ(devices.right().sample_t_s, 0.008);
}

TEST(ReadTracking, PosesAreHeldWhereNoLaterSampleIsKnown) {
    Devices devices;
    devices.step({sample_at(0.002, Vec3(1.0, 0.0, 0.0)), sample_at(0.006, Vec3(2.0, 0.0, 0.0))});
    EXPECT_EQ(devices.player_head().pose_ps.position, Vec3(2.0, 0.0, 0.0));
    EXPECT_EQ(devices.left().pose_ps.position, Vec3(2.0, 0.0, 0.0));
}

TEST(ReadTracking, SqueezeAndTriggerLieWithinTheirRange) {
    for (const auto& [given, read] :
         {std::pair(0.4, 0.4), std::pair(2.0, 1.0), std::pair(-1.0, 0.0), std::pair(k_nan, 0.0),
          std::pair(k_infinity, 1.0)}) {
        Devices devices;
        TrackingSample sample = sample_at(0.01);
        sample.controllers[index_of(HandSide::right)].squeeze = given;
        sample.controllers[index_of(HandSide::left)].trigger = given;
        devices.step({sample});
        EXPECT_EQ(devices.right().squeeze, read);
        EXPECT_EQ(devices.right().trigger, 0.0);
        EXPECT_EQ(devices.left().squeeze, 0.0);
        EXPECT_EQ(devices.left().trigger, read);
    }
}

TEST(ReadTracking, StartOfAFrameIsTheEndOfTheLast) {
    Devices devices;
    devices.step({sample_at(0.01, Vec3(1.0, 0.0, 0.0))});
    devices.step({sample_at(0.02, Vec3(3.0, 0.0, 0.0))});
    EXPECT_EQ(devices.player_head().start_ps.position, Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(devices.right().start_ps.position, Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(devices.right().pose_ps.position, Vec3(3.0, 0.0, 0.0));
}

TEST(ReadTracking, FirstPoseIsAlsoTheStartOfItsFrame) {
    Devices devices;
    devices.step({sample_at(0.01, Vec3(1.0, 2.0, 3.0))});
    EXPECT_EQ(devices.player_head().start_ps.position, Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(devices.right().start_ps.position, Vec3(1.0, 2.0, 3.0));
}

// The first sample lies after the frame: its pose is taken, and the sample itself counts in its own
// frame.
TEST(ReadTracking, SessionThatBeginsBetweenTwoSamplesLosesNeither) {
    Devices devices;
    devices.step({sample_at(0.012, Vec3(1.0, 0.0, 0.0), true)});
    EXPECT_EQ(devices.player_head().pose_ps.position, Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(devices.right().state, TrackingState::tracked);
    EXPECT_EQ(devices.right().edge, GrabEdge::none);
    devices.step({sample_at(0.012, Vec3(1.0, 0.0, 0.0), true)});
    EXPECT_EQ(count_of_all(devices.stats), 0U);
    EXPECT_EQ(devices.right().edge, GrabEdge::onset);
    EXPECT_EQ(devices.right().edge_t_s, 0.012);
}

TEST(ReadTracking, RotationsThatAreNearlyUnitAreMadeUnit) {
    for (const double t_s : {0.005, 0.012}) {
        Devices devices;
        TrackingSample sample = sample_at(t_s);
        sample.head_ps.rotation.coeffs() *= 1.0005;
        sample.controllers[0].controller_ps.rotation.coeffs() *= 1.0005;
        devices.step({sample});
        EXPECT_NEAR(devices.player_head().pose_ps.rotation.norm(), 1.0, 1e-12);
        EXPECT_NEAR(devices.left().pose_ps.rotation.norm(), 1.0, 1e-12);
    }
}

TEST(ReadTracking, HandSitsInItsControllerAsItsJointSays) {
    Devices devices;
    const Pose joint{Vec3(0.01, 0.02, 0.09), rotation_about(Vec3::UnitX(), 0.4)};
    devices.joint.at(Devices::hand_of(k_player, HandSide::left)).hand_in_controller = joint;
    TrackingSample sample = sample_at(0.005);
    sample.controllers[0].controller_ps = {Vec3(0.5, 1.0, 1.5), rotation_about(Vec3::UnitY(), 0.7)};
    devices.step({sample});
    EXPECT_LT(distance(devices.left().pose_ps, sample.controllers[0].controller_ps * joint), 1e-14);
}

RC_GTEST_PROP(ReadTracking, MirroredControllersGiveMirroredHands, (std::uint64_t seed)) {
    Random random(seed);
    Devices devices;
    devices.joint.clear();  // both hands have Tuning's joint
    devices.tuning.hand.max_arm_m = devices.tuning.tracking.max_jump_m = 100.0;
    devices.tuning.hand.controller_offset_m = random.vector(0.3);
    devices.tuning.hand.controller_pitch_rad = random.between(-3.0, 3.0);
    std::vector<TrackingSample> samples;
    for (const double t_s : {0.004, 0.009, 0.013}) {
        samples.push_back(sample_at(t_s));
        const Pose controller = random.pose();
        samples.back().controllers = {ControllerSample{test::mirrored(controller), t_s > 0.005},
                                      ControllerSample{controller, t_s > 0.005}};
    }
    devices.step(samples);
    RC_ASSERT(distance(devices.left().pose_ps, test::mirrored(devices.right().pose_ps)) < 1e-12);
    RC_ASSERT(distance(devices.left().edge_ps, test::mirrored(devices.right().edge_ps)) < 1e-12);
    RC_ASSERT(devices.left().edge == GrabEdge::onset);
}

// --- Bad samples ---------------------------------------------------------------------------------

TEST(ReadTracking, SamplesOutOfOrderAreIgnoredAndCountedOnceAPlayer) {
    Devices devices;
    devices.step({sample_at(0.006, Vec3(1.0, 0.0, 0.0)),
                  sample_at(0.004, Vec3(9.0, 0.0, 0.0), true),
                  sample_at(0.006, Vec3(9.0, 0.0, 0.0), true)});
    EXPECT_EQ(count_of(devices.stats, Fallback::sample_out_of_order), 2U);
    EXPECT_EQ(devices.right().pose_ps.position, Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(devices.right().edge, GrabEdge::none);
}

TEST(ReadTracking, SamplesWithoutATimeAreIgnoredAndHideNoOthers) {
    for (const double bad : {k_nan, k_infinity, -k_infinity}) {
        Devices devices;
        devices.step({sample_at(bad, Vec3(9.0, 0.0, 0.0), true),
                      sample_at(0.005, Vec3(1.0, 0.0, 0.0)),
                      sample_at(bad, Vec3(9.0, 0.0, 0.0), true)});
        EXPECT_EQ(count_of(devices.stats, Fallback::sample_out_of_order), 2U);
        EXPECT_EQ(devices.right().pose_ps.position, Vec3(1.0, 0.0, 0.0));
        EXPECT_EQ(devices.right().edge, GrabEdge::none);
        devices.step({sample_at(0.015, Vec3(2.0, 0.0, 0.0))});
        EXPECT_EQ(devices.player_head().pose_ps.position, Vec3(2.0, 0.0, 0.0));
    }
}

TEST(ReadTracking, PosesThatAreNotFiniteOrNotUnitAreIgnoredDeviceByDevice) {
    Devices devices;
    devices.step({sample_at(0.005, Vec3(1.0, 0.0, 0.0))});
    TrackingSample bad = sample_at(0.015, Vec3(2.0, 0.0, 0.0));
    bad.head_ps.position.y() = k_nan;
    bad.controllers[0].controller_ps.rotation.coeffs() *= 2.0;
    devices.step({bad});
    EXPECT_EQ(count_of(devices.stats, Fallback::sample_not_finite), 2U);
    EXPECT_EQ(devices.player_head().pose_ps.position, Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(devices.left().pose_ps.position, Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(devices.right().pose_ps.position, Vec3(2.0, 0.0, 0.0));
}

TEST(ReadTracking, LaterSampleThatIsNotFiniteIsNotInterpolatedTo) {
    Devices devices;
    TrackingSample bad = sample_at(0.015, Vec3(2.0, 0.0, 0.0));
    bad.head_ps.position.x() = k_infinity;
    bad.controllers[1].controller_ps.position.x() = k_nan;
    devices.step({sample_at(0.005, Vec3(1.0, 0.0, 0.0)), bad});
    EXPECT_EQ(devices.player_head().pose_ps.position, Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(devices.right().pose_ps.position, Vec3(1.0, 0.0, 0.0));
}

TEST(ReadTracking, HeadThatJumpsIsRecentredAndItsHandsWithIt) {
    const Vec3 jump_m(7.0, -3.0, 900.0);
    const auto place_at = [](double t_s) { return Vec3(t_s, 0.0, 1.0); };  // 1 m/s
    Devices devices;
    devices.step({sample_at(0.005, place_at(0.005))});
    devices.step(
        {sample_at(0.015, place_at(0.015)), sample_at(0.024, place_at(0.024) + jump_m, true)});
    // Not interpolated across the jump.
    EXPECT_LT((devices.player_head().pose_ps.position - place_at(0.015)).norm(), 1e-9);
    EXPECT_LT((devices.right().pose_ps.position - place_at(0.015)).norm(), 1e-9);
    EXPECT_EQ(count_of(devices.stats, Fallback::head_recentred), 0U);
    devices.step({sample_at(0.024, place_at(0.024) + jump_m, true),
                  sample_at(0.029, place_at(0.029) + jump_m, true)});
    EXPECT_EQ(count_of(devices.stats, Fallback::head_recentred), 1U);
    // The player does not move for the 9 ms of the jump, nor do the hands.
    const Vec3 stood_m(0.009, 0.0, 0.0);
    EXPECT_LT((devices.player_head().pose_ps.position + stood_m - place_at(0.029)).norm(), 1e-9);
    EXPECT_LT((devices.right().edge_ps.position + stood_m - place_at(0.024)).norm(), 1e-9);
    EXPECT_FALSE(devices.right().resumed);
    devices.step({sample_at(0.039, place_at(0.039) + jump_m)});
    // Release velocity: 1 m/s, less because of the time without motion during the jump.
    const double slope_mps = devices.left().release_velocity_ps_mps.x();
    EXPECT_GT(slope_mps, 0.5);
    EXPECT_LT(slope_mps, 1.0);
    devices.step({sample_at(0.045, place_at(0.045))});  // and back
    EXPECT_EQ(count_of(devices.stats, Fallback::head_recentred), 1U);
    EXPECT_LT((devices.left().pose_ps.position - devices.player_head().pose_ps.position).norm(),
              1e-9);
}

TEST(ReadTracking, GlitchWithinAFrameLeavesNothingBehind) {
    const Vec3 far_m(0.0, 3000.0, 0.0);
    Devices devices;
    devices.step({sample_at(0.005, Vec3(1.0, 0.0, 0.0), true)});
    devices.step({sample_at(0.012, Vec3(1.0, 0.0, 0.0), true), sample_at(0.014, far_m, false),
                  sample_at(0.016, Vec3(1.0, 0.0, 0.0), false)});
    EXPECT_EQ(count_of(devices.stats, Fallback::head_recentred), 2U);
    for (const Vec3& place : {devices.player_head().pose_ps.position,
                              devices.right().pose_ps.position, devices.right().edge_ps.position}) {
        EXPECT_LT((place - Vec3(1.0, 0.0, 0.0)).norm(), 1e-9);
    }
    EXPECT_EQ(devices.right().edge, GrabEdge::release);
    EXPECT_LT(devices.right().release_velocity_ps_mps.norm(), 1e-6);
}

TEST(ReadTracking, HandOutOfItsHeadsReachIsNotBelieved) {
    Devices devices;
    devices.step({sample_at(0.005, k_rest, true)});
    TrackingSample glitch = sample_at(0.015, k_rest, false);
    glitch.controllers[1].controller_ps.position.x() = devices.tuning.hand.max_arm_m + 0.001;
    devices.step({glitch});
    EXPECT_EQ(count_of(devices.stats, Fallback::hand_out_of_reach), 1U);
    // Where it was, but what its button says counts: it may open.
    EXPECT_EQ(devices.right().pose_ps.position, k_rest);
    EXPECT_EQ(devices.right().edge, GrabEdge::release);
    EXPECT_EQ(devices.right().release_velocity_ps_mps, Vec3::Zero());
    glitch.controllers[1].controller_ps.position.x() = devices.tuning.hand.max_arm_m - 0.001;
    glitch.t_s = 0.025;
    devices.step({glitch});
    EXPECT_EQ(count_of(devices.stats, Fallback::hand_out_of_reach), 0U);
    EXPECT_EQ(devices.right().pose_ps.position, glitch.controllers[1].controller_ps.position);
}

TEST(ReadTracking, HeadThatJumpsAloneLeavesItsHandsWhereTheyWere) {
    Devices devices;
    devices.step({sample_at(0.005, Vec3(1.0, 0.0, 0.0), true)});
    TrackingSample glitch = sample_at(0.015, Vec3(1.0, 0.0, 0.0), true);
    glitch.head_ps.position.z() = 3000.0;
    devices.step({glitch});
    EXPECT_EQ(count_of(devices.stats, Fallback::hand_out_of_reach), 2U);
    devices.step({sample_at(0.025, Vec3(1.0, 0.0, 0.0), true)});
    EXPECT_EQ(count_of(devices.stats, Fallback::hand_out_of_reach), 0U);
    EXPECT_FALSE(devices.right().resumed);
    EXPECT_LT((devices.right().pose_ps.position - Vec3(1.0, 0.0, 0.0)).norm(), 1e-9);
    EXPECT_TRUE(devices.right().pressed);
}

// --- Commands, players, preconditions ------------------------------------------------------------

TEST(ReadTracking, CommandsThatAreNotFiniteAskForNothing) {
    Devices devices;
    const PlayerInput input{k_player, {}, {k_nan, 2, k_infinity, Vec3(k_nan, 0.5, -k_infinity)}};
    devices.step_inputs(std::span(&input, 1));
    const PlayerCommands& commands = devices.commands.at(k_player);
    EXPECT_EQ(commands.smooth_turn, 0.0);
    EXPECT_EQ(commands.snap_turns, 2);
    EXPECT_EQ(commands.brake, 0.0);
    EXPECT_EQ(commands.thrust_ps, Vec3(0.0, 0.5, 0.0));
}

TEST(ReadTracking, OrderOfHandsAndInputsDoesNotMatter) {
    constexpr Entity k_second = entity(10);
    Devices forth;
    forth.add_player(k_second, {HandSide::left, HandSide::right});
    Devices back;
    back.origin.clear();
    back.owner.clear();
    back.joint.clear();
    back.hand.clear();
    back.history.clear();
    back.head.clear();
    back.commands.clear();
    back.add_player(k_second, {HandSide::right, HandSide::left});
    back.add_player(k_player, {HandSide::right, HandSide::left});
    const std::vector<TrackingSample> first = {sample_at(0.004, Vec3(1.0, 0.0, 0.0)),
                                               sample_at(0.012, Vec3(2.0, 0.0, 0.0), true)};
    const std::vector<TrackingSample> second = {sample_at(0.003, Vec3(5.0, 0.0, 0.0), true)};
    const std::vector<PlayerInput> inputs = {{k_player, first, {}}, {k_second, second, {}}};
    const std::vector<PlayerInput> swapped = {inputs[1], inputs[0]};
    forth.step_inputs(inputs);
    back.step_inputs(swapped);
    for (const Entity player : {k_player, k_second}) {
        EXPECT_EQ(forth.head.at(player).pose_ps.position, back.head.at(player).pose_ps.position);
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const HandTracking& a = forth.hand.at(Devices::hand_of(player, side));
            const HandTracking& b = back.hand.at(Devices::hand_of(player, side));
            EXPECT_EQ(a.pose_ps.position, b.pose_ps.position);
            EXPECT_EQ(a.edge, b.edge);
        }
    }
    EXPECT_EQ(forth.hand.at(Devices::hand_of(k_second, HandSide::left)).edge, GrabEdge::onset);
}

TEST(ReadTracking, FrameWithoutLengthIsRefused) {
    Devices devices;
    EXPECT_THROW(devices.step({}, 0.0), PreconditionError);
}

}  // namespace
}  // namespace handhold::read_tracking_test
