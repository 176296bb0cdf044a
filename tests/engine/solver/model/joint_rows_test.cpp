// Jacobians of joint rows against central differences; friction, motors and locks against closed
// forms.
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/engine/solver/scene.hpp"

namespace handhold::solver_joint_rows_test {
namespace {

using test::Random;

constexpr std::array k_joints = {RowKind::ball, RowKind::hinge, RowKind::slider, RowKind::fixed,
                                 RowKind::distance};

std::vector<SolverBody> two_random_bodies(Random& random) {
    return {test::random_free_body(1, random), test::random_free_body(2, random)};
}

// A satisfied joint, displaced along its free coordinate (rad or m; a ball is tilted by it).
RowBlock met_joint(RowKind kind, std::vector<SolverBody>& bodies, double displacement,
                   Random& random) {
    RowBlock block = test::random_block(kind, 0, 1, random);
    test::meet(bodies, block);
    const Quat frame = bodies[0].pose_ws.rotation * block.rotation_a_bs;
    const Vec3 axis = frame * Vec3::UnitX();
    Pose& b = bodies[1].pose_ws;
    const auto turn_b = [&](const Vec3& about) {
        const Vec3 point = transform_point(b, block.point_b_bs);
        b.rotation = (rotation_about(about, displacement) * b.rotation).normalized();
        b.position = point - b.rotation * block.point_b_bs;
    };
    if (kind == RowKind::hinge) {
        turn_b(axis);
    } else if (kind == RowKind::ball) {
        turn_b(frame * Vec3::UnitZ());
    } else if (kind == RowKind::slider || kind == RowKind::distance) {
        b.position += displacement * axis;
    }
    block.joint.limited = kind != RowKind::fixed;
    block.joint.lower = displacement - 0.05;
    block.joint.upper = displacement + 0.15;
    return block;
}

std::vector<SolverBody> nudged(std::vector<SolverBody> bodies, std::uint32_t body,
                               const Vec3& move_m, const Vec3& turn_rad) {
    Pose& pose = bodies[body].pose_ws;
    pose.position += move_m;
    pose.rotation = (rotation_from_vector(turn_rad) * pose.rotation).normalized();
    return bodies;
}

RC_GTEST_PROP(JointRows, JacobianEqualsFiniteDifferencesAtTheSolution, (std::uint64_t seed)) {
    Random random(seed);
    for (const RowKind kind : k_joints) {
        std::vector<SolverBody> bodies = two_random_bodies(random);
        const RowBlock block = met_joint(kind, bodies, random.between(0.3, 1.2), random);
        const Vec3 move = random.vector(1.0);
        const Vec3 turn = random.vector(1.0);
        const std::uint32_t moved = random.between(0.0, 1.0) < 0.5 ? 0 : 1;
        constexpr double k_step = 1e-5;
        std::vector<Row> rows;
        std::vector<Row> ahead;
        std::vector<Row> behind;
        append_rows(bodies, block, 0, rows);
        append_rows(nudged(bodies, moved, k_step * move, k_step * turn), block, 0, ahead);
        append_rows(nudged(bodies, moved, -k_step * move, -k_step * turn), block, 0, behind);
        RC_ASSERT(rows.size() == ahead.size());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const double slope = (ahead[i].residual - behind[i].residual) / (2.0 * k_step);
            const Row& row = rows[i];
            const double claimed = moved == 0 ? row.linear_a.dot(move) + row.angular_a.dot(turn)
                                              : row.angular_b.dot(turn) - row.linear_a.dot(move);
            RC_ASSERT(std::abs(slope - claimed) < 1e-7);
        }
    }
}

RC_GTEST_PROP(JointRows, CoordinateEqualsTheJointsDisplacement, (std::uint64_t seed)) {
    Random random(seed);
    for (const RowKind kind : k_joints) {
        std::vector<SolverBody> bodies = two_random_bodies(random);
        const double displacement = random.between(0.1, 3.0);
        const RowBlock block = met_joint(kind, bodies, displacement, random);
        const JointError error = joint_error(bodies, block);
        RC_ASSERT(error.point_m < 1e-12 && error.angle_rad < 1e-7);
        if (kind != RowKind::fixed) {
            RC_ASSERT(std::abs(joint_coordinate(bodies, block) - displacement) < 1e-9);
        }
    }
}

// Oracle: central difference of the coordinate over time.
RC_GTEST_PROP(JointRows, SpeedIsTheTimeDerivativeOfTheCoordinate, (std::uint64_t seed)) {
    Random random(seed);
    for (const RowKind kind : {RowKind::hinge, RowKind::slider, RowKind::distance}) {
        std::vector<SolverBody> bodies = two_random_bodies(random);
        const RowBlock block = met_joint(kind, bodies, random.between(0.3, 1.2), random);
        bodies[0].velocity_mps = random.vector(1.0);
        bodies[1].velocity_mps = random.vector(1.0);
        bodies[0].spin_radps = random.vector(1.0);
        bodies[1].spin_radps = random.vector(1.0);
        if (kind == RowKind::hinge) {
            // a hinge transmits all rotation across its axis
            const Vec3 axis = bodies[0].pose_ws.rotation * (block.rotation_a_bs * Vec3::UnitX());
            bodies[1].spin_radps = bodies[0].spin_radps + random.between(-1.0, 1.0) * axis;
        }
        const auto coordinate_after = [&](double dt_s) {
            std::vector<SolverBody> later = bodies;
            for (std::uint32_t i = 0; i < 2; ++i) {
                later =
                    nudged(later, i, dt_s * bodies[i].velocity_mps, dt_s * bodies[i].spin_radps);
            }
            return joint_coordinate(later, block);
        };
        const double rate = (coordinate_after(1e-5) - coordinate_after(-1e-5)) / 2e-5;
        RC_ASSERT(std::abs(rate - joint_speed(bodies, block)) < 1e-7);
    }
}

TEST(JointRows, HingeAngleContinuesOverWholeTurns) {
    Random random(3);
    for (const double before : {-20.0, -3.0, 0.0, 7.5, 100.0}) {
        std::vector<SolverBody> bodies = two_random_bodies(random);
        RowBlock block = met_joint(RowKind::hinge, bodies, 1.0, random);
        block.joint.previous = before;
        const double coordinate = joint_coordinate(bodies, block);
        EXPECT_LE(std::abs(coordinate - before), k_pi + 1e-9);
        EXPECT_NEAR(std::remainder(coordinate - 1.0, 2.0 * k_pi), 0.0, 1e-9);
    }
}

TEST(JointRows, DistantLimitsHaveNoRowAndALockHasOne) {
    Random random(4);
    std::vector<SolverBody> bodies = two_random_bodies(random);
    RowBlock block = met_joint(RowKind::slider, bodies, 0.5, random);
    const auto count = [&](double reach_m) {
        std::vector<Row> rows;
        append_rows(bodies, block, 0, rows, reach_m);
        return rows.size();
    };
    EXPECT_EQ(count(0.01), 5U);
    EXPECT_EQ(count(0.1), 6U);
    EXPECT_EQ(count(1.0), 7U);
    block.joint.lower = block.joint.upper = 0.5;
    EXPECT_EQ(count(0.01), 6U);
}

// From a metre away, every joint converges within its limits, and the centre of mass is unchanged.
// A distance joint whose points are close together may need more than 30 iterations (1 in 800 of
// the others' starts), so it starts closer, still farther than a frame ever moves.
RC_GTEST_PROP(JointRows, EveryJointConvergesFromAMetreAway, (std::uint64_t seed)) {
    Random random(seed);
    for (const RowKind kind : k_joints) {
        test::SolverScene scene;
        scene.graph.bodies = two_random_bodies(random);
        RowBlock block = met_joint(kind, scene.graph.bodies, random.between(0.3, 1.2), random);
        Pose& pose = scene.body(1).pose_ws;
        const double scale = kind == RowKind::distance ? 0.4 : 1.0;
        pose.position += random.vector(0.5 * scale);
        pose.rotation =
            (rotation_from_vector(random.vector(0.6 * scale)) * pose.rotation).normalized();
        scene.graph.blocks.push_back(block);
        const auto centre = [&]() -> Vec3 {
            return scene.body(0).mass_kg * scene.body(0).pose_ws.position +
                   scene.body(1).mass_kg * scene.body(1).pose_ws.position;
        };
        const Vec3 before = centre();
        const NewtonResult result = scene.solve_positions();
        RC_ASSERT(result.converged);
        RC_ASSERT(joint_error(scene.graph.bodies, scene.block(0)).point_m < 2e-7);
        RC_ASSERT((centre() - before).norm() < 1e-9);
    }
}

// --- Friction and restitution against closed forms -----------------------------------------------

constexpr double k_radius_m = 0.1;
constexpr double k_mass_kg = 2.0;

// A solid ball that touches a floor (y = 0), with oblique velocity and spin.
test::SolverScene ball_on_floor(double friction, double restitution, const Vec3& velocity_mps,
                                const Vec3& spin_radps) {
    test::SolverScene scene;
    scene.graph.bodies = {
        test::fixed_body(1),
        test::ball(2, k_mass_kg, k_radius_m, {Vec3(0.3, k_radius_m, -0.2), Quat::Identity()})};
    scene.body(1).velocity_mps = velocity_mps;
    scene.body(1).spin_radps = spin_radps;
    RowBlock contact =
        test::row_block(RowKind::contact, 1, 0, Vec3(0.0, -k_radius_m, 0.0), Vec3(0.3, 0.0, -0.2));
    contact.friction = friction;
    contact.restitution = restitution;
    scene.graph.blocks.push_back(contact);
    return scene;
}

// Closed form: normal impulse m (1 + e) v_n. Tangential impulse: 2/7 m u (u: slip velocity), which
// stops the contact point of a solid ball, but at most mu times the normal impulse.
RC_GTEST_PROP(Friction, BouncingBallFollowsCoulombAndNewton, (std::uint64_t seed)) {
    Random random(seed);
    const double friction = random.between(0.01, 1.5);
    const double restitution = random.between(0.0, 1.0);
    const Vec3 velocity{random.between(-3.0, 3.0), random.between(-4.0, -0.3),
                        random.between(-3.0, 3.0)};
    const Vec3 spin = random.vector(20.0);
    test::SolverScene scene = ball_on_floor(friction, restitution, velocity, spin);
    const Vec3 arm(0.0, -k_radius_m, 0.0);
    Vec3 slip = velocity + spin.cross(arm);
    slip.y() = 0.0;
    const double normal = k_mass_kg * (1.0 + restitution) * -velocity.y();
    const double sticking = 2.0 / 7.0 * k_mass_kg * slip.norm();
    const Vec3 along = -slip.normalized() * std::min(sticking, friction * normal);
    const Vec3 impulse = along + Vec3(0.0, normal, 0.0);
    const double inertia = 0.4 * k_mass_kg * k_radius_m * k_radius_m;
    scene.solve_velocities();
    RC_ASSERT((scene.body(1).velocity_mps - (velocity + impulse / k_mass_kg)).norm() < 1e-6);
    RC_ASSERT((scene.body(1).spin_radps - (spin + arm.cross(impulse) / inertia)).norm() < 1e-5);
}

TEST(Friction, ZeroFrictionKeepsTangentialVelocity) {
    test::SolverScene scene = ball_on_floor(0.0, 0.5, Vec3(1.0, -2.0, 0.5), Vec3(1.0, 2.0, 3.0));
    scene.solve_velocities();
    EXPECT_LE((scene.body(1).velocity_mps - Vec3(1.0, 1.0, 0.5)).norm(), 1e-7);
    EXPECT_LE((scene.body(1).spin_radps - Vec3(1.0, 2.0, 3.0)).norm(), 1e-9);
}

// A wheel of 0.5 kg m^2 on a hinge along x, on a fixed body.
test::SolverScene spinning_wheel(double spin_radps) {
    test::SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1), test::free_body(2, 3.0, Vec3(0.5, 0.4, 0.3))};
    scene.body(1).spin_radps = Vec3(spin_radps, 0.0, 0.0);
    scene.graph.blocks.push_back(test::row_block(RowKind::hinge, 0, 1));
    return scene;
}

