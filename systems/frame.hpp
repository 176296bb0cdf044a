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

// The library's front door: feed tracking samples, step, read RenderPose.
namespace handhold {

struct FrameInput {
    double dt_s = 1.0 / 90.0;              // [1e-6, 10]
    std::span<const PlayerInput> players;  // any subset of the world's players
};

// Everything that a frame keeps beside the world: caches, which may be thrown away before any frame
// without changing one bit of the next, and the assets that they are made for.
struct FrameCaches {
    // `shapes` must outlive the caches and hold every shape that the world's colliders name; so
    // must `grip_meshes`, to which hands are fitted. Without it, or where it lacks a shape, hands
    // are shown as they are tracked.
    explicit FrameCaches(const ShapeLibrary& shapes, const GripMeshLibrary* grip_meshes = nullptr)
        : collision(shapes), meshes_for_hands(grip_meshes) {}

    CollisionWorld collision;
    FrameGraph graph;
    const GripMeshLibrary* meshes_for_hands = nullptr;
    // Assets: whoever sets others sets them again in new caches.
    std::array<HandRig, k_hand_count> hand_rigs = {builtin_hand_rig(HandSide::left),
                                                   builtin_hand_rig(HandSide::right)};
    BodyClips body_clips;  // none: nothing is laid on top of the body
    HandScratch hands;
};

// One frame: a straight line of stages, each a system over the columns it is given; nothing else
// decides the order. `stats` is cleared first. Throws PreconditionError where dt_s is out of range;
// no input of a player makes it fail.
void step_frame(World& world, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
                StageStats& stats);

// A hash of all columns, by persistent id: independent of slots, order of creation, thread count,
// build and compiler.
std::uint64_t hash_state(const World& world);

}  // namespace handhold
