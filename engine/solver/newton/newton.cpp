// Sources: Levenberg-Marquardt regularisation of constrained rigid bodies; geometric stiffness
// after Tournier, Nesme, Gilles and Faure, Stable Constrained Dynamics (2015).
#include "engine/solver/newton/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/flush_denormals.hpp"
#include "engine/solver/newton/geometric_stiffness.hpp"
#include "engine/solver/newton/load_stepping.hpp"

namespace handhold {
namespace {

constexpr double k_unresolved_overlap_m =
    1e-4;  // contacts that contradict each other soften from here
constexpr double k_min_active_distance_m =
    1e-3;  // contacts farther than this and any error stay out
// The farthest that joints may move a body, in what they lack: a chain that is all but stretched
// out. A hand that pulls across an endless rail would send what slides on it to the horizon.
constexpr double k_max_joint_move_ratio = 10.0;
constexpr double k_unlimited_move_m = 0.1;  // no move is too far up to this
// Of the tolerance: the view goes where hands are, and shows what they lack. What a step leaves of
// it the same factor takes away.
constexpr double k_drive_tolerance_ratio = 0.1;
// Of the tolerance: what a step moves by less is at rest.
constexpr double k_inactive_move_ratio = 1e-3;

// --- Any rows ----------------------------------------------------------------------------------

bool is_unilateral_block(const RowBlock& block) { return is_contact(block) || block.joint.limited; }

bool has_unilateral_block(const IslandView& island) {
    return std::ranges::any_of(island.island_blocks, [&](std::uint32_t index) {
        return is_unilateral_block(island.blocks[index]);
    });
}

// Contacts and limits farther apart than this matter to no step: twice the worst error.
double active_distance_of(const IslandView& island) {
    if (!has_unilateral_block(island)) {
        return k_min_active_distance_m;
    }
    double worst = 0.0;
    for (const std::uint32_t index : island.island_blocks) {
        if (takes_part(island, island.blocks[index])) {
            worst = std::max(worst, block_error_m(island.bodies, island.blocks[index]));
        }
    }
    return std::max(k_min_active_distance_m, 2.0 * worst);
}

// Rows of the blocks that a step can matter to. What a step overlaps all the same is near in the
// next one.
void collect_rows(const IslandView& island, std::vector<Row>& rows) {
    const double reach_m = active_distance_of(island);
    rows.clear();
    for (const std::uint32_t index : island.island_blocks) {
        const RowBlock& block = island.blocks[index];
        if (takes_part(island, block) &&
            (!is_contact(block) || contact_separation_m(island.bodies, block) < reach_m)) {
            append_rows(island.bodies, block, index, rows, reach_m);
        }
    }
}

double worst_overlap_of(std::span<const Row> rows) {
    double worst = 0.0;
    for (const Row& row : rows) {
        worst = row.group == RowGroup::contact ? std::max(worst, -row.residual) : worst;
    }
    return worst;
}

// Rows of one error count together: the same however the world is turned.
double worst_of(std::span<const Row> rows) {
    double worst = 0.0;
    for (std::size_t i = 0; i < rows.size(); i += rows[i].width) {
        if (rows[i].unilateral) {
            worst = std::max(worst, -rows[i].residual);
            continue;
        }
        double square = 0.0;
        for (std::size_t j = i; j < i + rows[i].width; ++j) {
            square += rows[j].residual * rows[j].residual;
        }
        worst = std::max(worst, std::sqrt(square));
    }
    return worst;
}

// The same of hands alone.
double worst_drive_of(std::span<const Row> rows) {
    double worst = 0.0;
    for (std::size_t i = 0; i < rows.size(); i += rows[i].width) {
        if (rows[i].group == RowGroup::drive) {
            worst = std::max(worst, worst_of(rows.subspan(i, rows[i].width)));
        }
    }
    return worst;
}

// Returns the longest step, metres.
double apply_moves(const IslandView& island, double scale, const SolveScratch& scratch) {
    double longest_move = 0.0;
    double largest_rotation = 0.0;
    for (const std::uint32_t index : island.island_bodies) {
        SolverBody& body = island.bodies[index];
        if (!(body.inverse_mass > 0.0)) {
            continue;
        }
        const Vec3 move = scale * scratch.moves_m[body.slot];
        const Vec3 turn = scale * scratch.rotations_rad[body.slot];
        body.pose_ws.position += move;
        if (turn.squaredNorm() > 0.0) {
            // Cayley's map: a turn of 2 atan(|turn| / 2), as good a step as the exact one.
            const Vec3 half = 0.5 * turn;
            body.pose_ws.rotation =
                (Quat(1.0, half.x(), half.y(), half.z()) * body.pose_ws.rotation).normalized();
        }
        longest_move = std::max(longest_move, move.squaredNorm());
        largest_rotation = std::max(largest_rotation, turn.squaredNorm());
    }
    return std::max(std::sqrt(longest_move), k_angle_lever_m * std::sqrt(largest_rotation));
}

// An island's rows one by one, as RowSystem has them: any kind, with an active set.
class RowSteps {
  public:
    RowSteps(const IslandView& island, SolveScratch& scratch) : island_(island), scratch_(scratch) {
        scratch_.system.reset_active_set();
        clear_stiffness(island_, scratch_);
    }

