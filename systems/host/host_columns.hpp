#pragma once

#include <handhold/handhold.h>

#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "components/world.hpp"
#include "engine/geometry/grip_mesh_library.hpp"
#include "engine/geometry/shape_library.hpp"
#include "engine/math/math.hpp"
#include "systems/frame/frame.hpp"

// From a world of the C interface to the columns behind it, for source embedders who step through
// the interface and show or edit what it does not: gizmos, inspectors, reports, levels.
namespace handhold {

// What a hh_world consists of; valid until hh_world_destroy.
struct HostColumns {
    World& world;
    Tuning& tuning;
    ShapeLibrary& shapes;          // shapes added here are in their own frame
    GripMeshLibrary& grip_meshes;  // unused by a world without fits_hands
    FrameCaches& caches;
};
struct ConstHostColumns {
    const World& world;
    const Tuning& tuning;
    const ShapeLibrary& shapes;
    const GripMeshLibrary& grip_meshes;
    const FrameCaches& caches;
    const StageStats& stats;  // statistics of the last step
};

// `world` is not null. Change columns between steps only, and ask for them again after a query
// (hh_world_cast_ray and others) before changing them again: queries look for changes once.
HostColumns columns_of(hh_world* world);
ConstHostColumns columns_of(const hh_world* world);

// Ids of the interface and of the columns are the same two numbers.
inline Entity entity_of(hh_body body) { return {body.index, body.generation}; }
inline Entity entity_of(hh_player player) { return {player.index, player.generation}; }
inline hh_body body_id(Entity entity) { return {entity.slot, entity.generation}; }
inline hh_player player_id(Entity entity) { return {entity.slot, entity.generation}; }
// The entities of a player and both hands.
PlayerEntities player_entities(const World& world, hh_player player);

// The interface's vectors as Eigen's, and back, to the bit.
inline Vec3 from_host(const hh_vec3& v) { return {v.x, v.y, v.z}; }
inline Quat from_host(const hh_quat& q) { return {q.w, q.x, q.y, q.z}; }
inline Pose from_host(const hh_pose& pose) {
    return {from_host(pose.position), from_host(pose.rotation)};
}
inline hh_vec3 to_host(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline hh_quat to_host(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline hh_pose to_host(const Pose& pose) {
    return {to_host(pose.position), to_host(pose.rotation)};
}
inline hh_side to_host(HandSide side) { return side == HandSide::left ? HH_LEFT : HH_RIGHT; }

}  // namespace handhold
