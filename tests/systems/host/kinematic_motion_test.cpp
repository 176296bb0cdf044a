// Kinematic bodies whose poses the host sets less often than it steps. Players and bodies leave
// them at the speed of the motion, not faster.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "systems/host/host_call.hpp"
#include "tests/random.hpp"
#include "tests/systems/host/host_scene.hpp"

namespace handhold::kinematic_motion_test {
namespace {

using namespace test;

// Relative. At a constant rate the velocity of a lift or wheel is measured exactly: the motion from
// one pose to the next, over the time between them. Only rounding remains.
constexpr double k_rate_tolerance = 1e-9;

double speed_mps(const hh::Vec3& velocity) { return from_c(velocity).norm(); }

// A lift that rises, or a wheel that turns about +z. The host sets its pose every `every` steps.
struct HostMoved {
    HostScene scene;
    hh::Body body{};
    int every = 1;
    int phase = 0;  // the host sets a pose if frame + phase is a multiple of `every`; [0, every)
    bool turns = false;
    double rate = 1.0;  // m/s or rad/s
    double starts_s = 0.3;
    double stops_s = 1e9;
    bool repeats = false;  // the host sets the last pose again in the steps between

    explicit HostMoved(hh::Vec3 gravity_mps2 = {}) {
        EXPECT_EQ(hh_world_set_gravity(scene.world.get(), gravity_mps2), HH_OK);
    }
    void add(hh::Vec3 half_extents_m, hh::Vec3 position) {
        hh_body_def def = hh::body_def();
        def.kind = HH_KINEMATIC;
        def.shape = *scene.world.add_box(half_extents_m);
        def.pose.position = position;
        body = *scene.world.add(def);
        start_ = pose_ = def.pose;
    }
    hh::Pose pose_at(double t_s) const {
        const double y = rate * std::clamp(t_s - starts_s, 0.0, stops_s - starts_s);
        hh::Pose pose = start_;
        if (turns) {
            pose.rotation = {0.0, 0.0, std::sin(0.5 * y), std::cos(0.5 * y)};
        } else {
            pose.position.y += y;
        }
        return pose;
    }
    void step() {
        if ((scene.frame + phase) % every == 0) {
            pose_ = pose_at(scene.world.time_s() + k_step_s);
            sets_pose_ = true;
        } else if (!repeats) {
            sets_pose_ = false;
        }
        if (sets_pose_) {
            scene.is_good = scene.is_good && scene.world.move_kinematic(body, pose_);
        }
        scene.step();
    }
    void step_until(double t_s) {
        while (scene.world.time_s() < t_s) {
            step();
        }
    }
    // Opens both hands, and returns the speed of the player afterwards.
    double let_go_mps() {
        scene.closed[HH_RIGHT] = scene.closed[HH_LEFT] = false;
        step();
        return speed_mps(scene.world.pose(scene.player)->velocity_mps);
    }

  private:
    hh::Pose start_{};
    hh::Pose pose_{};
    bool sets_pose_ = false;
};

// A player who hangs on a lift or the rim of a wheel by one hand.
struct Hanging : HostMoved {
    explicit Hanging(std::uint64_t seed) : random(seed) {
        every = 1 + static_cast<int>(random.between(0.0, 12.0));
        phase = static_cast<int>(random.between(0.0, every));
        turns = random.between(0.0, 1.0) < 0.5;
        repeats = random.between(0.0, 1.0) < 0.5;
        rate = random.between(0.2, 2.0);
        add({2.0, 2.0, 0.1}, {0.0, 1.5, -0.6});
        side = random.between(0.0, 1.0) < 0.5 ? HH_LEFT : HH_RIGHT;
        scene.hand_at[side] = {0.9, turns ? 1.5 : 1.4, -0.43};
        scene.closed[side] = true;
    }
    double speed_of_grip_mps() const { return turns ? 0.9 * rate : rate; }
    bool is_gripping() const { return scene.hand(side).grip == HH_GRIP_SURFACE; }

    Random random;
    hh::Side side = HH_LEFT;
};

RC_GTEST_PROP(KinematicMotion, PlayersLeaveAtTheSpeedOfWhatTheyHungOn, (std::uint64_t seed)) {
    Hanging hanging(seed);
    // The rate is known after two poses.
    hanging.step_until(hanging.starts_s + 0.3 + hanging.random.between(0.0, 0.3));
    RC_ASSERT(hanging.is_gripping());
    const double left_mps = hanging.let_go_mps();
    RC_ASSERT(hanging.scene.is_good);
    RC_ASSERT(std::abs(left_mps - hanging.speed_of_grip_mps()) <
              k_rate_tolerance * hanging.speed_of_grip_mps());
}

// Sums over all runs.
struct Counts {
    int runs = 0;
    int moving = 0;   // let go while the body moved
    int stopped = 0;  // let go long after it stopped
};

void leave_a_body_that_stops(Counts& counts) {
    Hanging hanging(*rc::gen::arbitrary<std::uint64_t>());
    hanging.stops_s = hanging.starts_s + hanging.random.between(0.05, 0.6);
    hanging.step_until(hanging.starts_s + hanging.random.between(-0.1, 0.8));
    const double end_s = hanging.scene.world.time_s();
    RC_ASSERT(hanging.is_gripping());
    const double left_mps = hanging.let_go_mps();
    RC_ASSERT(hanging.scene.is_good);
    RC_ASSERT(left_mps < (1.0 + k_rate_tolerance) * hanging.speed_of_grip_mps());
    ++counts.runs;
    counts.moving += end_s > hanging.starts_s && end_s < hanging.stops_s ? 1 : 0;
    // The library knows that the body stopped once it did not move for a whole interval of poses.
    if (end_s > hanging.stops_s + (2 * hanging.every + 1) * k_step_s &&
        hanging.stops_s > hanging.starts_s + (3 * hanging.every) * k_step_s) {
        RC_ASSERT(left_mps < 1e-6);
        ++counts.stopped;
    }
}

TEST(KinematicMotion, NobodyLeavesFasterThanTheBodyMoved) {
    Counts counts;
    EXPECT_TRUE(rc::check([&counts] { leave_a_body_that_stops(counts); }));
    EXPECT_GT(20 * counts.moving, counts.runs);
    EXPECT_GT(20 * counts.stopped, counts.runs);
}

RC_GTEST_PROP(KinematicMotion, BallsAreThrownAsFastAsTheLiftMoves, (std::uint64_t seed)) {
    Random random(seed);
    HostMoved lift;
    lift.every = 1 + static_cast<int>(random.between(0.0, 12.0));
    lift.phase = static_cast<int>(random.between(0.0, lift.every));
    lift.rate = random.between(0.5, 2.0);
    lift.add({1.0, 0.1, 1.0}, {0.0, -1.0, 3.0});
    hh_body_def def = crate(lift.scene.world, {0.0, -0.55, 3.0});  // hit after 0.25 m
    def.restitution = 0.0;
    const hh::Body ball = *lift.scene.world.add(def);
    lift.step_until(lift.starts_s + 1.2);
    hh::Vec3 velocity{};
    RC_ASSERT(hh_body_velocity(lift.scene.world.get(), ball, &velocity, nullptr) == HH_OK);
    RC_ASSERT(lift.scene.is_good);
    RC_ASSERT(std::abs(velocity.y - lift.rate) < k_rate_tolerance * lift.rate);
}

}  // namespace
}  // namespace handhold::kinematic_motion_test
