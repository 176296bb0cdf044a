#include "systems/physics/update_velocities.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "engine/core/parallel.hpp"
#include "engine/solver/model/collider_pose.hpp"
#include "engine/solver/newton/velocities.hpp"

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

// Factor on the inverse mass of a pushed player who shares momentum with no other body. An
// immovable support pushes players alike, whatever their mass. Light objects that they move must
// not shake them, as in the forward phase: against those, a player counts as k_times_heaviest times
// the heaviest.
double pushed_share(double heaviest_kg, double mass_kg, const PhaseTuning& tuning) {
    constexpr double k_times_heaviest = 1000.0;  // with a larger ratio regularisation would show
    const double exchanged =
        smooth_step(heaviest_kg, tuning.kappa_light_kg,
                    std::max(tuning.kappa_heavy_kg, tuning.kappa_light_kg + 1e-9));
    const double min_share = mass_kg / std::max(k_times_heaviest * heaviest_kg, mass_kg);
    return std::max(exchanged, min_share);
}

// Momentum is exchanged with the masses of the phase that moved the island. Players have their true
// mass if they grip a surface, or were pushed by something that shares momentum. Heavy bodies have
// theirs if pushed or in an island with a grip or joint.
void set_masses(FrameGraph& frame, const Island& island, const PhaseTuning& tuning) {
    const bool reached = has_hand_or_joint(frame.graph, island);
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
            share = info.pushed || reached ? 1.0 : 0.0;
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
        if (is_object(a) && is_object(b)) {
            continue;  // both are objects: the sum is zero
        }
        // Both sides act at one point, as in the rows: a's point for contacts, else b's.
        const Vec3 point_ws = is_contact(block) ? transform_point(a.pose_ws, block.point_a_bs)
                                                : transform_point(b.pose_ws, block.point_b_bs);
        book_impulse(a, point_ws, block.impulse_ws_ns, block.angular_impulse_ws_nms, ledger);
        book_impulse(b, point_ws, -block.impulse_ws_ns, -block.angular_impulse_ws_nms, ledger);
    }
}

bool is_slower(const Vec3& velocity_mps, double limit_mps) {
    return velocity_mps.squaredNorm() < limit_mps * limit_mps;
}