    // Where all rows hold points and the step before was whole, the errors alone: directions stay
    // those of the factor at hand until `renew`.
    void evaluate(bool was_full_step) {
        reuses_jacobian_ = was_full_step && has_only_point_rows_;
        if (reuses_jacobian_) {
            update_point_residuals();
        } else {
            collect();
        }
    }
    void renew() {
        if (reuses_jacobian_) {
            collect();
        }
    }
    double worst_m() const { return worst_of(scratch_.rows); }
    double worst_drive_m() const { return worst_drive_of(scratch_.rows); }
    double overlap_m() const { return worst_overlap_of(scratch_.rows); }
    bool has_contact() const { return handhold::has_contact(scratch_.rows); }
    bool is_active_set_unconverged() const { return scratch_.system.is_active_set_unconverged(); }

    // True where the factor of the rows before serves these.
    bool keeps_factor() const { return has_only_point_rows_ || has_same_rows(); }
    void stiffen(bool stiff) {
        clear_stiffness(island_, scratch_);
        if (stiff) {
            gather_stiffness();
        }
    }

    void solve(const Regularisation& regularisation, double factor) {
        has_only_point_rows_ = has_only_point_rows();
        prepare_inertia(island_, scratch_);
        scratch_.system.assemble(island_.bodies, scratch_.inverse_inertia_ws, scratch_.rows);
        regularise(scratch_.rows, regularisation, factor, scratch_.system);
        take(scratch_.system.solve(scratch_.rows));
    }
    void solve_with_last_factor() {
        scratch_.values.clear();
        for (const Row& row : scratch_.rows) {
            scratch_.values.push_back(row.residual);
        }
        take(scratch_.system.solve_with_last_factor(scratch_.values));
    }
    double longest_move() const { return handhold::longest_move(scratch_); }
    double largest_rotation() const { return largest_rotation_; }
    double apply_moves(double scale) { return handhold::apply_moves(island_, scale, scratch_); }
    static void restrict_to_active(double /*still_m*/) {}
    static void activate_all_rows() {}
    static bool has_cheap_factor() { return false; }
    static std::optional<JointError> worst_joints() { return std::nullopt; }

