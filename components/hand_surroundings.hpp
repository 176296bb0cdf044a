#pragma once

#include <cstdint>
#include <vector>

#include "components/authored_grip.hpp"
#include "components/hand_rig.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/geometry/chain_fit.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// Input of the hand stages: one hand and the surfaces near it, in the frame of the gripped body
// (_bs). A hand on a moving body is therefore solved exactly as on a body at rest. Not state:
// gather_surroundings rewrites it every frame.
struct HandSurroundings {
    Entity hand = k_no_entity;
    Entity body = k_no_entity;  // gripped body; null: nothing to fit to, shown as tracked
    const HandRig* rig = nullptr;
    Pose body_ws;
    // Tracked wrist, or the wrist its grip dictates; in world space if the hand is empty.
    Pose wrist_bs;
    std::vector<PlacedMesh> meshes;  // the gripped body's mesh first, then meshes nearby
    // Hash of the body, the meshes and their poses rounded to 0.1 mm: nothing around the hand has
    // moved while it is unchanged. 0: the hand is empty.
    std::uint64_t signature = 0;
    bool is_gripping = false;                // also true if it grips a head, which is no body
    const AuthoredHand* authored = nullptr;  // its pose in an authored grip; null: not in one
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
        Vec3 point = Vec3::Zero();               // on that triangle, under the palm
        double cost_m = 0.0;                     // PalmCost in closed form
    };
    std::vector<Node> open;
    std::vector<Candidate> found;
    std::vector<Candidate> remaining;  // the part of `found` that may still be listed
    std::vector<std::uint32_t> seen;
    ChainPatch patch;
};

// Search and fit counters of one digit in one frame, for the measuring tools and the pictures. Not
// state. Fields as in ChainFit.
struct FingerTrace {
    std::uint32_t discs = 0;
    std::uint32_t pops = 0;
    std::uint32_t walked = 0;
    std::int32_t contact_link = -1;  // -1: touches nothing
    ChainFallback fallback = ChainFallback::none;
    double depth_m = 0.0;
};

}  // namespace handhold
