#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "engine/collision/bounds.hpp"
#include "engine/collision/collision_world.hpp"

// The broadphase: finds the colliders whose swept bounds overlap a box, with Bullet's dynamic AABB
// tree (btDbvt).
namespace handhold {

struct BroadphaseBody {
    ColliderProxy proxy;
    Bounds bounds_ws;            // swept, from from_ws to to_ws
    btDbvtNode* leaf = nullptr;  // null: not in the tree, because a pose is invalid
    Bounds leaf_ws;              // box of the leaf: contains bounds_ws, with slack
    std::uint64_t stamp = 0;     // change counter at this body's last change
    // Free bodies only: a region around the body that no partner's bounds reach into, unless the
    // partner changed after change number `isolated_since`. Partners are all non-free bodies and
    // the free bodies with a higher id. isolated_since = 0: no region is cached.
    std::uint64_t isolated_since = 0;
    Bounds isolation_ws;
    std::uint32_t isolation_wait = 0;  // passes until a region is searched again
    // True if the body changed since the last pass over all pairs. Then the next two members hold
    // its state at that pass.
    bool is_changed = false;
    bool was_placed = false;  // the body was in the tree
    Bounds old_bounds_ws;     // previous bounds, if there were any
};

// Scratch memory of one thread's queries. Its content is not used between calls.
struct BroadphaseScratch {
    std::uint64_t tree_queries = 0;  // counts the queries of the tree; the owner resets it
    std::vector<std::size_t> found;
    btAlignedObjectArray<const btDbvtNode*> stack;
};

class Broadphase {
  public:
    // Replaces all bodies. `proxies` is sorted by id; `extents` is indexed by shape. An unchanged
    // proxy costs only a comparison.
    void set_proxies(std::span<const ColliderProxy> proxies, std::span<const ShapeExtent> extents);
    // Replaces the proxies of the bodies whose ids occur in `proxies`, in any order. The other
    // bodies cost nothing. Adds and removes no body: throws PreconditionError if a proxy with a
    // shape has no body, or if one without a shape has a body.
    void update_proxies(std::span<const ColliderProxy> proxies,
                        std::span<const ShapeExtent> extents);

    std::span<const BroadphaseBody> bodies() const { return bodies_; }  // sorted by id
    // Index of the body with this id; bodies().size() if there is none.
    std::size_t find_index(std::uint64_t id) const;
    std::uint64_t last_change() const { return changes_; }
    // Indices of the bodies that changed since finish_pass, in the order of their first change.
    std::span<const std::uint32_t> changed() const { return changed_; }
    // True if bodies were added or removed since finish_pass: all indices may have changed.
    bool indices_changed() const { return indices_changed_; }
    void finish_pass();
    void set_isolated(std::size_t body, const Bounds& box_ws);
    // Back-off: after a search that found no region, the next passes do not search again, because
    // among moving bodies every search would fail. use_up_wait returns true during the back-off.
    bool use_up_wait(std::size_t body) {
        std::uint32_t& wait = bodies_[body].isolation_wait;
        return wait > 0 && wait-- > 0;
    }
    void postpone_isolation(std::size_t body) { bodies_[body].isolation_wait = 8; }
    void clear_isolation(std::size_t body) { bodies_[body].isolated_since = 0; }
    // Finds the bodies whose bounds overlap the box: indices into bodies(), ascending. Valid until
    // the scratch is used again. Thread-safe if each thread uses its own scratch.
    std::span<const std::size_t> find(const Bounds& box, BroadphaseScratch& scratch) const;

    // Same result as find(box) for a box within a free body's leaf box grown by `margin_m`, mostly
    // without a query of the tree: see neighbours_. Not thread-safe.
    std::span<const std::size_t> find_around(std::size_t body, const Bounds& box, double margin_m,
                                             BroadphaseScratch& scratch);

    // Length of the longest path in the tree.
    int depth() const { return btDbvt::maxdepth(tree_.m_root); }

  private:
    // Rebuilds bodies_ from the proxies that have a shape. Bodies that were in bodies_ before keep
    // their data.
    void match_bodies(std::span<const ColliderProxy> proxies);
    void replace(BroadphaseBody& body, const ColliderProxy& proxy, const ShapeExtent& extent);
    void place(BroadphaseBody& body, const ShapeExtent& extent);
    void park(BroadphaseBody& body);
    void note_moved_leaf(const BroadphaseBody& body);
    std::span<const std::size_t> find_leaves(const Bounds& box, BroadphaseScratch& scratch) const;
    void update_neighbours(double margin_m, BroadphaseScratch& scratch);
    void add_neighbour(std::size_t owner, std::size_t listed, double margin_m);

    std::vector<BroadphaseBody> bodies_;
    std::vector<std::uint64_t> ids_;           // ids of bodies_, close together for find_index
    std::vector<BroadphaseBody> next_bodies_;  // double buffer of match_bodies
    btDbvt tree_;
    // Unused leaves. They stay in the tree, because Bullet frees the memory of removed leaves.
    std::vector<btDbvtNode*> parked_;
    std::uint64_t parked_count_ = 0;  // number of park() calls so far
    std::uint64_t changes_ = 0;
    std::vector<std::uint32_t> changed_;
    bool indices_changed_ = true;
    // Of each free body: at least the bodies whose leaf boxes overlap its own grown by
    // neighbour_margin_m_, ascending. A leaf box that changes is searched for once, by the next
    // update_neighbours; until then its body is in moved_leaves_.
    std::vector<std::vector<std::size_t>> neighbours_;
    std::vector<std::size_t> moved_leaves_;
    double neighbour_margin_m_ = -1.0;  // negative: all lists are outdated
};

}  // namespace handhold
