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
constexpr double k_contact_softness = 1e-7;  // of the row's diagonal
constexpr double k_contact_softness_cap = 1e-3;
constexpr double k_stubborn_overlap_m =
    1e-4;                                    // contacts that contradict each other soften from here
constexpr double k_near_contact_m = 1e-3;    // contacts farther than this and any error stay out
constexpr double k_stiffness_from_m = 1e-4;  // residual above which geometric stiffness is added
constexpr double k_largest_turn_rad = 1.0;   // of a step
constexpr double k_largest_move = 10.0;      // of a step, in worst errors: a lever of 1 m
constexpr double k_smallest_scale = 0.3;     // below: regularise more instead of scaling further
constexpr int k_retries = 3;

bool takes_part(const IslandView& island, const RowBlock& block) {
    if (island.filter != BlockFilter::all &&
        is_hand(block) != (island.filter == BlockFilter::hands)) {
        return false;
    }
    return island.bodies[block.a].inverse_mass > 0.0 || island.bodies[block.b].inverse_mass > 0.0;
}

// Rows of the blocks that a step can matter to: hands, and contacts not farther apart than twice
// the worst error. A contact that a step overlaps all the same is near in the next one.
void collect_rows(const IslandView& island, std::vector<Row>& rows) {
    double worst = 0.0;
    for (const std::uint32_t index : island.island_blocks) {
        if (takes_part(island, island.blocks[index])) {
            worst = std::max(worst, block_error_m(island.bodies, island.blocks[index]));
        }
    }
    const double reach_m = std::max(k_near_contact_m, 2.0 * worst);
    rows.clear();
    for (const std::uint32_t index : island.island_blocks) {
        const RowBlock& block = island.blocks[index];
        if (takes_part(island, block) &&
            (is_hand(block) || contact_separation_m(island.bodies, block) < reach_m)) {
            append_rows(island.bodies, block, index, rows);
        }
    }
}

double worst_overlap_of(std::span<const Row> rows) {
    double worst = 0.0;
    for (const Row& row : rows) {
        worst = row.unilateral ? std::max(worst, -row.value_m) : worst;
    }
    return worst;
}

