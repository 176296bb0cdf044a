// Solver, newton: the velocity solve, row by row.
// Sources: Coulomb's cone by fixed-point iteration over sticking and sliding contacts, as in
// Moreau's contact dynamics (1988); restitution after Newton.
#include "engine/solver/newton/velocities.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/flush_denormals.hpp"
#include "engine/solver/model/negligible.hpp"
#include "engine/solver/newton/triad_velocities.hpp"
#include "engine/solver/newton/velocity_energy.hpp"

namespace handhold {
namespace {

double row_velocity(const IslandView& island, const Row& row) {
    const SolverBody& a = island.bodies[row.a];
    const SolverBody& b = island.bodies[row.b];
    return row.linear_a.dot(a.velocity_mps - b.velocity_mps) + row.angular_a.dot(a.spin_radps) +
           row.angular_b.dot(b.spin_radps);
}

// True if the joint has a motor. Only joints with one free coordinate can have one.
bool has_motor(const RowBlock& block) {
    return (block.kind == RowKind::hinge || block.kind == RowKind::slider) &&
           block.joint.motor_max_impulse > 0.0;
}

// The speed that the motor wants for a coordinate q after this solve.
double motor_speed(const JointRows& joint, double q) {
    const double wanted = joint.motor_time_s > 0.0 ? (joint.motor_target - q) / joint.motor_time_s
                                                   : joint.motor_speed;
    const double lost =
        joint.motor_frame_s > 0.0 ? (joint.previous - q) / joint.motor_frame_s : 0.0;
    return wanted + lost;
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
                -motor_speed(block.joint, joint_coordinate(island.bodies, block));
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

// Applies Coulomb's law to one friction after a solve. If its multiplier exceeds the limit, the
// friction slides: the multiplier is fixed at the limit, opposing the slip. A sliding friction that
// pushes along its slip sticks again. Returns true if another solve is needed.
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

// Stick-slip iteration; leaves the multipliers of the last pass in `lambda`. False if they still
// changed after `passes`.
bool solve_stick_slip(int passes, SolveScratch& scratch, std::span<const double>& lambda) {
    // In passes after this one, sliding contacts do not return to sticking, so that the iteration
    // cannot cycle.
    constexpr int k_max_stick_passes = 6;
    for (SolveScratch::Friction& friction : scratch.frictions) {
        stick(scratch, friction);
    }
    lambda = scratch.system.solve(scratch.rows);
    for (int pass = 0; pass < passes && !scratch.system.is_out_of_work(); ++pass) {
        bool changes = false;
        for (SolveScratch::Friction& friction : scratch.frictions) {
            changes |= apply_friction_law(lambda, pass < k_max_stick_passes, scratch, friction);
        }
        if (!changes) {
            return true;
        }
        lambda = scratch.system.solve(scratch.rows);
    }
    return false;
}

// Adds the gathered moves to the velocities, and the impulses to the blocks.
void apply_impulses(const IslandView& island, std::span<const double> lambda,
                    SolveScratch& scratch) {
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
            // Converts the lock's impulse to the coordinate's unit: angular rows are scaled by
            // their lever.
            const bool is_angle = row.linear_a.isZero(0.0);
            block.joint.lock_impulse += std::abs(lambda[i]) * (is_angle ? k_angle_lever_m : 1.0);
        }
    }
}

// --- Methods -------------------------------------------------------------------------------------

// Both methods solve for the multipliers of scratch.rows, write scratch.lambda and gather the
// moves.
class DirectMethod {
  public:
    DirectMethod(const IslandView& island, const VelocitySettings& settings, SolveScratch& scratch)
        : island_(island), settings_(settings), scratch_(scratch) {
        scratch_.system.reset_active_set();
        scratch_.system.limit_work(island.max_work);
        scratch_.system.assemble(island.bodies, scratch_.inverse_inertia_ws, scratch_.rows);
        regularise(scratch_.rows, settings.regularisation, 1.0,
                   mean_diagonal(scratch_.rows, scratch_.system), scratch_.system);
    }
    // Returns false if there is no plausible solution.
    bool solve() {
        std::span<const double> lambda;
        is_unconverged_ = !solve_stick_slip(settings_.friction_passes, scratch_, lambda);
        gather_moves(scratch_.system.moves(), scratch_);
        scratch_.lambda.assign(lambda.begin(), lambda.end());
        if (scratch_.system.is_active_set_unconverged() || !has_contact(scratch_.rows)) {
            return !scratch_.system.is_active_set_unconverged();
        }
        // No velocity satisfies contacts that contradict each other (a jam); stiff rows answer
        // with huge impulses. A stick-slip iteration that did not converge may throw bodies.
        constexpr double k_max_unconverged_ratio = 2.0;
        double largest = 0.0;
        for (const Row& row : scratch_.rows) {
            largest = std::max(largest, std::abs(row.residual));
        }
        return longest_move(scratch_) <=
               (is_unconverged_ ? k_max_unconverged_ratio : k_max_move_ratio) * largest;
    }
    bool is_unconverged() const { return is_unconverged_; }
    // Iterative refinement of the multipliers and of the gathered moves: reduces the error of
    // regularisation, which long levers amplify, until the rows are satisfied or cannot be. Further
    // steps would only press contradicting rows against each other.
    void refine() {
        double previous = std::numeric_limits<double>::infinity();
        for (int i = 0; i < settings_.refinements; ++i) {
            scratch_.values.clear();
            double worst = 0.0;
            for (std::size_t row = 0; row < scratch_.rows.size(); ++row) {
                const double rest = scratch_.rows[row].residual + moved(scratch_.rows[row]);
                scratch_.values.push_back(rest);
                worst = scratch_.system.is_active(row) ? std::max(worst, std::abs(rest)) : worst;
            }
            if (worst < settings_.tolerance_mps || worst > 0.5 * previous) {
                return;
            }
            previous = worst;
            add(scratch_.system.solve_with_last_factor(scratch_.values));
        }
    }

