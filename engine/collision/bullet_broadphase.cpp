#include "engine/collision/bullet_broadphase.hpp"

#include <algorithm>
#include <cmath>

#include "engine/collision/bullet_vector.hpp"
#include "engine/core/check.hpp"
#include "engine/core/hash.hpp"

namespace handhold {
namespace {

btDbvtVolume to_volume(const Bounds& bounds) {
    return btDbvtVolume::FromMM(to_bullet(bounds.low), to_bullet(bounds.high));
}

// A leaf's box is larger than the body's bounds by this share of the body's radius, on each side,
// and by no more than k_max_slack_m. A body that drifts changes the tree only when it leaves that
// box. Fixed bodies that do not move get no slack.
constexpr double k_slack_share = 0.2;
constexpr double k_max_slack_m = 0.25;
// A leaf's box is replaced if it exceeds the bounds by more than this many times that slack: the
// body was fast and has become slow.
constexpr double k_max_slacks = 4.0;
// A list of neighbours has room for this many without allocating, and drops the bodies that have
// left whenever it has grown by as many.
constexpr std::size_t k_many_neighbours = 64;

bool has_shape(const ColliderProxy& proxy) { return proxy.shape != k_no_shape; }

// True if `bodies` are exactly the proxies that have a shape, in the same order.
bool matches(std::span<const BroadphaseBody> bodies, std::span<const ColliderProxy> proxies) {
    std::size_t next = 0;
    for (const ColliderProxy& proxy : proxies) {
        if (has_shape(proxy) && (next == bodies.size() || bodies[next++].proxy.id != proxy.id)) {
            return false;
        }
    }
    return next == bodies.size();
}

// Box of an unused leaf. It overlaps nothing and enlarges no ancestor's box, because its low corner
// is above its high corner. Every number gives another centre, far from all bodies: Bullet inserts
// by the distance of centres, so unused leaves form a balanced subtree. Leaves with equal centres
// would form a list, and parking n bodies would cost n^2.
btDbvtVolume empty_volume(std::uint64_t number) {
    constexpr double k_half = 1e30;
    Vec3 centre;
    for (double& x : centre) {
        number = mix64(number + 0x9e3779b97f4a7c15ULL);
        x = 0.4 * k_half + 0.2 * k_half * std::ldexp(static_cast<double>(number >> 11U), -53);
    }
    return to_volume({centre + Vec3::Constant(k_half), centre - Vec3::Constant(k_half)});
}

}  // namespace

void Broadphase::place(BroadphaseBody& body, const ShapeExtent& extent) {
    if (!is_valid(body.proxy.from_ws) || !is_valid(body.proxy.to_ws)) {
        park(body);
        return;
    }
    body.bounds_ws = swept_bounds(extent, body.proxy.from_ws, body.proxy.to_ws);
    const bool is_still = !body.proxy.free && same_pose(body.proxy.from_ws, body.proxy.to_ws);
    const double slack_m =
        is_still ? 0.0 : std::min(k_slack_share * extent.radius_m, k_max_slack_m);
    if (body.leaf != nullptr && contains(body.leaf_ws, body.bounds_ws) &&
        contains(body.bounds_ws.grown(k_max_slacks * slack_m), body.leaf_ws)) {
        return;
    }
    body.leaf_ws = body.bounds_ws.grown(slack_m);
    note_moved_leaf(body);
    btDbvtVolume volume = to_volume(body.leaf_ws);
    if (body.leaf == nullptr && !parked_.empty()) {
        body.leaf = parked_.back();
        parked_.pop_back();
    }
    if (body.leaf == nullptr) {
        body.leaf = tree_.insert(volume, nullptr);
    } else {
        tree_.update(body.leaf, volume);
    }
}

// Nothing is noted while all lists are outdated anyway.
void Broadphase::note_moved_leaf(const BroadphaseBody& body) {
    if (moved_leaves_.size() > bodies_.size()) {
        neighbour_margin_m_ = -1.0;
        moved_leaves_.clear();
    }
    if (neighbour_margin_m_ >= 0.0) {
        moved_leaves_.push_back(static_cast<std::size_t>(&body - bodies_.data()));
    }
}

void Broadphase::park(BroadphaseBody& body) {
    if (body.leaf != nullptr) {
        btDbvtVolume volume = empty_volume(parked_count_++);
        tree_.update(body.leaf, volume);
        parked_.push_back(body.leaf);
        body.leaf = nullptr;
    }
}

void Broadphase::match_bodies(std::span<const ColliderProxy> proxies) {
    next_bodies_.clear();
    next_bodies_.reserve(std::max(proxies.size(), bodies_.capacity()));
    parked_.reserve(parked_.size() + bodies_.size());
    changed_.reserve(proxies.size());
    std::size_t previous = 0;
    for (const ColliderProxy& proxy : proxies) {
        if (!has_shape(proxy)) {
            continue;
        }
        for (; previous < bodies_.size() && bodies_[previous].proxy.id < proxy.id; ++previous) {
            park(bodies_[previous]);
        }
        const bool is_old = previous < bodies_.size() && bodies_[previous].proxy.id == proxy.id;
        next_bodies_.push_back(is_old ? bodies_[previous++] : BroadphaseBody{});
    }
    for (; previous < bodies_.size(); ++previous) {
        park(bodies_[previous]);
    }
    bodies_.swap(next_bodies_);
    indices_changed_ = true;
    neighbour_margin_m_ = -1.0;
}

std::size_t Broadphase::find_index(std::uint64_t id) const {
    const auto found = std::ranges::lower_bound(ids_, id);
    return found != ids_.end() && *found == id ? static_cast<std::size_t>(found - ids_.begin())
                                               : bodies_.size();
}

void Broadphase::finish_pass() {
    if (indices_changed_) {
        for (BroadphaseBody& body : bodies_) {
            body.is_changed = false;
        }
    } else {
        for (const std::uint32_t index : changed_) {
            bodies_[index].is_changed = false;
        }
    }
    changed_.clear();
    indices_changed_ = false;
}

void Broadphase::replace(BroadphaseBody& body, const ColliderProxy& proxy,
                         const ShapeExtent& extent) {
    if (!body.is_changed) {
        body.is_changed = true;
        body.was_placed = body.leaf != nullptr;
        body.old_bounds_ws = body.bounds_ws;
        changed_.push_back(static_cast<std::uint32_t>(&body - bodies_.data()));
    }
    if (body.proxy.free != proxy.free) {
        note_moved_leaf(body);
    }
    body.proxy = proxy;
    body.stamp = ++changes_;
    place(body, extent);
}

void Broadphase::update_proxies(std::span<const ColliderProxy> proxies,
                                std::span<const ShapeExtent> extents) {
    for (const ColliderProxy& proxy : proxies) {
        const std::size_t index = find_index(proxy.id);
        HH_CHECK((index < bodies_.size()) == has_shape(proxy),
                 "set_proxies adds and removes colliders", proxy.id);
        if (index == bodies_.size() || same_proxy(bodies_[index].proxy, proxy)) {
            continue;
        }
        BroadphaseBody& body = bodies_[index];
        replace(body, proxy, extents[proxy.shape.index]);
        if (body.leaf != nullptr) {
            body.leaf->dataAsInt = static_cast<int>(index);
        }
    }
}

void Broadphase::set_proxies(std::span<const ColliderProxy> proxies,
                             std::span<const ShapeExtent> extents) {
    if (!matches(bodies_, proxies)) {
        match_bodies(proxies);
        ids_.clear();
        for (const ColliderProxy& proxy : proxies) {
            if (has_shape(proxy)) {
                ids_.push_back(proxy.id);
            }
        }
    }
    auto body = bodies_.begin();
    for (const ColliderProxy& proxy : proxies) {
        if (!has_shape(proxy)) {
            continue;
        }
        if (!same_proxy(body->proxy, proxy)) {  // also true for a new body: its id is still 0
            replace(*body, proxy, extents[proxy.shape.index]);
        }
        if (body->leaf != nullptr) {
            body->leaf->dataAsInt = static_cast<int>(body - bodies_.begin());
        }
        ++body;
    }
}

void Broadphase::set_isolated(std::size_t body, const Bounds& box_ws) {
    bodies_[body].isolated_since = changes_;
    bodies_[body].isolation_ws = box_ws;
}

// The result is sorted, because the order of traversal depends on the tree's history.
std::span<const std::size_t> Broadphase::find_leaves(const Bounds& box,
                                                     BroadphaseScratch& scratch) const {
    struct Collector final : btDbvt::ICollide {
        explicit Collector(std::vector<std::size_t>& list) : found(list) {}
        void Process(const btDbvtNode* leaf) override {
            found.push_back(static_cast<std::size_t>(leaf->dataAsInt));
        }
        std::vector<std::size_t>& found;
    };
    constexpr int k_stack = 256;
    scratch.found.clear();
    scratch.found.reserve(bodies_.size());
    scratch.stack.reserve(k_stack);
    Collector collector(scratch.found);
    ++scratch.tree_queries;
    tree_.collideTVNoStackAlloc(tree_.m_root, to_volume(box), scratch.stack, collector);
    std::sort(scratch.found.begin(), scratch.found.end());
    return scratch.found;
}

std::span<const std::size_t> Broadphase::find(const Bounds& box, BroadphaseScratch& scratch) const {
    find_leaves(box, scratch);
    std::erase_if(scratch.found, [this, &box](std::size_t index) {
        return !overlaps(bodies_[index].bounds_ws, box);
    });
    return scratch.found;
}

void Broadphase::add_neighbour(std::size_t owner, std::size_t listed, double margin_m) {
    std::vector<std::size_t>& list = neighbours_[owner];
    const auto place = std::ranges::lower_bound(list, listed);
    if (place != list.end() && *place == listed) {
        return;
    }
    list.insert(place, listed);
    if (list.size() % k_many_neighbours == 0) {
        const Bounds near_ws = bodies_[owner].leaf_ws.grown(margin_m);
        std::erase_if(list, [this, &near_ws](std::size_t index) {
            return !overlaps(bodies_[index].leaf_ws, near_ws);
        });
    }
}

void Broadphase::update_neighbours(double margin_m, BroadphaseScratch& scratch) {
    if (margin_m != neighbour_margin_m_) {
        neighbour_margin_m_ = margin_m;
        neighbours_.resize(std::max(neighbours_.size(), bodies_.size()));
        moved_leaves_.reserve(bodies_.size() + 1);
        moved_leaves_.clear();
        // The queries of the free bodies find the fixed ones too.
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            neighbours_[i].clear();
            if (bodies_[i].proxy.free) {
                moved_leaves_.push_back(i);
            }
        }
    }
    for (const std::size_t moved : moved_leaves_) {
        const bool is_free = bodies_[moved].proxy.free;
        neighbours_[moved].clear();
        neighbours_[moved].reserve(is_free ? k_many_neighbours : 0);
        if (bodies_[moved].leaf == nullptr) {
            continue;
        }
        for (const std::size_t other :
             find_leaves(bodies_[moved].leaf_ws.grown(margin_m), scratch)) {
            if (is_free) {
                neighbours_[moved].push_back(other);
            }
            if (bodies_[other].proxy.free && other != moved) {
                add_neighbour(other, moved, margin_m);
            }
        }
    }
    moved_leaves_.clear();
}

std::span<const std::size_t> Broadphase::find_around(std::size_t body, const Bounds& box,
                                                     double margin_m, BroadphaseScratch& scratch) {
    if (!bodies_[body].proxy.free || bodies_[body].leaf == nullptr ||
        !contains(bodies_[body].leaf_ws.grown(margin_m), box)) {
        return find(box, scratch);
    }
    if (!moved_leaves_.empty() || margin_m != neighbour_margin_m_) {
        update_neighbours(margin_m, scratch);
    }
    scratch.found.clear();
    for (const std::size_t other : neighbours_[body]) {
        if (bodies_[other].leaf != nullptr && overlaps(bodies_[other].bounds_ws, box)) {
            scratch.found.push_back(other);
        }
    }
    return scratch.found;
}

}  // namespace handhold
