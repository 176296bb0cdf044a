// Two hands on one free body, as rows: the first hand's point, and the rotation that follows from
// both.
#include "engine/solver/model/drive_pair.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/engine/solver/scene.hpp"

namespace handhold::solver_two_hands_test {
namespace {

using test::Random;
using test::SolverScene;

double turn_between(const Quat& a, const Quat& b) {
    return rotation_to_vector((a.conjugate() * b).normalized()).norm();
}

// The hands' distance and the anchors' differ as they like.
DrivePair random_hands(Random& random) {
    DrivePair hands;
    for (Pose* const pose : {&hands.first, &hands.first_anchor_bs}) {
        *pose = test::random_pose(random, 0.5);
    }
    hands.second = {hands.first.position + random.between(0.04, 1.2) * random.direction(),
                    random.rotation()};
    hands.second_anchor_bs = {
        hands.first_anchor_bs.position + random.between(0.04, 1.2) * random.direction(),
        random.rotation()};
    return hands;
}

Vec3 line_of(const DrivePair& hands) {
    return (hands.second.position - hands.first.position).normalized();
}
Vec3 line_bs(const DrivePair& hands) {
    return (hands.second_anchor_bs.position - hands.first_anchor_bs.position).normalized();
}

// Hands turned about the line, and out of it by `swing` at most, from where `body` has the anchors.
void turn_hands(DrivePair& hands, const Quat& body, const Vec3& twists_rad, double swing_rad,
                Random& random) {
    const Vec3 line = line_of(hands);
    const auto turned = [&](const Quat& anchor_bs, double twist_rad) {
        const Vec3 across = line.cross(random.direction()).normalized();
        const Quat swing = rotation_about(across, random.between(0.0, swing_rad));
        return (swing * rotation_about(line, twist_rad) * body * anchor_bs).normalized();
    };
    hands.first.rotation = turned(hands.first_anchor_bs.rotation, twists_rad.x());
    hands.second.rotation = turned(hands.second_anchor_bs.rotation, twists_rad.y());
}

RC_GTEST_PROP(RotationByTwoHands, LaysTheAnchorsLineAlongTheHands, (std::uint64_t seed)) {
    Random random(seed);
    const DrivePair hands = random_hands(random);
    const Quat rotation = rotation_from_drive_pair(hands, random.rotation());
    RC_ASSERT((rotation * line_bs(hands) - line_of(hands)).norm() < 1e-12);
    RC_ASSERT(std::abs(rotation.norm() - 1.0) < 1e-14);
}

// No swing: twists add as angles, up to nearly a whole turn between the hands.
RC_GTEST_PROP(RotationByTwoHands, TwistsByTheMeanOfBoth, (std::uint64_t seed)) {
    Random random(seed);
    DrivePair hands = random_hands(random);
    const Quat body = rotation_from_drive_pair(hands, random.rotation());
    const Vec3 twists(random.between(-3.0, 3.0), random.between(-3.0, 3.0), 0.0);
    turn_hands(hands, body, twists, 0.0, random);
    const Quat expected = rotation_about(line_of(hands), 0.5 * (twists.x() + twists.y())) * body;
    RC_ASSERT(turn_between(rotation_from_drive_pair(hands, body), expected) < 1e-7);
}

RC_GTEST_PROP(RotationByTwoHands, DoesNotDependOnWhatItIsNearTo, (std::uint64_t seed)) {
    Random random(seed);
    DrivePair hands = random_hands(random);
    const Quat body = rotation_from_drive_pair(hands, random.rotation());
    turn_hands(hands, body, random.vector(0.8), 0.8, random);
    const Quat expected = rotation_from_drive_pair(hands, body);
    const Quat near = rotation_from_vector(random.vector(0.4)) * body;
    RC_ASSERT(turn_between(rotation_from_drive_pair(hands, near), expected) < 1e-7);
}

RC_GTEST_PROP(RotationByTwoHands, DoesNotDependOnWhichHandIsFirst, (std::uint64_t seed)) {
    Random random(seed);
    DrivePair hands = random_hands(random);
    const Quat body = rotation_from_drive_pair(hands, random.rotation());
    turn_hands(hands, body, random.vector(0.8), 0.8, random);
    const DrivePair swapped{hands.second, hands.first, hands.second_anchor_bs,
                            hands.first_anchor_bs};
    RC_ASSERT(turn_between(rotation_from_drive_pair(hands, body),
                           rotation_from_drive_pair(swapped, body)) < 1e-7);
}

RC_GTEST_PROP(RotationByTwoHands, ChangesNothingWhereHandsAreOnTheirAnchors, (std::uint64_t seed)) {
    Random random(seed);
    DrivePair hands = random_hands(random);
    const Pose body = test::random_pose(random);
    hands.first = body * hands.first_anchor_bs;
    hands.second = body * hands.second_anchor_bs;
    RC_ASSERT(turn_between(rotation_from_drive_pair(hands, body.rotation), body.rotation) < 1e-7);
}

TEST(RotationByTwoHands, KeepsTheRotationWhereThereIsNoLine) {
    Random random(1);
    DrivePair hands = random_hands(random);
    const Quat near = random.rotation();
    hands.second.position = hands.first.position;
    EXPECT_EQ(rotation_from_drive_pair(hands, near).coeffs(), near.coeffs());
    hands = random_hands(random);
    hands.second_anchor_bs.position = hands.first_anchor_bs.position;
    EXPECT_EQ(rotation_from_drive_pair(hands, near).coeffs(), near.coeffs());
}

// --- As rows -------------------------------------------------------------------------------------

// A player (body 0) with both hands on body 1.
SolverScene held_by_both(const DrivePair& hands, Random& random) {
    SolverScene scene;
    scene.graph.bodies = {test::player_body(1, 80.0, test::random_pose(random)),
                          test::random_free_body(2, random)};
    RowBlock point = test::row_block(RowKind::drive_point, 0, 1, hands.first.position,
                                     hands.first_anchor_bs.position);
    RowBlock direction = test::row_block(RowKind::drive_direction, 0, 1, hands.second.position,
                                         hands.second_anchor_bs.position);
    point.key = 1;
    direction.key = 2;
    const Quat near = scene.body(0).pose_ws.rotation.conjugate() * scene.body(1).pose_ws.rotation;
    direction.rotation_a_bs = rotation_from_drive_pair(hands, near);
    scene.graph.blocks = {point, direction};
    return scene;
}

RC_GTEST_PROP(TwoHandRows, AreMetFromAnywhereWhateverTheHandsDistanceAndMoveNoPlayer,
              (std::uint64_t seed)) {
    Random random(seed);
    const DrivePair hands = random_hands(random);
    SolverScene scene = held_by_both(hands, random);
    scene.body(0).inverse_mass = 0.0;  // as in the first phases
    NewtonSettings settings;
    settings.tolerance_m = 1e-8;
    scene.solve_positions(settings);
    const Pose& player = scene.body(0).pose_ws;
    const Pose& body = scene.body(1).pose_ws;
    const Vec3 first_ws = transform_point(player, hands.first.position);
    RC_ASSERT((first_ws - transform_point(body, hands.first_anchor_bs.position)).norm() <= 1e-7);
    const Vec3 line = player.rotation * line_of(hands);
    RC_ASSERT((line - body.rotation * line_bs(hands)).norm() <= 1e-6);
    // The second hand is on the line, apart by what the distances differ.
    const double slid = (hands.second.position - hands.first.position).norm() -
                        (hands.second_anchor_bs.position - hands.first_anchor_bs.position).norm();
    const Vec3 second_ws = transform_point(player, hands.second.position);
    const Vec3 anchor_ws = transform_point(body, hands.second_anchor_bs.position);
    RC_ASSERT((second_ws - anchor_ws - slid * line).norm() <= 2e-6);
}

// What the blocks say they gave is what the bodies received, linear and angular: what the momentum
// ledger books. The player cannot turn; what would have turned him is booked apart.
RC_GTEST_PROP(TwoHandRows, GiveTheBodyExactlyWhatTheyTakeFromThePlayer, (std::uint64_t seed)) {
    Random random(seed);
    const DrivePair hands = random_hands(random);
    SolverScene scene = held_by_both(hands, random);
    scene.solve_positions();
    for (RowBlock& block : scene.graph.blocks) {
        block.drive_velocity_ws_mps = random.vector(2.0);
        block.drive_spin_ws_radps = random.vector(4.0);
    }
    for (SolverBody& body : scene.graph.bodies) {
        body.velocity_mps = random.vector(3.0);
    }
    scene.body(1).spin_radps = random.vector(3.0);
    const SolverBody player = scene.body(0);
    const SolverBody body = scene.body(1);
    scene.solve_velocities();
    Vec3 impulse = Vec3::Zero();
    Vec3 angular = Vec3::Zero();  // about the body's centre
    for (const RowBlock& block : scene.graph.blocks) {
        impulse += block.impulse_ws_ns;
        angular += block.angular_impulse_ws_nms +
                   (body.pose_ws.rotation * block.point_b_bs).cross(block.impulse_ws_ns);
    }
    const Vec3 player_gain = player.mass_kg * (scene.body(0).velocity_mps - player.velocity_mps);
    const Vec3 body_gain = body.mass_kg * (scene.body(1).velocity_mps - body.velocity_mps);
    const Quat& axes = body.pose_ws.rotation;
    const Vec3 spin_bs = axes.conjugate() * (scene.body(1).spin_radps - body.spin_radps);
    const Vec3 spin_gain = axes * body.inertia_kgm2.cwiseProduct(spin_bs);
    const double size = 1.0 + impulse.norm() + angular.norm();
    RC_ASSERT((player_gain - impulse).norm() < 1e-9 * size);
    RC_ASSERT((body_gain + impulse).norm() < 1e-9 * size);
    RC_ASSERT((spin_gain + angular).norm() < 1e-9 * size);
    // And they are met: the first hand's velocity, and the spin.
    const Vec3 arm = axes * scene.block(0).point_b_bs;
    const Vec3 at_hand = scene.body(1).velocity_mps + scene.body(1).spin_radps.cross(arm);
    const Vec3 hand = scene.body(0).velocity_mps + scene.block(0).drive_velocity_ws_mps;
    RC_ASSERT((at_hand - hand).norm() < 1e-8);
    RC_ASSERT((scene.body(1).spin_radps - scene.block(1).drive_spin_ws_radps).norm() < 1e-7);
}

}  // namespace
}  // namespace handhold::solver_two_hands_test
