// Sources: Levenberg-Marquardt regularisation of constrained rigid bodies; geometric stiffness
// after Tournier, Nesme, Gilles and Faure, Stable Constrained Dynamics (2015).
#include "engine/solver/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace handhold {
namespace {

constexpr double k_softness_cap = 1e-2;
constexpr double k_softness_floor = 1e-9;
constexpr double k_contact_softness_cap = 1e-3;
constexpr double k_stubborn_overlap_m =
    1e-4;                                   // contacts that contradict each other soften from here
constexpr double k_near_contact_m = 1e-3;   // contacts farther than this and any error stay out
constexpr double k_largest_turn_rad = 1.0;  // of a step
// The farthest that joints may move a body, in what they lack: a chain that is all but stretched
// out. A hand that pulls across an endless rail would send what slides on it to the horizon.
constexpr double k_largest_joint_move = 10.0;
constexpr double k_free_move_m = 0.1;     // no move is too far up to this
constexpr double k_smallest_scale = 0.3;  // below: regularise more instead of scaling further

bool may_be_apart(const RowBlock& block) { return is_contact(block) || block.joint.limited; }

bool has_loose_block(const IslandView& island) {
    return std::ranges::any_of(island.island_blocks, [&](std::uint32_t index) {
        return may_be_apart(island.blocks[index]);
    });
}

// Contacts and limits farther apart than this matter to no step: twice the worst error.
double reach_of(const IslandView& island) {
    if (!has_loose_block(island)) {
        return k_near_contact_m;
    }
    double worst = 0.0;
    for (const std::uint32_t index : island.island_blocks) {
        if (takes_part(island, island.blocks[index])) {
            worst = std::max(worst, block_error_m(island.bodies, island.blocks[index]));
        }
    }
    return std::max(k_near_contact_m, 2.0 * worst);
}

// Rows of the blocks that a step can matter to. What a step overlaps all the same is near in the
// next one.
void collect_rows(const IslandView& island, std::vector<Row>& rows) {
    const double reach_m = reach_of(island);
    rows.clear();
    for (const std::uint32_t index : island.island_blocks) {
        const RowBlock& block = island.blocks[index];
        if (takes_part(island, block) &&
            (!is_contact(block) || contact_separation_m(island.bodies, block) < reach_m)) {
            append_rows(island.bodies, block, index, rows, reach_m);
        }
    }
}

// True where every row, now and after a step, holds a point on a point.
bool holds_only_points(const IslandView& island, std::span<const Row> rows) {
    if (has_loose_block(island)) {
        return false;
    }
    for (std::size_t i = 0; i < rows.size(); i += 3) {
        if (!begins_point(rows[i])) {
            return false;
        }
    }
    return true;
}

// The errors alone: the rows' directions stay those of the step before.
void update_point_values(const IslandView& island, std::vector<Row>& rows) {
    for (std::size_t i = 0; i < rows.size(); i += 3) {
        const Vec3 error = point_error(island.bodies, island.blocks[rows[i].block]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            rows[i + axis].value_m = error[static_cast<Eigen::Index>(axis)];
        }
    }
}

double worst_overlap_of(std::span<const Row> rows) {
    double worst = 0.0;
    for (const Row& row : rows) {
        worst = row.group == RowGroup::contact ? std::max(worst, -row.value_m) : worst;
    }
    return worst;
}

// Rows of one error count together: the same however the world is turned.
double worst_of(std::span<const Row> rows) {
    double worst = 0.0;
    for (std::size_t i = 0; i < rows.size(); i += rows[i].width) {
        if (rows[i].unilateral) {
            worst = std::max(worst, -rows[i].value_m);
            continue;
        }
        double square = 0.0;
        for (std::size_t j = i; j < i + rows[i].width; ++j) {
            square += rows[j].value_m * rows[j].value_m;
        }
        worst = std::max(worst, std::sqrt(square));
    }
    return worst;
}

// The part of (l.r) I - sym(l r^T) (sign +1) or of its negative (-1) with eigenvalues above zero,
// in closed form: its eigenvectors are l/|l| - r/|r|, l/|l| + r/|r| and l x r.
Mat3 positive_stiffness(const Vec3& force, const Vec3& arm, double sign) {
    const double product = force.norm() * arm.norm();
    if (product < 1e-12) {
        return Mat3::Zero();
    }
    const double along = force.dot(arm);
    const Vec3 axis = force.normalized() - sign * arm.normalized();
    const Vec3 normal = force.cross(arm);
    Mat3 sum = Mat3::Zero();
    if (axis.squaredNorm() > 1e-12) {
        sum += (0.5 * (product + sign * along) / axis.squaredNorm()) * (axis * axis.transpose());
    }
    if (sign * along > 0.0 && normal.squaredNorm() > 1e-12 * product * product) {
        sum += (sign * along / normal.squaredNorm()) * (normal * normal.transpose());
    }
    return sum;
}

// From the rows and multipliers of the last step, for every point held on, or away from, a point.
void gather_stiffness(const IslandView& island, SolveScratch& scratch) {
    clear_stiffness(island, scratch);
    const std::span<const double> lambda = scratch.lambda;
    const auto add = [&](std::uint32_t index, const Vec3& force, const Vec3& point_bs,
                         double sign) {
        const SolverBody& body = island.bodies[index];
        if (body.inverse_inertia_bs.squaredNorm() > 0.0) {
            scratch.stiffness[body.slot] +=
                positive_stiffness(force, body.pose_ws.rotation * point_bs, sign);
        }
    };
    for (std::size_t i = 0; i < scratch.previous_rows.size(); ++i) {
        const Row& row = scratch.previous_rows[i];
        const RowBlock& block = island.blocks[row.block];
        const bool is_point = begins_point(row);
        if (!is_point && block.kind != RowKind::distance) {
            continue;
        }
        const Vec3 force = is_point ? Vec3(lambda[i], lambda[i + 1], lambda[i + 2])
                                    : Vec3(lambda[i] * row.linear_a);
        add(row.a, force, block.point_a_bs, 1.0);
        add(row.b, force, block.point_b_bs, -1.0);
    }
}

// Returns the longest step, metres.
double apply_moves(const IslandView& island, double scale, const SolveScratch& scratch) {
    double longest = 0.0;
    for (const std::uint32_t index : island.island_bodies) {
        SolverBody& body = island.bodies[index];
        if (!(body.inverse_mass > 0.0)) {
            continue;
        }
        const Vec3 move = scale * scratch.moves_m[body.slot];
        const Vec3 turn = scale * scratch.turns_rad[body.slot];
        body.pose_ws.position += move;
        if (turn.squaredNorm() > 0.0) {
            // Cayley's map: a turn of 2 atan(|turn| / 2), as good a step as the exact one.
            const Vec3 half = 0.5 * turn;
            body.pose_ws.rotation =
                (Quat(1.0, half.x(), half.y(), half.z()) * body.pose_ws.rotation).normalized();
        }
        longest = std::max({longest, move.norm(), k_angle_m * turn.norm()});
    }
    return longest;
}

// Hands give way until the error falls below half of the least so far: steps that overshoot to and
// fro are no progress. Contacts do so only where they contradict each other: else their multipliers
// grow without bound and push along what they do not even oppose.
void adapt(double residual_m, double least_m, double overlap_m, double previous_overlap_m,
           double contact_softness, Softness& softness) {
    const bool hands_gave_way = softness.hand >= k_softness_cap;
    const bool stubborn =
        hands_gave_way && overlap_m > k_stubborn_overlap_m && overlap_m > 0.5 * previous_overlap_m;
    softness.hand = residual_m < 0.5 * least_m ? std::max(softness.hand * 0.03, k_softness_floor)
                                               : std::min(softness.hand * 10.0, k_softness_cap);
    softness.contact = stubborn ? std::min(softness.contact * 10.0, k_contact_softness_cap)
                                : std::max(softness.contact * 0.1, contact_softness);
}

struct StepResult {
    double length_m = 0.0;
    bool whole = true;  // not scaled down
};

// One Newton step.
StepResult take_step(const IslandView& island, const Softness& softness, double worst_m,
                     SolveScratch& scratch) {
    double factor = 1.0;
    double scale = 1.0;
    for (int attempt = 0; attempt <= k_softening_retries; ++attempt) {
        prepare_inertia(island, scratch);
        scratch.system.assemble(island.bodies, scratch.inverse_inertia_ws, scratch.rows);
        regularise(scratch.rows, softness, factor, scratch.system);
        const std::span<const double> lambda = scratch.system.solve(scratch.rows);
        const double turn = gather_moves(scratch);
        scale = std::min(1.0, k_largest_turn_rad / std::max(turn, 1e-30));
        const double move = std::max(longest_move(scratch), 1e-30);
        const double largest = has_contact(scratch.rows)
                                   ? k_largest_move * worst_m
                                   : std::max(k_largest_joint_move * worst_m, k_free_move_m);
        scale = std::min(scale, largest / move);
        scratch.lambda.assign(lambda.begin(), lambda.end());
        if (scale >= k_smallest_scale) {
            break;
        }
        factor *= 100.0;
    }
    return {apply_moves(island, scale, scratch), scale == 1.0};
}

// A step with the factor of the one before: as good where the poses hardly moved since.
StepResult repeat_step(const IslandView& island, SolveScratch& scratch) {
    scratch.values.clear();
    for (const Row& row : scratch.rows) {
        scratch.values.push_back(row.value_m);
    }
    const std::span<const double> lambda = scratch.system.solve_again(scratch.values);
    gather_moves(scratch);
    scratch.lambda.assign(lambda.begin(), lambda.end());
    return {apply_moves(island, 1.0, scratch), true};
}

// True where the factor of the rows before serves these: all of them hold, none may let go.
bool are_alike(std::span<const Row> rows, std::span<const Row> previous_rows) {
    return rows.size() == previous_rows.size() &&
           std::ranges::none_of(rows, [](const Row& row) { return row.unilateral; });
}

// True where the last step took the error down so well that its factor is worth another.
bool is_good_step(double residual_m, double previous_m, double stiffness_from_m) {
    constexpr double k_good_step = 0.05;
    return residual_m < stiffness_from_m && residual_m < k_good_step * previous_m;
}

}  // namespace

