#include "systems/physics/place_colliders.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "components/play_space.hpp"

namespace handhold {
namespace {

ColliderProxy proxy_of(const PlaceCollidersIo& io, Entity entity, const HeadTuning& tuning) {
    ColliderProxy proxy;
    proxy.id = io.persistent_id.at(entity).value;
    const Collider* const collider = io.collider.find(entity);
    proxy.shape = collider != nullptr ? collider->shape : k_no_shape;
    if (const CollisionFilter* const filter =
            io.filter != nullptr ? io.filter->find(entity) : nullptr) {
        proxy.layers = filter->layers;
        proxy.mask = filter->mask;
    }
    if (const PlayerOrigin* const origin = io.origin.find(entity)) {
        proxy.to_ws =
            origin->pose_ws * Pose{head_center_ps(io.head.at(entity), tuning), Quat::Identity()};
        const LastValidPose& valid = io.last_valid.at(entity);
        // A head that was nowhere yet still moves through its first frame.
        const Pose start_ws = io.player_start.at(entity).pose_ws *
                              Pose{head_center_ps(io.head.at(entity), tuning), Quat::Identity()};
        proxy.from_ws = valid.known ? valid.pose_ws : start_ws;
        proxy.free = true;
        if (io.head.at(entity).state == TrackingState::never) {
            // No pose yet: proxies with an invalid pose take no part in collision.
            proxy.to_ws.position.setConstant(std::numeric_limits<double>::quiet_NaN());
        }
        return proxy;
    }
    proxy.to_ws = io.body_pose.at(entity).pose_ws;
    proxy.free = io.body.at(entity).kind == BodyKind::free;
    proxy.from_ws =
        proxy.free ? io.last_valid.at(entity).pose_ws : io.body_start.at(entity).pose_ws;
    return proxy;
}

}  // namespace

void place_colliders(const PlaceCollidersIo& io, const HeadTuning& tuning) {
    FrameGraph& frame = io.frame;
    frame.by_id.clear();
    for (const std::span<const Entity> owners : {io.body.owners(), io.origin.owners()}) {
        for (const Entity entity : owners) {
            frame.by_id.push_back({io.persistent_id.at(entity), entity});
        }
    }
    std::ranges::sort(frame.by_id, {}, &FrameGraph::Identified::id);
    frame.entities.clear();
    for (const FrameGraph::Identified& identified : frame.by_id) {
        frame.entities.push_back(identified.entity);
    }
    frame.proxies.clear();
    for (const Entity entity : frame.entities) {
        frame.proxies.push_back(proxy_of(io, entity, tuning));
    }
    io.collision.set_proxies(frame.proxies);
}

}  // namespace handhold
