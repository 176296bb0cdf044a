// Solver, contact: overlaps that a sweep cannot see.
#include "engine/solver/contact/missed_overlaps.hpp"

#include <algorithm>
#include <numeric>

#include "engine/solver/contact/moving_contacts.hpp"

namespace handhold {
namespace {

// Bound on the error of the distance between two proxies in a heap, because each may lag behind its
// body by k_heap_moved_m (moving_contacts.cpp).
constexpr double k_heap_lag_m = 3e-3;
// Assumed distance of the collider's surface from its centre; conservative.
constexpr double k_max_arm_m = 1.0;

// True if the motion of a relative to b is so long that the collision world may have swept it.
bool may_be_swept(const ColliderProxy& a, const ColliderProxy& b, double sweep_m) {
    const Pose from = inverse(b.from_ws) * a.from_ws;
    const Pose to = inverse(b.to_ws) * a.to_ws;
    const double turn = 2.0 * (from.rotation.conjugate() * to.rotation).vec().norm();
    return (to.position - from.position).norm() + turn * k_max_arm_m > sweep_m;
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

void find_missed_overlaps(const CollisionWorld& collision, std::span<const ColliderProxy> proxies,
                          const ConstraintGraph& graph, double sweep_m, MissedOverlaps& missed) {
    missed.clear(graph.bodies.size());
    const auto record = [&](std::uint32_t body, std::uint32_t other, double depth_m) {
        Overlap& deepest = missed.of_body[body];
        if (graph.bodies[body].role != BodyRole::fixed && depth_m > deepest.depth_m) {
            if (deepest.depth_m == 0.0) {
                missed.deep.push_back(body);
            }
            deepest = {depth_m, other};
        }
    };
    const RowBlock* last = nullptr;
    for (const RowBlock& block : graph.blocks) {
        const bool same_pair = last != nullptr && last->a == block.a && last->b == block.b;
        if (!is_contact(block) || same_pair || is_heap_contact(graph.bodies, block) ||
            !may_be_swept(proxies[block.a], proxies[block.b], sweep_m)) {
            continue;
        }
        last = &block;
        const double depth_m = collision.overlap_m(proxies[block.a], proxies[block.b]);
        const bool is_heap = graph.bodies[block.a].in_heap || graph.bodies[block.b].in_heap;
        if (depth_m > (is_heap ? k_heap_lag_m : k_new_overlap_m)) {
            record(block.a, block.b, depth_m);
            record(block.b, block.a, depth_m);
        }
    }
    std::ranges::sort(missed.deep);
}

}  // namespace handhold
