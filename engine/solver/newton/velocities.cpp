// Solver, newton: the velocity solve, row by row.
// Sources: Coulomb's cone by fixed-point iteration over sticking and sliding contacts, as in
// Moreau's contact dynamics (1988); restitution after Newton.
#include "engine/solver/newton/velocities.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/flush_denormals.hpp"
#include "engine/solver/newton/triad_velocities.hpp"

namespace handhold {
namespace {

double row_velocity(const IslandView& island, const Row& row) {
    const SolverBody& a = island.bodies[row.a];
    const SolverBody& b = island.bodies[row.b];
    return row.linear_a.dot(a.velocity_mps - b.velocity_mps) + row.angular_a.dot(a.spin_radps) +
           row.angular_b.dot(b.spin_radps);
}

// Only joints with one free coordinate have a motor.
bool has_motor(const RowBlock& block) {
    return (block.kind == RowKind::hinge || block.kind == RowKind::slider) &&
           block.joint.motor_max_impulse > 0.0;
}

// Appends the friction and motor rows of a block, and their bounds.
void collect_frictions(const IslandView& island, const RowBlock& block, std::uint32_t index,
                       SolveScratch& scratch) {
    const std::size_t normal = scratch.rows.size() - 1;  // a contact's only row; a joint's last row
    const auto add = [&](double limit, double coefficient) {
        const std::size_t row = scratch.rows.size();
        const std::size_t width = append_sliding_rows(island.bodies, block, index, scratch.rows);
        if (width > 0) {
            scratch.frictions.push_back({row, width, limit, normal, coefficient, false});
        }
    };
    if (is_contact(block) && block.friction > 0.0) {
        add(0.0, block.friction);
    }
    if (block.joint.lock_limit_impulse > 0.0 && block.joint.lower == block.joint.upper) {
        // The lock is the last of the joint's rows. Angular rows are scaled by their lever.
        const double lever = is_angular(block.kind) ? k_angle_lever_m : 1.0;
        scratch.frictions.push_back(
            {normal, 1, block.joint.lock_limit_impulse / lever, normal, 0.0, false});
    }
    if (is_joint(block) && block.joint.friction_impulse > 0.0) {
        add(block.joint.friction_impulse, 0.0);
    }
    if (has_motor(block)) {
        add(block.joint.motor_max_impulse, 0.0);
    }
}

void collect_velocity_rows(const IslandView& island, const VelocitySettings& settings,
                           SolveScratch& scratch) {
    scratch.rows.clear();
    scratch.frictions.clear();
    scratch.has_energy_source = false;
    scratch.approach_mps.clear();
    for (const std::uint32_t index : island.island_blocks) {
        RowBlock& block = island.blocks[index];
        block.impulse_ws_ns.setZero();
        block.angular_impulse_ws_nms.setZero();
        block.joint.lock_impulse = 0.0;
        const bool counts =
            !is_contact(block) || contact_separation_m(island.bodies, block) < settings.touch_m;
        if (!counts || !takes_part(island, block)) {
            continue;
        }
        scratch.has_energy_source =
            scratch.has_energy_source || is_drive(block) || has_motor(block);
        append_rows(island.bodies, block, index, scratch.rows, settings.touch_m);
        for (std::size_t i = scratch.approach_mps.size(); i < scratch.rows.size(); ++i) {
            const double speed = row_velocity(island, scratch.rows[i]);
            const bool bounces = is_contact(block) && speed < -settings.restitution_speed_mps;
            scratch.approach_mps.push_back(bounces ? block.restitution * speed : 0.0);
        }
        collect_frictions(island, block, index, scratch);
        scratch.approach_mps.resize(scratch.rows.size(), 0.0);
        if (has_motor(block)) {
            scratch.approach_mps.back() =
                (joint_coordinate(island.bodies, block) - block.joint.motor_target) /
                block.joint.motor_time_s;
        }
    }
}

// Residual of every row at the current velocities, m/s (Row::residual).
void evaluate_velocity_rows(const IslandView& island, SolveScratch& scratch) {
    for (std::size_t i = 0; i < scratch.rows.size(); ++i) {
        Row& row = scratch.rows[i];
        const RowBlock& block = island.blocks[row.block];
        double speed = row_velocity(island, row) + scratch.approach_mps[i];
        if (row.group == RowGroup::drive) {
            speed += row.linear_a.dot(block.drive_velocity_ws_mps);
            if (row.linear_a.isZero(0.0)) {
                speed += row.angular_a.dot(block.drive_spin_ws_radps);
            }
        }
        row.residual = speed;  // m/s, unlike in positions
    }
}

void stick(SolveScratch& scratch, SolveScratch::Friction& friction) {
    friction.slides = false;
    for (std::size_t i = 0; i < friction.width; ++i) {
        scratch.system.free_multiplier(friction.row + i);
    }
}

// Coulomb's law for one friction after a solve. A multiplier above its limit slides: it is fixed at
// the limit, opposing the slip. A sliding one that pushes along its slip sticks again. True if the
// next solve changes.
bool apply_friction_law(std::span<const double> lambda, bool may_stick, SolveScratch& scratch,
                        SolveScratch::Friction& friction) {
    const double limit = friction.coefficient > 0.0
                             ? friction.coefficient * std::max(0.0, lambda[friction.normal])
                             : friction.limit;
    Vec3 push = Vec3::Zero();
    Vec3 slip = Vec3::Zero();
    for (std::size_t i = 0; i < friction.width; ++i) {
        const std::size_t row = friction.row + i;
        push[static_cast<Eigen::Index>(i)] = lambda[row];
        slip[static_cast<Eigen::Index>(i)] =
            scratch.system.remaining_residual(row, scratch.rows[row].residual);
    }
    const double tolerance = 1e-6 * limit + 1e-15;
    if (!friction.slides && push.norm() <= limit + tolerance) {
        return false;
    }
    if (friction.slides && may_stick && push.dot(slip) > 0.0 && limit > 0.0) {
        stick(scratch, friction);
        return true;
    }
    Vec3 target = friction.slides ? Vec3(-slip) : push;
    target = target.norm() > 1e-12 ? Vec3(target * (limit / target.norm())) : push;
    if (friction.slides && !may_stick && push.dot(slip) > 0.0) {
        target = 0.5 * push;  // bisects: avoids pushing along the slip
    }
    const bool changes = !friction.slides || (target - push).norm() > tolerance;
    friction.slides = true;
    for (std::size_t i = 0; i < friction.width; ++i) {
        scratch.system.fix_multiplier(friction.row + i, target[static_cast<Eigen::Index>(i)]);
    }
    return changes;
}

// Largest normal impulse of a contact with friction, N s; 0 if there is none.
double largest_normal_impulse(std::span<const double> lambda, const SolveScratch& scratch) {
    double largest = 0.0;
    for (const SolveScratch::Friction& friction : scratch.frictions) {
        if (friction.coefficient > 0.0 && !friction.is_frictionless) {
            largest = std::max(largest, std::abs(lambda[friction.normal]));
        }
    }
    return largest;
}

// True if the rows of an island without energy source add energy. Work of a row: impulse times the
// mean of its velocity before and after.
bool adds_energy(std::span<const double> lambda, const VelocityResult& result,
                 const SolveScratch& scratch) {
    // Relative to the energy exchanged, which is unreliable if friction did not converge.
    const double tolerance = result.friction_unconverged ? 1e-9 : 1e-3;
    constexpr double k_slow_mps = 1e-3;
    if (scratch.has_energy_source) {
        return false;
    }
    double work = 0.0;
    double exchanged = 0.0;
    for (std::size_t i = 0; i < scratch.rows.size(); ++i) {
        const double before = scratch.rows[i].residual - scratch.approach_mps[i];
        const double after = scratch.system.remaining_residual(i, before);
        work += 0.5 * lambda[i] * (before + after);
        exchanged += 0.5 * std::abs(lambda[i]) * (std::abs(before) + std::abs(after) + k_slow_mps);
    }
    return work > tolerance * exchanged;
}

// Stick-slip iteration. Returns the multipliers of the last pass.
std::span<const double> solve_stick_slip(int passes, SolveScratch& scratch,
                                         VelocityResult& result) {
    // later passes allow no return to sticking, so the iteration cannot cycle
    constexpr int k_max_stick_passes = 6;
    constexpr double k_wedge = 10.0;  // times the largest normal impulse with all contacts sticking
    std::span<const double> lambda = scratch.system.solve(scratch.rows);
    const double sticking_impulse = largest_normal_impulse(lambda, scratch);
    for (int pass = 0; pass < passes; ++pass) {
        bool changes = false;
        for (SolveScratch::Friction& friction : scratch.frictions) {
            changes |= !friction.is_frictionless &&
                       apply_friction_law(lambda, pass < k_max_stick_passes, scratch, friction);
        }
        if (!changes) {
            return lambda;
        }
        lambda = scratch.system.solve(scratch.rows);
        if (largest_normal_impulse(lambda, scratch) > k_wedge * sticking_impulse) {
            result.wedged = true;
            return lambda;
        }
    }
    result.friction_unconverged = true;
    return lambda;
}

void release_friction(SolveScratch& scratch, SolveScratch::Friction& friction) {
    friction.is_frictionless = true;
    for (std::size_t i = 0; i < friction.width; ++i) {
        scratch.system.fix_multiplier(friction.row + i, 0.0);
    }
}

// Removes restitution: Newton's law adds energy if some contacts of a body bounce and others do
// not.
void clear_restitution(SolveScratch& scratch) {
    for (std::size_t i = 0; i < scratch.rows.size(); ++i) {
        if (scratch.rows[i].group == RowGroup::contact) {
            scratch.rows[i].residual -= scratch.approach_mps[i];
            scratch.approach_mps[i] = 0.0;
        }
    }
}

// Solves for the multipliers of all rows with friction.
std::span<const double> solve_with_friction(int passes, SolveScratch& scratch,
                                            VelocityResult& result) {
    result = {};
    for (SolveScratch::Friction& friction : scratch.frictions) {
        friction.is_frictionless = false;
        stick(scratch, friction);
    }
    if (scratch.frictions.empty()) {
        return scratch.system.solve(scratch.rows);
    }
    const std::span<const double> lambda = solve_stick_slip(passes, scratch, result);
    if (!result.wedged && !adds_energy(lambda, result, scratch)) {
        return lambda;
    }
    // The contacts wedge (more friction causes more normal impulse) or the rows add energy. Contact
    // friction is removed and joint friction is solved again.
    for (SolveScratch::Friction& friction : scratch.frictions) {
        stick(scratch, friction);
        if (friction.coefficient > 0.0) {
            release_friction(scratch, friction);
        }
    }
    result = {};
    std::span<const double> without = solve_stick_slip(passes, scratch, result);
    if (adds_energy(without, result, scratch)) {
        clear_restitution(scratch);
        without = solve_stick_slip(passes, scratch, result);
    }
    result.wedged = true;
    return without;
}

void apply_impulses(const IslandView& island, std::span<const double> lambda,
                    SolveScratch& scratch) {
    gather_moves(scratch);
    for (const std::uint32_t index : island.island_bodies) {
        SolverBody& body = island.bodies[index];
        if (body.inverse_mass > 0.0) {
            body.velocity_mps += scratch.moves_m[body.slot];
            body.spin_radps += scratch.rotations_rad[body.slot];
        }
    }
    for (std::size_t i = 0; i < scratch.rows.size(); ++i) {
        const Row& row = scratch.rows[i];
        RowBlock& block = island.blocks[row.block];
        block.impulse_ws_ns += lambda[i] * row.linear_a;
        if (row.linear_a.isZero(0.0)) {
            block.angular_impulse_ws_nms += lambda[i] * row.angular_a;
        }
        if (row.group == RowGroup::limit && !row.unilateral) {
            // In the coordinate's unit: angular rows are scaled by their lever.
            const bool is_angle = row.linear_a.isZero(0.0);
            block.joint.lock_impulse += std::abs(lambda[i]) * (is_angle ? k_angle_lever_m : 1.0);
        }
    }
}

// Largest residual of the active rows.
double worst_speed(std::span<const Row> rows, const RowSystem& system) {
    double worst = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        worst = system.is_active(i) ? std::max(worst, std::abs(rows[i].residual)) : worst;
    }
    return worst;
}

// Iterative refinement: reduces the error of regularisation, which long levers amplify, until the
// rows are satisfied or cannot be. Further steps would only press contradicting rows against each
// other.
void refine_velocities(const IslandView& island, const VelocitySettings& settings,
                       SolveScratch& scratch) {
    double previous = std::numeric_limits<double>::infinity();
    for (int i = 0; i < settings.refinements; ++i) {
        evaluate_velocity_rows(island, scratch);
        const double worst = worst_speed(scratch.rows, scratch.system);
        if (worst < settings.tolerance_mps || worst > 0.5 * previous) {
            return;
        }
        previous = worst;
        scratch.values.clear();
        for (const Row& row : scratch.rows) {
            scratch.values.push_back(row.residual);
        }
        apply_impulses(island, scratch.system.solve_with_last_factor(scratch.values), scratch);
    }
}

}  // namespace

