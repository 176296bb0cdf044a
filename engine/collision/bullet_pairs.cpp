// Finds the pairs of colliders that may touch, and the cached results that are still valid.
#include <algorithm>

#include "engine/collision/bullet_world.hpp"

namespace handhold {
namespace {

PairCache::Version version_of(const BroadphaseBody& body) { return {body.proxy.id, body.stamp}; }

// Limits the number of pairs of bodies that were spawned in one place, which would be n^2. If a
// body overlaps others deeply, it gets at most this many pairs with free bodies of higher id. Deep
// pairs come first. The others are found once these bodies have separated.
constexpr std::size_t k_max_crowded_pairs = 6;
// Two convex bodies overlap deeply if the distance of their centres is below this share of the sum
// of their inner radii.
constexpr double k_deep_share = 0.75;

// Smallest distance from the shape's centre to a side of its bounding box.
double inner_radius(const Bounds& box) { return box.high.cwiseMin(-box.low).minCoeff(); }

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
    // Compounds are excluded: there may be nothing at a compound's centre.
    if (!b.proxy.free || cache[a.proxy.shape.index].parts.size() > 1 ||
        cache[b.proxy.shape.index].parts.size() > 1) {
        return false;
    }
    const double depth_m = k_deep_share * (inner_radius(extents[a.proxy.shape.index].box) +
                                           inner_radius(extents[b.proxy.shape.index].box));
    // The pair may overlap deeply already at the last valid poses. Then a sweep from there finds no
    // first impact, so those poses are tested too.
    const Vec3 from = a.proxy.from_ws.position - b.proxy.from_ws.position;
    const Vec3 to = a.proxy.to_ws.position - b.proxy.to_ws.position;
    return std::min(from.squaredNorm(), to.squaredNorm()) < depth_m * depth_m;
}

void CollisionWorld::Impl::mark(std::size_t body, Visit visit, std::size_t slot) {
    if (!broadphase.bodies()[body].proxy.free || visit <= visit_of_body[body]) {
        return;
    }
    if (visit_of_body[body] == Visit::none) {
        visits.push_back(body);
    }
    visit_of_body[body] = visit;
    slot_of_visit[body] = static_cast<std::uint32_t>(slot);
}

// Marks the free bodies whose pairs may differ from those of the last pass: bodies that changed,
// and bodies near the old or new bounds of a changed body. near_changed keeps the bodies near each
// changed body, for find_candidates.
void CollisionWorld::Impl::mark_near_changes(double margin_m) {
    const std::span<const BroadphaseBody> bodies = broadphase.bodies();
    near_changed.clear();
    near_ends.clear();
    for (const std::uint32_t index : broadphase.changed()) {
        const BroadphaseBody& body = bodies[index];
        const bool is_placed = body.leaf != nullptr;
        mark(index, Visit::changed, near_ends.size());
        if (is_placed || body.was_placed) {
            Bounds box = is_placed ? body.bounds_ws : body.old_bounds_ws;
            if (body.was_placed) {
                box.low = box.low.cwiseMin(body.old_bounds_ws.low);
                box.high = box.high.cwiseMax(body.old_bounds_ws.high);
            }
            for (const std::size_t other :
                 broadphase.find_around(index, box.grown(margin_m), margin_m, broadphase_scratch)) {
                near_changed.push_back(other);
                mark(other, Visit::dirty, 0);
            }
        }
        near_ends.push_back(near_changed.size());
    }
}

// Lists the bodies to visit, ascending: those marked by mark_near_changes, those that had pairs in
// the last pass, and those whose ignored pairs changed. If indices or the margin changed, lists all
// free bodies. Bodies that are not listed still have no pairs, and cost nothing.
void CollisionWorld::Impl::find_visits(double margin_m) {
    const std::size_t count = broadphase.bodies().size();
    visits.clear();
    if (broadphase.indices_changed() || margin_m != last_margin_m) {
        visit_of_body.assign(count, Visit::none);
        slot_of_visit.resize(count);
        last_body_pairs.clear();
        for (std::size_t i = 0; i < count; ++i) {
            mark(i, Visit::dirty, 0);
        }
        return;
    }
    for (std::size_t i = 0; i < last_body_pairs.size(); ++i) {
        mark(last_body_pairs[i].body, Visit::listed, i);
    }
    mark_near_changes(margin_m);
    for (const std::uint64_t id : dirty_ids) {
        if (const std::size_t body = broadphase.find_index(id); body < count) {
            mark(body, Visit::dirty, 0);
        }
    }
    std::ranges::sort(visits);
}

// Returns indices of all bodies near the visited body, and possibly of others; ascending.
std::span<const std::size_t> CollisionWorld::Impl::find_candidates(std::size_t body,
                                                                   const Bounds& reach_ws) {
    if (visit_of_body[body] != Visit::changed) {
        return broadphase.find(reach_ws, broadphase_scratch);
    }
    const std::size_t slot = slot_of_visit[body];
    const std::size_t first = slot > 0 ? near_ends[slot - 1] : 0;
    return std::span(near_changed).subspan(first, near_ends[slot] - first);
}

// Appends the body's pairs with free bodies to `pairs`, up to the limit. Then sorts the body's
// pairs, which begin at index `first`.
void CollisionWorld::Impl::add_free_pairs(std::size_t first) {
    const auto deep =
        static_cast<std::size_t>(std::ranges::count(free_pairs, true, &FreePair::deep));
    const bool is_crowded = deep > 0;
    std::size_t deep_left = k_max_crowded_pairs;
    std::size_t others_left = k_max_crowded_pairs - std::min(deep, k_max_crowded_pairs);
    for (const FreePair& pair : free_pairs) {
        std::size_t& left = pair.deep ? deep_left : others_left;
        if (is_crowded && left == 0) {
            ++work.deferred_pairs;
            continue;
        }
        pairs.push_back(pair.other);
        left -= left > 0 ? 1 : 0;
    }
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end());
}