TEST(Friction, HingeFrictionIsLimitedToItsImpulse) {
    for (const double impulse : {0.01, 0.2, 10.0}) {
        test::SolverScene scene = spinning_wheel(1.0);
        JointRows& hinge = scene.block(0).joint;
        hinge.friction_impulse = impulse;
        scene.solve_velocities();
        EXPECT_NEAR(scene.body(1).spin_radps.x(), std::max(0.0, 1.0 - impulse / 0.5), 1e-7);
    }
}

TEST(Friction, MotorReachesItsSpeedWithinItsImpulse) {
    for (const double impulse : {0.1, 10.0}) {
        test::SolverScene scene;
        scene.graph.bodies = {test::fixed_body(1), test::free_body(2, 4.0, Vec3::Constant(0.4))};
        RowBlock slider = test::row_block(RowKind::slider, 0, 1);
        slider.joint.motor_target = 0.05;
        slider.joint.motor_time_s = 0.1;
        slider.joint.motor_max_impulse = impulse;
        scene.graph.blocks.push_back(slider);
        scene.solve_velocities();
        EXPECT_NEAR(scene.body(1).velocity_mps.x(), std::min(0.5, impulse / 4.0), 1e-7);
    }
}

TEST(JointRows, LockYieldsAtItsLimitImpulse) {
    for (const double strength : {0.25, 0.75, 1.5}) {
        test::SolverScene scene = spinning_wheel(2.0);
        JointRows& hinge = scene.block(0).joint;
        hinge.limited = true;
        hinge.lock_limit_impulse = strength;
        scene.solve_velocities();
        EXPECT_NEAR(scene.block(0).joint.lock_impulse, std::min(strength, 1.0), 1e-6);
        EXPECT_NEAR(scene.body(1).spin_radps.x(), std::max(0.0, 2.0 - strength / 0.5), 1e-6);
    }
}

// A body passing through the cone's centre must not be stopped there.
TEST(JointRows, ConeLimitDoesNotActAtItsCentre) {
    test::SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1), test::free_body(2, 3.0, Vec3(0.5, 0.4, 0.3))};
    RowBlock ball = test::row_block(RowKind::ball, 0, 1);
    ball.joint.limited = true;
    ball.joint.upper = 0.8;
    scene.graph.blocks.push_back(ball);
    for (const Vec3& axis : {Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ()), Vec3(-Vec3::UnitY())}) {
        scene.body(1).spin_radps = 0.05 * axis;
        scene.solve_velocities();
        EXPECT_NEAR((scene.body(1).spin_radps - 0.05 * axis).norm(), 0.0, 1e-9);
    }
}

TEST(JointRows, LockReportsItsImpulse) {
    test::SolverScene scene = spinning_wheel(2.0);
    scene.block(0).joint.limited = true;
    scene.solve_velocities();
    EXPECT_NEAR(scene.block(0).joint.lock_impulse, 0.5 * 2.0, 1e-6);
    EXPECT_NEAR(scene.body(1).spin_radps.x(), 0.0, 1e-7);
}

}  // namespace
}  // namespace handhold::solver_joint_rows_test
