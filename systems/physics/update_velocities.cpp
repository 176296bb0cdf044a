#include "systems/physics/update_velocities.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/parallel.hpp"
#include "engine/solver/model/collider_pose.hpp"
#include "engine/solver/newton/velocities.hpp"
#include "systems/physics/shared/player_share.hpp"

namespace handhold {
namespace {

// A pose that overlaps by more than this is not a last valid pose.
constexpr double k_valid_overlap_m = 1e-4;

bool has_hand_or_joint(const ConstraintGraph& graph, const Island& island) {
    return std::ranges::any_of(graph.blocks_of(island),
                               [&](std::uint32_t i) { return !is_contact(graph.blocks[i]); });
}

bool joint_has_force(const JointRows& joint) {
    return joint.friction_impulse > 0.0 || joint.motor_max_impulse > 0.0 ||
           joint.lock_limit_impulse > 0.0;
}

// True if a pushed player shares momentum with another body: a second player, a heavy body, a
// touching contact, or a joint with friction, a detent or a locked latch.
bool shares_momentum(const FrameGraph& frame, const Island& island) {
    int players = 0;
    for (const std::uint32_t i : frame.graph.bodies_of(island)) {
        const BodyRole role = frame.graph.bodies[i].role;
        players += role == BodyRole::translating ? 1 : 0;
        if (role == BodyRole::heavy || players > 1) {
            return true;
        }
    }
    return std::ranges::any_of(frame.graph.blocks_of(island), [&](std::uint32_t i) {
        const RowBlock& block = frame.graph.blocks[i];
        return is_contact(block)
                   ? contact_separation_m(frame.graph.bodies, block) < k_valid_overlap_m
                   : is_joint(block) && joint_has_force(block.joint);
    });
}

double heaviest_free_kg(const FrameGraph& frame, const Island& island) {
    double heaviest_kg = 0.0;
    for (const std::uint32_t i : frame.graph.bodies_of(island)) {
        const SolverBody& body = frame.graph.bodies[i];
        heaviest_kg = std::max(heaviest_kg, body.role == BodyRole::free ? body.mass_kg : 0.0);
    }
    return heaviest_kg;
}

// Factor on the inverse mass of a pushed player who exchanges momentum with no other body. 1 if the
// island's heaviest free body has kappa_heavy_kg or more. Below that it falls smoothly, at
// kappa_light_kg down to least_player_share, so that light objects do not shake the player.
double pushed_share(double heaviest_kg, double mass_kg, const PhaseTuning& tuning) {
    const double exchanged =
        smooth_step(heaviest_kg, tuning.kappa_light_kg,
                    std::max(tuning.kappa_heavy_kg, tuning.kappa_light_kg + 1e-9));
    return std::max(exchanged, least_player_share(heaviest_kg, mass_kg));
}

// A hand whose player counts as nearly immovable in this frame: it holds a light body, and nothing
// has pushed the player yet.
bool has_unyielding_hand(const FrameGraph& frame, const Island& island) {
    return std::ranges::any_of(frame.graph.blocks_of(island), [&](std::uint32_t i) {
        const RowBlock& block = frame.graph.blocks[i];
        if (!is_drive(block)) {
            return false;
        }
        const FrameGraph::PhaseBody& player = frame.phase[block.a];
        return !player.grips_surface && !player.pushed && player.forward_share < 1.0;
    });
}

// True if a hand or joint acts on the body.
bool is_joined(const ConstraintGraph& graph, const Island& island, std::uint32_t body) {
    return std::ranges::any_of(graph.blocks_of(island), [&](std::uint32_t i) {
        const RowBlock& block = graph.blocks[i];
        return !is_contact(block) && (block.a == body || block.b == body);
    });
}

// Momentum is exchanged with the masses of the phase that moved the island. Players have their true
// mass if they grip a surface, or were pushed by something that shares momentum. Heavy bodies have
// theirs if pushed or in an island with a grip or joint. If a hand there does not yield, those that
// only contacts reach stand still: they would get momentum that no player pays for.
void set_masses(FrameGraph& frame, const Island& island, const PhaseTuning& tuning) {
    const bool reached = has_hand_or_joint(frame.graph, island);
    const bool is_unyielding = has_unyielding_hand(frame, island);
    const bool shares = shares_momentum(frame, island);
    const double heaviest_kg = heaviest_free_kg(frame, island);
    for (const std::uint32_t i : frame.graph.bodies_of(island)) {
        SolverBody& body = frame.graph.bodies[i];
        const FrameGraph::PhaseBody& info = frame.phase[i];
        double share = 1.0;
        if (body.role == BodyRole::translating) {
            const double pushed = shares ? 1.0 : pushed_share(heaviest_kg, body.mass_kg, tuning);
            share = info.grips_surface ? 1.0 : info.pushed ? pushed : info.forward_share;
        } else if (body.role == BodyRole::heavy) {
            const bool moves = is_unyielding ? is_joined(frame.graph, island, i) : reached;
            share = info.pushed || moves ? 1.0 : 0.0;
        }
        body.inverse_mass = share / body.mass_kg;
        body.inverse_inertia_bs.setZero();
        if (body.role != BodyRole::translating && share > 0.0) {
            body.inverse_inertia_bs = share * body.inertia_kgm2.cwiseInverse();
        }
    }
}

VelocitySettings settings_of(const Tuning& tuning) {
    VelocitySettings settings{k_valid_overlap_m, tuning.contact.restitution_speed_mps};
    settings.regularisation.contact = tuning.solver.contact_regularisation;
    settings.regularisation.joint = tuning.solver.joint_regularisation;
    settings.friction_passes = tuning.solver.friction_passes;
    return settings;
}

void solve_islands(FrameGraph& frame, const Tuning& tuning, StageStats& stats) {
    ConstraintGraph& graph = frame.graph;
    const VelocitySettings settings = settings_of(tuning);
    if (frame.island_scratch.size() < graph.islands.size()) {
        frame.island_scratch.resize(graph.islands.size());
    }
    frame.velocity_results.assign(graph.islands.size(), {});
    frame.island_order.resize(graph.islands.size());
    std::iota(frame.island_order.begin(), frame.island_order.end(), 0U);
    sort_largest_first(graph, frame.island_order);
    auto solve_one = [&](std::size_t order) {
        const std::uint32_t i = frame.island_order[order];
        const Island& island = graph.islands[i];
        set_masses(frame, island, tuning.phases);
        const IslandView view{
            BlockFilter::all,        graph.bodies,   graph.blocks,  graph.bodies_of(island),
            graph.blocks_of(island), graph.revision, island.is_heap};
        VelocitySettings of_island = settings;
        of_island.max_work += WorkBudget{}.per_block *
                              std::min(graph.blocks_of(island).size(), WorkBudget{}.max_blocks);
        frame.velocity_results[i] = solve_velocities(view, of_island, frame.island_scratch[i]);
    };
    parallel_for(graph.islands.size(), solve_one);
    for (const VelocityResult& result : frame.velocity_results) {
        if (result.unconverged) {
            stats.count(Fallback::friction_not_converged);
        }
        if (result.out_of_work) {
            stats.count(Fallback::solver_budget);
        }
    }
}

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

void book_impulses(const ConstraintGraph& graph, MomentumLedger& ledger) {
    for (const RowBlock& block : graph.blocks) {
        const SolverBody& a = graph.bodies[block.a];
        const SolverBody& b = graph.bodies[block.b];
        if (is_object(a) && is_object(b) && !block.is_impact) {
            continue;  // both are objects, at one point: the sum is zero
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

// Limits the spin of free bodies: impulses on a thin body can spin it without bound.
Vec3 clamp_spin(const SolverBody& body, double limit_radps, StageStats& stats) {
    const double square = body.spin_radps.squaredNorm();
    if (body.role != BodyRole::free || square <= limit_radps * limit_radps) {
        return body.spin_radps;
    }
    stats.count(Fallback::object_speed_clamped);
    return body.spin_radps * (limit_radps / std::sqrt(square));
}

void write_velocities(const UpdateVelocitiesIo& io, const LocomotionTuning& tuning,
                      StageStats& stats) {
    for (const std::uint32_t i : io.frame.active.list) {
        const SolverBody& body = io.frame.graph.bodies[i];
        const Entity entity = io.frame.entities[i];
        if (body.role == BodyRole::translating) {
            io.player_velocity.at(entity).linear_mps = body.velocity_mps;
        } else if (body.role != BodyRole::fixed) {
            io.body_velocity.at(entity) = {body.velocity_mps,
                                           clamp_spin(body, tuning.object_spin_max_radps, stats)};
        }
    }
}

// For each body, the other body of its deepest overlap; its own index if no overlap is too deep.
void find_overlaps(FrameGraph& frame) {
    const ConstraintGraph& graph = frame.graph;
    // Entries of inactive bodies are not read.
    frame.overlap_m.resize(graph.bodies.size());
    frame.overlaps_with.resize(graph.bodies.size());
    const auto clear = [&frame](std::uint32_t body) {
        frame.overlap_m[body] = k_valid_overlap_m;
        frame.overlaps_with[body] = body;
    };
    std::ranges::for_each(frame.active.list, clear);
    for (const RowBlock& block : graph.blocks) {
        clear(block.a);
        clear(block.b);
    }
    const auto update = [&frame](std::uint32_t body, std::uint32_t other, double depth_m) {
        if (depth_m > frame.overlap_m[body]) {
            frame.overlap_m[body] = depth_m;
            frame.overlaps_with[body] = other;
        }
    };
    for (const RowBlock& block : graph.blocks) {
        if (is_contact(block)) {
            const double depth_m = block_error_m(graph.bodies, block);
            update(block.a, block.b, depth_m);
            update(block.b, block.a, depth_m);
        }
    }
    for (const std::uint32_t i : frame.hidden_overlaps.deep) {
        const Overlap& hidden = frame.hidden_overlaps.of_body[i];
        update(i, hidden.with, hidden.depth_m);
    }
}

void write_last_valid(const UpdateVelocitiesIo& io) {
    FrameGraph& frame = io.frame;
    find_overlaps(frame);
    for (const std::uint32_t i : frame.active.list) {
        LastValidPose* const valid = io.last_valid.find(frame.entities[i]);
        if (valid == nullptr) {
            continue;
        }
        const SolverBody& body = frame.graph.bodies[i];
        const HeadTracking* const head =
            body.role == BodyRole::translating ? io.head.find(frame.entities[i]) : nullptr;
        valid->known = head == nullptr || head->state != TrackingState::never;
        if (frame.overlaps_with[i] == i) {
            valid->pose_ws = collider_pose(body);
            continue;
        }
        frame.active.note(i);  // the sweep of the next frame starts elsewhere
        // Penetrating: keep the last valid pose, carried along if the obstacle moves.
        const ColliderProxy& other = frame.proxies[frame.overlaps_with[i]];
        if (frame.graph.bodies[frame.overlaps_with[i]].role == BodyRole::fixed) {
            valid->pose_ws = other.to_ws * (inverse(other.from_ws) * valid->pose_ws);
        }
    }
}

}  // namespace

void update_velocities(const UpdateVelocitiesIo& io, const Tuning& tuning, StageStats& stats) {
    for (const std::uint32_t i : io.frame.active.list) {
        io.frame.phase[i].velocity_before_mps = io.frame.graph.bodies[i].velocity_mps;
    }
    solve_islands(io.frame, tuning, stats);
    book_impulses(io.frame.graph, stats.ledger);
    write_velocities(io, tuning.locomotion, stats);
    write_last_valid(io);
}

}  // namespace handhold