NewtonResult solve_positions(const IslandView& island, const NewtonSettings& settings,
                             SolveScratch& scratch) {
    NewtonResult result;
    Softness softness = settings.softness;
    double previous = std::numeric_limits<double>::infinity();
    double previous_overlap = previous;
    double least = previous;
    StepResult step{previous, false};
    bool only_points = false;
    scratch.system.forget_active_set();
    clear_stiffness(island, scratch);
    for (;;) {
        if (only_points && step.whole) {
            update_point_values(island, scratch.rows);
        } else {
            std::swap(scratch.rows, scratch.previous_rows);
            collect_rows(island, scratch.rows);
        }
        result.residual_m = worst_of(scratch.rows);
        result.converged = result.residual_m < settings.tolerance_m;
        if (result.converged || result.iterations == settings.max_iterations ||
            step.length_m < settings.step_tolerance_m) {
            return result;
        }
        const double overlap = worst_overlap_of(scratch.rows);
        const bool repeats = step.whole &&
                             (only_points || are_alike(scratch.rows, scratch.previous_rows)) &&
                             is_good_step(result.residual_m, previous, settings.stiffness_from_m);
        if (only_points && step.whole && !repeats) {
            std::swap(scratch.rows, scratch.previous_rows);
            collect_rows(island, scratch.rows);
        }
        if (result.iterations > 0 && !repeats) {
            adapt(result.residual_m, least, overlap, previous_overlap, settings.softness.contact,
                  softness);
            if (result.residual_m > settings.stiffness_from_m) {
                gather_stiffness(island, scratch);
            } else {
                clear_stiffness(island, scratch);
            }
        }
        step = repeats ? repeat_step(island, scratch)
                       : take_step(island, softness, result.residual_m, scratch);
        result.unsettled |= scratch.system.is_unsettled();
        only_points = holds_only_points(island, scratch.rows);
        previous = result.residual_m;
        least = std::min(least, previous);
        previous_overlap = overlap;
        ++result.iterations;
    }
}

}  // namespace handhold
