// Sources: Coulomb's cone by fixed point over who sticks and who slides, as in Moreau's contact
// dynamics (1988); restitution after Newton.
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

// Only what has one free coordinate can be pulled to a speed.
bool has_motor(const RowBlock& block) {
    return (block.kind == RowKind::hinge || block.kind == RowKind::slider) &&
           block.joint.motor_max_impulse > 0.0;
}

// What may slide against a bounded impulse, and what pulls a joint to a speed.
void collect_frictions(const IslandView& island, const RowBlock& block, std::uint32_t index,
                       SolveScratch& scratch) {
    const std::size_t normal = scratch.rows.size() - 1;  // a contact's only row
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
        // The lock is the last of the joint's rows; angular rows are scaled by their lever.
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

// What each row's velocity lacks.
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
        row.residual = speed;  // metres a second here
    }
}

void stick(SolveScratch& scratch, SolveScratch::Friction& friction) {
    friction.slides = false;
    for (std::size_t i = 0; i < friction.width; ++i) {
        scratch.system.free_multiplier(friction.row + i);
    }
}

// Coulomb's law for one friction after a solve: what takes more than its limit slides, against its
// motion, by the limit; what slides and is pushed along its motion sticks again. True where that
// changes the next solve.
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
    Vec3 wanted = friction.slides ? Vec3(-slip) : push;
    wanted = wanted.norm() > 1e-12 ? Vec3(wanted * (limit / wanted.norm())) : push;
    if (friction.slides && !may_stick && push.dot(slip) > 0.0) {
        wanted = 0.5 * push;  // between too much and too little: never along the slip for long
    }
    const bool changes = !friction.slides || (wanted - push).norm() > tolerance;
    friction.slides = true;
    for (std::size_t i = 0; i < friction.width; ++i) {
        scratch.system.fix_multiplier(friction.row + i, wanted[static_cast<Eigen::Index>(i)]);
    }
    return changes;
}

// The largest impulse that presses a contact that rubs, N s; 0 where none does.
double pressure_of(std::span<const double> lambda, const SolveScratch& scratch) {
    double largest = 0.0;
    for (const SolveScratch::Friction& friction : scratch.frictions) {
        if (friction.coefficient > 0.0 && !friction.is_frictionless) {
            largest = std::max(largest, std::abs(lambda[friction.normal]));
        }
    }
    return largest;
}

// True where the rows of an island that nothing drives give it more energy than they take: half of
// impulse times velocity, before and after.
bool adds_energy(std::span<const double> lambda, const VelocityResult& result,
                 const SolveScratch& scratch) {
    // Of what they exchange, which is out of all proportion where friction was not settled.
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

// Who sticks and who slides, by fixed point. The multipliers are those of the last pass.
std::span<const double> solve_stick_slip(int passes, SolveScratch& scratch,
                                         VelocityResult& result) {
    constexpr int k_max_stick_passes = 6;  // later ones only slide: no going round in circles
    constexpr double k_wedge = 10.0;       // times what pressed while all stuck
    std::span<const double> lambda = scratch.system.solve(scratch.rows);
    const double pressed = pressure_of(lambda, scratch);
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
        if (pressure_of(lambda, scratch) > k_wedge * pressed) {
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

// Newton's law of restitution gains energy where some contacts bounce and others do not.
void clear_restitution(SolveScratch& scratch) {
    for (std::size_t i = 0; i < scratch.rows.size(); ++i) {
        if (scratch.rows[i].group == RowGroup::contact) {
            scratch.rows[i].residual -= scratch.approach_mps[i];
            scratch.approach_mps[i] = 0.0;
        }
    }
}

// Multipliers of all rows, with friction.
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
    // The harder it is held, the harder it presses, or the more it gains. A wedge has no answer;
    // let contacts slip freely, and settle what rubs in joints anew.
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
            // In the coordinate's own unit: angular rows are scaled by their lever.
            const bool angle = row.linear_a.isZero(0.0);
            block.joint.lock_impulse += std::abs(lambda[i]) * (angle ? k_angle_lever_m : 1.0);
        }
    }
}

// Of the rows that act.
double worst_speed(std::span<const Row> rows, const RowSystem& system) {
    double worst = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        worst = system.is_active(i) ? std::max(worst, std::abs(rows[i].residual)) : worst;
    }
    return worst;
}

// Takes the error of regularisation down, by a factor that long levers make small, until the rows
// are met or cannot be: more would only press contradicting rows against each other.
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
    // Contacts that contradict each other (a jam) are met by no velocity; hard ones would try with
    // huge ones. Nobody may gain more than the rows lack.
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
        regularisation.drive *= 100.0;
        regularisation.contact *= 100.0;
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
