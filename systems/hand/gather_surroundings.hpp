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
#include "systems/hand/shared/resized_meshes.hpp"

namespace handhold {

inline constexpr double k_hand_length_m = 0.25;

// Meshes that hands are fitted to.
struct MeshesForHands {
    // By shape. Null: hands are fitted neither to shapes nor to parts of players.
    const GripMeshLibrary* of_shapes = nullptr;
    const Column<BodySurface>& of_bodies;  // used instead of the mesh of the body's shape
    const PartMeshes& of_parts;            // meshes of every part that a hand holds
    ResizedMeshes& resized;                // in/out: for hands of players of another scale
};

// Where gather_surroundings looks for bodies near a hand.
struct BodiesNearHands {
    std::span<const Entity> bodies;  // bodies in an order independent of entity slots
    // Has the colliders of `bodies`. Null: every body is tested.
    const CollisionWorld* collision = nullptr;
    // Proxies of `collision`, indexed like `bodies` and sorted by id.
    std::span<const ColliderProxy> proxies = {};
};

struct GatherSurroundingsIo {
    MeshesForHands meshes;                        // in
    std::span<const HandRig, k_hand_count> rigs;  // in: by HandSide
    std::span<const HandRig> more_rigs;           // in: by HandRigChoice::index
    // in: a hand without a choice, or with an index beyond more_rigs, has its side's rig of `rigs`
    const Column<HandRigChoice>& rig_choice;
    BodiesNearHands near;                       // in: end of the frame
    const Column<PersistentId>& persistent_id;  // in
    const Column<HandOwner>& owner;             // in
    const Column<HandTracking>& hand;           // in: pose_ps, end of the frame
    const Column<Grab>& grab;                   // in: kind, body, anchor_bs, jointed, two_handed
    const Column<BodyHold>& body_hold;          // in: hands that grip another player's body
    const Column<PlayerOrigin>& origin;         // in: pose_ws, end of the frame
    const Column<HeadTracking>& head;           // in: pose_ps, for hands on a player's head
    const Column<RenderPose>& shown;            // in: held players, as of the last frame
    const Column<BodyMeasures>& measures;       // in: held players
    const Column<BodyPose>& body_pose;          // in: pose_ws, end of the frame
    const Column<Collider>& collider;           // in: shape, the key into `meshes.of_shapes`
    // in: HandSurroundings::authored points into this column, so it must not change before the hand
    // stages have run
    const Column<AuthoredHold>& authored_hold;
    std::vector<HandSurroundings>& surroundings;  // out: one per element of `owner`, in its order
};

// Collects each hand's wrist pose and the surfaces near the hand, in the gripped body's frame. This
// is the first hand stage; the later ones read its output and their own columns.
//
// The wrist of a gripping hand is at its anchor. Its rotation is the tracked one, unless the
// gripped object turns with the hand. A body is near if its mesh's bounding box is within
// k_hand_length_m of the palm; for players whose scale is not 1, if its surface is. A hand on
// another player's part is fitted to the part's capsule; the body's frame is then the capsule's.
//
// If the gripped body has no mesh, HandSurroundings::body is null: the hand is shown at its anchor,
// not fitted. Heads never have a mesh.
//
// All lengths are in the hand's metres: the world's over the player's scale. Meshes for a scale
// other than 1 come from MeshesForHands::resized.
//
// Fallbacks counted: body_no_surface, if a gripped body has no mesh in a world that fits hands.
void gather_surroundings(const GatherSurroundingsIo& io, StageStats& stats);
// gather_surroundings for the elements [first, last) of `owner`. `surroundings` must already have
// its full size. Ranges may be gathered in parallel if all players have a scale of 1.
void gather_surroundings(const GatherSurroundingsIo& io, std::size_t first, std::size_t last,
                         StageStats& stats);

}  // namespace handhold