VelocityResult solve_velocities(const IslandView& island, const VelocitySettings& settings,
                                SolveScratch& scratch) {
    const FlushDenormals flush;
    if (scratch.triads.resume(island) || scratch.triads.load(island, settings.touch_m)) {
        solve_triad_velocities(island, settings, scratch.triads);
        return {};
    }
    VelocityResult result;
    collect_velocity_rows(island, settings, scratch);
    evaluate_velocity_rows(island, scratch);
    clear_stiffness(island, scratch);
    prepare_inertia(island, scratch);
    scratch.system.reset_active_set();
    scratch.system.assemble(island.bodies, scratch.inverse_inertia_ws, scratch.rows);
    double largest_residual = 0.0;
    for (const Row& row : scratch.rows) {
        largest_residual = std::max(largest_residual, std::abs(row.residual));
    }
    // No velocity satisfies contacts that contradict each other (a jam); stiff rows would answer
    // with huge impulses. No body may gain more speed than k_max_move_ratio times the residual.
    Regularisation regularisation = settings.regularisation;
    for (int attempt = 0; attempt <= k_max_regularisation_retries; ++attempt) {
        regularise(scratch.rows, regularisation, 1.0, scratch.system);
        const std::span<const double> lambda =
            solve_with_friction(settings.friction_passes, scratch, result);
        gather_moves(scratch);
        scratch.lambda.assign(lambda.begin(), lambda.end());
        if (!has_contact(scratch.rows) ||
            longest_move(scratch) <= k_max_move_ratio * largest_residual) {
            break;
        }
        regularisation.drive *= k_retry_regularisation_increase;
        regularisation.contact *= k_retry_regularisation_increase;
    }
    result.active_set_unconverged = scratch.system.is_active_set_unconverged();
    apply_impulses(island, scratch.lambda, scratch);
    if (regularisation.contact == settings.regularisation.contact &&
        !result.active_set_unconverged) {
        refine_velocities(island, settings, scratch);
    }
    return result;
}

}  // namespace handhold