// Hand rows come in threes along the world's axes: only the three together say the same however the
// world is turned.
double worst_of(std::span<const Row> rows) {
    double worst = 0.0;
    for (std::size_t i = 0; i < rows.size();) {
        if (rows[i].hand) {
            worst = std::max(
                worst, Vec3(rows[i].value_m, rows[i + 1].value_m, rows[i + 2].value_m).norm());
            i += 3;
        } else {
            worst =
                std::max(worst, rows[i].unilateral ? -rows[i].value_m : std::abs(rows[i].value_m));
            ++i;
        }
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

void clear_stiffness(const IslandView& island, SolveScratch& scratch) {
    scratch.stiffness.assign(island.island_bodies.size(), Mat3::Zero());
}

// From the multipliers of the last step. The three rows of a point come one after the other.
void gather_stiffness(const IslandView& island, std::span<const double> lambda,
                      SolveScratch& scratch) {
    clear_stiffness(island, scratch);
    for (std::size_t i = 0; i + 2 < scratch.rows.size(); ++i) {
        const Row& row = scratch.rows[i];
        if (!row.hand || row.linear_a != Vec3::UnitX()) {
            continue;
        }
        const Vec3 force(lambda[i], lambda[i + 1], lambda[i + 2]);
        const RowBlock& block = island.blocks[row.block];
        const SolverBody& b = island.bodies[row.b];
        if (b.inverse_inertia_bs.squaredNorm() > 0.0) {
            scratch.stiffness[b.slot] +=
                positive_stiffness(force, b.pose_ws.rotation * block.point_b_bs, -1.0);
        }
    }
}

void prepare_inertia(const IslandView& island, SolveScratch& scratch) {
    scratch.inverse_inertia_ws.resize(island.island_bodies.size());
    for (const std::uint32_t index : island.island_bodies) {
        const SolverBody& body = island.bodies[index];
        Mat3& inverse = scratch.inverse_inertia_ws[body.slot];
        if (body.inverse_inertia_bs.squaredNorm() == 0.0) {
            inverse.setZero();
            continue;
        }
        inverse = inverse_inertia_ws(body);
        const Mat3& stiffness = scratch.stiffness[body.slot];
        if (!stiffness.isZero(0.0)) {
            const Mat3 stiffened = inverse.inverse() + stiffness;
            inverse = stiffened.inverse();
        }
    }
}

// How much each kind of row may give way, relative to the system's diagonal.
struct Softness {
    double hand = 1e-6;
    double contact = k_contact_softness;
};

void regularise(std::span<const Row> rows, const Softness& softness, double factor,
                DenseSystem& system) {
    double inverse_sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < system.size();) {
        const std::size_t width = rows[i].hand ? 3 : 1;
        double sum = 0.0;
        for (std::size_t end = i + width; i < end; ++i) {
            sum += system.diagonal(i);
        }
        if (sum > 0.0) {
            const double size = static_cast<double>(width);
            inverse_sum += size * size / sum;
            count += size;
        }
    }
    const double mean = inverse_sum > 0.0 ? count / inverse_sum : 0.0;
    for (std::size_t i = 0; i < system.size(); ++i) {
        system.alpha()[i] =
            factor * (rows[i].hand ? softness.hand * mean : softness.contact * system.diagonal(i));
    }
}

// W J^T lambda by slot; returns the largest turn in radians.
double gather_moves(const IslandView& island, std::span<const double> lambda,
                    SolveScratch& scratch) {
    scratch.moves_m.assign(island.island_bodies.size(), Vec3::Zero());
    scratch.turns_rad.assign(island.island_bodies.size(), Vec3::Zero());
    for (std::size_t i = 0; i < scratch.rows.size(); ++i) {
        const Row& row = scratch.rows[i];
        const SolverBody& a = island.bodies[row.a];
        const SolverBody& b = island.bodies[row.b];
        if (a.inverse_mass > 0.0) {
            scratch.moves_m[a.slot] += (a.inverse_mass * lambda[i]) * row.linear_a;
            scratch.turns_rad[a.slot] += lambda[i] * row.angular_a;
        }
        if (b.inverse_mass > 0.0) {
            scratch.moves_m[b.slot] -= (b.inverse_mass * lambda[i]) * row.linear_a;
            scratch.turns_rad[b.slot] += lambda[i] * row.angular_b;
        }
    }
    double largest = 0.0;
    for (std::size_t slot = 0; slot < scratch.turns_rad.size(); ++slot) {
        const Vec3 turn = scratch.inverse_inertia_ws[slot] * scratch.turns_rad[slot];
        scratch.turns_rad[slot] = turn;
        largest = std::max(largest, turn.norm());
    }
    return largest;
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
            body.pose_ws.rotation =
                (rotation_from_vector(turn) * body.pose_ws.rotation).normalized();
        }
        longest = std::max({longest, move.norm(), k_angle_m * turn.norm()});
    }
    return longest;
}

// Only contacts can contradict each other into huge steps; hands on long levers may need them.
bool has_contact(std::span<const Row> rows) {
    return std::ranges::any_of(rows, [](const Row& row) { return row.unilateral; });
}

double longest_move(const SolveScratch& scratch) {
    double longest = 0.0;
    for (const Vec3& move : scratch.moves_m) {
        longest = std::max(longest, move.norm());
    }
    return longest;
}

// Hands give way while the error does not fall. Contacts do so only where they contradict each
// other: else their multipliers grow without bound and push along what they do not even oppose.
void adapt(double residual_m, double previous_m, double overlap_m, double previous_overlap_m,
           Softness& softness) {
    const bool hands_gave_way = softness.hand >= k_softness_cap;
    const bool stubborn =
        hands_gave_way && overlap_m > k_stubborn_overlap_m && overlap_m > 0.5 * previous_overlap_m;
    softness.hand = residual_m < 0.5 * previous_m ? std::max(softness.hand * 0.03, k_softness_floor)
                                                  : std::min(softness.hand * 10.0, k_softness_cap);
    softness.contact = stubborn ? std::min(softness.contact * 10.0, k_contact_softness_cap)
                                : std::max(softness.contact * 0.1, k_contact_softness);
}

