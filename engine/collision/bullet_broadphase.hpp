#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "engine/collision/bounds.hpp"
#include "engine/collision/collision_world.hpp"

// Which colliders may meet a box, by Bullet's tree over moving bounds (btDbvt).
namespace handhold {

struct BroadphaseBody {
    ColliderProxy proxy;
    Bounds bounds_ws;            // of the whole way from from_ws to to_ws
    btDbvtNode* leaf = nullptr;  // null: left out, its pose is not valid
    std::uint64_t stamp = 0;     // of its last change, in changes of any
    // Of a free body: nothing that it looks for and that did not change since this stamp comes into
    // this box (free bodies with lower ids look for it, not it for them); 0: none is known.
    std::uint64_t isolated_since = 0;
    Bounds isolation_ws;
};

// Memory of one thread's search; its content means nothing between calls.
struct BroadphaseScratch {
    std::vector<std::size_t> found;
    btAlignedObjectArray<const btDbvtNode*> stack;
};

class Broadphase {
  public:
    // Replaces all bodies: `extents` by shape. Proxies are sorted by id. What did not change costs
    // nothing but the comparison.
    void set_proxies(std::span<const ColliderProxy> proxies, std::span<const ShapeExtent> extents);

    std::span<const BroadphaseBody> bodies() const { return bodies_; }  // sorted by id
    std::uint64_t last_change() const { return changes_; }
    void set_isolated(std::size_t body, const Bounds& box_ws);
    void clear_isolation(std::size_t body) { bodies_[body].isolated_since = 0; }
    // Numbers of the bodies that may meet the box, rising; good until the scratch is used again.
    // Any threads may ask at the same time, each with a scratch of its own.
    std::span<const std::size_t> find(const Bounds& box, BroadphaseScratch& scratch) const;

    // Longest path in the tree: for tests.
    int depth() const { return btDbvt::maxdepth(tree_.m_root); }

  private:
    // Makes bodies_ one for each proxy that has a shape; what was there before stays as it was.
    void match_bodies(std::span<const ColliderProxy> proxies);
    void place(BroadphaseBody& body, const ShapeExtent& extent);
    void park(BroadphaseBody& body);

    std::vector<BroadphaseBody> bodies_;
    std::vector<BroadphaseBody> next_bodies_;  // the list under construction: the two swap
    btDbvt tree_;
    // Leaves without a body, kept in the tree: Bullet frees a removed leaf's memory.
    std::vector<btDbvtNode*> parked_;
    std::uint64_t parked_count_ = 0;  // since the beginning
    std::uint64_t changes_ = 0;
};

}  // namespace handhold