// A body that stays inside its isolation box is tested only against bodies that changed since the
// box was computed.
void CollisionWorld::Impl::search_pairs(std::size_t i, double margin_m) {
    const std::span<const BroadphaseBody> bodies = broadphase.bodies();
    const BroadphaseBody& a = bodies[i];
    if (a.leaf == nullptr) {
        return;
    }
    const Bounds reach_ws = a.bounds_ws.grown(margin_m);
    const bool is_isolated = a.isolated_since > 0 && contains(a.isolation_ws, reach_ws);
    if (!is_isolated) {
        broadphase.clear_isolation(i);
    }
    const std::uint64_t since = is_isolated ? a.isolated_since : 0;
    const std::size_t first = pairs.size();
    free_pairs.clear();
    for (const std::size_t other : find_candidates(i, reach_ws)) {
        const BroadphaseBody& b = bodies[other];
        if (b.stamp <= since || b.leaf == nullptr || !overlaps(b.bounds_ws, reach_ws) ||
            !is_pair(a, b)) {
            continue;
        }
        if (b.proxy.free) {
            free_pairs.push_back({other, is_deep(a, b)});
        } else {
            pairs.push_back(other);
        }
    }
    add_free_pairs(first);
    if (!is_isolated || pairs.size() > first) {
        body_pairs.push_back({i, first, pairs.size(), is_isolated, true});
    }
}

void CollisionWorld::Impl::find_pairs(double margin_m) {
    std::swap(body_pairs, last_body_pairs);
    std::swap(pairs, last_pairs);
    body_pairs.clear();
    pairs.clear();
    std::erase_if(last_body_pairs, [](const BodyPairs& body) { return body.first == body.last; });
    find_visits(margin_m);
    for (const std::size_t i : visits) {
        if (visit_of_body[i] != Visit::listed) {
            search_pairs(i, margin_m);
        } else {
            const BodyPairs& last = last_body_pairs[slot_of_visit[i]];
            const std::size_t first = pairs.size();
            pairs.insert(pairs.end(), last_pairs.begin() + static_cast<std::ptrdiff_t>(last.first),
                         last_pairs.begin() + static_cast<std::ptrdiff_t>(last.last));
            body_pairs.push_back({i, first, pairs.size(), last.is_isolated, false});
        }
        visit_of_body[i] = Visit::none;
    }
    last_margin_m = margin_m;
    dirty_ids.clear();
    broadphase.finish_pass();
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
            work.narrowphase_calls += pair_results.back().cached ? 0U : 1U;
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
    if (body.is_isolated || !body.is_new || broadphase.use_up_wait(body.body)) {
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
            broadphase.postpone_isolation(body.body);
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
