#include "systems/locomotion/locomote_players.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/systems/frame/column_scene.hpp"

namespace handhold::locomote_players_test {
namespace {

using test::angle_between;
using test::distance;
using test::entity;
using test::k_left;
using test::k_player;
using test::k_right;
using test::k_ship;
using test::k_wall;
using test::Random;

constexpr double k_dt_s = 1.0 / 90.0;

struct Locomotion {
    Vec3 scene_velocity = Vec3::Zero();
    Column<PlayerCommands> commands;
    Column<HeadTracking> head;
    Column<HandOwner> owner;
    Column<HandTracking> hand;
    Column<Grab> grab;
    Column<BodyPose> body_pose;
    Column<BodyVelocity> body_velocity;
    Column<PlayerOrigin> origin;
    Column<PlayerVelocity> velocity;
    Column<ReferenceVelocity> reference;
    Column<BodyHold> body_hold;
    LocomotionTuning tuning;

    Locomotion() {
        tuning.drift_drag_per_s = 0.0;
        commands.add(k_player);
        head.add(k_player);
        origin.add(k_player);
        velocity.add(k_player);
        reference.add(k_player);
        head.at(k_player).start_ps.position = Vec3(0.1, 1.6, 0.2);
        for (const Entity entity : {k_left, k_right}) {
            owner.add(entity, {k_player, entity == k_left ? HandSide::left : HandSide::right});
            hand.add(entity);
            grab.add(entity);
            hand.at(entity).start_ps.position = Vec3(entity == k_left ? -0.4 : 0.4, 1.1, -0.3);
        }
        for (const Entity body : {k_ship, k_wall}) {
            body_pose.add(body);
            body_velocity.add(body);
        }
    }
    PlayerCommands& command() { return commands.at(k_player); }
    Pose& play_space() { return origin.at(k_player).pose_ws; }
    Vec3& speed() { return velocity.at(k_player).linear_mps; }
    Vec3 head_ws() { return transform_point(play_space(), head.at(k_player).start_ps.position); }
    Vec3 hand_ws(Entity which) {
        return transform_point(play_space(), hand.at(which).start_ps.position);
    }
    void grip(Entity which, GripKind kind, Entity body, GrabPhase phase = GrabPhase::holding) {
        grab.at(which).kind = kind;
        grab.at(which).phase = phase;
        grab.at(which).body = body;
    }
    void run() {
        locomote_players({.dt_s = k_dt_s,
                          .scene_velocity_mps = scene_velocity,
                          .commands = commands,
                          .head = head,
                          .owner = owner,
                          .hand = hand,
                          .grab = grab,
                          .body_pose = body_pose,
                          .body_velocity = body_velocity,
                          .origin = origin,
                          .velocity = velocity,
                          .reference = reference,
                          .body_hold = body_hold},
                         tuning);
    }
};

Vec3 up_of(const Pose& play_space) { return play_space.rotation * Vec3::UnitY(); }

// --- Turning -------------------------------------------------------------------------------------

TEST(LocomotePlayers, SnapTurnsByItsAngleToTheLeftAboutTheHead) {
    Locomotion player;
    player.command().snap_turns = 2;
    const Vec3 head = player.head_ws();
    player.run();
    EXPECT_LT((player.head_ws() - head).norm(), 1e-14);
    const Quat expected = rotation_about(Vec3::UnitY(), 2.0 * player.tuning.snap_turn_rad);
    EXPECT_LT(test::angle_between(player.play_space().rotation, expected), 1e-14);
}

TEST(LocomotePlayers, SmoothTurnIsSpeedTimesTimeAndTheStickEndsAtOne) {
    for (const double stick : {-5.0, -1.0, -0.25, 0.5, 1.0, 7.0}) {
        Locomotion player;
        player.command().smooth_turn = stick;
        player.run();
        const double angle =
            std::clamp(stick, -1.0, 1.0) * player.tuning.smooth_turn_radps * k_dt_s;
        EXPECT_LT((rotation_to_vector(player.play_space().rotation) - angle * Vec3::UnitY()).norm(),
                  1e-14);
    }
}

RC_GTEST_PROP(LocomotePlayers, TurningLeavesThePivotAndTheUpOfThePlaySpace, (std::uint64_t seed)) {
    Random random(seed);
    for (const bool grips : {false, true}) {
        Locomotion player;
        player.play_space() = random.pose(100.0);
        player.head.at(k_player).start_ps = random.pose(1.0);
        player.hand.at(k_right).start_ps = random.pose(1.0);
        player.command().smooth_turn = random.between(-1.0, 1.0);
        player.command().snap_turns = 1;
        if (grips) {
            player.grip(k_right, GripKind::surface, k_wall);
        }
        const Vec3 pivot = grips ? player.hand_ws(k_right) : player.head_ws();
        const Vec3 up = up_of(player.play_space());
        player.run();
        RC_ASSERT(((grips ? player.hand_ws(k_right) : player.head_ws()) - pivot).norm() < 1e-12);
        RC_ASSERT((up_of(player.play_space()) - up).norm() < 1e-14);
    }
}

TEST(LocomotePlayers, FreshGripIsNoPivotYet) {
    Locomotion player;
    player.grip(k_right, GripKind::surface, k_wall, GrabPhase::fresh);
    player.command().snap_turns = 1;
    const Vec3 head = player.head_ws();
    player.run();
    EXPECT_LT((player.head_ws() - head).norm(), 1e-14);
}

TEST(LocomotePlayers, NothingAskedNothingTurnedBitForBit) {
    Locomotion player;
    player.play_space() = {Vec3(1.0, 2.0, 3.0), rotation_about(Vec3::UnitX(), 0.3)};
    const Pose before = player.play_space();
    player.run();
    EXPECT_EQ(player.play_space().position, before.position);
    EXPECT_EQ(player.play_space().rotation.coeffs(), before.rotation.coeffs());
}

// --- Following a support -------------------------------------------------------------------------

TEST(LocomotePlayers, PlaySpaceFollowsItsSupportAsFarAsTheDesignerSays) {
    const Vec3 spin(0.5, -0.8, 0.3);
    for (const SupportFollow follow :
         {SupportFollow::off, SupportFollow::yaw, SupportFollow::full}) {
        Locomotion player;
        player.tuning.support_follow = follow;
        player.body_velocity.at(k_ship).angular_radps = spin;
        player.grip(k_left, GripKind::surface, k_ship);
        const Vec3 pivot = player.hand_ws(k_left);
        player.run();
        Vec3 expected = Vec3::Zero();
        if (follow == SupportFollow::yaw) {
            expected.y() = spin.y() * k_dt_s;
        } else if (follow == SupportFollow::full) {
            expected = spin * k_dt_s;
        }
        EXPECT_LT((rotation_to_vector(player.play_space().rotation) - expected).norm(), 1e-14);
        EXPECT_LT((player.hand_ws(k_left) - pivot).norm(), 1e-14);
    }
}

TEST(LocomotePlayers, TwoHandsOnOneBodyFollowItFullyWhateverTheDesignerSays) {
    const Vec3 spin(0.5, -0.8, 0.3);
    Locomotion player;
    player.body_velocity.at(k_ship).angular_radps = spin;
    player.grip(k_left, GripKind::surface, k_ship);
    player.grip(k_right, GripKind::surface, k_ship);
    player.run();
    EXPECT_LT((rotation_to_vector(player.play_space().rotation) - spin * k_dt_s).norm(), 1e-14);

    Locomotion split;
    split.body_velocity.at(k_ship).angular_radps = spin;
    split.grip(k_left, GripKind::surface, k_ship);
    split.grip(k_right, GripKind::surface, k_wall);
    split.run();
    EXPECT_EQ(rotation_to_vector(split.play_space().rotation), Vec3(Vec3::Zero()));
}

TEST(LocomotePlayers, HeldRockTurnsNobody) {
    Locomotion player;
    player.tuning.support_follow = SupportFollow::full;
    player.body_velocity.at(k_ship).angular_radps = Vec3(1.0, 2.0, 3.0);
    player.grip(k_left, GripKind::held, k_ship);
    player.run();
    EXPECT_EQ(rotation_to_vector(player.play_space().rotation), Vec3(Vec3::Zero()));
}

// --- Reference velocity --------------------------------------------------------------------------

// The velocity of a turning body is taken where it is gripped: v + w x r. It is not taken at the
// player, who may drift away for good: there it would grow with the distance.
TEST(LocomotePlayers, ReferenceIsTheGrippedBodysVelocityAtTheGrip) {
    Locomotion player;
    player.body_pose.at(k_ship).pose_ws.position = Vec3(10.0, 0.0, 0.0);
    player.body_velocity.at(k_ship) = {Vec3(20.0, 0.0, 0.0), Vec3(0.0, 2.0, 0.0)};
    player.grip(k_left, GripKind::surface, k_ship);
    const Vec3 arm(0.1, 1.6, 0.2);
    player.grab.at(k_left).anchor_bs.position = arm;
    player.run();
    const Vec3 expected = Vec3(20.0, 0.0, 0.0) + Vec3(2.0 * arm.z(), 0.0, -2.0 * arm.x());
    EXPECT_LT((player.reference.at(k_player).linear_mps - expected).norm(), 1e-12);
    EXPECT_EQ(player.reference.at(k_player).body, k_ship);
}

TEST(LocomotePlayers, ReferenceStaysAfterLettingGoUntilTheBodyIsGone) {
    Locomotion player;
    player.scene_velocity = Vec3(0.0, 0.0, 3.0);
    player.body_velocity.at(k_ship).linear_mps = Vec3(20.0, 0.0, 0.0);
    player.run();
    EXPECT_EQ(player.reference.at(k_player).linear_mps, player.scene_velocity);
    player.grip(k_left, GripKind::surface, k_ship);
    player.run();
    player.grab.at(k_left) = {};
    player.body_velocity.at(k_ship).linear_mps = Vec3(21.0, 0.0, 0.0);
    player.run();
    EXPECT_EQ(player.reference.at(k_player).linear_mps, Vec3(21.0, 0.0, 0.0));
    player.body_velocity.remove(k_ship);
    player.body_pose.remove(k_ship);
    player.run();
    EXPECT_EQ(player.reference.at(k_player).linear_mps, player.scene_velocity);
    EXPECT_EQ(player.reference.at(k_player).body, k_no_entity);
}

TEST(LocomotePlayers, HeldRockIsNoReference) {
    Locomotion player;
    player.body_velocity.at(k_ship).linear_mps = Vec3(20.0, 0.0, 0.0);
    player.grip(k_left, GripKind::held, k_ship);
    player.run();
    EXPECT_EQ(player.reference.at(k_player).linear_mps, Vec3(Vec3::Zero()));
}

// --- Brake, drag, thrusters ----------------------------------------------------------------------

// A body that moves relative to the reference loses 1/(1 + drag dt); a body at rest relative to it
// keeps its speed.
TEST(LocomotePlayers, BrakeActsAgainstTheReference) {
    Locomotion player;
    player.scene_velocity = Vec3(20.0, 0.0, 0.0);
    player.tuning.drift_drag_per_s = 0.5;
    player.command().brake = 0.5;
    player.speed() = Vec3(22.0, 1.0, 0.0);
    player.run();
    const double drag = 0.5 + 0.5 * player.tuning.brake_drag_per_s;
    const Vec3 expected = player.scene_velocity + Vec3(2.0, 1.0, 0.0) / (1.0 + drag * k_dt_s);
    EXPECT_LT((player.speed() - expected).norm(), 1e-14);

    player.speed() = player.scene_velocity;
    player.run();
    EXPECT_EQ(player.speed(), player.scene_velocity);
}

// If two hands closed at the same time, the left one counts, whichever is listed first.
TEST(LocomotePlayers, OrderOfHandsDoesNotMatterWhereBothClosedAtOnce) {
    const auto turned = [](bool reversed) {
        Locomotion scene;
        scene.grip(k_left, GripKind::surface, k_wall);
        scene.grip(k_right, GripKind::surface, k_ship);
        scene.grab.at(k_left).anchor_bs.position = Vec3::UnitX();
        scene.grab.at(k_right).anchor_bs.position = Vec3::UnitY();
        scene.command().snap_turns = 1;
        if (reversed) {
            const HandOwner left = scene.owner.at(k_left);
            scene.owner.remove(k_left);  // the right hand moves to the front
            scene.owner.add(k_left, left);
        }
        scene.run();
        EXPECT_EQ(scene.reference.at(k_player).body, k_wall);
        return scene.play_space();
    };
    EXPECT_EQ(distance(turned(false), turned(true)), 0.0);
}

// Against exp(-drag t): first order in the frame's length.
TEST(LocomotePlayers, BrakingForASecondApproachesExponentialDecay) {
    Locomotion player;
    player.command().brake = 1.0;
    player.speed() = Vec3(1.0, 0.0, 0.0);
    for (int frame = 0; frame < 90; ++frame) {
        player.run();
    }
    const double drag = player.tuning.brake_drag_per_s;
    EXPECT_NEAR(player.speed().x(), std::exp(-drag), std::exp(-drag) * drag * drag * k_dt_s);
}

TEST(LocomotePlayers, ThrustersPushAlongThePlaySpaceAndOnlyWhereAllowed) {
    Locomotion player;
    player.play_space().rotation = rotation_about(Vec3::UnitY(), 0.5 * k_pi);
    player.command().thrust_ps = Vec3(0.0, 0.5, -3.0);
    player.run();
    EXPECT_EQ(player.speed(), Vec3(Vec3::Zero()));
    player.tuning.thruster_mps2 = 2.0;
    player.run();
    // A quarter turn to the left: forward (-z) is now -x; the stick ends at one.
    EXPECT_LT((player.speed() - 2.0 * k_dt_s * Vec3(-1.0, 0.5, 0.0)).norm(), 1e-14);
}

TEST(LocomotePlayers, GrippingHandStandsAgainstBrakeAndThrusters) {
    for (const GripKind kind : {GripKind::surface, GripKind::held}) {
        Locomotion player;
        player.tuning.thruster_mps2 = 2.0;
        player.command().brake = 1.0;
        player.command().thrust_ps = Vec3::UnitX();
        player.speed() = Vec3(0.0, 1.0, 0.0);
        player.grip(k_right, kind, k_wall);
        player.run();
        EXPECT_EQ(player.speed() == Vec3(0.0, 1.0, 0.0), kind == GripKind::surface);
    }
}

// --- Properties ----------------------------------------------------------------------------------

RC_GTEST_PROP(LocomotePlayers, MovedAndRotatedWorldIsTheSameToItsPlayer, (std::uint64_t seed)) {
    Random random(seed);
    Locomotion here;
    here.tuning.support_follow = SupportFollow::full;
    here.tuning.thruster_mps2 = 1.0;
    here.play_space() = random.pose();
    here.speed() = random.vector(3.0);
    here.command() = {random.between(-1.0, 1.0), 1, random.between(0.0, 1.0), random.vector(1.0)};
    here.body_pose.at(k_ship).pose_ws = random.pose();
    here.body_velocity.at(k_ship) = {random.vector(5.0), random.vector(1.0)};
    here.grip(k_left, random.between(0.0, 1.0) < 0.5 ? GripKind::held : GripKind::surface, k_ship);
    Locomotion there = here;
    const Pose moved = random.pose(100.0);
    there.play_space() = moved * here.play_space();
    there.speed() = moved.rotation * here.speed();
    there.body_pose.at(k_ship).pose_ws = moved * here.body_pose.at(k_ship).pose_ws;
    there.body_velocity.at(k_ship) = {moved.rotation * here.body_velocity.at(k_ship).linear_mps,
                                      moved.rotation * here.body_velocity.at(k_ship).angular_radps};
    here.run();
    there.run();
    RC_ASSERT(distance(inverse(moved) * there.play_space(), here.play_space()) < 1e-7);
    RC_ASSERT((moved.rotation.conjugate() * there.speed() - here.speed()).norm() < 1e-12);
    RC_ASSERT((moved.rotation.conjugate() * there.reference.at(k_player).linear_mps -
               here.reference.at(k_player).linear_mps)
                  .norm() < 1e-12);
}

TEST(LocomotePlayers, PlayersDoNotSeeEachOthersHands) {
    constexpr Entity k_other = entity(10);
    Locomotion players;
    players.commands.add(k_other, {0.0, 1, 0.0, Vec3::Zero()});
    players.head.add(k_other);
    players.origin.add(k_other);
    players.velocity.add(k_other, {Vec3(1.0, 0.0, 0.0)});
    players.reference.add(k_other);
    players.head.at(k_other).start_ps.position = Vec3(5.0, 1.6, 0.0);
    players.grip(k_left, GripKind::surface, k_ship);
    players.body_velocity.at(k_ship).linear_mps = Vec3(20.0, 0.0, 0.0);
    players.run();
    EXPECT_EQ(players.reference.at(k_other).linear_mps, Vec3(Vec3::Zero()));
    const Vec3 head = transform_point(players.origin.at(k_other).pose_ws, Vec3(5.0, 1.6, 0.0));
    EXPECT_LT((head - Vec3(5.0, 1.6, 0.0)).norm(), 1e-14);
}

}  // namespace
}  // namespace handhold::locomote_players_test
