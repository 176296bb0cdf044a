#pragma once

#include "engine/collision/bullet_broadphase.hpp"
#include "engine/collision/bullet_triangle_tree.hpp"
#include "engine/collision/pair_contact.hpp"

// What a CollisionWorld holds.
namespace handhold {

// One of the two is there.
struct CollisionShape {
    std::optional<ScaledTriangles> triangles;  // of a mesh
    std::vector<ConvexPart> parts;             // of anything else
};

struct CollisionWorld::Impl {
    explicit Impl(const ShapeLibrary& library);

    void check(std::span<const ColliderProxy> proxies) const;
    bool is_pair(const BroadphaseBody& a, const BroadphaseBody& b) const;
    void find_pair(const BroadphaseBody& a, const BroadphaseBody& b, const ContactLimits& limits,
                   PairScratch& scratch, std::vector<ContactPoint>& contacts) const;

    const ShapeLibrary& shapes;
    std::vector<CollisionShape> cache;  // by shape
    std::vector<ShapeExtent> extents;   // by shape
    Broadphase broadphase;
    std::vector<IgnoredPair> ignored;
    BroadphaseScratch broadphase_scratch;  // of find_contacts, as the next
    PairScratch pair_scratch;
};

}  // namespace handhold
