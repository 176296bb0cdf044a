#pragma once

#include <initializer_list>
#include <vector>

#include "systems/grab/update_grabs.hpp"
#include "tests/systems/grab/hands_and_bodies.hpp"

namespace handhold::update_grabs_test {

using test::count_of;
using test::count_of_all;
using test::entity;
using test::k_left;
using test::k_player;
using test::k_right;
using test::k_wall;
using test::Random;

constexpr Entity k_rock = entity(4);

// Hands that close among bodies; a head that sees them.
struct Grabs : test::HandsAndBodies {
    Column<HeadTracking> head;
    Column<AuthoredGrips> authored_grips;
    Column<AuthoredHold> authored_hold;
    Column<ReferenceVelocity> reference;
    Column<HeadIgnores> head_ignores;
    Column<BodyHold> body_hold;
    Column<GrabOrder> order;
    std::vector<ClosingHand> closing;
    Column<GrippableBody> grippable;
    Column<BodyMeasures> measures;

    explicit Grabs(const Pose& frame = {}, std::initializer_list<Entity> hands = {k_left, k_right})
        : HandsAndBodies(frame, hands) {
        head_ignores.add(k_player);
        reference.add(k_player);
        head.add(k_player).pose_ps = test::pose_at(Vec3(0.0, 1.8, 0.4));
    }
    // A wall whose top is at `top_y`.
    void add_floor(double top_y, BodyKind kind = BodyKind::fixed) {
        RigidBody rigid;
        rigid.kind = kind;
        add_body(k_wall, rigid, shapes.add_box(Vec3(2.0, 0.5, 2.0)),
                 {Vec3(0.0, top_y - 0.5, 0.0), Quat::Identity()});
    }
    void add_rock(Entity entity, double mass_kg, const Vec3& center) {
        add_body(entity, {BodyKind::free, mass_kg, Vec3::Constant(0.01), 0.0},
                 shapes.add_sphere(0.08), {center, Quat::Identity()});
    }
    void add_head(const Vec3& center, double radius_m = 0.11) {
        const Pose pose = frame_ws * Pose{center, Quat::Identity()};
        proxies.push_back({100, shapes.add_sphere(radius_m), pose, pose, true});
    }
    // The hand closes where its palm is at `palm`, in the frame.
    void close(Entity entity, const Vec3& palm, const Quat& rotation = Quat::Identity()) {
        HandTracking& tracking = hand.at(entity);
        tracking.edge = GrabEdge::onset;
        tracking.edge_ps = {palm - rotation * palm_center_hs(entity), rotation};
    }
    void run() {
        CollisionWorld collision(shapes);
        place_proxies(collision);
        stats = {};
        update_grabs({.start_s = 0.0,
                      .dt_s = 0.0,
                      .surfaces = collision,
                      .persistent_id = persistent_id,
                      .owner = owner,
                      .hand = hand,
                      .origin = origin,
                      .head = head,
                      .body = body,
                      .body_pose = body_pose,
                      .joint_groups = joint_groups,
                      .authored_grips = authored_grips,
                      .rules = {.rule = grab_rule, .layers = grab_layers, .filter = filter},
                      .grippable = grippable,
                      .measures = measures,
                      .pull = pull,
                      .reference = reference,
                      .sight = sight,
                      .grab = grab,
                      .authored_hold = authored_hold,
                      .head_ignores = head_ignores,
                      .body_hold = body_hold,
                      .order = order,
                      .closing = closing},
                     tuning, stats);
    }
};

}  // namespace handhold::update_grabs_test
