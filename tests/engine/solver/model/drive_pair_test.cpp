// Two drives on one free body, as rows: the first drive's point, and the rotation that follows from
// both.
#include "engine/solver/model/drive_pair.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/engine/solver/scene.hpp"

namespace handhold::solver_drive_pair_test {
namespace {

using test::Random;
using test::SolverScene;

double angle_between(const Quat& a, const Quat& b) {
    return rotation_to_vector((a.conjugate() * b).normalized()).norm();
}

// The distances of the drives and of the anchors differ.
DrivePair random_drives(Random& random) {
    DrivePair drives;
    for (Pose* const pose : {&drives.first, &drives.first_anchor_bs}) {
        *pose = test::random_pose(random, 0.5);
    }
    drives.second = {drives.first.position + random.arm(0.04, 1.2), random.rotation()};
    drives.second_anchor_bs = {drives.first_anchor_bs.position + random.arm(0.04, 1.2),
                               random.rotation()};
    return drives;
}

Vec3 line_of(const DrivePair& drives) {
    return (drives.second.position - drives.first.position).normalized();
}
Vec3 line_bs(const DrivePair& drives) {
    return (drives.second_anchor_bs.position - drives.first_anchor_bs.position).normalized();
}

// Rotates the drives about the line by the twists, and out of it by at most `swing_rad`, from the
// poses at which `body` has the anchors.
void rotate_drives(DrivePair& drives, const Quat& body, const Vec3& twists_rad, double swing_rad,
                   Random& random) {
    const Vec3 line = line_of(drives);
    const auto turned = [&](const Quat& anchor_bs, double twist_rad) {
        const Vec3 across = line.cross(random.direction()).normalized();
        const Quat swing = rotation_about(across, random.between(0.0, swing_rad));
        return (swing * rotation_about(line, twist_rad) * body * anchor_bs).normalized();
    };
    drives.first.rotation = turned(drives.first_anchor_bs.rotation, twists_rad.x());
    drives.second.rotation = turned(drives.second_anchor_bs.rotation, twists_rad.y());
}

RC_GTEST_PROP(RotationFromDrivePair, AlignsTheLinesOfAnchorsAndDrives, (std::uint64_t seed)) {
    Random random(seed);
    const DrivePair drives = random_drives(random);
    const Quat rotation = rotation_from_drive_pair(drives, random.rotation());
    RC_ASSERT((rotation * line_bs(drives) - line_of(drives)).norm() < 1e-12);
    RC_ASSERT(std::abs(rotation.norm() - 1.0) < 1e-14);
}

// Without swing, twists add as angles, up to almost a whole turn between the drives.
RC_GTEST_PROP(RotationFromDrivePair, TwistIsTheMeanOfBoth, (std::uint64_t seed)) {
    Random random(seed);
    DrivePair drives = random_drives(random);
    const Quat body = rotation_from_drive_pair(drives, random.rotation());
    const Vec3 twists{random.between(-3.0, 3.0), random.between(-3.0, 3.0), 0.0};
    rotate_drives(drives, body, twists, 0.0, random);
    const Quat expected = rotation_about(line_of(drives), 0.5 * (twists.x() + twists.y())) * body;
    RC_ASSERT(angle_between(rotation_from_drive_pair(drives, body), expected) < 1e-7);
}

RC_GTEST_PROP(RotationFromDrivePair, DoesNotDependOnTheStartingRotation, (std::uint64_t seed)) {
    Random random(seed);
    DrivePair drives = random_drives(random);
    const Quat body = rotation_from_drive_pair(drives, random.rotation());
    rotate_drives(drives, body, random.vector(0.8), 0.8, random);
    const Quat expected = rotation_from_drive_pair(drives, body);
    const Quat near = rotation_from_vector(random.vector(0.4)) * body;
    RC_ASSERT(angle_between(rotation_from_drive_pair(drives, near), expected) < 1e-7);
}

RC_GTEST_PROP(RotationFromDrivePair, IsSymmetricInTheDrives, (std::uint64_t seed)) {
    Random random(seed);
    DrivePair drives = random_drives(random);
    const Quat body = rotation_from_drive_pair(drives, random.rotation());
    rotate_drives(drives, body, random.vector(0.8), 0.8, random);
    const DrivePair swapped{drives.second, drives.first, drives.second_anchor_bs,
                            drives.first_anchor_bs};
    RC_ASSERT(angle_between(rotation_from_drive_pair(drives, body),
                            rotation_from_drive_pair(swapped, body)) < 1e-7);
}

RC_GTEST_PROP(RotationFromDrivePair, KeepsTheRotationIfDrivesAreOnTheirAnchors,
              (std::uint64_t seed)) {
    Random random(seed);
    DrivePair drives = random_drives(random);
    const Pose body = test::random_pose(random);
    drives.first = body * drives.first_anchor_bs;
    drives.second = body * drives.second_anchor_bs;
    RC_ASSERT(angle_between(rotation_from_drive_pair(drives, body.rotation), body.rotation) < 1e-7);
}

TEST(RotationFromDrivePair, KeepsTheRotationIfPointsCoincide) {
    Random random(1);
    DrivePair drives = random_drives(random);
    const Quat near = random.rotation();
    drives.second.position = drives.first.position;
    EXPECT_EQ(rotation_from_drive_pair(drives, near).coeffs(), near.coeffs());
    drives = random_drives(random);
    drives.second_anchor_bs.position = drives.first_anchor_bs.position;
    EXPECT_EQ(rotation_from_drive_pair(drives, near).coeffs(), near.coeffs());
}

// --- As rows -------------------------------------------------------------------------------------

// A translating body (body 0) with two drives on body 1.
SolverScene held_by_both(const DrivePair& drives, Random& random) {
    SolverScene scene;
    scene.graph.bodies = {test::translating_body(1, 80.0, test::random_pose(random)),
                          test::random_free_body(2, random)};
    RowBlock point = test::row_block(RowKind::drive_point, 0, 1, drives.first.position,
                                     drives.first_anchor_bs.position);
    RowBlock direction = test::row_block(RowKind::drive_direction, 0, 1, drives.second.position,
                                         drives.second_anchor_bs.position);
    point.key = 1;
    direction.key = 2;
    const Quat near = scene.body(0).pose_ws.rotation.conjugate() * scene.body(1).pose_ws.rotation;
    direction.rotation_a_bs = rotation_from_drive_pair(drives, near);
    scene.graph.blocks = {point, direction};
    return scene;
}

RC_GTEST_PROP(DrivePairRows, ConvergeFromAnyPoseAndAnyDistanceOfTheDrives, (std::uint64_t seed)) {
    Random random(seed);
    const DrivePair drives = random_drives(random);
    SolverScene scene = held_by_both(drives, random);
    scene.body(0).inverse_mass = 0.0;  // held still, as in the forward phase
    NewtonSettings settings = test::tight_settings();
    settings.tolerance_m = 1e-8;
    scene.solve_positions(settings);
    const Pose& driver = scene.body(0).pose_ws;
    const Pose& body = scene.body(1).pose_ws;
    const Vec3 first_ws = transform_point(driver, drives.first.position);
    RC_ASSERT((first_ws - transform_point(body, drives.first_anchor_bs.position)).norm() <= 1e-7);
    const Vec3 line = driver.rotation * line_of(drives);
    RC_ASSERT((line - body.rotation * line_bs(drives)).norm() <= 1e-6);
    // The second drive is on the line, off by the difference of the two distances.
    const double slid = (drives.second.position - drives.first.position).norm() -
                        (drives.second_anchor_bs.position - drives.first_anchor_bs.position).norm();
    const Vec3 second_ws = transform_point(driver, drives.second.position);
    const Vec3 anchor_ws = transform_point(body, drives.second_anchor_bs.position);
    RC_ASSERT((second_ws - anchor_ws - slid * line).norm() <= 2e-6);
}

// The impulses reported by the blocks equal what the bodies received, linear and angular; the
// momentum ledger books them. The driver cannot rotate, so its angular part is booked separately.
RC_GTEST_PROP(DrivePairRows, ConserveLinearAndAngularMomentum, (std::uint64_t seed)) {
    Random random(seed);
    const DrivePair drives = random_drives(random);
    SolverScene scene = held_by_both(drives, random);
    scene.solve_positions();
    for (RowBlock& block : scene.graph.blocks) {
        block.drive_velocity_ws_mps = random.vector(2.0);
        block.drive_spin_ws_radps = random.vector(4.0);
    }
    for (SolverBody& body : scene.graph.bodies) {
        body.velocity_mps = random.vector(3.0);
    }
    scene.body(1).spin_radps = random.vector(3.0);
    const SolverBody driver = scene.body(0);
    const SolverBody body = scene.body(1);
    scene.solve_velocities();
    Vec3 impulse = Vec3::Zero();
    Vec3 angular = Vec3::Zero();  // about the body's centre
    for (const RowBlock& block : scene.graph.blocks) {
        impulse += block.impulse_ws_ns;
        angular += block.angular_impulse_ws_nms +
                   (body.pose_ws.rotation * block.point_b_bs).cross(block.impulse_ws_ns);
    }
    const Vec3 player_gain = driver.mass_kg * (scene.body(0).velocity_mps - driver.velocity_mps);
    const Vec3 body_gain = body.mass_kg * (scene.body(1).velocity_mps - body.velocity_mps);
    const Quat& axes = body.pose_ws.rotation;
    const Vec3 spin_bs = axes.conjugate() * (scene.body(1).spin_radps - body.spin_radps);
    const Vec3 spin_gain = axes * body.inertia_kgm2.cwiseProduct(spin_bs);
    const double size = 1.0 + impulse.norm() + angular.norm();
    RC_ASSERT((player_gain - impulse).norm() < 1e-9 * size);
    RC_ASSERT((body_gain + impulse).norm() < 1e-9 * size);
    RC_ASSERT((spin_gain + angular).norm() < 1e-9 * size);
    // The rows are satisfied: the first drive's velocity, and the spin.
    const Vec3 arm = axes * scene.block(0).point_b_bs;
    const Vec3 at_drive = scene.body(1).velocity_mps + scene.body(1).spin_radps.cross(arm);
    const Vec3 drive = scene.body(0).velocity_mps + scene.block(0).drive_velocity_ws_mps;
    RC_ASSERT((at_drive - drive).norm() < 1e-8);
    RC_ASSERT((scene.body(1).spin_radps - scene.block(1).drive_spin_ws_radps).norm() < 1e-7);
}

}  // namespace
}  // namespace handhold::solver_drive_pair_test
