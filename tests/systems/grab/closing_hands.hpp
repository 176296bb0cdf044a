#pragma once

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "systems/grab/update_grabs.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::update_grabs_test {

using test::count_of;
using test::count_of_all;
using test::entity;
using test::Random;

constexpr Entity k_player = entity(0);
constexpr Entity k_left = entity(1);
constexpr Entity k_right = entity(2);
constexpr Entity k_wall = entity(3);
constexpr Entity k_rock = entity(4);

// A player at the origin whose hands' palms look down (-Y); colliders are added by hand. Everything
// is put into the world through frame_ws.
struct Grabs {
    Pose frame_ws;
    ShapeLibrary shapes;
    std::vector<ColliderProxy> proxies;
    Column<PersistentId> persistent_id;
    Column<HandOwner> owner;
    Column<HandTracking> hand;
    Column<PlayerOrigin> origin;
    Column<HeadTracking> head;
    Column<RigidBody> body;
    Column<BodyPose> body_pose;
    JointGroups joint_groups;
    Column<AuthoredGrips> authored_grips;
    Column<Grab> grab;
    Column<AuthoredHold> authored_hold;
    Column<HandPull> pull;
    Column<ReferenceVelocity> reference;
    Column<HandSight> sight;
    Column<HeadIgnores> head_ignores;
    Column<BodyHold> body_hold;
    Column<GrabOrder> order;
    Column<GrabRule> grab_rule;
    Column<GrabLayers> grab_layers;
    Column<CollisionFilter> filter;
    Column<RenderPose> shown;
    Column<BodyMeasures> measures;
    Tuning tuning;
    StageStats stats;

    explicit Grabs(const Pose& frame = {}, std::initializer_list<Entity> hands = {k_left, k_right})
        : frame_ws(frame) {
        persistent_id.add(k_player, {100});
        origin.add(k_player, {frame_ws});
        head_ignores.add(k_player);
        reference.add(k_player);
        head.add(k_player).pose_ps = test::pose_at(Vec3(0.0, 1.8, 0.4));  // sees the hands
        for (const Entity entity : hands) {
            owner.add(entity, {k_player, entity == k_left ? HandSide::left : HandSide::right});
            hand.add(entity);
            grab.add(entity);
            sight.add(entity);
        }
    }
    void add_body(Entity entity, const RigidBody& kind, ShapeId shape, const Pose& pose) {
        persistent_id.add(entity, {200 + std::uint64_t{entity.slot}});
        body.add(entity, kind);
        body_pose.add(entity, {frame_ws * pose});
        proxies.push_back({persistent_id.at(entity).value, shape, frame_ws * pose, frame_ws * pose,
                           kind.kind == BodyKind::free});
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
        Vec3 center = tuning.hand.palm_center_m;
        center.x() *= owner.at(entity).side == HandSide::right ? 1.0 : -1.0;
        HandTracking& tracking = hand.at(entity);
        tracking.edge = GrabEdge::onset;
        tracking.edge_ps = {palm - rotation * center, rotation};
    }
    void run() {
        CollisionWorld collision(shapes);
        std::sort(proxies.begin(), proxies.end(),
                  [](const auto& a, const auto& b) { return a.id < b.id; });
        collision.set_proxies(proxies);
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
                      .shown = shown,
                      .measures = measures,
                      .pull = pull,
                      .reference = reference,
                      .sight = sight,
                      .grab = grab,
                      .authored_hold = authored_hold,
                      .head_ignores = head_ignores,
                      .body_hold = body_hold,
                      .order = order},
                     tuning, stats);
    }
};

}  // namespace handhold::update_grabs_test
