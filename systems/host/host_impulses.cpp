// The impulses of hands and contacts that a host reads.
#include "systems/host/host_impulses.hpp"

#include <algorithm>
#include <limits>

namespace handhold {
namespace {

constexpr double k_no_limit = std::numeric_limits<double>::infinity();
// Lever arm that converts a hand's angular speed to a linear speed: about the length of the longest
// held body.
constexpr double k_held_lever_m = 1.0;

// Greatest speed at which the island's hands move what they hold.
double hand_speed_mps(const ConstraintGraph& graph, const Island& island) {
    double speed_mps = 0.0;
    for (const std::uint32_t i : graph.blocks_of(island)) {
        const RowBlock& block = graph.blocks[i];
        if (is_drive(block)) {
            speed_mps = std::max(speed_mps, block.drive_velocity_ws_mps.norm() +
                                                k_held_lever_m * block.drive_spin_ws_radps.norm());
        }
    }
    return speed_mps;
}

bool is_kind_of_drive(const RowBlock& block) { return is_drive(block); }
bool is_kind_of_contact(const RowBlock& block) { return is_contact(block); }

double impulse_limit_ns(const FrameGraph& frame, const Island& island) {
    // A player's share of their true inverse mass below this is not rounding: the step treated the
    // player as heavier.
    constexpr double k_true_share = 1.0 - 1e-9;
    const ConstraintGraph& graph = frame.graph;
    const double hand_mps = hand_speed_mps(graph, island);
    double limit_ns = 0.0;
    bool is_unyielding = false;
    for (const std::uint32_t i : graph.bodies_of(island)) {
        const SolverBody& body = graph.bodies[i];
        if (body.role == BodyRole::fixed) {
            continue;
        }
        const bool is_player = body.role == BodyRole::translating;
        is_unyielding =
            is_unyielding || (is_player && body.inverse_mass * body.mass_kg < k_true_share);
        limit_ns += body.mass_kg * (frame.phase[i].velocity_before_mps.norm() + hand_mps);
    }
    if (!is_unyielding) {
        return k_no_limit;
    }
    return limit_ns;
}

// Factor for the impulses of one kind in an island: 1, or less if their sum exceeds the limit.
double share_within(const ConstraintGraph& graph, const Island& island,
                    bool (*is_kind)(const RowBlock&), double limit_ns) {
    double sum_ns = 0.0;
    for (const std::uint32_t i : graph.blocks_of(island)) {
        sum_ns += is_kind(graph.blocks[i]) ? graph.blocks[i].impulse_ws_ns.norm() : 0.0;
    }
    return sum_ns > limit_ns ? limit_ns / sum_ns : 1.0;
}

}  // namespace

void limit_impulses(hh_world& host) {
    const ConstraintGraph& graph = host.caches.graph.graph;
    host.impulse_shares.assign(graph.blocks.size(), 1.0);
    for (const Island& island : graph.islands) {
        const double limit_ns = impulse_limit_ns(host.caches.graph, island);
        for (const auto is_kind : {&is_kind_of_drive, &is_kind_of_contact}) {
            const double share = share_within(graph, island, is_kind, limit_ns);
            for (const std::uint32_t i : graph.blocks_of(island)) {
                if (is_kind(graph.blocks[i])) {
                    host.impulse_shares[i] = share;
                }
            }
        }
    }
}

Vec3 reported_impulse_ns(const hh_world& host, std::size_t block) {
    return host.impulse_shares[block] * host.caches.graph.graph.blocks[block].impulse_ws_ns;
}

}  // namespace handhold