// Limits the speed relative to the reference. True if it was exceeded.
bool clamp_speed(const Vec3& reference_mps, double limit_mps, Vec3& velocity_mps) {
    const Vec3 relative = velocity_mps - reference_mps;
    const double speed = relative.norm();
    if (speed <= limit_mps) {
        return false;
    }
    velocity_mps = reference_mps + relative * (limit_mps / speed);
    return true;
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
    for (std::size_t i = 0; i < io.frame.entities.size(); ++i) {
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

// The highest speed, relative to the reference, at the rows of the island's kinematic and heavy
// bodies: up to there a body's velocity is explained by what drives it.
double driven_speed(const FrameGraph& frame, const Island& island, const Vec3& reference_mps) {
    double fastest = 0.0;
    for (const std::uint32_t i : frame.graph.blocks_of(island)) {
        const RowBlock& block = frame.graph.blocks[i];
        for (const std::uint32_t index : {block.a, block.b}) {
            const SolverBody& body = frame.graph.bodies[index];
            if (body.role == BodyRole::fixed || body.role == BodyRole::heavy) {
                const Vec3 arm =
                    transform_point(frame.graph.bodies[block.a].pose_ws, block.point_a_bs) -
                    body.pose_ws.position;
                const Vec3 at_row = body.velocity_mps + body.spin_radps.cross(arm);
                fastest = std::max(fastest, (at_row - reference_mps).norm());
            }
        }
    }
    return fastest;
}

// A push or pull on a player may come from a tracking jump. It must not launch them, neither now
// nor when the grip breaks in the next frame. Poses stay; speed they had before, or got from a
// moving support, is kept.
void clamp_players(const UpdateVelocitiesIo& io, const LocomotionTuning& tuning,
                   StageStats& stats) {
    for (const Island& island : io.frame.graph.islands) {
        for (const std::uint32_t i : io.frame.graph.bodies_of(island)) {
            const FrameGraph::PhaseBody& info = io.frame.phase[i];
            if (io.frame.graph.bodies[i].role != BodyRole::translating ||
                !(info.pushed || info.grips_surface)) {
                continue;
            }
            const Entity player = io.frame.entities[i];
            const Vec3& reference = io.reference.at(player).linear_mps;
            const double limit = std::max({tuning.release_speed_max_mps,
                                           (info.velocity_before_mps - reference).norm(),
                                           driven_speed(io.frame, island, reference)});
            if (clamp_speed(reference, limit, io.player_velocity.at(player).linear_mps) &&
                info.pushed) {
                stats.count(Fallback::release_speed_clamped);
            }
        }
    }
}

// A held or pushed body may be torn from the hand in the next frame by a tracking jump, and must
// not leave at that speed. A held body's pose still follows its hand.
void clamp_handled_bodies(const UpdateVelocitiesIo& io, const LocomotionTuning& tuning,
                          StageStats& stats) {
    const FrameGraph& frame = io.frame;
    for (const Island& island : frame.graph.islands) {
        const std::span<const std::uint32_t> blocks = frame.graph.blocks_of(island);
        const auto hand = std::ranges::find_if(
            blocks, [&](std::uint32_t i) { return is_drive(frame.graph.blocks[i]); });
        if (hand == blocks.end()) {
            continue;
        }
        const Entity player = frame.entities[frame.graph.blocks[*hand].a];
        const Vec3& reference = io.reference.at(player).linear_mps;
        std::optional<double> driven;  // computed once, and only if a body is fast
        for (const std::uint32_t i : frame.graph.bodies_of(island)) {
            if (frame.graph.bodies[i].role != BodyRole::free) {
                continue;
            }
            Vec3& velocity_mps = io.body_velocity.at(frame.entities[i]).linear_mps;
            if (is_slower(velocity_mps - reference, tuning.object_speed_max_mps)) {
                continue;  // the common case
            }
            const double before = (frame.phase[i].velocity_before_mps - reference).norm();
            if (!driven) {
                driven = driven_speed(frame, island, reference);
            }
            const double limit = std::max({tuning.object_speed_max_mps, before, *driven});
            if (clamp_speed(reference, limit, velocity_mps)) {
                stats.count(Fallback::object_speed_clamped);
            }
        }
    }
}

void finish_releases(const UpdateVelocitiesIo& io, const LocomotionTuning& tuning,
                     StageStats& stats) {
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        Grab& grab = io.grab.rows()[row];
        const Entity player = io.owner.at(io.grab.owners()[row]).player;
        const Vec3& reference = io.reference.at(player).linear_mps;
        if (grab.phase != GrabPhase::releasing) {
            continue;
        }
        bool clamped = false;
        if (grab.kind != GripKind::held) {
            clamped = clamp_speed(reference, tuning.release_speed_max_mps,
                                  io.player_velocity.at(player).linear_mps);
        } else if (!grab.jointed) {
            // Jointed bodies may be on a moving ship: clamp_handled_bodies accounts for its speed.
            clamped = clamp_speed(reference, tuning.object_speed_max_mps,
                                  io.body_velocity.at(grab.body).linear_mps);
        }
        if (clamped) {
            stats.count(Fallback::release_speed_clamped);
        }
        grab = {};
    }
}

// For each body, the other body of its deepest overlap; its own index if no overlap is too deep.
void find_overlaps(FrameGraph& frame) {
    const ConstraintGraph& graph = frame.graph;
    frame.overlap_m.assign(graph.bodies.size(), k_valid_overlap_m);
    frame.overlaps_with.resize(graph.bodies.size());
    std::iota(frame.overlaps_with.begin(), frame.overlaps_with.end(), 0U);
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
    for (std::uint32_t i = 0; i < graph.bodies.size(); ++i) {
        const Overlap& hidden = frame.hidden_overlaps.of_body[i];
        update(i, hidden.with, hidden.depth_m);
    }
}

void write_last_valid(const UpdateVelocitiesIo& io) {
    FrameGraph& frame = io.frame;
    find_overlaps(frame);
    for (std::uint32_t i = 0; i < frame.entities.size(); ++i) {
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
        // Penetrating: keep the last valid pose, carried along if the obstacle moves.
        const ColliderProxy& other = frame.proxies[frame.overlaps_with[i]];
        if (frame.graph.bodies[frame.overlaps_with[i]].role == BodyRole::fixed) {
            valid->pose_ws = other.to_ws * (inverse(other.from_ws) * valid->pose_ws);
        }
    }
}

}  // namespace

void update_velocities(const UpdateVelocitiesIo& io, const Tuning& tuning, StageStats& stats) {
    for (std::size_t i = 0; i < io.frame.phase.size(); ++i) {
        io.frame.phase[i].velocity_before_mps = io.frame.graph.bodies[i].velocity_mps;
    }
    solve_islands(io.frame, tuning, stats);
    book_impulses(io.frame.graph, stats.ledger);
    write_velocities(io, tuning.locomotion, stats);
    clamp_handled_bodies(io, tuning.locomotion, stats);
    finish_releases(io, tuning.locomotion, stats);
    clamp_players(io, tuning.locomotion, stats);
    write_last_valid(io);
}

}  // namespace handhold