  private:
    // The row's velocity from the gathered moves.
    double moved(const Row& row) const {
        const SolverBody& a = island_.bodies[row.a];
        const SolverBody& b = island_.bodies[row.b];
        double sum = 0.0;
        if (a.inverse_mass > 0.0) {
            sum += row.linear_a.dot(scratch_.moves_m[a.slot]) +
                   row.angular_a.dot(scratch_.rotations_rad[a.slot]);
        }
        if (b.inverse_mass > 0.0) {
            sum += row.angular_b.dot(scratch_.rotations_rad[b.slot]) -
                   row.linear_a.dot(scratch_.moves_m[b.slot]);
        }
        return sum;
    }
    void add(std::span<const double> lambda) {
        for (std::size_t i = 0; i < lambda.size(); ++i) {
            scratch_.lambda[i] += lambda[i];
        }
        const std::span<const RowMatrix::Twist> moves = scratch_.system.moves();
        for (std::size_t slot = 0; slot < moves.size(); ++slot) {
            const RowMatrix::Twist& move = moves[slot];
            scratch_.moves_m[slot] += Vec3(move[0], move[1], move[2]);
            scratch_.rotations_rad[slot] += Vec3(move[3], move[4], move[5]);
        }
    }

    const IslandView& island_;
    const VelocitySettings& settings_;
    SolveScratch& scratch_;
    bool is_unconverged_ = false;
};

class SweepMethod {
  public:
    // Sweeps end when they change no row's velocity by more than this.
    static constexpr double k_tolerance_mps = 1e-8;
    static constexpr double k_heap_tolerance_mps = 1e-5;
    static constexpr int k_max_heap_sweeps = 60;
    static constexpr int k_max_sweeps = 30;  // maximum after a failed direct solve

    SweepMethod(const IslandView& island, const VelocitySettings& settings, SolveScratch& scratch)
        : island_(island), settings_(settings), scratch_(scratch) {
        scratch_.bounded.clear();
        for (const SolveScratch::Friction& friction : scratch_.frictions) {
            scratch_.bounded.push_back({friction.row, friction.width, friction.limit,
                                        friction.normal, friction.coefficient});
        }
        RowSweeps& sweeps = scratch_.sweeps;
        sweeps.assemble(island.bodies, scratch_.inverse_inertia_ws, scratch_.rows,
                        scratch_.bounded);
        regularise(scratch_.rows, settings.regularisation, 1.0,
                   mean_diagonal(scratch_.rows, sweeps), sweeps);
        sweeps.factorise();
    }
    void solve() {
        RowSweeps& sweeps = scratch_.sweeps;
        gather_residuals(scratch_);
        const std::span<const double> lambda = sweeps.solve(
            scratch_.values,
            {island_.max_work, island_.is_heap ? k_max_heap_sweeps : k_max_sweeps,
             island_.is_heap ? k_heap_tolerance_mps : k_tolerance_mps, settings_.tolerance_mps});
        gather_moves(sweeps.moves(), scratch_);
        scratch_.lambda.assign(lambda.begin(), lambda.end());
    }
    bool is_out_of_work() const { return scratch_.sweeps.work() >= island_.max_work; }

  private:
    const IslandView& island_;
    const VelocitySettings& settings_;
    SolveScratch& scratch_;
};

VelocityResult solve_island(const IslandView& island, const VelocitySettings& settings,
                            SolveScratch& scratch) {
    if (scratch.triads.resume(island) || scratch.triads.load(island, settings.touch_m)) {
        solve_triad_velocities(island, settings, scratch.triads);
        return {};
    }
    collect_velocity_rows(island, settings, scratch);
    evaluate_velocity_rows(island, scratch);
    clear_stiffness(island, scratch);
    prepare_inertia(island, scratch);
    if (!island.is_heap) {
        DirectMethod direct(island, settings, scratch);
        if (direct.solve()) {
            direct.refine();
            const auto solve_again = [&] {
                direct.solve();
                direct.refine();
            };
            limit_energy(island, solve_again, scratch);
            apply_impulses(island, scratch.lambda, scratch);
            return {.unconverged = direct.is_unconverged(),
                    .out_of_work = scratch.system.is_out_of_work()};
        }
    }
    SweepMethod sweeps(island, settings, scratch);
    sweeps.solve();
    limit_energy(
        island, [&] { sweeps.solve(); }, scratch);
    apply_impulses(island, scratch.lambda, scratch);
    return {
        .unconverged = !island.is_heap,
        .out_of_work = island.is_heap ? sweeps.is_out_of_work() : scratch.system.is_out_of_work()};
}

}  // namespace

VelocityResult solve_island_velocities(const IslandView& island, const VelocitySettings& settings,
                                       SolveScratch& scratch) {
    const FlushDenormals flush;
    const VelocityResult result = solve_island(island, settings, scratch);
    drop_negligible(island);
    return result;
}

}  // namespace handhold
