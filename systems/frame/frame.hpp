#pragma once

#include <array>
#include <span>
#include <vector>

#include "components/frame_graph.hpp"
#include "components/hand_scratch.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "components/world.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/geometry/grip_mesh_library.hpp"
#include "engine/geometry/shape_library.hpp"
#include "systems/grab/shared/grab_search.hpp"
#include "systems/hand/shared/part_meshes.hpp"
#include "systems/hand/shared/resized_meshes.hpp"
#include "systems/rigs/body_clips.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"

// The library's entry point: feed tracking samples, step, read RenderPose.
namespace handhold {

inline constexpr double k_min_dt_s = 1e-6;
inline constexpr double k_max_dt_s = 10.0;

struct FrameInput {
    double dt_s = 1.0 / 90.0;              // [k_min_dt_s, k_max_dt_s]
    std::span<const PlayerInput> players;  // any subset of the world's players
};

// Data that frames keep outside the world: caches, and the assets that they are built from. Caches
// may be dropped before any frame; no bit of a result changes.
struct FrameCaches {
    // `shapes` must outlive the caches and contain every shape of the world's colliders.
    // `grip_meshes` has the meshes that hands are fitted to, and must outlive the caches too. Hands
    // are shown as tracked without it, and on shapes that it lacks.
    explicit FrameCaches(const ShapeLibrary& library, const GripMeshLibrary* grip_meshes = nullptr)
        : shapes(&library), collision(library), meshes_for_hands(grip_meshes) {}

    const ShapeLibrary* shapes;
    CollisionWorld collision;
    FrameGraph graph;
    const GripMeshLibrary* meshes_for_hands = nullptr;
    // Surfaces that hands and legs query instead of colliders; empty: colliders. The queried object
    // must outlive every frame.
    SurfaceQuery host_surfaces;
    // Assets. Set them again whenever new caches are made.
    std::array<HandRig, k_hand_count> hand_rigs = {builtin_hand_rig(HandSide::left),
                                                   builtin_hand_rig(HandSide::right)};
    std::vector<HandRig> more_hand_rigs;  // rigs of hands with a HandRigChoice
    BodyClips body_clips;                 // empty: no additive clips
    Column<BodySurface> body_surfaces;    // bodies with a grip mesh of their own
    HandScratch hands;
    std::vector<ClosingHand> closing_hands;  // scratch of update_grabs
    PartMeshes part_meshes;        // meshes of held players' parts; built when a hand grips one
    ResizedMeshes resized_meshes;  // meshes for hands of players whose scale is not 1
};

// Steps one frame: every stage in the order of the list in frame.cpp. `stats` is cleared first. No
// player input makes it fail. Throws PreconditionError, before it changes anything, if dt_s, a
// number of `tuning`, or the world's gravity or reference velocity is out of range, or a collider's
// shape is not in the caches' library or is a mesh on a free body or a player.
void step_frame(World& world, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
                StageStats& stats);

// The same without the shown stages: no fitted hands, arms, spine and legs, and RenderPose stays as
// it was. Simulated columns (k_is_shown) change exactly as in step_frame. For rollback: of many
// steps only the last is shown.
void step_simulated(World& world, FrameCaches& caches, const Tuning& tuning,
                    const FrameInput& input, StageStats& stats);

// Shows players while the world is paused, as in a menu. Heads, hands and bodies follow each
// player's last sample for dt_s; the clock, bodies, joints, grips and players' origins do not
// change. The next step_frame continues from the end of the last one. Throws the same errors as
// step_frame.
void step_pose_only(World& world, FrameCaches& caches, const Tuning& tuning,
                    const FrameInput& input, StageStats& stats);

// Hash of all columns, the clock, the reference velocity and, unless it is zero, gravity.
// Identifies elements by persistent id, so it is independent of slots, creation order, thread
// count, build, compiler and processor. docs/guide/platforms.md lists the tested targets.
std::uint64_t hash_state(const World& world);
// The same of the simulated columns alone: equal whichever steps were shown.
std::uint64_t hash_simulated(const World& world);

}  // namespace handhold