  private:
    // All of them hold, none may let go.
    bool has_same_rows() const {
        return scratch_.rows.size() == scratch_.previous_rows.size() &&
               std::ranges::none_of(scratch_.rows, [](const Row& row) { return row.unilateral; });
    }
    void collect() {
        std::swap(scratch_.rows, scratch_.previous_rows);
        collect_rows(island_, scratch_.rows);
    }
    // True where every row, now and after a step, holds a point on a point.
    bool has_only_point_rows() const {
        if (has_unilateral_block(island_)) {
            return false;
        }
        for (std::size_t i = 0; i < scratch_.rows.size(); i += 3) {
            if (!starts_point_rows(scratch_.rows[i])) {
                return false;
            }
        }
        return true;
    }
    void update_point_residuals() {
        for (std::size_t i = 0; i < scratch_.rows.size(); i += 3) {
            const Vec3 error = point_error(island_.bodies, island_.blocks[scratch_.rows[i].block]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                scratch_.rows[i + axis].residual = error[static_cast<Eigen::Index>(axis)];
            }
        }
    }
    void take(std::span<const double> lambda) {
        largest_rotation_ = gather_moves(scratch_);
        scratch_.lambda.assign(lambda.begin(), lambda.end());
    }

    // From the rows and multipliers of the last step, for every point held on, or away from, a
    // point.
    void gather_stiffness() {
        const std::span<const double> lambda = scratch_.lambda;
        const auto add = [&](std::uint32_t index, const Vec3& force, const Vec3& point_bs,
                             double sign) {
            const SolverBody& body = island_.bodies[index];
            if (body.inverse_inertia_bs.squaredNorm() > 0.0) {
                scratch_.stiffness[body.slot] +=
                    positive_stiffness(force, body.pose_ws.rotation * point_bs, sign);
            }
        };
        for (std::size_t i = 0; i < scratch_.previous_rows.size(); ++i) {
            const Row& row = scratch_.previous_rows[i];
            const RowBlock& block = island_.blocks[row.block];
            const bool is_point = starts_point_rows(row);
            if (!is_point && block.kind != RowKind::distance) {
                continue;
            }
            const Vec3 force = is_point ? Vec3(lambda[i], lambda[i + 1], lambda[i + 2])
                                        : Vec3(lambda[i] * row.linear_a);
            add(row.a, force, block.point_a_bs, 1.0);
            add(row.b, force, block.point_b_bs, -1.0);
        }
    }

    const IslandView& island_;
    SolveScratch& scratch_;
    double largest_rotation_ = 0.0;
    bool has_only_point_rows_ = false;
    bool reuses_jacobian_ = false;
};

// --- Rows that all hold ------------------------------------------------------------------------

// The same for an island that TriadSystem serves.
class TriadSteps {
  public:
    TriadSteps(const IslandView& island, TriadSystem& system) : island_(island), system_(system) {}

    void evaluate(bool /*was_full_step*/) { system_.evaluate(island_); }
    static void renew() {}
    double worst_m() { return system_.worst_residual(); }
    double worst_drive_m() const { return system_.worst_drive_residual(); }
    static double overlap_m() { return 0.0; }
    static bool has_contact() { return false; }
    static bool is_active_set_unconverged() { return false; }
    static bool keeps_factor() { return true; }
    void stiffen(bool stiff) {
        if (stiff) {
            system_.gather_stiffness();
        } else {
            system_.clear_stiffness();
        }
    }
    void solve(const Regularisation& regularisation, double factor) {
        system_.factorise(regularisation, factor);
        system_.solve();
    }
    void solve_with_last_factor() { system_.solve(); }
    double longest_move() const { return system_.longest_move(); }
    double largest_rotation() const { return system_.largest_rotation(); }
    double apply_moves(double scale) { return system_.apply_moves(scale); }
    void restrict_to_active(double min_move_m) { system_.restrict_to_active(min_move_m); }
    void activate_all_rows() { system_.activate_all_rows(); }
    static bool has_cheap_factor() { return true; }
    std::optional<JointError> worst_joints() const { return system_.worst_joints(); }

