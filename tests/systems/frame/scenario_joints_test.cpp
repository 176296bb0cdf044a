// Levers, drawers and doors through the whole frame (talk row 5).
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/physics/joint_errors.hpp"

namespace handhold::scenario_joints_test {
namespace {

using test::error_of;

constexpr double k_frame_s = 1.0 / 90.0;

// A mechanism with a handle, and the player in front of it.
struct Contraption {
    Scenario scene;
    Entity thing;
    Entity joint;
    Vec3 handle = Vec3::Zero();
    // Motion of the hand after the grab, relative to its pose then.
    std::function<Pose(double)> hand_move = [](double) { return Pose{}; };
    double release_s = 1e9;
    test::JointErrors worst;
    double highest = 0.0;  // coordinate

    void add_free_body(const Vec3& half_m, const Vec3& center, double mass_kg) {
        thing = scene.add_crate("thing", mass_kg, center, half_m);
    }
    void add_joint_at(Joint settings, const Vec3& point, const Vec3& axis) {
        settings.b = thing;
        const Quat turned = rotation_between(Vec3::UnitX(), axis);
        const Pose frame = scene.frame_ws * Pose{point, turned};
        joint = add_joint(scene.world, {"joint", joint_at(scene.world, settings, frame)});
    }
    // The right hand grips the handle at 0.1 s and then follows its path.
    void start() {
        scene.script.hands[1] = [this](double t_s) {
            return hand_move(t_s) * Pose{hand_for_palm(scene, handle), Quat::Identity()};
        };
        scene.script.grabs[1] = [this](double t_s) { return t_s > 0.1 && t_s < release_s; };
        scene.script.head = [this](double) {
            return Pose{handle + Vec3(-0.6, 0.4, 1.0), Quat::Identity()};
        };
        scene.add_player_here();
    }
    void run(double seconds) {
        scene.run(seconds, [this] {
            worst.take(error_of(scene, joint));
            highest = std::max(highest, state().coordinate);
        });
    }
    const JointState& state() const { return scene.world.joint_state.at(joint); }
    bool holds() const { return scene.grab(HandSide::right).kind == GripKind::held; }
};

// A lever of 40 cm on a wall at the origin, hinged about z at its lower end; its handle on top.
Contraption& make_lever(Contraption& c, bool limited = true) {
    c.add_free_body(Vec3(0.015, 0.2, 0.015), Vec3(0.0, 0.2, 0.0), 2.0);
    Joint settings;
    settings.kind = JointKind::hinge;
    settings.limited = limited;
    settings.lower = -1.2;
    settings.upper = 1.2;
    c.add_joint_at(settings, Vec3::Zero(), Vec3::UnitZ());
    c.handle = Vec3(0.0, 0.415, 0.0);
    return c;
}

TEST(Lever, FollowsTheHandAndThePlayerIsBitwiseUnmoved) {
    Contraption c;
    make_lever(c);
    c.hand_move = [](double t_s) {
        return Pose{Vec3::Zero(), rotation_about(Vec3::UnitZ(), 0.8 * ease(t_s, 0.3, 1.0))};
    };
    c.start();
    const Vec3 origin = c.scene.origin();
    c.run(1.2);
    ASSERT_TRUE(c.holds());
    EXPECT_NEAR(c.state().coordinate, 0.8, 1e-6);
    EXPECT_LE(c.worst.m, 1e-7);
    EXPECT_LE(c.worst.rad, 1e-6);
    EXPECT_EQ(c.scene.origin(), origin);
    EXPECT_LE(c.scene.grab(HandSide::right).error_m, 1e-6);
}

TEST(Lever, PulledOffItsArcKeepsItsJointAndMovesThePlayerInstead) {
    for (const double off_m : {0.05, 0.1, 0.2}) {
        Contraption c;
        make_lever(c);
        c.hand_move = [off_m](double t_s) {
            return Pose{off_m * ease(t_s, 0.3, 0.6) * Vec3::UnitZ(), Quat::Identity()};
        };
        c.start();
        c.run(1.0);
        ASSERT_TRUE(c.holds());
        EXPECT_LE(c.worst.m, 1e-6) << off_m;
        EXPECT_LE(c.worst.rad, 1e-4 * k_degree) << off_m;
        // The lever cannot move along its hinge: the player moves by that much.
        EXPECT_NEAR(c.scene.origin().z(), -off_m, 1e-6);
        EXPECT_LE(c.scene.grab(HandSide::right).error_m, 1e-6);
    }
}

TEST(Lever, TwistOfAStillWristDoesNotMoveThePlayer) {
    Contraption c;
    make_lever(c);
    // 46 degrees about an axis through the hand's position: the tracked point is still.
    c.hand_move = [&c](double t_s) {
        const Quat twist = rotation_about(Vec3(1.0, 2.0, -1.0).normalized(),
                                          46.0 * k_pi / 180.0 * ease(t_s, 0.3, 0.8));
        const Vec3 hand = hand_for_palm(c.scene, c.handle);
        return Pose{hand - twist * hand, twist};
    };
    c.start();
    const Vec3 origin = c.scene.origin();
    c.run(1.2);
    ASSERT_TRUE(c.holds());
    EXPECT_EQ(c.scene.origin(), origin);
    EXPECT_NEAR(c.state().coordinate, 0.0, 1e-9);
}

TEST(Lever, AtItsLimitActsAsAWall) {
    Contraption c;
    make_lever(c);
    c.hand_move = [](double t_s) {
        return Pose{Vec3::Zero(), rotation_about(Vec3::UnitZ(), 1.6 * ease(t_s, 0.3, 1.2))};
    };
    c.start();
    c.run(1.4);
    ASSERT_TRUE(c.holds());
    EXPECT_NEAR(c.highest, 1.2, 1e-6);
    EXPECT_GT(c.scene.origin().norm(), 0.1) << "and he drifts on as fast as he pulled himself";
    EXPECT_LE(c.worst.m, 1e-6);
    EXPECT_LE(c.scene.grab(HandSide::right).error_m, 1e-6);
}

TEST(Drawer, SlidesWithTheHandAndStopsAtItsEnd) {
    Contraption c;
    c.add_free_body(Vec3(0.2, 0.1, 0.2), Vec3(0.0, 0.0, -0.2), 5.0);
    Joint settings;
    settings.kind = JointKind::slider;
    settings.limited = true;
    settings.upper = 0.3;
    c.add_joint_at(settings, Vec3(0.0, 0.0, 0.0), Vec3::UnitZ());
    c.handle = Vec3(0.0, 0.115, -0.05);
    c.hand_move = [](double t_s) {
        return Pose{Vec3(0.0, 0.0, 0.45 * ease(t_s, 0.3, 1.0)), Quat::Identity()};
    };
    c.start();
    c.run(1.2);
    ASSERT_TRUE(c.holds());
    EXPECT_LE(c.worst.m, 1e-6);
    EXPECT_LE(c.worst.rad, 1e-4 * k_degree);
    EXPECT_NEAR(c.highest, 0.3, 1e-6);
    EXPECT_LT(c.scene.origin().z(), -0.15) << "and he drifts on as fast as he pulled himself";
}

TEST(Valve, CountsFullTurns) {
    Contraption c;
    make_lever(c, false);
    c.hand_move = [](double t_s) {
        const double turns = 2.0 * std::clamp((t_s - 0.3) / 3.0, 0.0, 1.0);
        return Pose{Vec3::Zero(), rotation_about(Vec3::UnitZ(), 2.0 * k_pi * turns)};
    };
    c.start();
    c.run(3.6);
    ASSERT_TRUE(c.holds());
    EXPECT_NEAR(c.state().coordinate, 4.0 * k_pi, 1e-5);
}

TEST(Joints, FrictionStopsAReleasedLeverAfterTheClosedFormAngle) {
    Contraption c;
    make_lever(c, false);
    c.scene.world.joint.at(c.joint).friction = 0.5;
    const double spin = 3.0;
    // About the hinge: the box's own inertia and its distance.
    const RigidBody& body = c.scene.world.body.at(c.thing);
    const double inertia = body.inertia_kgm2.z() + body.mass_kg * 0.2 * 0.2;
    c.scene.world.body_velocity.at(c.thing) = {Vec3(-0.2 * spin, 0.0, 0.0), spin * Vec3::UnitZ()};
    c.release_s = 0.0;
    c.start();
    c.run(3.0);
    const double expected = spin * spin * inertia / (2.0 * 0.5);
    // A first-order integrator may be off by one frame's rotation.
    EXPECT_NEAR(c.state().coordinate, expected, spin * k_frame_s);
    EXPECT_NEAR(c.state().speed, 0.0, 1e-12) << "friction holds what it stopped";
}

TEST(Joints, DetentDrivesAReleasedLeverToTheNearestRest) {
    Contraption c;
    make_lever(c, false);
    Joint& joint = c.scene.world.joint.at(c.joint);
    joint.detent_spacing = 0.5;
    joint.detent_strength = 2.0;
    c.hand_move = [](double t_s) {
        return Pose{Vec3::Zero(), rotation_about(Vec3::UnitZ(), 0.65 * ease(t_s, 0.3, 0.8))};
    };
    c.release_s = 1.0;
    c.start();
    c.run(0.99);
    EXPECT_NEAR(c.state().coordinate, 0.65, 1e-5) << "a hand is stronger";
    c.run(2.0);
    EXPECT_NEAR(c.state().coordinate, 0.5, 1e-3);
}

// A door of 80 cm hinged about y, with a handle near its free edge that unlocks it.
struct Door : Contraption {
    Entity handle_body;
    Entity handle_joint;

