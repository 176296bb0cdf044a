#pragma once

#include <cstdint>
#include <vector>

#include "components/authored_grip.hpp"
#include "components/hand_rig.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/geometry/chain_fit.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// What one hand has around it, in the frame of the body that it grips (_bs), so that a hand on
// something that moves is solved as on something that stands. Not state: written anew in every
// frame by gather_surroundings.
struct HandSurroundings {
    Entity hand = k_no_entity;
    Entity body = k_no_entity;  // gripped; null: an empty hand, which is shown where it is tracked
    const HandRig* rig = nullptr;
    Pose body_ws;
    Pose wrist_bs;  // as tracked, or as its grip holds it; in the world for an empty hand
    std::vector<PlacedMesh> meshes;  // the gripped body's first, then what is near
    std::uint64_t signature = 0;  // of the body and the meshes and where they are, within 0.1 mm:
                                  // while it stays, nothing around the hand has changed; 0: empty
    bool grips = false;           // also what is no body: a head
    const AuthoredHand* authored = nullptr;  // how it sits in an authored grip; null: in none
};

// What search_grip works in: keeps its memory between calls.
struct GripSearchScratch {
    struct Node {
        double cost_m = 0.0;
        std::uint32_t triangle = 0;
        std::uint32_t order = 0;
        Vec3 point = Vec3::Zero();  // as Found's
    };
    struct Candidate {
        std::uint32_t triangle = k_no_triangle;
        Vec3 point = Vec3::Zero();  // under the palm, on the search detail
        double cost_m = 0.0;
    };
    std::vector<Node> open;
    std::vector<Candidate> found;
    std::vector<Candidate> remaining;  // of those, what may still be listed
    std::vector<std::uint32_t> seen;
    ChainPatch patch;
};

// Triangle-wise figures of a frame's hands, for the measuring tools and the pictures. Not state.
struct FingerTrace {
    std::uint32_t discs = 0;
    std::uint32_t pops = 0;
    std::uint32_t walked = 0;
    std::int32_t contact_link = -1;
    ChainFallback fallback = ChainFallback::none;
    double depth_m = 0.0;
};

}  // namespace handhold
