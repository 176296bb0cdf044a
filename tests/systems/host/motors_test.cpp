// Motors, limits and friction of joints that a host changes after their creation.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>

#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_motors_test {
namespace {

using namespace test;

constexpr double k_mass_kg = 2.0;

// A cube of 0.2 m and 2 kg on a joint of the world, whose axis is the world's x axis (hinge,
// slider) or, with `is_upright`, its y axis.
struct Machine {
    HostScene scene;
    hh::Body cube{};
    hh::Joint joint{};

    explicit Machine(hh_joint_kind kind, bool is_upright = false) {
        cube = *scene.world.add(crate(scene.world, {5.0, 5.0, 0.0}));
        hh_joint_def def = hh::joint_def();
        def.kind = kind;
        def.body_b = cube;
        def.frame = hh::pose_at({5.0, 5.0, 0.0});
        if (is_upright) {
            const double half = std::sqrt(0.5);
            def.frame.rotation = {0.0, 0.0, half, half};
        }
        joint = *scene.world.add(def);
    }
    hh_result drive(hh_motor_kind kind, double number, double strength) {
        hh_motor_def motor = hh_default_motor_def();
        motor.kind = kind;
        motor.speed = motor.position = number;
        motor.strength = strength;
        return hh_joint_set_motor(scene.world.get(), joint, &motor);
    }
    double coordinate() const {
        double value = 0.0;
        EXPECT_EQ(hh_joint_state(scene.world.get(), joint, &value, nullptr, nullptr), HH_OK);
        return value;
    }
    double speed() const {
        double value = 0.0;
        EXPECT_EQ(hh_joint_state(scene.world.get(), joint, nullptr, &value, nullptr), HH_OK);
        return value;
    }
};

// A limited force F on a mass m gives v = F t / m until the wanted speed is reached.
TEST(JointMotors, SpeedOfASliderGrowsWithForceOverMass) {
    for (const double wanted : {1.0, -1.0}) {
        Machine machine(HH_SLIDER);
        ASSERT_EQ(machine.drive(HH_MOTOR_SPEED, wanted, 4.0), HH_OK);
        for (int step = 1; step <= 90; ++step) {
            machine.scene.step();
            const double fastest = std::min(4.0 / k_mass_kg * step * k_step_s, 1.0);
            ASSERT_NEAR(machine.speed(), std::copysign(fastest, wanted), 1e-9) << step;
        }
        ASSERT_EQ(machine.drive(HH_MOTOR_NONE, 0.0, 0.0), HH_OK);
        machine.scene.step(10);
        EXPECT_NEAR(machine.speed(), wanted, 1e-9) << "nothing brakes it";
    }
}

// A cube of side s has the inertia m s^2 / 6.
TEST(JointMotors, SpeedOfAHingeGrowsWithTorqueOverInertia) {
    Machine machine(HH_HINGE);
    ASSERT_EQ(machine.drive(HH_MOTOR_SPEED, 3.0, 0.02), HH_OK);
    const double inertia_kgm2 = k_mass_kg * 0.2 * 0.2 / 6.0;
    for (int step = 1; step <= 200; ++step) {
        machine.scene.step();
        const double wanted = std::min(0.02 / inertia_kgm2 * step * k_step_s, 3.0);
        ASSERT_NEAR(machine.speed(), wanted, 1e-6) << step;
    }
}

TEST(JointMotors, FrictionActsAgainstTheMotor) {
    Machine machine(HH_SLIDER);
    ASSERT_TRUE(machine.scene.world.set_friction(machine.joint, 3.0));
    ASSERT_EQ(machine.drive(HH_MOTOR_SPEED, 1.0, 4.0), HH_OK);
    machine.scene.step(45);
    EXPECT_NEAR(machine.speed(), (4.0 - 3.0) / k_mass_kg * 45 * k_step_s, 1e-6);
    ASSERT_EQ(machine.drive(HH_MOTOR_SPEED, 1.0, 2.0), HH_OK);
    machine.scene.step(90);
    EXPECT_NEAR(machine.speed(), 0.0, 1e-9) << "friction is stronger";
}

// Below its strength a position motor is stiff; above it the load falls with g - F / m.
TEST(JointMotors, PositionHoldsALoadUpToItsStrength) {
    constexpr double k_gravity_mps2 = 9.81;
    for (const double strength_n : {30.0, 10.0}) {
        Machine machine(HH_SLIDER, true);
        ASSERT_EQ(hh_world_set_gravity(machine.scene.world.get(), {0.0, -k_gravity_mps2, 0.0}),
                  HH_OK);
        ASSERT_EQ(machine.drive(HH_MOTOR_POSITION, 0.3, strength_n), HH_OK);
        machine.scene.step(180);
        if (strength_n > k_gravity_mps2 * k_mass_kg) {
            EXPECT_NEAR(machine.coordinate(), 0.3, 1e-6);
        } else {
            const double fall_mps2 = k_gravity_mps2 - strength_n / k_mass_kg;
            EXPECT_NEAR(machine.speed(), -fall_mps2 * 180 * k_step_s, 1e-6);
        }
    }
}

// A lift moves at its speed also under a load.
TEST(JointMotors, SpeedHoldsUnderGravity) {
    for (const double wanted_mps : {0.5, -0.5}) {
        Machine machine(HH_SLIDER, true);
        ASSERT_EQ(hh_world_set_gravity(machine.scene.world.get(), {0.0, -9.81, 0.0}), HH_OK);
        ASSERT_EQ(machine.drive(HH_MOTOR_SPEED, wanted_mps, 100.0), HH_OK);
        machine.scene.step(10);
        const double before_m = machine.coordinate();
        machine.scene.step(90);
        EXPECT_NEAR(machine.coordinate() - before_m, wanted_mps * 90 * k_step_s, 1e-6);
    }
}

// An arm whose weight has a lever: m g r = 5.9 N m.
TEST(JointMotors, AHingeHoldsAnArmLevel) {
    HostScene scene;
    hh_world* const world = scene.world.get();
    ASSERT_EQ(hh_world_set_gravity(world, {0.0, -9.81, 0.0}), HH_OK);
    hh_joint_def def = hh::joint_def();
    def.kind = HH_HINGE;
    def.body_b = *scene.world.add(crate(scene.world, {5.0, 5.0, 0.3}));
    def.frame = hh::pose_at({5.0, 5.0, 0.0});
    const hh::Joint joint = *scene.world.add(def);
    hh_motor_def motor = hh_default_motor_def();
    motor.kind = HH_MOTOR_POSITION;
    motor.position = -0.4;
    motor.strength = 40.0;
    ASSERT_EQ(hh_joint_set_motor(world, joint, &motor), HH_OK);
    scene.step(270);
    double angle_rad = 0.0;
    ASSERT_EQ(hh_joint_state(world, joint, &angle_rad, nullptr, nullptr), HH_OK);
    EXPECT_NEAR(angle_rad, -0.4, 1e-6);
    motor.strength = 2.0;  // too weak: it falls
    ASSERT_EQ(hh_joint_set_motor(world, joint, &motor), HH_OK);
    scene.step(60);
    ASSERT_EQ(hh_joint_state(world, joint, &angle_rad, nullptr, nullptr), HH_OK);
    EXPECT_GT(angle_rad, 0.0);
}

TEST(JointMotors, AreRefusedForOtherJointsAndNumbers) {
    Machine ball(HH_BALL);
    EXPECT_EQ(ball.drive(HH_MOTOR_SPEED, 1.0, 1.0), HH_ERROR_VALUE);
    Machine machine(HH_HINGE);
    EXPECT_EQ(machine.drive(HH_MOTOR_SPEED, std::nan(""), 1.0), HH_ERROR_VALUE);
    EXPECT_EQ(machine.drive(HH_MOTOR_SPEED, 1.0, -1.0), HH_ERROR_VALUE);
    EXPECT_EQ(machine.drive(static_cast<hh_motor_kind>(7), 1.0, 1.0), HH_ERROR_VALUE);
    machine.scene.step(5);
    EXPECT_EQ(machine.speed(), 0.0);
}

TEST(JointMotors, ArePartOfTheState) {
    Machine machine(HH_SLIDER);
    hh::World& world = machine.scene.world;
    const std::uint64_t before = world.hash();
    ASSERT_EQ(machine.drive(HH_MOTOR_SPEED, 1.0, 4.0), HH_OK);
    EXPECT_NE(world.hash(), before);
    machine.scene.step(10);
    std::vector<std::byte> saved;
    ASSERT_TRUE(world.save(saved));
    machine.scene.step(20);
    const std::uint64_t after = world.hash();
    ASSERT_EQ(machine.drive(HH_MOTOR_NONE, 0.0, 0.0), HH_OK);
    ASSERT_TRUE(world.restore(saved));
    machine.scene.step(20);
    EXPECT_EQ(world.hash(), after);
}

TEST(JointLimits, ChangeAfterCreation) {
    Machine machine(HH_SLIDER);
    hh_world* const world = machine.scene.world.get();
    ASSERT_EQ(machine.drive(HH_MOTOR_SPEED, 1.0, 100.0), HH_OK);
    ASSERT_EQ(hh_joint_set_limits(world, machine.joint, 1, -0.1, 0.25), HH_OK);
    machine.scene.step(90);
    EXPECT_NEAR(machine.coordinate(), 0.25, 1e-6);
    ASSERT_EQ(hh_joint_set_limits(world, machine.joint, 1, 0.1, 0.1), HH_OK);
    machine.scene.step(30);
    EXPECT_NEAR(machine.coordinate(), 0.1, 1e-6) << "equal limits lock it";
    EXPECT_EQ(hh_joint_set_limits(world, machine.joint, 1, 0.2, 0.1), HH_ERROR_VALUE);
    machine.scene.step(30);
    EXPECT_NEAR(machine.coordinate(), 0.1, 1e-6);
    ASSERT_EQ(hh_joint_set_limits(world, machine.joint, 0, 0.0, 0.0), HH_OK);
    machine.scene.step(90);
    EXPECT_GT(machine.coordinate(), 0.9);
}

TEST(JointLimits, LatchesAreAddedAndTakenAway) {
    Machine machine(HH_SLIDER);
    ASSERT_TRUE(machine.scene.world.set_latch(machine.joint, 0.0, 0.01));
    machine.scene.step(2);
    ASSERT_EQ(machine.drive(HH_MOTOR_SPEED, 1.0, 50.0), HH_OK);
    machine.scene.step(30);
    EXPECT_NEAR(machine.coordinate(), 0.0, 1e-6);
    ASSERT_TRUE(machine.scene.world.set_latch(machine.joint, 0.0, 0.0));
    machine.scene.step(30);
    EXPECT_GT(machine.coordinate(), 0.2);
}

}  // namespace
}  // namespace handhold::host_motors_test
