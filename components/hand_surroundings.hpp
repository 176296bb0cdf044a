#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "components/authored_grip.hpp"
#include "components/hand_rig.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/geometry/chain_fit.hpp"
#include "engine/geometry/grip_mesh.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// Grip mesh of one body, in the body's frame, for hosts whose shapes are not in a ShapeLibrary. An
// asset, not state. Written by the host.
struct BodySurface {
    std::shared_ptr<const GripMesh> mesh;  // never null
};

// Step of HandSurroundings::search_signature. A sixth of the travel after which a hand searches
// again (k_search_again_m): a link beside the gripped one moves in every frame of a swinging cable.
inline constexpr double k_search_step_m = 0.005;
// Axes are rounded to that step at the mesh's farthest point, or at this distance if that is more.
inline constexpr double k_search_lever_m = 0.1;

// Input of the hand stages: one hand and the surfaces near it, in the gripped body's frame (_bs)
// and in the hand's metres: the world's over PlayerOrigin::scale. A hand on a moving body is
// therefore solved exactly like a hand on a body at rest, and a hand of any size like one of a
// player of scale 1. Not state: gather_surroundings rewrites it every frame.
struct HandSurroundings {
    Entity hand = k_no_entity;
    Entity body = k_no_entity;  // gripped body; null: there is no surface to fit the hand to
    const HandRig* rig = nullptr;
    Pose body_ws;        // position in the world's metres
    double scale = 1.0;  // PlayerOrigin::scale: the world's metres in one of the hand's
    // Wrist of a gripping hand: its anchor, with the tracked rotation if the hand may turn on its
    // grip. For an empty hand: the tracked wrist, in world space.
    Pose wrist_bs;
    // Between the player's eyes. Null: the hand is empty, or the head was never tracked.
    std::optional<Vec3> eye_bs = std::nullopt;
    std::vector<PlacedMesh> meshes;  // mesh of the gripped body, then other meshes near the hand
    // Hash of the body, the meshes and their poses rounded to 0.1 mm. While the hash is unchanged,
    // nothing around the hand has moved. 0: no body.
    std::uint64_t signature = 0;
    // The same hash with poses rounded to k_search_step_m: while it is unchanged, the surface under
    // the palm is not searched again. 0: no body.
    std::uint64_t search_signature = 0;
    bool is_gripping = false;  // also true for a grip on a head, which has no mesh
    // The hand's pose in its authored grip, in the world's metres; null: not in an authored grip.
    const AuthoredHand* authored = nullptr;

    // Precondition: in an authored grip.
    Pose authored_wrist_bs() const {
        return {authored->wrist_bs.position / scale, authored->wrist_bs.rotation};
    }
};

// Scratch memory of search_grip; keeps its capacity between calls.
struct GripSearchScratch {
    struct Node {
        double cost_m = 0.0;
        std::uint32_t triangle = 0;
        std::uint32_t order = 0;    // insertion order, the tie-breaker
        Vec3 point = Vec3::Zero();  // see Candidate
    };
    struct Candidate {
        std::uint32_t triangle = k_no_triangle;  // index into the search mesh
        Vec3 point = Vec3::Zero();               // point on that triangle, under the palm
        double cost_m = 0.0;                     // closed-form cost (PalmCost)
    };
    std::vector<Node> open;
    std::vector<Candidate> found;
    std::vector<Candidate> remaining;  // candidates of `found` that may still be listed
    std::vector<std::uint32_t> seen;
};

// Counters of one digit's searches and fits in one frame, for measuring tools and pictures. Not
// state. The fields are explained at ChainFit.
struct FingerTrace {
    std::uint32_t discs = 0;
    std::uint32_t pops = 0;
    std::uint32_t walked = 0;
    std::int32_t contact_link = -1;  // -1: touches nothing
    ChainFallback fallback = ChainFallback::none;
    double depth_m = 0.0;
};

}  // namespace handhold
