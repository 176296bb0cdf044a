#include "systems/physics/predict_bodies.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/systems/frame/column_scene.hpp"

namespace handhold::predict_bodies_test {
namespace {

using test::entity;
using test::Random;

constexpr Entity k_body = entity(1);
constexpr Entity k_player = entity(2);

struct Prediction {
    Column<RigidBody> body;
    Column<PlayerVelocity> player_velocity;
    Column<BodyPose> body_pose;
    Column<BodyStart> body_start;
    Column<BodyVelocity> body_velocity;
    Column<PlayerOrigin> origin;
    Column<PlayerStart> player_start;
    Column<GravityScale> gravity_scale;

    void add_body(Entity entity, BodyKind kind, const Vec3& inertia_kgm2, const Pose& pose,
                  const BodyVelocity& velocity) {
        body.add(entity, {kind, 2.0, inertia_kgm2, 0.0});
        body_pose.add(entity, {pose});
        body_start.add(entity);
        body_velocity.add(entity, velocity);
    }
    Pose& pose() { return body_pose.at(k_body).pose_ws; }
    Vec3& spin() { return body_velocity.at(k_body).angular_radps; }
    void run(double dt_s) {
        predict_bodies({.dt_s = dt_s,
                        .gravity_mps2 = Vec3::Zero(),
                        .gravity_scale = gravity_scale,
                        .body = body,
                        .player_velocity = player_velocity,
                        .body_pose = body_pose,
                        .body_start = body_start,
                        .body_velocity = body_velocity,
                        .origin = origin,
                        .player_start = player_start});
    }
};

Vec3 angular_momentum(const Prediction& scene) {
    const Quat& rotation = scene.body_pose.at(k_body).pose_ws.rotation;
    const Vec3 spin_bs = rotation.conjugate() * scene.body_velocity.at(k_body).angular_radps;
    return rotation * Vec3(scene.body.at(k_body).inertia_kgm2.cwiseProduct(spin_bs));
}

TEST(PredictBodies, FreeBodiesAndPlayersMoveByTheirVelocity) {
    Prediction scene;
    const Pose start{Vec3(1.0, 2.0, 3.0), rotation_about(Vec3::UnitX(), 0.3)};
    scene.add_body(k_body, BodyKind::free, Vec3(0.1, 0.2, 0.3), start,
                   {Vec3(2.0, 0.0, -1.0), Vec3::Zero()});
    scene.origin.add(k_player, {start});
    scene.player_start.add(k_player);
    scene.player_velocity.add(k_player, {Vec3(0.0, 4.0, 0.0)});
    scene.run(0.5);
    EXPECT_EQ(scene.pose().position, Vec3(2.0, 2.0, 2.5));
    EXPECT_EQ(scene.pose().rotation.coeffs(), start.rotation.coeffs());
    EXPECT_EQ(scene.body_start.at(k_body).pose_ws.position, start.position);
    EXPECT_EQ(scene.origin.at(k_player).pose_ws.position, Vec3(1.0, 4.0, 3.0));
    EXPECT_EQ(scene.origin.at(k_player).pose_ws.rotation.coeffs(), start.rotation.coeffs());
    EXPECT_EQ(scene.player_start.at(k_player).pose_ws.position, start.position);
}

TEST(PredictBodies, FixedAndKinematicBodiesStayBitForBit) {
    for (const BodyKind kind : {BodyKind::fixed, BodyKind::kinematic}) {
        Prediction scene;
        const Pose start{Vec3(1.0, 2.0, 3.0), rotation_about(Vec3::UnitX(), 0.3)};
        scene.add_body(k_body, kind, Vec3::Zero(), start,
                       {Vec3(2.0, 0.0, -1.0), Vec3(1.0, 1.0, 1.0)});
        scene.run(0.5);
        EXPECT_EQ(scene.pose().position, start.position);
        EXPECT_EQ(scene.pose().rotation.coeffs(), start.rotation.coeffs());
        EXPECT_EQ(scene.body_start.at(k_body).pose_ws.position,
                  Vec3(Vec3::Zero()));  // written by animate_movers
    }
}

RC_GTEST_PROP(PredictBodies, AngularMomentumIsConservedForAnyStep, (std::uint64_t seed)) {
    Random random(seed);
    Prediction scene;
    const Vec3 inertia{random.between(0.05, 1.0), random.between(0.05, 1.0),
                       random.between(0.05, 1.0)};
    const Pose pose = random.pose();
    scene.add_body(k_body, BodyKind::free, inertia, pose,
                   {random.vector(1.0), random.vector(10.0)});
    const Vec3 before = angular_momentum(scene);
    const double dt_s = random.between(0.001, 0.05);
    for (int frame = 0; frame < 100; ++frame) {
        scene.run(dt_s);
    }
    RC_ASSERT((angular_momentum(scene) - before).norm() < 1e-12 * before.norm());
    RC_ASSERT(std::abs(scene.pose().rotation.norm() - 1.0) < 1e-14);
}

TEST(PredictBodies, SpinAboutAPrincipalAxisIsSteady) {
    Prediction scene;
    scene.add_body(k_body, BodyKind::free, Vec3(0.1, 0.2, 0.3), {},
                   {Vec3::Zero(), Vec3(0.0, 0.0, 4.0)});
    for (int frame = 0; frame < 90; ++frame) {
        scene.run(1.0 / 90.0);
    }
    EXPECT_LT((scene.spin() - Vec3(0.0, 0.0, 4.0)).norm(), 1e-13);
    EXPECT_LT(test::angle_between(scene.pose().rotation, rotation_about(Vec3::UnitZ(), 4.0)),
              1e-12);
}

// A symmetric top, I1 = I2 < I3, spinning obliquely: its axis precesses about the angular momentum
// L at |L| / I1 (Landau and Lifshitz, Mechanics, 33). Returns the axis's error after one second.
double precession_error(double hz) {
    constexpr double k_across = 0.2;
    constexpr double k_along = 0.35;
    Prediction scene;
    const Vec3 spin(3.0, 0.0, 5.0);
    scene.add_body(k_body, BodyKind::free, Vec3(k_across, k_across, k_along), {},
                   {Vec3::Zero(), spin});
    const Vec3 momentum = angular_momentum(scene);
    const auto frames = static_cast<int>(std::lround(hz));
    for (int frame = 0; frame < frames; ++frame) {
        scene.run(1.0 / hz);
    }
    const Quat precession = rotation_about(momentum.normalized(), momentum.norm() / k_across);
    return (scene.pose().rotation * Vec3::UnitZ() - precession * Vec3::UnitZ()).norm();
}

TEST(PredictBodies, SymmetricTopPrecessesAtTheAnalyticRateForAnyStep) {
    EXPECT_LT(precession_error(10.0), 1e-12);
    EXPECT_LT(precession_error(90.0), 1e-12);
}

double energy(const Prediction& scene) {
    const Quat& rotation = scene.body_pose.at(k_body).pose_ws.rotation;
    const Vec3 spin_bs = rotation.conjugate() * scene.body_velocity.at(k_body).angular_radps;
    return 0.5 * spin_bs.cwiseProduct(spin_bs).dot(scene.body.at(k_body).inertia_kgm2);
}

// One second of tumbling about the intermediate axis, which is unstable.
Prediction tumble(double hz, const Vec3& inertia_kgm2, const Vec3& spin_radps) {
    Prediction scene;
    scene.add_body(k_body, BodyKind::free, inertia_kgm2, {}, {Vec3::Zero(), spin_radps});
    const auto frames = static_cast<int>(std::lround(hz));
    for (int frame = 0; frame < frames; ++frame) {
        scene.run(1.0 / hz);
    }
    return scene;
}

TEST(PredictBodies, ErrorOfATumbleFallsWithTheSquareOfTheStep) {
    const Vec3 inertia(0.1, 0.2, 0.28);
    const Vec3 spin(0.3, 6.0, 0.2);
    const Quat exact = tumble(20000.0, inertia, spin).pose().rotation;
    const double coarse = test::angle_between(tumble(90.0, inertia, spin).pose().rotation, exact);
    const double fine = test::angle_between(tumble(180.0, inertia, spin).pose().rotation, exact);
    EXPECT_LT(coarse, 0.01);
    EXPECT_NEAR(coarse / fine, 4.0, 0.4);
}

// A screwdriver torn into a spin must not gain energy: the midpoint rule took this one from 50 to
// 400 rad/s within ten frames.
TEST(PredictBodies, FastTumbleOfALongBodyKeepsItsEnergy) {
    Prediction scene;
    scene.add_body(k_body, BodyKind::free, Vec3(2e-5, 8e-4, 8.1e-4), {},
                   {Vec3::Zero(), Vec3(20.0, 150.0, 40.0)});
    const double before = energy(scene);
    Random random(3);
    for (int frame = 0; frame < 20000; ++frame) {
        scene.run(random.between(0.001, 0.1));
        ASSERT_NEAR(energy(scene) / before, 1.0, 0.05) << "frame " << frame;
    }
}

// Even a damaged state must leave the pose valid.
TEST(PredictBodies, ExcessiveSpinKeepsThePoseValid) {
    for (const double spin : {1e6, 1e200, 1.7e308}) {
        Prediction scene;
        scene.add_body(k_body, BodyKind::free, Vec3(0.1, 0.2, 0.3), {},
                       {Vec3::Zero(), Vec3(spin, 0.0, spin)});
        scene.run(0.1);
        EXPECT_EQ(scene.pose().rotation.coeffs(), Quat::Identity().coeffs());
    }
}

TEST(PredictBodies, ResultDoesNotDependOnTheOrderOfBodies) {
    Random random(7);
    const Pose one = random.pose();
    const Pose two = random.pose();
    const BodyVelocity spin{Vec3(1.0, 0.0, 0.0), Vec3(1.0, 2.0, 3.0)};
    Prediction forth;
    forth.add_body(k_body, BodyKind::free, Vec3(0.1, 0.2, 0.3), one, spin);
    forth.add_body(entity(5), BodyKind::free, Vec3(0.3, 0.2, 0.3), two, spin);
    Prediction back;
    back.add_body(entity(5), BodyKind::free, Vec3(0.3, 0.2, 0.3), two, spin);
    back.add_body(k_body, BodyKind::free, Vec3(0.1, 0.2, 0.3), one, spin);
    forth.run(0.01);
    back.run(0.01);
    for (const Entity body : {k_body, entity(5)}) {
        EXPECT_EQ(forth.body_pose.at(body).pose_ws.position,
                  back.body_pose.at(body).pose_ws.position);
        EXPECT_EQ(forth.body_pose.at(body).pose_ws.rotation.coeffs(),
                  back.body_pose.at(body).pose_ws.rotation.coeffs());
    }
}

RC_GTEST_PROP(PredictBodies, RotatedWorldTumblesTheSame, (std::uint64_t seed)) {
    Random random(seed);
    const Pose start = random.pose();
    const BodyVelocity velocity{random.vector(2.0), random.vector(6.0)};
    const Pose moved = random.pose(1e3);
    Prediction here;
    Prediction there;
    here.add_body(k_body, BodyKind::free, Vec3(0.1, 0.2, 0.3), start, velocity);
    there.add_body(k_body, BodyKind::free, Vec3(0.1, 0.2, 0.3), moved * start,
                   {moved.rotation * velocity.linear_mps, moved.rotation * velocity.angular_radps});
    for (int frame = 0; frame < 30; ++frame) {
        here.run(1.0 / 90.0);
        there.run(1.0 / 90.0);
    }
    RC_ASSERT(
        (inverse_transform_point(moved, there.pose().position) - here.pose().position).norm() <
        1e-10);
    RC_ASSERT((moved.rotation.conjugate() * there.spin() - here.spin()).norm() < 1e-11);
}

}  // namespace
}  // namespace handhold::predict_bodies_test