  private:
    const IslandView& island_;
    TriadSystem& system_;
};

// --- Newton's method ---------------------------------------------------------------------------

// Hands give way until the error falls below half of the least so far, or steadily: steps that
// overshoot to and fro are no progress, but on a light link at the end of heavy ones it is the soft
// hand itself that lets the error fall but slowly. Contacts do so only where they contradict each
// other: else their multipliers grow without bound and push along what they do not even oppose.
void adapt(bool progresses, double overlap_m, double previous_overlap_m,
           const NewtonSettings& settings, Regularisation& regularisation) {
    const StepControl& schedule = settings.schedule;
    const bool drive_at_max = regularisation.drive >= schedule.max_drive_regularisation;
    const bool is_unresolved =
        drive_at_max && overlap_m > k_unresolved_overlap_m && overlap_m > 0.5 * previous_overlap_m;
    regularisation.drive = progresses
                               ? std::max(regularisation.drive * schedule.regularisation_decrease,
                                          schedule.min_drive_regularisation)
                               : std::min(regularisation.drive * schedule.regularisation_increase,
                                          schedule.max_drive_regularisation);
    regularisation.contact =
        is_unresolved ? std::min(regularisation.contact * schedule.regularisation_increase,
                                 schedule.max_contact_regularisation)
                      : std::max(regularisation.contact * (1.0 / schedule.regularisation_increase),
                                 settings.regularisation.contact);
}

// Says whether the error falls steadily, step by step, and begins to count anew where it does.
// Steps that repeat a factor are not asked: they neither count nor end a run, for they say nothing
// of how soft hands should be. Until a run is long enough its steps are no progress, so that hands
// soften twice by `softening` and then harden once by `hardening`: about where they were, in three
// steps, in place of a thousand times as soft. Between contacts steps are not trusted that far.
class SteadyDecrease {
  public:
    explicit SteadyDecrease(const StepControl& schedule) : schedule_(schedule) {}

    bool take(double residual_m, double least_m, bool is_whole, bool has_contact) {
        const bool falls =
            is_whole && !has_contact && residual_m < schedule_.linear_decrease_ratio * least_m;
        steps_ = falls ? steps_ + 1 : 0;
        if (steps_ < schedule_.linear_decrease_steps) {
            return false;
        }
        steps_ = 0;
        return true;
    }

