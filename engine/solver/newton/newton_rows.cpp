// Solver, newton: the rows of a Newton step.
#include "engine/solver/newton/newton_rows.hpp"

#include <algorithm>
#include <cmath>

#include "engine/solver/model/geometric_stiffness.hpp"

namespace handhold {
namespace {

// Contacts and limits farther away than both this and twice the worst error are omitted from a
// step.
constexpr double k_min_active_distance_m = 1e-3;

bool is_unilateral_block(const RowBlock& block) { return is_contact(block) || block.joint.limited; }

// Separation beyond which contacts and limits are omitted from a step.
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

// Adds make(body), a stiffness, to a body that can rotate.
template <typename Make>
void add_stiffness(const IslandView& island, std::uint32_t index, SolveScratch& scratch,
                   const Make& make) {
    const SolverBody& body = island.bodies[index];
    if (body.inverse_inertia_bs.squaredNorm() > 0.0) {
        scratch.stiffness[body.slot] += make(body);
    }
}

// `force`: on a at its point; b gets the opposite.
void add_force_stiffness(const IslandView& island, const RowBlock& block, const Vec3& force,
                         SolveScratch& scratch) {
    add_stiffness(island, block.a, scratch, [&](const SolverBody& a) {
        return positive_stiffness(force, a.pose_ws.rotation * block.point_a_bs, 1.0);
    });
    add_stiffness(island, block.b, scratch, [&](const SolverBody& b) {
        return positive_stiffness(force, b.pose_ws.rotation * block.point_b_bs, -1.0);
    });
}

void add_cone_stiffness(const IslandView& island, const Row& row, double lambda,
                        SolveScratch& scratch) {
    const RowBlock& block = island.blocks[row.block];
    const auto axis_of = [&island](std::uint32_t body, const Quat& frame_bs) {
        return Vec3(island.bodies[body].pose_ws.rotation * frame_bs * Vec3::UnitX());
    };
    const Vec3 axis_a = axis_of(row.a, block.rotation_a_bs);
    const Vec3 axis_b = axis_of(row.b, block.rotation_b_bs);
    // Positive if the row keeps the angle from growing.
    const double torque = -lambda * row.angular_b.dot(axis_a.cross(axis_b).normalized());
    add_stiffness(island, row.a, scratch,
                  [&](const SolverBody&) { return cone_stiffness(torque, axis_a, axis_b); });
    add_stiffness(island, row.b, scratch,
                  [&](const SolverBody&) { return cone_stiffness(torque, axis_b, axis_a); });
}

}  // namespace

void gather_stiffness(const IslandView& island, SolveScratch& scratch) {
    const std::span<const double> lambda = scratch.lambda;
    for (std::size_t i = 0; i < scratch.previous_rows.size(); ++i) {
        const Row& row = scratch.previous_rows[i];
        const RowBlock& block = island.blocks[row.block];
        if (starts_point_rows(row)) {
            add_force_stiffness(island, block, Vec3(lambda[i], lambda[i + 1], lambda[i + 2]),
                                scratch);
        } else if (block.kind == RowKind::distance) {
            add_force_stiffness(island, block, lambda[i] * row.linear_a, scratch);
        } else if (block.kind == RowKind::ball && row.group == RowGroup::limit) {
            add_cone_stiffness(island, row, lambda[i], scratch);
        }
    }
}

bool has_unilateral_block(const IslandView& island) {
    return std::ranges::any_of(island.island_blocks, [&](std::uint32_t index) {
        return is_unilateral_block(island.blocks[index]);
    });
}

void collect_rows(const IslandView& island, std::vector<Row>& rows) {
    const double reach_m = active_distance_of(island);
    rows.clear();
    for (const std::uint32_t index : island.island_blocks) {
        const RowBlock& block = island.blocks[index];
        if (!takes_part(island, block)) {
            continue;
        }
        append_rows(island.bodies, block, index, rows, reach_m);
        if (is_contact(block) && !(rows.back().residual < reach_m)) {
            rows.pop_back();  // cheaper than to measure every separation twice
        }
    }
}

double worst_overlap(std::span<const Row> rows) {
    double worst = 0.0;
    for (const Row& row : rows) {
        worst = row.group == RowGroup::contact ? std::max(worst, -row.residual) : worst;
    }
    return worst;
}

double worst_error(std::span<const Row> rows) {
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

double worst_drive_error(std::span<const Row> rows) {
    double worst = 0.0;
    for (std::size_t i = 0; i < rows.size(); i += rows[i].width) {
        if (rows[i].group == RowGroup::drive) {
            worst = std::max(worst, worst_error(rows.subspan(i, rows[i].width)));
        }
    }
    return worst;
}

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
            // Cayley map: a rotation by 2 atan(|turn| / 2), to second order equal to the
            // exponential map.
            const Vec3 half = 0.5 * turn;
            body.pose_ws.rotation =
                (Quat(1.0, half.x(), half.y(), half.z()) * body.pose_ws.rotation).normalized();
        }
        longest_move = std::max(longest_move, move.squaredNorm());
        largest_rotation = std::max(largest_rotation, turn.squaredNorm());
    }
    return std::max(std::sqrt(longest_move), k_angle_lever_m * std::sqrt(largest_rotation));
}

}  // namespace handhold
