// Finds the pairs of colliders that may touch, and the cached results that are still valid.
#include <algorithm>

#include "engine/collision/bullet_world.hpp"

namespace handhold {
namespace {

PairCache::Version version_of(const BroadphaseBody& body) { return {body.proxy.id, body.stamp}; }

// If more bodies than this have changed, one tree query is faster than testing each of them.
constexpr std::size_t k_max_linear_changes = 128;

// Bodies spawned in one place would be n^2 pairs. Of the free bodies that overlap a free body so
// deeply that it contains their centres, or they its, only the first few by id are tested. The
// others follow as these come apart.
constexpr std::size_t k_max_deep_pairs = 8;

double smallest_half(const Bounds& box) { return 0.5 * (box.high - box.low).minCoeff(); }

}  // namespace

bool CollisionWorld::Impl::is_pair(const BroadphaseBody& a, const BroadphaseBody& b) const {
    if (b.proxy.free && a.proxy.id >= b.proxy.id) {
        return false;  // two free bodies form one pair, found from the lower id
    }
    if ((a.proxy.layers & b.proxy.mask) == 0 || (b.proxy.layers & a.proxy.mask) == 0) {
        return false;
    }
    const auto [low, high] = std::minmax(a.proxy.id, b.proxy.id);
    return !std::binary_search(ignored.begin(), ignored.end(), IgnoredPair{low, high});
}

bool CollisionWorld::Impl::is_deep(const BroadphaseBody& a, const BroadphaseBody& b) const {
    if (!b.proxy.free) {
        return false;
    }
    const double depth_m = std::min(smallest_half(extents[a.proxy.shape.index].box),
                                    smallest_half(extents[b.proxy.shape.index].box));
    const Vec3 offset = a.proxy.to_ws.position - b.proxy.to_ws.position;
    return offset.squaredNorm() < depth_m * depth_m;
}

// A body that stays inside its isolation box is tested only against bodies that changed since the
// box was computed.
void CollisionWorld::Impl::find_pairs(double margin_m) {
    body_pairs.clear();
    pairs.clear();
    find_changed_bodies();
    const std::span<const BroadphaseBody> bodies = broadphase.bodies();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const BroadphaseBody& a = bodies[i];
        if (!a.proxy.free || a.leaf == nullptr) {
            continue;
        }
        const Bounds reach_ws = a.bounds_ws.grown(margin_m);
        const bool is_isolated = a.isolated_since > 0 && contains(a.isolation_ws, reach_ws);
        if (!is_isolated) {
            broadphase.clear_isolation(i);
        }
        const std::uint64_t since = is_isolated ? a.isolated_since : 0;
        const bool use_changed_list = is_isolated && changed_bodies.size() <= k_max_linear_changes;
        const std::span<const std::size_t> candidates =
            use_changed_list ? changed_bodies : broadphase.find(reach_ws, broadphase_scratch);
        const std::size_t first = pairs.size();
        std::size_t deep_pairs = 0;
        for (const std::size_t other : candidates) {
            const BroadphaseBody& b = bodies[other];
            if (b.stamp > since && overlaps(b.bounds_ws, reach_ws) && is_pair(a, b) &&
                (!is_deep(a, b) || deep_pairs++ < k_max_deep_pairs)) {
                pairs.push_back(other);
            }
        }
        if (!is_isolated || pairs.size() > first) {
            body_pairs.push_back({i, first, pairs.size(), is_isolated});
        }
    }
}

void CollisionWorld::Impl::find_changed_bodies() {
    changed_bodies.clear();
    const std::span<const BroadphaseBody> bodies = broadphase.bodies();
    std::uint64_t oldest = broadphase.last_change();
    for (const BroadphaseBody& body : bodies) {
        oldest = body.isolated_since > 0 ? std::min(oldest, body.isolated_since) : oldest;
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i].stamp > oldest && bodies[i].leaf != nullptr) {
            changed_bodies.push_back(i);
        }
    }
}

void CollisionWorld::Impl::look_up_pairs(const ContactLimits& limits) {
    pair_cache.begin(limits);
    const std::span<const BroadphaseBody> bodies = broadphase.bodies();
    pair_results.clear();
    for (const BodyPairs& of_body : body_pairs) {
        const BroadphaseBody& a = bodies[of_body.body];
        const Bounds reach_ws = a.bounds_ws.grown(limits.margin_m);
        for (std::size_t i = of_body.first; i < of_body.last; ++i) {
            pair_results.push_back(
                {pair_cache.recall(version_of(a), version_of(bodies[pairs[i]]), reach_ws), 0, {}});
        }
    }
}

void CollisionWorld::Impl::remember(const BodyPairs& body, std::span<const ContactPoint> contacts) {
    const std::span<const BroadphaseBody> bodies = broadphase.bodies();
    std::size_t first = 0;
    for (std::size_t i = body.first; i < body.last; ++i) {
        pair_cache.record(
            version_of(bodies[body.body]), version_of(bodies[pairs[i]]),
            {contacts.subspan(first, pair_results[i].count), pair_results[i].clear_ws});
        first += pair_results[i].count;
    }
}

void CollisionWorld::Impl::cache_isolation(const BodyPairs& body, double margin_m) {
    const std::span<const BroadphaseBody> bodies = broadphase.bodies();
    const BroadphaseBody& a = bodies[body.body];
    if (body.is_isolated) {
        return;
    }
    Bounds box_ws = a.bounds_ws.grown(margin_m + k_isolation_reach_m);
    for (std::size_t i = body.first; i < body.last; ++i) {
        if (!pair_results[i].clear_ws) {
            return;
        }
        box_ws = intersection(box_ws, *pair_results[i].clear_ws);
    }
    if (!contains(box_ws, a.bounds_ws.grown(margin_m))) {
        return;
    }
    for (const std::size_t other : broadphase.find(box_ws, broadphase_scratch)) {
        if (other != body.body && may_enter(box_ws, a, bodies[other])) {
            return;
        }
    }
    broadphase.set_isolated(body.body, box_ws);
}

// True if b may reach into `box_ws`, the box around a, and the pair is found from a. A pair of free
// bodies is found from the lower id.
bool CollisionWorld::Impl::may_enter(const Bounds& box_ws, const BroadphaseBody& a,
                                     const BroadphaseBody& b) const {
    if (b.proxy.free) {
        return a.proxy.id < b.proxy.id;
    }
    const std::optional<ScaledTriangles>& triangles = cache[b.proxy.shape.index].triangles;
    return !triangles || !same_pose(b.proxy.from_ws, b.proxy.to_ws) ||
           triangles->may_meet(transformed(box_ws, inverse(b.proxy.to_ws)));
}

}  // namespace handhold