  private:
    const StepControl& schedule_;
    int steps_ = 0;
};

struct StepResult {
    double length_m = 0.0;
    bool whole = true;  // not scaled down
};

// One Newton step.
template <typename Steps>
StepResult take_step(const Regularisation& regularisation, const StepControl& schedule,
                     double worst_m, Steps& steps) {
    double factor = 1.0;
    double scale = 1.0;
    for (int attempt = 0; attempt <= k_max_regularisation_retries; ++attempt) {
        steps.solve(regularisation, factor);
        const double turn = std::max(steps.largest_rotation(), 1e-30);
        const double move = std::max(steps.longest_move(), 1e-30);
        const double largest = steps.has_contact()
                                   ? k_max_move_ratio * worst_m
                                   : std::max(k_max_joint_move_ratio * worst_m, k_unlimited_move_m);
        scale = std::min({1.0, schedule.max_step_rotation_rad / turn, largest / move});
        if (scale >= schedule.min_step_scale) {
            break;
        }
        factor *= 100.0;
    }
    return {steps.apply_moves(scale), scale == 1.0};
}

// What a step hardly moved the next ones do not look at, as long as they take the error down.
template <typename Steps>
void choose_active_rows(bool halves, const NewtonSettings& settings, Steps& steps) {
    if (halves) {
        steps.restrict_to_active(k_inactive_move_ratio * settings.tolerance_m);
    } else {
        steps.activate_all_rows();
    }
}

// A step with the factor of the one before: as good where the poses hardly moved since.
template <typename Steps>
StepResult repeat_step(Steps& steps) {
    steps.solve_with_last_factor();
    return {steps.apply_moves(1.0), true};
}

// True where the last step took the error down so well that its factor is worth another. Where a
// factor costs little more than a step (`is_factor_cheap`), only if that should be the last one.
bool is_good_step(double residual_m, double previous_m, bool is_factor_cheap,
                  const NewtonSettings& settings) {
    constexpr double k_good_step = 0.05;
    constexpr double k_spare = 0.1;  // such steps are not quite as good as the one before
    const double ratio = residual_m / previous_m;
    return residual_m < settings.geometric_stiffness_from_m && ratio < k_good_step &&
           (!is_factor_cheap || ratio * residual_m < k_spare * settings.tolerance_m);
}

template <typename Steps>
NewtonResult iterate(const NewtonSettings& settings, Steps&& steps) {
    NewtonResult result;
    Regularisation regularisation = settings.regularisation;
    double previous = std::numeric_limits<double>::infinity();
    double previous_overlap = previous;
    double least = previous;
    StepResult step{previous, false};
    SteadyDecrease fall(settings.schedule);
    bool refines_drives = false;  // the step to come, or just taken, is for hands alone
    for (;;) {
        steps.evaluate(step.whole);
        result.residual_m = steps.worst_m();
        result.converged = result.residual_m < settings.tolerance_m;
        if (result.iterations == 0) {
            result.initial_drive_error_m = steps.worst_drive_m();
        }
        refines_drives = result.converged && !refines_drives && step.whole &&
                         steps.keeps_factor() && result.iterations + 1 < settings.max_iterations &&
                         steps.worst_drive_m() > k_drive_tolerance_ratio * settings.tolerance_m;
        if ((result.converged && !refines_drives) || result.iterations == settings.max_iterations ||
            step.length_m < settings.step_tolerance_m) {
            result.joints = steps.worst_joints();
            return result;
        }
        const double overlap = steps.overlap_m();
        const bool repeats = refines_drives || (step.whole && steps.keeps_factor() &&
                                                is_good_step(result.residual_m, previous,
                                                             steps.has_cheap_factor(), settings));
        if (!repeats) {
            steps.renew();
        }
        if (result.iterations > 0 && !repeats) {
            const bool is_steady =
                fall.take(result.residual_m, least, step.whole, steps.has_contact());
            adapt(result.residual_m < 0.5 * least || is_steady, overlap, previous_overlap, settings,
                  regularisation);
            choose_active_rows(step.whole && result.residual_m < 0.5 * previous, settings, steps);
            steps.stiffen(result.residual_m > settings.geometric_stiffness_from_m);
        }
        step = repeats ? repeat_step(steps)
                       : take_step(regularisation, settings.schedule, result.residual_m, steps);
        result.active_set_unconverged |= steps.is_active_set_unconverged();
        previous = result.residual_m;
        least = std::min(least, previous);
        previous_overlap = overlap;
        ++result.iterations;
    }
}

// From the bodies' present poses, which may have changed since the island was loaded.
NewtonResult solve_load_step(const IslandView& island, const NewtonSettings& settings,
                             SolveScratch& scratch) {
    if (!scratch.triads.load(island)) {
        return {};
    }
    const NewtonResult result = iterate(settings, TriadSteps(island, scratch.triads));
    scratch.triads.store_poses(island);
    return result;
}

NewtonResult solve_triads(const IslandView& island, const NewtonSettings& settings,
                          SolveScratch& scratch) {
    const NewtonResult full_load = iterate(settings, TriadSteps(island, scratch.triads));
    reserve_load_stepping(island, scratch);
    const bool steps_load =
        needs_load_stepping(full_load, settings) && scratch.load_stepped.take(island);
    scratch.triads.store_poses(island);
    return steps_load
               ? solve_by_load_stepping(island, settings, full_load, scratch, &solve_load_step)
               : full_load;
}

}  // namespace

NewtonResult solve_positions(const IslandView& island, const NewtonSettings& settings,
                             SolveScratch& scratch) {
    const FlushDenormals flush;
    return scratch.triads.load(island) ? solve_triads(island, settings, scratch)
                                       : iterate(settings, RowSteps(island, scratch));
}

}  // namespace handhold
