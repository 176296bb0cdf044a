#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tracked_devices.hpp"

// Button edges, and the velocities that are measured at them.
namespace handhold::read_tracking_edges_test {
namespace {

using test::Devices;
using test::k_frame_s;
using test::k_rest;
using test::Random;
using test::sample_at;

// --- Buttons -------------------------------------------------------------------------------------

TEST(ReadTracking, EdgeHasTheTimeAndPoseOfItsOwnSample) {
    Devices devices;
    devices.step({sample_at(0.002, Vec3(1.0, 0.0, 0.0)),
                  sample_at(0.004, Vec3(2.0, 0.0, 0.0), true),
                  sample_at(0.008, Vec3(3.0, 0.0, 0.0), true)});
    EXPECT_EQ(devices.right().edge, GrabEdge::onset);
    EXPECT_EQ(devices.right().edge_t_s, 0.004);
    EXPECT_EQ(devices.right().edge_ps.position, Vec3(2.0, 0.0, 0.0));
    EXPECT_TRUE(devices.right().pressed);
    devices.step({sample_at(0.012, k_rest, true)});
    EXPECT_EQ(devices.right().edge, GrabEdge::none);
}

TEST(ReadTracking, TapWithinOneFrameIsAnOnsetAndAReleaseInTheNext) {
    Devices devices;
    devices.step({sample_at(0.001), sample_at(0.003, k_rest, true), sample_at(0.006)});
    EXPECT_EQ(devices.right().edge, GrabEdge::onset);
    devices.step({sample_at(0.013), sample_at(0.018)});
    EXPECT_EQ(devices.right().edge, GrabEdge::release);
    EXPECT_EQ(devices.right().edge_t_s, 0.01);  // the frame's start
    devices.step({sample_at(0.023)});
    EXPECT_EQ(devices.right().edge, GrabEdge::none);
}

TEST(ReadTracking, BouncesThatEndAsTheyBeganAreOneEdge) {
    Devices devices;
    std::vector<TrackingSample> bouncing = {sample_at(0.001)};
    for (int i = 0; i < 7; ++i) {
        bouncing.push_back(sample_at(0.002 + 0.001 * i, k_rest, i % 2 == 0));
    }
    devices.step(bouncing);
    EXPECT_EQ(devices.right().edge, GrabEdge::onset);
    EXPECT_EQ(devices.right().edge_t_s, 0.002);
    devices.step({sample_at(0.015, k_rest, true)});
    EXPECT_EQ(devices.right().edge, GrabEdge::none);
    EXPECT_TRUE(devices.right().pressed);
}

// Onsets and releases alternate, at most one per frame, each within its frame. At the end, the
// hand's state is the button's.
RC_GTEST_PROP(ReadTracking, EdgesAlternateHoweverTheButtonBounces, (std::uint64_t seed)) {
    Random random(seed);
    Devices devices;
    bool was_pressed = false;
    double sample_t_s = 0.0;
    for (int frame = 0; frame < 50; ++frame) {
        std::vector<TrackingSample> samples;
        for (sample_t_s += random.between(1e-4, 0.004); sample_t_s < devices.t_s + k_frame_s;
             sample_t_s += random.between(1e-4, 0.004)) {
            const Vec3 place = random.vector(1.0);
            samples.push_back(sample_at(sample_t_s, place, random.between(0.0, 1.0) < 0.5));
        }
        const double start_s = devices.t_s;
        devices.step(samples);
        const HandTracking& hand = devices.right();
        if (hand.edge != GrabEdge::none) {
            RC_ASSERT((hand.edge == GrabEdge::onset) == !was_pressed);
            RC_ASSERT(hand.edge_t_s >= start_s && hand.edge_t_s <= devices.t_s);
        }
        RC_ASSERT(hand.pressed == (hand.edge == GrabEdge::none ? was_pressed : !was_pressed));
        was_pressed = hand.pressed;
    }
    devices.step({sample_at(devices.t_s + 0.005, k_rest, true)});
    devices.step({sample_at(devices.t_s + 0.005, k_rest, true)});
    RC_ASSERT(devices.right().pressed);
}

// --- Release velocities --------------------------------------------------------------------------

struct Motion {
    Vec3 start = Vec3(0.1, 1.2, -0.3);
    Vec3 velocity = Vec3(1.0, -0.5, 2.0);
    Vec3 acceleration = Vec3::Zero();
    Vec3 spin = Vec3::Zero();
    Pose at(double t_s) const {
        return {start + t_s * velocity + 0.5 * t_s * t_s * acceleration,
                rotation_from_vector(spin * t_s)};
    }
};

// 100 ms with the hand closed, sampled at 500 Hz, then it opens at 0.1 s.
void move_and_let_go(const Motion& motion, Devices& devices, double dt_s) {
    const int frames = static_cast<int>(std::lround(0.12 / dt_s));
    int next = 0;
    for (int frame = 0; frame < frames; ++frame) {
        std::vector<TrackingSample> samples;
        for (; 0.002 * next <= devices.t_s + dt_s; ++next) {
            samples.push_back(sample_at(0.002 * next, k_rest, next < 50));
            for (ControllerSample& controller : samples.back().controllers) {
                controller.controller_ps = motion.at(0.002 * next);
            }
        }
        devices.step(samples, dt_s);
        if (devices.right().edge == GrabEdge::release) {
            return;
        }
    }
    FAIL() << "the hand never opened";
}

TEST(ReadTracking, ReleaseAfterSteadyMotionHasItsVelocityAndSpin) {
    Devices devices;
    Motion motion;
    motion.spin = Vec3(2.0, -3.0, 1.0);
    move_and_let_go(motion, devices, k_frame_s);
    EXPECT_DOUBLE_EQ(devices.right().edge_t_s, 0.1);
    EXPECT_LT((devices.right().release_velocity_ps_mps - motion.velocity).norm(), 1e-12);
    EXPECT_LT((devices.right().release_spin_ps_radps - motion.spin).norm(), 1e-11);
}

// The least-squares line through a parabola sampled evenly has the parabola's slope at the samples'
// mean time: half the window back.
TEST(ReadTracking, ReleaseOnAParabolaHasItsSlopeInTheMiddleOfTheWindow) {
    Devices devices;
    devices.tuning.tracking.release_window_s = 0.0401;  // 21 samples: those of the last 40 ms
    Motion motion;
    motion.acceleration = Vec3(20.0, 5.0, -30.0);
    move_and_let_go(motion, devices, k_frame_s);
    const Vec3 expected = motion.velocity + (0.1 - 0.02) * motion.acceleration;
    EXPECT_LT((devices.right().release_velocity_ps_mps - expected).norm(), 1e-12);
}

TEST(ReadTracking, ReleaseVelocityIsTheSameBitForBitAtAnyFrameRate) {
    Motion motion;
    motion.acceleration = Vec3(20.0, 5.0, -30.0);
    motion.spin = Vec3(2.0, -3.0, 1.0);
    Devices reference;
    move_and_let_go(motion, reference, k_frame_s);
    for (const double hz : {60.0, 72.0, 90.0, 120.0, 144.0}) {
        Devices devices;
        move_and_let_go(motion, devices, 1.0 / hz);
        EXPECT_EQ(devices.right().release_velocity_ps_mps,
                  reference.right().release_velocity_ps_mps)
            << hz;
        EXPECT_EQ(devices.right().release_spin_ps_radps, reference.right().release_spin_ps_radps)
            << hz;
        EXPECT_EQ(devices.right().edge_t_s, reference.right().edge_t_s) << hz;
    }
}

TEST(ReadTracking, ReleaseOfASingleSampleIsStillAndOfTwoIsTheirDifference) {
    Devices still;
    still.tuning.tracking.release_window_s = 0.01;
    still.step({sample_at(0.005, k_rest, true)});
    for (int frame = 0; frame < 8; ++frame) {
        still.step({});
    }
    still.step({sample_at(9.0 * k_frame_s + 0.005, Vec3(1.0, 0.0, 0.0))});
    ASSERT_EQ(still.right().edge, GrabEdge::release);
    EXPECT_EQ(still.right().release_velocity_ps_mps, Vec3(Vec3::Zero()));

    Devices moving;
    moving.step({sample_at(0.005, k_rest, true)});
    moving.step({sample_at(0.015, k_rest + Vec3(0.02, 0.0, -0.01))});
    ASSERT_EQ(moving.right().edge, GrabEdge::release);
    EXPECT_LT((moving.right().release_velocity_ps_mps - Vec3(2.0, 0.0, -1.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace handhold::read_tracking_edges_test
