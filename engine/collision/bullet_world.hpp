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
    bool is_new = false;       // searched in this pass, not taken over from the last one
};

// Isolation boxes are larger than a body's bounds with margin by at most this, on each side.
constexpr double k_isolation_reach_m = 0.3;

struct CollisionWorld::Impl {
    explicit Impl(const ShapeLibrary& library) : shapes(library) { update_shapes(); }

    void update_shapes();
    std::shared_ptr<const TriangleTree> tree_of(const std::shared_ptr<const Mesh>& mesh);

    void check(std::span<const ColliderProxy> proxies) const;
    void check(const ColliderProxy& proxy) const;
    bool is_pair(const BroadphaseBody& a, const BroadphaseBody& b) const;
    // True if two convex free bodies overlap by about a quarter of their mean thickness or more.
    bool is_deep(const BroadphaseBody& a, const BroadphaseBody& b) const;
    void add_free_pairs(std::size_t first);
    // Fills body_pairs and pairs. A body that has no pairs costs nothing if nothing near it changed
    // since the last pass.
    void find_pairs(double margin_m);
    // Why find_pairs visits a body. If there are several reasons, the highest value is kept.
    enum class Visit : std::uint8_t { none, listed, dirty, changed };
    void mark(std::size_t body, Visit visit, std::size_t slot);
    void mark_near_changes(double margin_m);
    void find_visits(double margin_m);
    std::span<const std::size_t> find_candidates(std::size_t body, const Bounds& reach_ws);
    void search_pairs(std::size_t i, double margin_m);
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
    std::vector<CollisionShape> cache;  // indexed by shape index
    std::vector<ShapeExtent> extents;   // indexed by shape index
    std::uint64_t shapes_revision = 0;  // library's revision when `cache` was last updated
    // Shapes of one mesh share its tree. The mesh itself is kept alive by its shapes.
    std::map<const Mesh*, std::weak_ptr<const TriangleTree>> trees;
    Broadphase broadphase;
    std::vector<IgnoredPair> ignored;
    std::vector<IgnoredPair> ignored_changes;  // scratch of set_ignored_pairs
    // Scratch of find_contacts.
    BroadphaseScratch broadphase_scratch;
    std::vector<std::size_t> visits;   // bodies, ascending
    std::vector<Visit> visit_of_body;  // all none between passes
    // By body. Visit::changed: index into near_ends. Visit::listed: index into last_body_pairs.
    std::vector<std::uint32_t> slot_of_visit;
    struct FreePair {
        std::size_t other;
        bool deep;
    };
    std::vector<FreePair> free_pairs;  // pairs of one body
    std::vector<std::size_t>
        near_changed;                      // bodies near each changed body, one range after another
    std::vector<std::size_t> near_ends;    // end of each range; in the order of changed()
    std::vector<std::uint64_t> dirty_ids;  // colliders whose ignored pairs changed
    double last_margin_m = 0.0;
    std::vector<BodyPairs>
        body_pairs;  // ascending by id; only bodies that were searched or have pairs
    std::vector<std::size_t> pairs;          // indices of the other bodies into broadphase.bodies()
    std::vector<BodyPairs> last_body_pairs;  // pairs of the last pass
    std::vector<std::size_t> last_pairs;
    CollisionWork work;
    std::uint64_t proxy_set = 0;
    std::uint64_t counted_changes = 0;  // changes of the broadphase that take_work has reported
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
