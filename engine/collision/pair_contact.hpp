#pragma once

#include <span>
#include <vector>

#include "engine/collision/bullet_sweep.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/collision/mesh_contact.hpp"

// Contacts of one pair of colliders: a pure function of the two shapes and a's way relative to b.
namespace handhold {

// A triangle that a part is on its way to.
struct TriangleApproach {
    Approach approach;
    std::uint32_t triangle = 0;
};

// Memory that is reused from pair to pair; its content means nothing between calls.
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
    std::span<const ConvexPart> b;  // empty: a mesh
    Pose from_bs;                   // a's last valid pose in b's frame as b was then
    Pose to_bs;                     // a's present pose in b's present frame
    // For a mesh b, for each part of a: all triangles that come within the margin of it on its way,
    // about to_bs.position. Not looked at otherwise.
    std::span<const NearTriangles> triangles;
    const ContactLimits& limits;
    std::vector<ContactPoint>& contacts;  // appended; ids are left 0
    PairScratch& scratch;                 // `triangles` above may be its own
};
void find_pair_contacts(const PairIo& io);

}  // namespace handhold
