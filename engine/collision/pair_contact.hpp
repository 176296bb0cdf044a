#pragma once

#include <span>
#include <vector>

#include "engine/collision/bullet_sweep.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/collision/mesh_contact.hpp"

// Narrowphase: contacts of one pair of colliders, as a pure function of the two shapes and a's
// motion relative to b.
namespace handhold {

// State of a sweep of one part towards one triangle (conservative advancement).
struct TriangleApproach {
    Approach approach;
    std::uint32_t triangle = 0;
};

// Scratch memory, reused from pair to pair. Its content is not used between calls.
struct PairScratch {
    TriangleShape triangle;
    ClipScratch clip;
    std::vector<NearTriangles> triangles;
    std::vector<TriangleApproach> approaches;
    std::vector<NearContact> contacts;
    std::vector<NearContact> spare;
};

struct PairIo {
    std::span<const ConvexPart> a;
    std::span<const ConvexPart> b;  // empty if b is a mesh
    Pose from_bs;                   // last valid pose of a in the frame of b's last valid pose
    Pose to_bs;                     // current pose of a in the frame of b's current pose
    // Only if b is a mesh: one entry per part of a, with all triangles within the margin of that
    // part's motion. Positions are relative to to_bs.position.
    std::span<const NearTriangles> triangles;
    const ContactLimits& limits;
    std::vector<ContactPoint>& contacts;  // appended to; ids are left 0
    PairScratch& scratch;                 // may own `triangles` above
};
void find_pair_contacts(const PairIo& io);

}  // namespace handhold
