// Solver, contact: turns contact points into constraint blocks.
#include "engine/solver/contact/contact_rows.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

Vec3 velocity_at(const SolverBody& body, const Vec3& point_bs) {
    return body.velocity_mps + body.spin_radps.cross(body.pose_ws.rotation * point_bs);
}

// At least the speed of one point against the other; cheap.
double largest_approach_mps(const SolverBody& a, const SolverBody& b, const RowBlock& block) {
    return (a.velocity_mps - b.velocity_mps).norm() +
           a.spin_radps.norm() * block.point_a_bs.norm() +
           b.spin_radps.norm() * block.point_b_bs.norm();
}

// True if the bodies approach each other fast and the contact's two points are offset along the
// surface: a sweep found the contact where the bodies met, and they have moved on since. Other
// contacts act at one common point, so that they cannot turn bodies that are squeezed.
bool is_impact(const ConstraintGraph& graph, const RowBlock& block) {
    constexpr double k_slid_m = 1e-3;
    constexpr double k_fast_mps = 1.0;
    const SolverBody& a = graph.bodies[block.a];
    const SolverBody& b = graph.bodies[block.b];
    constexpr double k_rounding = 1.0 - 1e-9;
    if (largest_approach_mps(a, b, block) < k_rounding * k_fast_mps) {
        return false;
    }
    const Vec3 normal = b.pose_ws.rotation * block.normal_b_bs;
    const double approach_mps =
        normal.dot(velocity_at(b, block.point_b_bs) - velocity_at(a, block.point_a_bs));
    const Vec3 offset =
        transform_point(a.pose_ws, block.point_a_bs) - transform_point(b.pose_ws, block.point_b_bs);
    const double slid_square = (offset - normal * normal.dot(offset)).squaredNorm();
    return approach_mps > k_fast_mps && slid_square > k_slid_m * k_slid_m;
}

std::size_t body_with(std::uint64_t id, const ConstraintGraph& graph) {
    const std::size_t body = find_body(graph, id);
    HH_CHECK(body < graph.bodies.size(), "no body has this id", id);
    return body;
}

// Writes into the graph's memory: a block is large.
void append_contact_block(const ContactPoint& contact, std::size_t a, std::size_t b,
                          ConstraintGraph& graph) {
    RowBlock& block = graph.blocks.emplace_back();
    block.kind = RowKind::contact;
    block.a = static_cast<std::uint32_t>(a);
    block.b = static_cast<std::uint32_t>(b);
    block.key = contact.feature;
    block.point_a_bs = contact.point_a_bs + graph.bodies[a].collider_offset_bs;
    block.point_b_bs = contact.point_b_bs + graph.bodies[b].collider_offset_bs;
    block.normal_b_bs = contact.normal_b_bs;
    block.is_impact = is_impact(graph, block);
    block.friction = std::sqrt(graph.bodies[a].friction * graph.bodies[b].friction);
    block.restitution = std::max(graph.bodies[a].restitution, graph.bodies[b].restitution);
}

}  // namespace

void replace_contact_rows(std::span<const ContactPoint> contacts, ConstraintGraph& graph) {
    std::erase_if(graph.blocks, [](const RowBlock& block) { return is_contact(block); });
    const ContactPoint* last = nullptr;  // points of one pair of bodies follow each other
    std::size_t a = 0;
    std::size_t b = 0;
    for (const ContactPoint& contact : contacts) {
        if (last == nullptr || contact.id_a != last->id_a || contact.id_b != last->id_b) {
            a = body_with(contact.id_a, graph);
            b = body_with(contact.id_b, graph);
        }
        last = &contact;
        append_contact_block(contact, a, b, graph);
    }
    sort_blocks(graph);
    build_islands(graph);
}

}  // namespace handhold
