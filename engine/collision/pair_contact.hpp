#pragma once

#include <span>
#include <vector>

#include "engine/collision/bullet_sweep.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/collision/mesh_contact.hpp"

// Narrowphase: contacts of one pair of colliders, as a pure function of the two shapes and a's
// motion relative to b.
namespace handhold {

// Conservative advancement of one part towards one triangle.
struct TriangleApproach {
    Approach approach;
    std::uint32_t triangle = 0;
};

// Scratch, reused from pair to pair. The content means nothing between calls.
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
    Pose from_bs;                   // a's last valid pose in the frame of b's last valid pose
    Pose to_bs;                     // a's current pose in the frame of b's current pose
    // Mesh b only, one entry per part of a: all triangles within the margin of the part's motion,
    // relative to to_bs.position.
    std::span<const NearTriangles> triangles;
    const ContactLimits& limits;
    std::vector<ContactPoint>& contacts;  // appended to; ids are left 0
    PairScratch& scratch;                 // may own `triangles` above
};
void find_pair_contacts(const PairIo& io);

}  // namespace handhold
