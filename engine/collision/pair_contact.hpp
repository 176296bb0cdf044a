#pragma once

#include <span>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "engine/collision/mesh_contact.hpp"

// Contacts of one pair of colliders: a pure function of the two shapes and a's way relative to b.
namespace handhold {

// Memory that is reused from pair to pair; its content means nothing between calls.
struct PairScratch {
    TriangleShape triangle;
    ClipScratch clip;
    std::vector<NearTriangle> triangles;
    std::vector<NearContact> contacts;
    std::vector<NearContact> spare;
};

struct PairIo {
    const ConvexShape& a;
    const ConvexShape* b;  // null: a mesh
    Pose from_bs;          // a's last valid pose in b's frame as b was then
    Pose to_bs;            // a's present pose in b's present frame
    // For a mesh b: all triangles that come within the margin of a on its way, about
    // to_bs.position. Empty otherwise.
    std::span<const NearTriangle> triangles;
    const ContactLimits& limits;
    std::vector<ContactPoint>& contacts;  // appended; ids are left 0
    PairScratch& scratch;                 // `triangles` above may be its own
};
void find_pair_contacts(const PairIo& io);

}  // namespace handhold
