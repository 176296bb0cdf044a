// Solver, contact: overlaps that a sweep cannot see.
#include "engine/solver/contact/missed_overlaps.hpp"

#include <algorithm>

namespace handhold {
namespace {

// Proxies of a heap follow their bodies only roughly (moving_contacts.cpp), two of them twice.
constexpr double k_heap_lag_m = 3e-3;
// assumed distance of the collider's surface from its centre; conservative
constexpr double k_max_arm_m = 1.0;

// True if a motion is so long that the collision world may have swept it.
bool may_be_swept(const Pose& from, const Pose& to, double sweep_m) {
    const double turn = 2.0 * (from.rotation.conjugate() * to.rotation).vec().norm();
    return (to.position - from.position).norm() + turn * k_max_arm_m > sweep_m;
}
bool may_be_swept(const ColliderProxy& proxy, double sweep_m) {
    return may_be_swept(proxy.from_ws, proxy.to_ws, sweep_m);
}
// The same for the motion of a relative to b.
bool may_be_swept(const ColliderProxy& a, const ColliderProxy& b, double sweep_m) {
    return may_be_swept(inverse(b.from_ws) * a.from_ws, inverse(b.to_ws) * a.to_ws, sweep_m);
}

// Sets up the proxies for a query without sweeps: colliders that may have been swept are at rest at
// their end poses. Marks the movable ones. False if there are none.
bool prepare_static_query(const MovingContacts& moving, double sweep_m, MissedOverlaps& missed) {
    missed.proxies.clear();
    missed.is_suspect.assign(moving.graph.bodies.size(), 0);
    bool any = false;
    const auto mark = [&](std::uint32_t body) {
        if (missed.proxies.empty()) {
            missed.proxies.assign(moving.proxies.begin(), moving.proxies.end());
        }
        missed.proxies[body].from_ws = missed.proxies[body].to_ws;
        if (moving.graph.bodies[body].role != BodyRole::fixed) {
            missed.is_suspect[body] = 1;
            any = true;
        }
    };
    for (std::uint32_t i = 0; i < moving.proxies.size(); ++i) {
        if (moving.proxies[i].shape != k_no_shape && !moving.graph.bodies[i].in_heap &&
            may_be_swept(moving.proxies[i], sweep_m)) {
            mark(i);
        }
    }
    for (const RowBlock& block : moving.graph.blocks) {
        if (is_contact(block) && !is_heap_contact(moving.graph.bodies, block) &&
            may_be_swept(moving.proxies[block.a], moving.proxies[block.b], sweep_m)) {
            mark(block.a);
            mark(block.b);
        }
    }
    return any;
}

}  // namespace

void find_missed_overlaps(const MovingContacts& moving, const ContactLimits& limits,
                          MissedOverlaps& missed) {
    missed.of_body.resize(moving.graph.bodies.size());
    for (std::uint32_t i = 0; i < missed.of_body.size(); ++i) {
        missed.of_body[i] = {0.0, i};
    }
    if (!prepare_static_query(moving, limits.sweep_m, missed)) {
        return;
    }
    moving.collision.set_proxies(missed.proxies);
    moving.collision.find_contacts(limits, moving.scratch);
    const auto record = [&missed](std::size_t body, std::size_t other, double depth_m) {
        if (missed.is_suspect[body] != 0 && depth_m > missed.of_body[body].depth_m) {
            missed.of_body[body] = {depth_m, static_cast<std::uint32_t>(other)};
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
}

}  // namespace handhold
