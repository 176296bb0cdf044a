#include "systems/physics/shared/mass_shares.hpp"

#include <algorithm>

namespace handhold {
namespace {

// Contacts closer than this may support a body, and thus push a player.
constexpr double k_supporting_m = 1e-5;
// Largest ratio, in the solve, of a player's mass to the mass of the light bodies in hand.
constexpr double k_max_player_ratio = 1000.0;

template <typename Predicate>
bool any_body(const ConstraintGraph& graph, const Island& island, Predicate&& predicate) {
    return std::ranges::any_of(graph.bodies_of(island), predicate);
}
template <typename Predicate>
bool any_block(const ConstraintGraph& graph, const Island& island, Predicate&& predicate) {
    return std::ranges::any_of(graph.blocks_of(island),
                               [&](std::uint32_t i) { return predicate(graph.blocks[i]); });
}

bool acts_on(const RowBlock& block, std::uint32_t body) {
    return block.a == body || block.b == body;
}

void write_share(double share, SolverBody& body) {
    body.inverse_mass = share / body.mass_kg;
    body.inverse_inertia_bs.setZero();
    if (body.role != BodyRole::translating && share > 0.0) {
        body.inverse_inertia_bs = share * body.inertia_kgm2.cwiseInverse();
    }
}

// --- Positions -----------------------------------------------------------------------------------

double player_share(const FrameGraph& frame, const Island& island, std::uint32_t player,
                    Phase phase) {
    const FrameGraph::PhaseBody& info = frame.phase[player];
    switch (phase) {
        case Phase::reach:
            return info.grips_surface ? 1.0 : info.forward_share;
        case Phase::forward:
            return info.grips_surface ? 0.0 : info.forward_share;
        case Phase::relax:
            return 0.0;
        case Phase::backward:
            return 1.0;
        case Phase::contradiction:
            break;
    }
    const bool touches = any_block(frame.graph, island, [player](const RowBlock& block) {
        return is_contact(block) && acts_on(block, player);
    });
    return touches && info.pushed ? 1.0 : 0.0;
}

double share_of(const FrameGraph& frame, const Island& island, std::uint32_t index, Phase phase) {
    const SolverBody& body = frame.graph.bodies[index];
    const bool is_held_still = phase == Phase::backward && body.in_heap;
    switch (body.role) {
        case BodyRole::fixed:
            return 0.0;
        case BodyRole::free:
            return is_held_still ? 0.0 : 1.0;
        case BodyRole::heavy:
            return phase == Phase::forward || phase == Phase::relax || is_held_still ? 0.0 : 1.0;
        case BodyRole::translating:
            break;
    }
    return player_share(frame, island, index, phase);
}

// --- Velocities ----------------------------------------------------------------------------------

bool joint_has_force(const JointRows& joint) {
    return joint.friction_impulse > 0.0 || joint.motor_max_impulse > 0.0 ||
           joint.lock_limit_impulse > 0.0;
}

// True if a pushed player shares momentum with another body: a second player, a heavy body, a
// contact that takes part in the velocity solve, or a joint with friction, a detent or a locked
// latch.
bool shares_momentum(const ConstraintGraph& graph, const Island& island) {
    int players = 0;
    for (const std::uint32_t i : graph.bodies_of(island)) {
        const BodyRole role = graph.bodies[i].role;
        players += role == BodyRole::translating ? 1 : 0;
        if (role == BodyRole::heavy || players > 1) {
            return true;
        }
    }
    return any_block(graph, island, [&graph](const RowBlock& block) {
        return is_contact(block)
                   ? contact_separation_m(graph.bodies, block) < VelocitySettings{}.touch_m
                   : is_joint(block) && joint_has_force(block.joint);
    });
}

double heaviest_free_kg(const ConstraintGraph& graph, const Island& island) {
    double heaviest_kg = 0.0;
    for (const std::uint32_t i : graph.bodies_of(island)) {
        const SolverBody& body = graph.bodies[i];
        heaviest_kg = std::max(heaviest_kg, body.role == BodyRole::free ? body.mass_kg : 0.0);
    }
    return heaviest_kg;
}

// True if the island has a hand whose player counts as nearly immovable in this frame: the hand
// holds a light body, and nothing has pushed the player yet.
bool has_unyielding_hand(const FrameGraph& frame, const Island& island) {
    return any_block(frame.graph, island, [&frame](const RowBlock& block) {
        if (!is_drive(block)) {
            return false;
        }
        const FrameGraph::PhaseBody& player = frame.phase[block.a];
        return !player.grips_surface && !player.pushed && player.forward_share < 1.0;
    });
}

bool is_joined(const ConstraintGraph& graph, const Island& island, std::uint32_t body) {
    return any_block(graph, island, [body](const RowBlock& block) {
        return !is_contact(block) && acts_on(block, body);
    });
}

}  // namespace

// --- Assembly ------------------------------------------------------------------------------------

BodyRole role_of(const RigidBody& body, const PhaseTuning& tuning) {
    if (body.kind != BodyKind::free) {
        return BodyRole::fixed;
    }
    return is_light(body, tuning.heavy_body_kg) ? BodyRole::free : BodyRole::heavy;
}

void note_grip(const Grab& grab, std::size_t player, std::size_t body, const PhaseTuning& tuning,
               FrameGraph& frame) {
    FrameGraph::PhaseBody& own = frame.phase[player];
    FrameGraph::PhaseBody& gripped = frame.phase[body];
    gripped.held = grab.kind == GripKind::held;
    if (grab.kind == GripKind::player) {
        gripped.grips_surface = true;  // the grip is symmetric
    }
    if (grab.kind != GripKind::held) {
        own.grips_surface = true;
    } else if (!grab.jointed) {
        own.forward_share =
            std::max(own.forward_share, momentum_share(frame.graph.bodies[body].mass_kg, tuning));
    }
}

void mark_pushed(const Island& island, FrameGraph& frame) {
    for (const std::uint32_t i : frame.graph.bodies_of(island)) {
        frame.phase[i].pushed = true;
    }
}

// --- What the facts say about an island ----------------------------------------------------------

bool has_hand_or_joint(const ConstraintGraph& graph, const Island& island) {
    return any_block(graph, island, [](const RowBlock& block) { return !is_contact(block); });
}

bool is_pushed(const FrameGraph& frame, const Island& island) {
    return any_body(frame.graph, island, [&](std::uint32_t i) { return frame.phase[i].pushed; });
}

bool may_push(const ConstraintGraph& graph, const Island& island) {
    const auto players = std::ranges::count_if(graph.bodies_of(island), [&](std::uint32_t i) {
        return graph.bodies[i].role == BodyRole::translating;
    });
    if (players == 0) {
        return false;
    }
    const auto is_unmoved = [&](std::uint32_t i) {
        return graph.bodies[i].role == BodyRole::fixed || graph.bodies[i].role == BodyRole::heavy;
    };
    return players > 1 || any_block(graph, island, [&](const RowBlock& block) {
               const bool active =
                   !is_contact(block) || contact_separation_m(graph.bodies, block) < k_supporting_m;
               return active && (is_unmoved(block.a) || is_unmoved(block.b));
           });
}

// --- Inverse masses ------------------------------------------------------------------------------

void set_masses(const Island& island, Phase phase, FrameGraph& frame) {
    for (const std::uint32_t i : frame.graph.bodies_of(island)) {
        write_share(share_of(frame, island, i, phase), frame.graph.bodies[i]);
    }
}

void set_velocity_masses(const Island& island, const PhaseTuning& tuning, FrameGraph& frame) {
    ConstraintGraph& graph = frame.graph;
    const bool has_driver = has_hand_or_joint(graph, island);
    const bool is_unyielding = has_unyielding_hand(frame, island);
    const bool shares = shares_momentum(graph, island);
    const double heaviest_kg = heaviest_free_kg(graph, island);
    for (const std::uint32_t i : graph.bodies_of(island)) {
        SolverBody& body = graph.bodies[i];
        const FrameGraph::PhaseBody& info = frame.phase[i];
        double share = 1.0;
        if (body.role == BodyRole::translating) {
            const double pushed = shares ? 1.0
                                         : std::max(momentum_share(heaviest_kg, tuning),
                                                    least_player_share(heaviest_kg, body.mass_kg));
            share = info.grips_surface ? 1.0 : info.pushed ? pushed : info.forward_share;
        } else if (body.role == BodyRole::heavy) {
            const bool moves = is_unyielding ? is_joined(graph, island, i) : has_driver;
            share = info.pushed || moves ? 1.0 : 0.0;
        }
        write_share(share, body);
    }
}

double mass_for_host_kg(const FrameGraph& frame, std::size_t player, double mass_kg) {
    if (player >= frame.phase.size() || frame.phase[player].grips_surface) {
        return mass_kg;
    }
    double heaviest_kg = 0.0;
    for (const RowBlock& block : frame.hand_blocks) {
        if (block.a == player) {
            heaviest_kg = std::max(heaviest_kg, frame.graph.bodies[block.b].mass_kg);
        }
    }
    return mass_kg /
           std::max(frame.phase[player].forward_share, least_player_share(heaviest_kg, mass_kg));
}

double momentum_share(double mass_kg, const PhaseTuning& tuning) {
    return smooth_step(mass_kg, tuning.kappa_light_kg,
                       std::max(tuning.kappa_heavy_kg, tuning.kappa_light_kg + 1e-9));
}

double least_player_share(double heaviest_kg, double mass_kg) {
    return mass_kg / std::max(k_max_player_ratio * heaviest_kg, mass_kg);
}

}  // namespace handhold
