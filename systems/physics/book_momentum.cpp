#include "systems/physics/book_momentum.hpp"

namespace handhold {
namespace {

void add_to(MomentumLedger& ledger, MomentumLedger::Receiver receiver, const Vec3& linear,
            const Vec3& angular) {
    ledger.linear_kgmps[receiver] += linear;
    ledger.angular_kgm2ps[receiver] += angular;
}

bool is_object(const SolverBody& body) {
    return body.role != BodyRole::translating && body.inverse_mass > 0.0;
}

// Books one side of a row's impulse, by receiver.
void book_impulse(const SolverBody& body, const Vec3& point_ws, const Vec3& impulse,
                  const Vec3& couple, MomentumLedger& ledger) {
    const Vec3 angular = point_ws.cross(impulse) + couple;
    if (body.role != BodyRole::translating) {
        add_to(ledger, is_object(body) ? MomentumLedger::objects : MomentumLedger::statics, impulse,
               angular);
        return;
    }
    // The play space cannot rotate, and may be heavier than its player in this phase. What does not
    // become the player's own momentum goes to the virtual player.
    const Vec3 own = (body.inverse_mass * body.mass_kg) * impulse;
    const Vec3 own_angular = body.pose_ws.position.cross(own);
    add_to(ledger, MomentumLedger::players, own, own_angular);
    add_to(ledger, MomentumLedger::virtual_player, impulse - own, angular - own_angular);
}

}  // namespace

void book_momentum(const ConstraintGraph& graph, MomentumLedger& ledger) {
    for (const RowBlock& block : graph.blocks) {
        const SolverBody& a = graph.bodies[block.a];
        const SolverBody& b = graph.bodies[block.b];
        if (is_object(a) && is_object(b) && !block.is_impact) {
            continue;  // both receivers are objects: the impulses cancel
        }
        // Both sides act at one point, as in the rows: a's point for contacts, else b's. Only fast
        // impacts have two points.
        const Vec3 point_ws = is_contact(block) ? transform_point(a.pose_ws, block.point_a_bs)
                                                : transform_point(b.pose_ws, block.point_b_bs);
        book_impulse(a, point_ws, block.impulse_ws_ns, block.angular_impulse_ws_nms, ledger);
        const Vec3 point_b_ws =
            block.is_impact ? transform_point(b.pose_ws, block.point_b_bs) : point_ws;
        book_impulse(b, point_b_ws, -block.impulse_ws_ns, -block.angular_impulse_ws_nms, ledger);
    }
}

}  // namespace handhold
