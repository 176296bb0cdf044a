// Solver, contact: overlaps that a sweep cannot see.
#include "engine/solver/contact/missed_overlaps.hpp"

#include <algorithm>
#include <numeric>

namespace handhold {
namespace {

// Proxies of a heap follow their bodies only roughly (moving_contacts.cpp), two of them twice.
constexpr double k_heap_lag_m = 3e-3;
// assumed distance of the collider's surface from its centre; conservative
constexpr double k_max_arm_m = 1.0;

// True if the motion of a relative to b is so long that the collision world may have swept it.
bool may_be_swept(const ColliderProxy& a, const ColliderProxy& b, double sweep_m) {
    const Pose from = inverse(b.from_ws) * a.from_ws;
    const Pose to = inverse(b.to_ws) * a.to_ws;
    const double turn = 2.0 * (from.rotation.conjugate() * to.rotation).vec().norm();
    return (to.position - from.position).norm() + turn * k_max_arm_m > sweep_m;
}

// Sets up the proxies for a query without sweeps: colliders whose touch a sweep may have found are
// at rest at their end poses. Marks the movable ones. False if there are none.
bool prepare_static_query(const MovingContacts& moving, double sweep_m, MissedOverlaps& missed) {
    const std::size_t count = moving.graph.bodies.size();
    missed.is_marked.resize(std::max(missed.is_marked.size(), count), 0);
    missed.is_suspect.resize(std::max(missed.is_suspect.size(), count), 0);
    bool any = false;
    const auto mark = [&](std::uint32_t body) {
        if (missed.is_marked[body] == 0) {
            missed.is_marked[body] = 1;
            moving.displaced.push_back(body);
        }
        if (moving.graph.bodies[body].role != BodyRole::fixed) {
            missed.is_suspect[body] = 1;
            any = true;
        }
    };
    for (const RowBlock& block : moving.graph.blocks) {
        if (is_contact(block) && !is_heap_contact(moving.graph.bodies, block) &&
            may_be_swept(moving.proxies[block.a], moving.proxies[block.b], sweep_m)) {
            mark(block.a);
            mark(block.b);
        }
    }
    return any;
}

void query(const MovingContacts& moving, const ContactLimits& limits, MissedOverlaps& missed) {
    moving.updates.clear();
    for (const std::uint32_t i : moving.displaced) {
        moving.updates.push_back(moving.proxies[i]);
        moving.updates.back().from_ws = moving.updates.back().to_ws;
    }
    moving.collision.update_proxies(moving.updates);
    moving.collision.find_contacts(limits, moving.scratch);
    const auto record = [&missed](std::size_t body, std::size_t other, double depth_m) {
        Overlap& deepest = missed.of_body[body];
        if (missed.is_suspect[body] != 0 && depth_m > deepest.depth_m) {
            if (deepest.depth_m == 0.0) {
                missed.deep.push_back(static_cast<std::uint32_t>(body));
            }
            deepest = {depth_m, static_cast<std::uint32_t>(other)};
        }
    };
    for (const ContactPoint& contact : moving.scratch) {
        const std::size_t a = find_body(moving.graph, contact.id_a);
        const std::size_t b = find_body(moving.graph, contact.id_b);
        const bool is_heap = moving.graph.bodies[a].in_heap || moving.graph.bodies[b].in_heap;
        if (-contact.separation_m > (is_heap ? k_heap_lag_m : k_new_overlap_m)) {
            record(a, b, -contact.separation_m);
            record(b, a, -contact.separation_m);
        }
    }
    std::ranges::sort(missed.deep);
}

}  // namespace

void MissedOverlaps::clear(std::size_t count) {
    if (of_body.size() != count) {
        of_body.resize(count);
        deep.resize(count);
        std::iota(deep.begin(), deep.end(), 0U);
    }
    for (const std::uint32_t body : deep) {
        of_body[body] = {0.0, body};
    }
    deep.clear();
}

void find_missed_overlaps(const MovingContacts& moving, const ContactLimits& limits,
                          MissedOverlaps& missed) {
    const std::size_t count = moving.graph.bodies.size();
    missed.clear(count);
    const std::size_t first = moving.displaced.size();
    // Enough for all bodies, so that a warm frame allocates nothing.
    moving.displaced.reserve(2 * count);
    moving.updates.reserve(2 * count);
    const bool any = prepare_static_query(moving, limits.sweep_m, missed);
    if (any) {
        query(moving, limits, missed);
    } else {
        moving.displaced.resize(first);
    }
    for (const RowBlock& block : moving.graph.blocks) {
        missed.is_marked[block.a] = missed.is_marked[block.b] = 0;
        missed.is_suspect[block.a] = missed.is_suspect[block.b] = 0;
    }
}

}  // namespace handhold
