#pragma once

#include <array>
#include <span>
#include <vector>

#include "components/authored_grip.hpp"
#include "components/body.hpp"
#include "components/body_part.hpp"
#include "components/grab.hpp"
#include "components/hand_surroundings.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/ecs/column.hpp"
#include "engine/geometry/grip_mesh_library.hpp"
#include "systems/hand/shared/part_meshes.hpp"

namespace handhold {

inline constexpr double k_hand_length_m = 0.25;

struct GatherSurroundingsIo {
    // In: grip meshes by shape. Null: hands are not fitted to surfaces.
    const GripMeshLibrary* meshes = nullptr;
    const std::array<HandRig, k_hand_count>& rigs;  // in: by HandSide
    // In: the bodies that may be near a hand, in an order independent of entity slots.
    std::span<const Entity> bodies;
    const Column<PersistentId>& persistent_id;  // in
    const Column<HandOwner>& owner;             // in
    const Column<HandTracking>& hand;           // in: pose_ps, end of the frame
    const Column<Grab>& grab;                   // in: kind, body, anchor_bs
    const Column<PlayerOrigin>& origin;         // in: pose_ws, end of the frame
    const Column<HeadTracking>& head;           // in: pose_ps, for hands on a player's head
    const Column<BodyPose>& body_pose;          // in: pose_ws, end of the frame
    const Column<Collider>& collider;           // in: shape, the key into `meshes`
    // In. HandSurroundings::authored points into this column, so it must not change before the hand
    // stages have run.
    const Column<AuthoredHold>& authored_hold;
    std::vector<HandSurroundings>& surroundings;  // out: one per row of `owner`, in its order
    // In: hands with a rig of their own, and these rigs. Null, or an index beyond: `rigs`.
    const Column<HandRigChoice>* rig_choice = nullptr;
    std::span<const HandRig> more_rigs = {};
    // In: bodies that have their own grip mesh. It is used instead of the mesh of their shape.
    const Column<BodySurface>* body_surface = nullptr;
    // In: collision world with the colliders of `bodies`, used to find bodies near a hand.
    // `proxies` are in the order of `bodies`, sorted by id. Null: every body is tested.
    const CollisionWorld* collision = nullptr;
    std::span<const ColliderProxy> proxies = {};
    const Column<BodyHold>* body_hold = nullptr;  // in: of hands on a player's part
    // In: meshes of the parts that hands hold, and the bodies as the last frame showed them. Null:
    // hands on parts are shown as tracked.
    const PartMeshes* part_meshes = nullptr;
    const Column<RenderPose>* shown = nullptr;
    const Column<BodyMeasures>* measures = nullptr;
};

// Collects each hand's wrist pose and the surfaces near the hand, in the gripped body's frame. This
// is the first hand stage; the later ones read its output and their own columns.
//
// The wrist of a gripping hand is at its anchor. Its rotation is the tracked one, unless the
// gripped object turns with the hand. A body is near if its mesh's bounding box is within
// k_hand_length_m of the palm. Heads have no grip mesh: a hand that grips a head is shown as
// tracked. A hand on another player's part is fitted to the part's capsule; the body's frame is
// then the capsule's.
//
// Fallbacks counted: body_no_surface.
void gather_surroundings(const GatherSurroundingsIo& io, StageStats& stats);
// The same for the rows [first, last) of `owner`. `surroundings` must already have its full size.
void gather_surroundings(const GatherSurroundingsIo& io, std::size_t first, std::size_t last,
                         StageStats& stats);

}  // namespace handhold
