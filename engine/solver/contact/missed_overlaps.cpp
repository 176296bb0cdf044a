#include "engine/solver/contact/missed_overlaps.hpp"

#include <algorithm>

namespace handhold {
namespace {

constexpr double k_reach_m = 1.0;  // of what turns: more is looked at than was swept

// True where a way is so long that it may have been swept.
bool is_long(const Pose& from, const Pose& to, double sweep_m) {
    const double turn = 2.0 * (from.rotation.conjugate() * to.rotation).vec().norm();
    return (to.position - from.position).norm() + turn * k_reach_m > sweep_m;
}
bool is_long(const ColliderProxy& proxy, double sweep_m) {
    return is_long(proxy.from_ws, proxy.to_ws, sweep_m);
}
// The same of a against b.
bool is_long(const ColliderProxy& a, const ColliderProxy& b, double sweep_m) {
    return is_long(inverse(b.from_ws) * a.from_ws, inverse(b.to_ws) * a.to_ws, sweep_m);
}

// Colliders that may have been swept are where they are. True where any of them can move: those
// are marked.
bool hold_still(const MovingContacts& moving, double sweep_m, MissedOverlaps& hidden) {
    hidden.proxies.clear();
    hidden.is_suspect.assign(moving.graph.bodies.size(), 0);
    bool any = false;
    const auto hold = [&](std::uint32_t body) {
        if (hidden.proxies.empty()) {
            hidden.proxies.assign(moving.proxies.begin(), moving.proxies.end());
        }
        hidden.proxies[body].from_ws = hidden.proxies[body].to_ws;
        if (moving.graph.bodies[body].role != BodyRole::fixed) {
            hidden.is_suspect[body] = 1;
            any = true;
        }
    };
    for (std::uint32_t i = 0; i < moving.proxies.size(); ++i) {
        if (moving.proxies[i].shape != k_no_shape && is_long(moving.proxies[i], sweep_m)) {
            hold(i);
        }
    }
    for (const RowBlock& block : moving.graph.blocks) {
        if (is_contact(block) &&
            is_long(moving.proxies[block.a], moving.proxies[block.b], sweep_m)) {
            hold(block.a);
            hold(block.b);
        }
    }
    return any;
}

}  // namespace

void find_missed_overlaps(const MovingContacts& moving, const ContactLimits& limits,
                          MissedOverlaps& hidden) {
    hidden.of_body.resize(moving.graph.bodies.size());
    for (std::uint32_t i = 0; i < hidden.of_body.size(); ++i) {
        hidden.of_body[i] = {0.0, i};
    }
    if (!hold_still(moving, limits.sweep_m, hidden)) {
        return;
    }
    moving.collision.set_proxies(hidden.proxies);
    moving.collision.find_contacts(limits, moving.scratch);
    const auto note = [&hidden](std::size_t body, std::size_t other, double depth_m) {
        if (hidden.is_suspect[body] != 0 && depth_m > hidden.of_body[body].depth_m) {
            hidden.of_body[body] = {depth_m, static_cast<std::uint32_t>(other)};
        }
    };
    for (const ContactPoint& contact : moving.scratch) {
        if (-contact.separation_m > k_new_overlap_m) {
            const std::size_t a = find_body(moving.graph, contact.id_a);
            const std::size_t b = find_body(moving.graph, contact.id_b);
            note(a, b, -contact.separation_m);
            note(b, a, -contact.separation_m);
        }
    }
}

}  // namespace handhold
