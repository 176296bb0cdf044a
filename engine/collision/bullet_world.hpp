#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "engine/collision/bullet_broadphase.hpp"
#include "engine/collision/bullet_triangle_tree.hpp"
#include "engine/collision/pair_cache.hpp"
#include "engine/collision/pair_contact.hpp"

// Private data of CollisionWorld.
namespace handhold {

// Exactly one of the two members is set.
struct CollisionShape {
    std::optional<ScaledTriangles> triangles;  // meshes
    std::vector<ConvexPart> parts;             // all other shapes
};

// A free body and the colliders that it may touch: the range [first, last) of Impl::pairs.
struct BodyPairs {
    std::size_t body = 0;
    std::size_t first = 0;
    std::size_t last = 0;
    bool is_isolated = false;  // inside its isolation box: only the pairs listed need a test
};

// Isolation boxes are larger than a body's bounds with margin by at most this, on each side.
constexpr double k_isolation_reach_m = 0.3;

struct CollisionWorld::Impl {
    explicit Impl(const ShapeLibrary& library) : shapes(library) { update_shapes(); }

    void update_shapes();
    std::shared_ptr<const TriangleTree> tree_of(const std::shared_ptr<const Mesh>& mesh);

    void check(std::span<const ColliderProxy> proxies) const;
    bool is_pair(const BroadphaseBody& a, const BroadphaseBody& b) const;
    // True if one of two free bodies has the other's centre well inside.
    bool is_deep(const BroadphaseBody& a, const BroadphaseBody& b) const;
    // Fills body_pairs and pairs.
    void find_pairs(double margin_m);
    // Fills changed_bodies.
    void find_changed_bodies();
    // If no partner of the body is near, caches a box around the body that no partner reaches into.
    void cache_isolation(const BodyPairs& body, double margin_m);
    bool may_enter(const Bounds& box_ws, const BroadphaseBody& a, const BroadphaseBody& b) const;
    // Appends the pair's contacts. Returns a box around a's swept bounds that b does not reach
    // into, if one is known.
    std::optional<Bounds> find_pair(const BroadphaseBody& a, const BroadphaseBody& b,
                                    const ContactLimits& limits,
                                    std::vector<ContactPoint>& contacts) const;
    // Looks up every pair in the cache: a hit needs no narrowphase.
    void look_up_pairs(const ContactLimits& limits);
    void find_contacts_of(const BodyPairs& body, const ContactLimits& limits,
                          std::vector<ContactPoint>& contacts);
    void remember(const BodyPairs& body, std::span<const ContactPoint> contacts);

    const ShapeLibrary& shapes;
    std::vector<CollisionShape> cache;  // by shape index
    std::vector<ShapeExtent> extents;   // by shape index
    std::uint64_t shapes_revision = 0;  // of the library, when `cache` was brought up to date
    // Shapes of one mesh share its tree. The mesh itself is kept alive by its shapes.
    std::map<const Mesh*, std::weak_ptr<const TriangleTree>> trees;
    Broadphase broadphase;
    std::vector<IgnoredPair> ignored;
    // Scratch of find_contacts.
    BroadphaseScratch broadphase_scratch;
    // Bodies that changed after the oldest cached isolation box was computed.
    std::vector<std::size_t> changed_bodies;
    std::vector<BodyPairs> body_pairs;  // one per free body, ascending by id
    std::vector<std::size_t> pairs;     // indices of the other bodies into broadphase.bodies()
    // One list per entry of body_pairs, so that threads can work in parallel.
    std::vector<std::vector<ContactPoint>> found;
    struct PairResult {
        std::optional<PairCache::Result> cached;
        std::size_t count = 0;  // number of contacts
        std::optional<Bounds> clear_ws;
    };
    std::vector<PairResult> pair_results;  // parallel to pairs
    PairCache pair_cache;
};

}  // namespace handhold