    Door() {
        add_free_body(Vec3(0.4, 0.9, 0.02), Vec3(0.4, 0.0, 0.0), 20.0);
        handle_body = scene.add_crate("handle", 0.5, Vec3(0.75, 0.0, 0.08), Vec3(0.06, 0.01, 0.01));
        Joint turn;
        turn.kind = JointKind::hinge;
        turn.a = thing;
        turn.b = handle_body;
        turn.limited = true;
        turn.lower = -0.8;
        turn.upper = 0.8;
        handle_joint = add_joint(
            scene.world,
            {"handle_joint",
             joint_at(scene.world, turn,
                      {Vec3(0.75, 0.0, 0.08), rotation_between(Vec3::UnitX(), Vec3::UnitZ())})});
        Joint settings;
        settings.kind = JointKind::hinge;
        settings.limited = true;
        settings.lower = -1.6;
        settings.upper = 0.0;
        settings.latch = {0.0, 0.02, 0.0, handle_joint, 0.5};
        add_joint_at(settings, Vec3::Zero(), Vec3::UnitY());
        handle = Vec3(0.75, 0.025, 0.08);
    }
};

TEST(Door, LatchedDoorActsAsAWall) {
    Door c;
    c.hand_move = [](double t_s) {
        return Pose{Vec3(0.0, 0.0, 0.2 * ease(t_s, 0.3, 1.0)), Quat::Identity()};
    };
    c.start();
    c.run(1.2);
    ASSERT_TRUE(c.holds());
    EXPECT_TRUE(c.state().latched);
    EXPECT_NEAR(c.state().coordinate, 0.0, 1e-5);
    EXPECT_NEAR(c.scene.origin().z(), -0.2, 1e-5);
}

TEST(Door, TurningTheHandleOpensTheLatchAndClosingLocksIt) {
    Door c;
    c.scene.world.joint_state.at(c.handle_joint).coordinate = 0.0;
    c.release_s = 0.0;
    c.start();
    c.run(0.1);
    EXPECT_TRUE(c.state().latched);
    // Turns the handle as a hand would, for three frames.
    const auto turn_handle = [&](double angle) {
        Pose& pose = c.scene.world.body_pose.at(c.handle_body).pose_ws;
        pose.rotation = rotation_about(Vec3::UnitZ(), angle);
    };
    turn_handle(0.6);
    c.run(0.02);
    EXPECT_FALSE(c.state().latched);
    c.scene.world.body_velocity.at(c.thing).angular_radps = -1.0 * Vec3::UnitY();
    c.run(0.2);
    EXPECT_LT(c.state().coordinate, -0.02);
    EXPECT_FALSE(c.state().latched);
    turn_handle(0.0);
    Pose& handle_pose = c.scene.world.body_pose.at(c.handle_body).pose_ws;
    handle_pose.rotation = c.scene.world.body_pose.at(c.thing).pose_ws.rotation;
    c.scene.world.body_velocity.at(c.thing).angular_radps = 1.0 * Vec3::UnitY();
    c.run(1.0);
    EXPECT_TRUE(c.state().latched);
    EXPECT_NEAR(c.state().coordinate, 0.0, 1e-6);
}

TEST(Door, ForceAboveItsStrengthOpensTheLatch) {
    for (const double strength_nm : {5.0, 50.0}) {
        Door c;
        c.scene.world.joint.at(c.joint).latch.strength = strength_nm;
        c.release_s = 0.0;
        c.start();
        c.run(0.1);
        ASSERT_TRUE(c.state().latched);
        // A spin of 0.05 rad/s that the latch must stop in one frame: I w / dt, I = m (2a)^2 / 3.
        const double torque = 20.0 * 0.8 * 0.8 / 3.0 * 0.05 / k_frame_s;
        EXPECT_GT(torque, 5.0);
        EXPECT_LT(torque, 50.0);
        c.scene.world.body_velocity.at(c.thing) = {Vec3(0.0, 0.0, 0.4 * 0.05),
                                                   -0.05 * Vec3::UnitY()};
        c.run(0.02);
        EXPECT_EQ(c.state().latched, strength_nm > torque);
        // The rest of the momentum keeps the door moving.
        c.run(0.5);
        EXPECT_EQ(c.state().latched, strength_nm > torque);
        const double slowed = strength_nm / torque;
        const double turned = slowed < 1.0 ? 0.5 * 0.05 * (1.0 - slowed) : 0.0;
        EXPECT_NEAR(std::abs(c.state().coordinate), turned, 0.1 * turned + 1e-6);
    }
}

TEST(Joints, SlackRopeActsOnlyAtItsLength) {
    Contraption c;
    c.add_free_body(Vec3(0.1, 0.1, 0.1), Vec3(0.5, 0.0, 0.0), 3.0);
    Joint settings;
    settings.kind = JointKind::distance;
    settings.upper = 1.0;
    settings.b = c.thing;
    c.joint = add_joint(c.scene.world, {"joint", settings});
    c.scene.world.body_velocity.at(c.thing).linear_mps = Vec3(1.0, 0.0, 0.0);
    c.release_s = 0.0;
    c.handle = Vec3(0.0, 3.0, 0.0);
    c.start();
    c.run(0.4);
    EXPECT_NEAR(c.scene.body_velocity(c.thing).x(), 1.0, 1e-9) << "free until it is taut";
    c.run(0.6);
    EXPECT_NEAR(c.scene.body(c.thing).position.x(), 1.0, 1e-3);
    EXPECT_LE(c.scene.body_velocity(c.thing).x(), 1e-9);
    EXPECT_LE(c.worst.m, 1e-6);
}

TEST(Joints, FixedBodiesShareTheirMomentum) {
    Contraption c;
    c.add_free_body(Vec3(0.1, 0.1, 0.1), Vec3(0.0, 0.0, 0.0), 1.0);
    const Entity other = c.scene.add_crate("other", 3.0, Vec3(0.4, 0.0, 0.0), Vec3(0.1, 0.1, 0.1));
    Joint settings;
    settings.kind = JointKind::fixed;
    settings.a = other;
    c.add_joint_at(settings, Vec3(0.2, 0.0, 0.0), Vec3::UnitX());
    c.scene.world.body_velocity.at(c.thing).linear_mps = Vec3(0.0, 0.0, 2.0);
    c.release_s = 0.0;
    c.handle = Vec3(0.0, 5.0, 0.0);
    c.start();
    c.run(2.0);
    const Vec3 momentum = 1.0 * c.scene.body_velocity(c.thing) + 3.0 * c.scene.body_velocity(other);
    EXPECT_LE((momentum - Vec3(0.0, 0.0, 2.0)).norm(), 1e-9);
    EXPECT_LE(c.worst.m, 1e-6);
    EXPECT_LE(c.worst.rad, 1e-4 * k_degree);
}

TEST(Joints, DestroyingABodyDestroysItsJoints) {
    Contraption c;
    make_lever(c);
    c.start();
    c.run(0.3);
    ASSERT_TRUE(c.holds());
    EXPECT_TRUE(destroy(c.scene.world, c.thing));
    EXPECT_TRUE(c.scene.world.joint.empty());
    c.scene.step();
    EXPECT_FALSE(c.holds());
}

}  // namespace
}  // namespace handhold::scenario_joints_test
