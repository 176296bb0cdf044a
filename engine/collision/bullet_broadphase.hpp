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
    std::uint64_t stamp = 0;     // change counter at this body's last change
    // Free bodies only: cached isolation. No potential partner that has been unchanged since change
    // `isolated_since` reaches into isolation_ws. Partners are non-free bodies and free bodies with
    // a higher id. 0: no isolation cached.
    std::uint64_t isolated_since = 0;
    Bounds isolation_ws;
};

// Scratch of one thread's queries. The content means nothing between calls.
struct BroadphaseScratch {
    std::vector<std::size_t> found;
    btAlignedObjectArray<const btDbvtNode*> stack;
};

class Broadphase {
  public:
    // Replaces all bodies. `proxies` is sorted by id; `extents` is indexed by shape. An unchanged
    // proxy costs only a comparison.
    void set_proxies(std::span<const ColliderProxy> proxies, std::span<const ShapeExtent> extents);

    std::span<const BroadphaseBody> bodies() const { return bodies_; }  // sorted by id
    std::uint64_t last_change() const { return changes_; }
    void set_isolated(std::size_t body, const Bounds& box_ws);
    void clear_isolation(std::size_t body) { bodies_[body].isolated_since = 0; }
    // Indices into bodies() of those whose bounds overlap the box, ascending. Valid until the
    // scratch is used again. Thread-safe if each thread uses its own scratch.
    std::span<const std::size_t> find(const Bounds& box, BroadphaseScratch& scratch) const;

    // Longest path in the tree.
    int depth() const { return btDbvt::maxdepth(tree_.m_root); }

  private:
    // Rebuilds bodies_ to match the proxies that have a shape; bodies that stay keep their data.
    void match_bodies(std::span<const ColliderProxy> proxies);
    void place(BroadphaseBody& body, const ShapeExtent& extent);
    void park(BroadphaseBody& body);

    std::vector<BroadphaseBody> bodies_;
    std::vector<BroadphaseBody> next_bodies_;  // double buffer of match_bodies
    btDbvt tree_;
    // Unused leaves. They stay in the tree for reuse, because Bullet frees a removed leaf's memory.
    std::vector<btDbvtNode*> parked_;
    std::uint64_t parked_count_ = 0;  // since the beginning
    std::uint64_t changes_ = 0;
};

}  // namespace handhold