// One Newton step; returns its length, metres.
double step(const IslandView& island, const Softness& softness, double worst_m,
            SolveScratch& scratch) {
    double factor = 1.0;
    double scale = 1.0;
    for (int attempt = 0; attempt <= k_retries; ++attempt) {
        prepare_inertia(island, scratch);
        scratch.system.assemble(island.bodies, scratch.inverse_inertia_ws, scratch.rows);
        regularise(scratch.rows, softness, factor, scratch.system);
        const std::span<const double> lambda = scratch.system.solve(scratch.rows);
        const double turn = gather_moves(island, lambda, scratch);
        scale = std::min(1.0, k_largest_turn_rad / std::max(turn, 1e-30));
        if (has_contact(scratch.rows)) {
            const double move = std::max(longest_move(scratch), 1e-30);
            scale = std::min(scale, k_largest_move * worst_m / move);
        }
        scratch.lambda.assign(lambda.begin(), lambda.end());
        if (scale >= k_smallest_scale) {
            break;
        }
        factor *= 100.0;
    }
    return apply_moves(island, scale, scratch);
}

void write_errors(const IslandView& island) {
    for (const std::uint32_t index : island.island_blocks) {
        island.blocks[index].error_m = block_error_m(island.bodies, island.blocks[index]);
    }
}

}  // namespace

NewtonResult solve_positions(const IslandView& island, const NewtonSettings& settings,
                             SolveScratch& scratch) {
    NewtonResult result;
    Softness softness{settings.hand_softness, k_contact_softness};
    double previous = std::numeric_limits<double>::infinity();
    double previous_overlap = previous;
    clear_stiffness(island, scratch);
    scratch.lambda.clear();
    for (;;) {
        collect_rows(island, scratch.rows);
        result.residual_m = worst_of(scratch.rows);
        result.converged = result.residual_m < settings.tolerance_m;
        if (result.converged || result.iterations == settings.max_iterations) {
            break;
        }
        if (result.iterations > 0) {
            adapt(result.residual_m, previous, worst_overlap_of(scratch.rows), previous_overlap,
                  softness);
            if (result.residual_m > k_stiffness_from_m) {
                gather_stiffness(island, scratch.lambda, scratch);
            } else {
                clear_stiffness(island, scratch);
            }
        }
        previous = result.residual_m;
        previous_overlap = worst_overlap_of(scratch.rows);
        const double length = step(island, softness, result.residual_m, scratch);
        ++result.iterations;
        if (length < settings.step_tolerance_m) {
            collect_rows(island, scratch.rows);
            result.residual_m = worst_of(scratch.rows);
            result.converged = result.residual_m < settings.tolerance_m;
            break;
        }
    }
    write_errors(island);
    return result;
}

