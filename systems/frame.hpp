#pragma once

#include <array>
#include <span>

#include "components/frame_graph.hpp"
#include "components/hand_scratch.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "components/world.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/collision/shape_library.hpp"
#include "engine/geometry/grip_mesh_library.hpp"
#include "systems/rigs/body_clips.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"

// The library's entry point: feed tracking samples, step, read RenderPose.
namespace handhold {

struct FrameInput {
    double dt_s = 1.0 / 90.0;              // [1e-6, 10]
    std::span<const PlayerInput> players;  // any subset of the world's players
};

// Data that frames keep outside the world: caches, and the assets that they are built from. Caches
// may be dropped before any frame; no bit of a result changes.
struct FrameCaches {
    // `shapes` must outlive the caches and contain every shape of the world's colliders.
    // `grip_meshes` has the meshes that hands are fitted to, and must outlive the caches too. Hands
    // are shown as tracked without it, and on shapes that it lacks.
    explicit FrameCaches(const ShapeLibrary& shapes, const GripMeshLibrary* grip_meshes = nullptr)
        : collision(shapes), meshes_for_hands(grip_meshes) {}

    CollisionWorld collision;
    FrameGraph graph;
    const GripMeshLibrary* meshes_for_hands = nullptr;
    // Assets. Set them again whenever new caches are made.
    std::array<HandRig, k_hand_count> hand_rigs = {builtin_hand_rig(HandSide::left),
                                                   builtin_hand_rig(HandSide::right)};
    BodyClips body_clips;  // empty: no additive clips
    HandScratch hands;
};

// Steps one frame. `stats` is cleared first. Throws PreconditionError if dt_s,
// world.reference_velocity_mps or `tuning` is out of range; no player input makes it fail.
void step_frame(World& world, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
                StageStats& stats);

// Hash of all columns, the clock and the reference velocity. Identifies rows by persistent id, so
// it is independent of slots, creation order, thread count, build and compiler.
std::uint64_t hash_state(const World& world);

}  // namespace handhold
