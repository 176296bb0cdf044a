#pragma once

#include <initializer_list>

#include "systems/grab/anchor_grabs.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::anchor_grabs_test {

using test::k_left;
using test::k_player;
using test::k_right;
using test::k_ship;
using test::k_wall;
using test::Random;

constexpr double k_start_s = 2.0;
constexpr double k_end_s = 2.01;
constexpr double k_dt_s = k_end_s - k_start_s;

constexpr Entity other_of(Entity hand) { return hand == k_left ? k_right : k_left; }

// One player, a wall at rest and a moving ship. Tests set the motion of hands.
struct Anchoring {
    Column<HandOwner> owner;
    Column<HandTracking> hand;
    Column<PlayerStart> player_start;
    Column<PlayerOrigin> origin;
    Column<HeadTracking> head;
    Column<BodyStart> body_start;
    Column<BodyPose> body_pose;
    Column<AuthoredHold> authored_hold;
    Column<HandHistory> hand_history;
    Column<RigidBody> rigid_body;
    Column<Joint> joint;
    Column<JointState> joint_state;
    Tuning tuning;
    Column<Grab> grab;
    Column<BodyHold> body_hold;
    StageStats stats;

    explicit Anchoring(std::initializer_list<Entity> hands = {k_left, k_right}) {
        tuning.tracking.max_hand_speed_mps = 1e3;  // hands move as far as a test likes
        player_start.add(k_player);
        origin.add(k_player);
        for (const Entity body : {k_wall, k_ship}) {
            body_start.add(body);
            body_pose.add(body);
        }
        for (const Entity entity : hands) {
            add_hand(k_player, entity, entity == k_left ? HandSide::left : HandSide::right);
        }
    }
    void add_hand(Entity player, Entity entity, HandSide side) {
        owner.add(entity, {player, side});
        hand.add(entity);
        hand_history.add(entity);
        grab.add(entity);
    }
    void move_player(const Pose& from, const Pose& to) {
        player_start.at(k_player).pose_ws = from;
        origin.at(k_player).pose_ws = to;
    }
    void move_body(Entity body, const Pose& from, const Pose& to) {
        body_start.at(body).pose_ws = from;
        body_pose.at(body).pose_ws = to;
    }
    void move_hand(Entity which, const Pose& from, const Pose& to) {
        hand.at(which).start_ps = from;
        hand.at(which).pose_ps = to;
    }
    // Sets a button edge at a fraction of the frame, with the hand on its straight path.
    void set_edge(Entity which, GrabEdge edge, double fraction) {
        HandTracking& tracking = hand.at(which);
        tracking.edge = edge;
        tracking.edge_t_s = k_start_s + fraction * k_dt_s;
        tracking.edge_ps = interpolate(tracking.start_ps, tracking.pose_ps, fraction);
    }
    void set_grip(Entity which, GripKind kind, GrabPhase phase, Entity body,
                  const Pose& anchor_bs = {}) {
        Grab& grip = grab.at(which);
        grip.kind = kind;
        grip.phase = phase;
        grip.body = body;
        grip.anchor_bs = anchor_bs;
    }
    void run() {
        stats = {};
        anchor_grabs({.start_s = k_start_s,
                      .end_s = k_end_s,
                      .owner = owner,
                      .hand = hand,
                      .hand_history = hand_history,
                      .player_start = player_start,
                      .origin = origin,
                      .head = head,
                      .body_start = body_start,
                      .body_pose = body_pose,
                      .authored_hold = authored_hold,
                      .body = rigid_body,
                      .joint = joint,
                      .joint_state = joint_state,
                      .body_hold = body_hold,
                      .grab = grab},
                     tuning, stats);
    }
};

// Everything moves; the player drifts along a line.
inline Anchoring random_anchoring(Random& random,
                                  std::initializer_list<Entity> hands = {k_left, k_right}) {
    Anchoring scene(hands);
    const Pose origin = random.pose();
    scene.move_player(origin, {origin.position + random.vector(0.05), origin.rotation});
    for (const Entity body : {k_wall, k_ship}) {
        const Pose from = random.pose();
        scene.move_body(body, from,
                        {from.position + random.vector(0.1),
                         rotation_from_vector(random.vector(0.1)) * from.rotation});
    }
    for (const Entity hand : {k_left, k_right}) {
        const Pose from = random.pose(0.5);
        scene.move_hand(hand, from,
                        {from.position + random.vector(0.05),
                         rotation_from_vector(random.vector(0.1)) * from.rotation});
    }
    return scene;
}

}  // namespace handhold::anchor_grabs_test
