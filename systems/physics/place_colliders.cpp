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
    if (const CollisionFilter* const filter = io.filter.find(entity)) {
        proxy.layers = filter->layers;
        proxy.mask = filter->mask;
    }
    if (const PlayerOrigin* const origin = io.origin.find(entity)) {
        const Pose center_ps{head_center_ps(io.head.at(entity), origin->scale, tuning),
                             Quat::Identity()};
        proxy.to_ws = origin->pose_ws * center_ps;
        const LastValidPose& valid = io.last_valid.at(entity);
        // A head that has no valid pose yet is swept from its pose at the start of the frame.
        const Pose start_ws = io.player_start.at(entity).pose_ws * center_ps;
        proxy.from_ws = valid.known ? valid.pose_ws : start_ws;
        proxy.free = true;
        if (io.head.at(entity).state == TrackingState::never) {
            // The head has no pose yet. A proxy with an invalid pose takes no part in collision.
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

constexpr std::uint32_t k_no_index = std::numeric_limits<std::uint32_t>::max();

// Lists and places all bodies and players.
void place_all(const PlaceCollidersIo& io, const HeadTuning& tuning) {
    FrameGraph& frame = io.frame;
    frame.by_id.clear();
    for (const std::span<const Entity> owners : {io.body.owners(), io.origin.owners()}) {
        for (const Entity entity : owners) {
            frame.by_id.push_back({io.persistent_id.at(entity), entity});
        }
    }
    std::ranges::sort(frame.by_id, {}, &FrameGraph::Identified::id);
    frame.entities.clear();
    frame.index_of_slot.clear();
    for (const FrameGraph::Identified& identified : frame.by_id) {
        const std::uint32_t slot = identified.entity.slot;
        if (slot >= frame.index_of_slot.size()) {
            frame.index_of_slot.resize(std::size_t{slot} + 1, k_no_index);
        }
        frame.index_of_slot[slot] = static_cast<std::uint32_t>(frame.entities.size());
        frame.entities.push_back(identified.entity);
    }
    frame.proxies.clear();
    for (const Entity entity : frame.entities) {
        frame.proxies.push_back(proxy_of(io, entity, tuning));
    }
    frame.active.reset(frame.entities.size());
    io.collision.set_proxies(frame.proxies);
    frame.proxy_set = io.collision.proxy_set();
}

std::uint32_t index_of(const FrameGraph& frame, Entity entity) {
    return entity.slot < frame.index_of_slot.size() ? frame.index_of_slot[entity.slot] : k_no_index;
}

// Notes the bodies whose components changed since the last call, and all players. Returns false if
// all must be placed: bodies or players were added or removed, or another caller replaced the
// proxies.
bool note_changes(const PlaceCollidersIo& io) {
    FrameGraph& frame = io.frame;
    FrameGraph::Watches& watches = frame.watches;
    const auto note = [&frame](Entity entity) {
        if (const std::uint32_t i = index_of(frame, entity);
            i != k_no_index && frame.entities[i] == entity) {
            frame.active.note(i);
        }
    };
    bool same_ids = true;
    bool same = watches.persistent_id.update(io.persistent_id,
                                             [&same_ids](Entity /*entity*/) { same_ids = false; });
    // Compares every column, even after a difference was found, so that all copies are up to date.
    same = watches.collider.update(io.collider, note) && same;
    same = watches.body.update(io.body, note) && same;
    same = watches.body_pose.update(io.body_pose, note) && same;
    same = watches.body_start.update(io.body_start, note) && same;
    same = watches.last_valid.update(io.last_valid, note) && same;
    same = watches.origin.update(io.origin, note) && same;
    same = watches.body_velocity.update(io.body_velocity, note) && same;
    same = watches.filter.update(io.filter, note) && same;
    for (const Entity player : io.origin.owners()) {
        note(player);
    }
    return same && same_ids && frame.proxy_set == io.collision.proxy_set();
}

// Places the noted bodies. Returns false if a body has gained or lost its shape.
bool place_noted(const PlaceCollidersIo& io, const HeadTuning& tuning) {
    FrameGraph& frame = io.frame;
    frame.proxy_updates.clear();
    for (const std::uint32_t i : frame.active.noted) {
        const ColliderProxy proxy = proxy_of(io, frame.entities[i], tuning);
        if ((proxy.shape == k_no_shape) != (frame.proxies[i].shape == k_no_shape)) {
            return false;
        }
        frame.proxies[i] = proxy;
        frame.proxy_updates.push_back(proxy);
    }
    io.collision.update_proxies(frame.proxy_updates);
    return true;
}

}  // namespace

void place_colliders(const PlaceCollidersIo& io, const HeadTuning& tuning) {
    if (!note_changes(io) || !place_noted(io, tuning)) {
        place_all(io, tuning);
    }
    io.frame.active.is_tracked = true;
}

}  // namespace handhold
