#pragma once

#include "engine/collision/bullet_broadphase.hpp"
#include "engine/collision/bullet_triangle_tree.hpp"
#include "engine/collision/pair_cache.hpp"
#include "engine/collision/pair_contact.hpp"

// What a CollisionWorld holds.
namespace handhold {

// One of the two is there.
struct CollisionShape {
    std::optional<ScaledTriangles> triangles;  // of a mesh
    std::vector<ConvexPart> parts;             // of anything else
};

// A free body and those that it may touch: a range of Impl::pairs.
struct BodyPairs {
    std::size_t body = 0;
    std::size_t first = 0;
    std::size_t last = 0;
    bool is_isolated = false;  // it is where all but these have nothing
};

// How far about a body at most it is noted that nothing is there.
constexpr double k_isolation_reach_m = 0.3;

struct CollisionWorld::Impl {
    explicit Impl(const ShapeLibrary& library);

    void check(std::span<const ColliderProxy> proxies) const;
    bool is_pair(const BroadphaseBody& a, const BroadphaseBody& b) const;
    // Fills body_pairs and pairs.
    void find_pairs(double margin_m);
    // Fills restless.
    void find_changed_bodies();
    // Where none of the body's pairs is near: a box about it in which nothing is, if there is one.
    void cache_isolation(const BodyPairs& body, double margin_m);
    bool may_enter(const Bounds& box_ws, const BroadphaseBody& a, const BroadphaseBody& b) const;
    // The pair's contacts; a box about a's way in which b has nothing, where that is easily seen.
    std::optional<Bounds> find_pair(const BroadphaseBody& a, const BroadphaseBody& b,
                                    const ContactLimits& limits,
                                    std::vector<ContactPoint>& contacts) const;
    // Asks the memory for every pair: what it has need not be met.
    void look_up_pairs(const ContactLimits& limits);
    void find_contacts_of(const BodyPairs& body, const ContactLimits& limits,
                          std::vector<ContactPoint>& contacts);
    void remember(const BodyPairs& body, std::span<const ContactPoint> contacts);

    const ShapeLibrary& shapes;
    std::vector<CollisionShape> cache;  // by shape
    std::vector<ShapeExtent> extents;   // by shape
    Broadphase broadphase;
    std::vector<IgnoredPair> ignored;
    // Of find_contacts.
    BroadphaseScratch broadphase_scratch;
    std::vector<std::size_t>
        changed_bodies;                 // numbers of bodies that changed since some box was noted
    std::vector<BodyPairs> body_pairs;  // by rising id of a
    std::vector<std::size_t> pairs;     // numbers of the bodies b
    std::vector<std::vector<ContactPoint>> found;  // by body_pairs: threads share the work
    struct PairResult {
        std::optional<PairCache::Known> cached;
        std::size_t count = 0;  // contacts of the pair
        std::optional<Bounds> clear_ws;
    };
    std::vector<PairResult> pair_results;  // by pairs
    PairCache memory;
};

}  // namespace handhold