namespace {

double normal_velocity(const IslandView& island, const Row& row) {
    const SolverBody& a = island.bodies[row.a];
    const SolverBody& b = island.bodies[row.b];
    return row.linear_a.dot(a.velocity_mps - b.velocity_mps) + row.angular_a.dot(a.spin_radps) +
           row.angular_b.dot(b.spin_radps);
}

void collect_velocity_rows(const IslandView& island, const VelocitySettings& settings,
                           SolveScratch& scratch) {
    scratch.rows.clear();
    for (const std::uint32_t index : island.island_blocks) {
        RowBlock& block = island.blocks[index];
        block.impulse_ws_ns.setZero();
        block.couple_ws_nms.setZero();
        const bool counts =
            is_hand(block) || contact_separation_m(island.bodies, block) < settings.touch_m;
        if (counts && takes_part(island, block)) {
            append_rows(island.bodies, block, index, scratch.rows);
        }
    }
    scratch.approach_mps.clear();
    for (const Row& row : scratch.rows) {
        const double speed = normal_velocity(island, row);
        const bool bounces = row.unilateral && speed < -settings.restitution_speed_mps;
        scratch.approach_mps.push_back(bounces ? island.blocks[row.block].restitution * speed
                                               : 0.0);
    }
}

// What each row's velocity lacks.
void evaluate_velocity_rows(const IslandView& island, SolveScratch& scratch) {
    for (std::size_t i = 0; i < scratch.rows.size(); ++i) {
        Row& row = scratch.rows[i];
        const RowBlock& block = island.blocks[row.block];
        double speed = normal_velocity(island, row) + scratch.approach_mps[i];
        if (row.hand) {
            speed += row.linear_a.dot(block.drive_velocity_ws_mps);
            if (row.linear_a.isZero(0.0)) {
                speed += row.angular_a.dot(block.drive_spin_ws_radps);
            }
        }
        row.value_m = speed;  // metres a second here
    }
}

void apply_impulses(const IslandView& island, std::span<const double> lambda,
                    SolveScratch& scratch) {
    gather_moves(island, lambda, scratch);
    for (const std::uint32_t index : island.island_bodies) {
        SolverBody& body = island.bodies[index];
        if (body.inverse_mass > 0.0) {
            body.velocity_mps += scratch.moves_m[body.slot];
            body.spin_radps += scratch.turns_rad[body.slot];
        }
    }
    for (std::size_t i = 0; i < scratch.rows.size(); ++i) {
        const Row& row = scratch.rows[i];
        RowBlock& block = island.blocks[row.block];
        block.impulse_ws_ns += lambda[i] * row.linear_a;
        if (row.linear_a.isZero(0.0)) {
            block.couple_ws_nms += lambda[i] * row.angular_a;
        }
    }
}

// Of the rows that act.
double worst_speed(std::span<const Row> rows, const DenseSystem& system) {
    double worst = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        worst = system.is_active(i) ? std::max(worst, std::abs(rows[i].value_m)) : worst;
    }
    return worst;
}

// Takes the error of regularisation down, by a factor that long levers make small, until the rows
// are met or cannot be: more would only press contradicting rows against each other.
void refine_velocities(const IslandView& island, SolveScratch& scratch) {
    constexpr double k_speed_tolerance_mps = 1e-10;
    constexpr int k_refinements = 8;
    double previous = std::numeric_limits<double>::infinity();
    for (int i = 0; i < k_refinements; ++i) {
        evaluate_velocity_rows(island, scratch);
        const double worst = worst_speed(scratch.rows, scratch.system);
        if (worst < k_speed_tolerance_mps || worst > 0.5 * previous) {
            return;
        }
        previous = worst;
        scratch.values.clear();
        for (const Row& row : scratch.rows) {
            scratch.values.push_back(row.value_m);
        }
        apply_impulses(island, scratch.system.solve_again(scratch.values), scratch);
    }
}

}  // namespace

void solve_velocities(const IslandView& island, const VelocitySettings& settings,
                      SolveScratch& scratch) {
    constexpr double k_hand_softness = 1e-6;
    collect_velocity_rows(island, settings, scratch);
    evaluate_velocity_rows(island, scratch);
    clear_stiffness(island, scratch);
    prepare_inertia(island, scratch);
    scratch.system.assemble(island.bodies, scratch.inverse_inertia_ws, scratch.rows);
    double lacking = 0.0;
    for (const Row& row : scratch.rows) {
        lacking = std::max(lacking, std::abs(row.value_m));
    }
    // Contacts that contradict each other (a jam) are met by no velocity; hard ones would try with
    // huge ones. Nobody may gain more than the rows lack.
    Softness softness{k_hand_softness, k_contact_softness};
    for (int attempt = 0; attempt <= k_retries; ++attempt) {
        regularise(scratch.rows, softness, 1.0, scratch.system);
        const std::span<const double> lambda = scratch.system.solve(scratch.rows);
        gather_moves(island, lambda, scratch);
        scratch.lambda.assign(lambda.begin(), lambda.end());
        if (!has_contact(scratch.rows) || longest_move(scratch) <= k_largest_move * lacking) {
            break;
        }
        softness.hand *= 100.0;
        softness.contact *= 100.0;
    }
    apply_impulses(island, scratch.lambda, scratch);
    if (softness.contact == k_contact_softness) {
        refine_velocities(island, scratch);
    }
}

}  // namespace handhold
