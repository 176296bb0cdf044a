#pragma once

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "components/authored_grip.hpp"
#include "components/grab.hpp"
#include "engine/collision/collision_world.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::test {

// A player at the origin whose hands' palms look down (-Y), and bodies that a test adds. Everything
// is put into the world through frame_ws.
struct HandsAndBodies {
    Pose frame_ws;
    ShapeLibrary shapes;
    std::vector<ColliderProxy> proxies;
    Column<PersistentId> persistent_id;
    Column<HandOwner> owner;
    Column<HandTracking> hand;
    Column<PlayerOrigin> origin;
    Column<RigidBody> body;
    Column<BodyPose> body_pose;
    JointGroups joint_groups;
    Column<Grab> grab;
    Column<HandPull> pull;
    Column<HandSight> sight;
    Column<GrabRule> grab_rule;
    Column<GrabLayers> grab_layers;
    Column<CollisionFilter> filter;
    Tuning tuning;
    StageStats stats;

    HandsAndBodies(const Pose& frame, std::initializer_list<Entity> hands) : frame_ws(frame) {
        persistent_id.add(k_player, {100});
        origin.add(k_player, {frame_ws});
        for (const Entity entity : hands) {
            owner.add(entity, {k_player, entity == k_left ? HandSide::left : HandSide::right});
            hand.add(entity);
            grab.add(entity);
            sight.add(entity);
        }
    }
    void add_body(Entity entity, const RigidBody& rigid, ShapeId shape, const Pose& pose) {
        persistent_id.add(entity, {200 + std::uint64_t{entity.slot}});
        body.add(entity, rigid);
        body_pose.add(entity, {frame_ws * pose});
        proxies.push_back({persistent_id.at(entity).value, shape, frame_ws * pose, frame_ws * pose,
                           rigid.kind == BodyKind::free});
    }
    Vec3 palm_center_hs(Entity entity) const {
        const Vec3& right = tuning.hand.palm_center_m;
        return owner.at(entity).side == HandSide::right ? right : mirrored(right);
    }
    void place_proxies(CollisionWorld& collision) {
        std::ranges::sort(proxies, {}, &ColliderProxy::id);
        collision.set_proxies(proxies);
    }
};

}  // namespace handhold::test
