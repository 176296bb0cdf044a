// Solver, sparse: assembles J W J^T block by block, as products of the Jacobians of rows that share
// a body.
#include "engine/solver/sparse/row_matrix.hpp"

#include <algorithm>

namespace handhold {
namespace {

// Kernels for loop lengths known at compile time, which halves the cost for nodes three rows wide
// (nearly all). 0: the length is known only at run time. The order of operations, and so every bit
// of the result, is the same.
template <std::size_t KnownWidth>
struct RowKernels {
    // Writes J and W J^T of one side of a node, and adds J W J^T to the diagonal of its rows.
    static void write_end(std::span<const Row> rows, bool is_a, double inverse_mass,
                          const Mat3& inverse_inertia, double* jacobian, double* response,
                          double* diagonal) {
        const std::size_t width = KnownWidth != 0 ? KnownWidth : rows.size();
        for (std::size_t m = 0; m < width; ++m) {
            const Row& row = rows[m];
            const Vec3 linear = is_a ? row.linear_a : Vec3(-row.linear_a);
            const Vec3& angular = is_a ? row.angular_a : row.angular_b;
            const Vec3 move = inverse_mass * linear;
            const Vec3 turn = inverse_inertia * angular;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto i = static_cast<Eigen::Index>(axis);
                jacobian[axis * width + m] = linear[i];
                jacobian[(axis + 3) * width + m] = angular[i];
                response[6 * m + axis] = move[i];
                response[6 * m + axis + 3] = turn[i];
            }
            diagonal[m] += linear.dot(move) + angular.dot(turn);
        }
    }

    // out += response^T jacobian, summed over the six components of a body's motion.
    static void add_product(const double* response, std::size_t column_width,
                            const double* jacobian, std::size_t row_width, double* out,
                            std::size_t stride) {
        const std::size_t height = KnownWidth != 0 ? KnownWidth : column_width;
        const std::size_t width = KnownWidth != 0 ? KnownWidth : row_width;
        for (std::size_t i = 0; i < height; ++i) {
            for (std::size_t c = 0; c < 6; ++c) {
                const double factor = response[6 * i + c];
                for (std::size_t j = 0; j < width; ++j) {
                    out[i * stride + j] += factor * jacobian[c * width + j];
                }
            }
        }
    }

    // add_product for two point nodes. Their linear parts are plus or minus the identity, so
    // translations contribute to the diagonal only.
    static void add_point_product(const double* response, const double* jacobian, double* out,
                                  std::size_t stride) {
        for (std::size_t i = 0; i < 3; ++i) {
            double sums[3] = {out[i * stride], out[i * stride + 1], out[i * stride + 2]};
            sums[i] += response[7 * i] * jacobian[4 * i];
            for (std::size_t c = 3; c < 6; ++c) {
                const double factor = response[6 * i + c];
                for (std::size_t j = 0; j < 3; ++j) {
                    sums[j] += factor * jacobian[c * 3 + j];
                }
            }
            std::copy_n(sums, 3, out + i * stride);
        }
    }

    // move += response lambda.
    static void add_move(const double* response, const double* lambda, std::size_t node_width,
                         RowMatrix::Twist& move) {
        const std::size_t width = KnownWidth != 0 ? KnownWidth : node_width;
        RowMatrix::Twist sum = move;
        for (std::size_t m = 0; m < width; ++m) {
            for (std::size_t c = 0; c < 6; ++c) {
                sum[c] += response[6 * m + c] * lambda[m];
            }
        }
        move = sum;
    }
};

bool has_only_contacts(std::span<const Row> rows) {
    return std::ranges::all_of(rows, [](const Row& row) { return row.group == RowGroup::contact; });
}

std::uint32_t slot_of(const SolverBody& body) {
    return body.inverse_mass > 0.0 ? body.slot : k_no_slot;
}

}  // namespace

void RowMatrix::group_rows(std::span<const SolverBody> bodies, std::size_t slot_count,
                           std::span<const Row> rows) {
    nodes_.clear();
    row_nodes_.clear();
    node_of_row_.resize(rows.size());
    can_rotate_.assign(slot_count, 0);
    body_of_slot_.assign(slot_count, 0);
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
        const bool joins = i > 0 && rows[i].a == rows[i - 1].a && rows[i].b == rows[i - 1].b &&
                           nodes_.back().width < k_widest_node;
        if (!joins) {
            Node node{i, 0, {slot_of(bodies[rows[i].a]), slot_of(bodies[rows[i].b])}};
            for (std::size_t side = 0; side < 2; ++side) {
                const std::uint32_t body = side == 0 ? rows[i].a : rows[i].b;
                if (node.slots[side] != k_no_slot) {
                    can_rotate_[node.slots[side]] =
                        bodies[body].inverse_inertia_bs.squaredNorm() == 0.0 ? 0 : 1;
                    body_of_slot_[node.slots[side]] = body;
                }
            }
            nodes_.push_back(node);
        }
        ++nodes_.back().width;
        node_of_row_[i] = static_cast<std::uint32_t>(nodes_.size() - 1);
    }
    for (Node& node : nodes_) {
        node.is_point = node.width == 3 && starts_point_rows(rows[node.first_row]);
        const bool is_regularised = has_only_contacts(rows.subspan(node.first_row, node.width));
        row_nodes_.push_back({{node.slots[0], node.slots[1]}, node.width, is_regularised});
    }
}

void RowMatrix::write_jacobians(std::span<const SolverBody> bodies,
                                std::span<const Mat3> inverse_inertia_ws,
                                std::span<const Row> rows) {
    jacobians_.resize(12 * rows.size());
    responses_.resize(12 * rows.size());
    diagonal_.assign(rows.size(), 0.0);
    for (std::uint32_t end = 0; end < 2 * nodes_.size(); ++end) {
        const Node& node = nodes_[end / 2];
        const std::uint32_t slot = node.slots[end % 2];
        if (slot == k_no_slot) {
            continue;
        }
        const bool is_a = end % 2 == 0;
        const double inverse_mass =
            bodies[is_a ? rows[node.first_row].a : rows[node.first_row].b].inverse_mass;
        const std::span<const Row> of = rows.subspan(node.first_row, node.width);
        const auto write = node.width == 3 ? RowKernels<3>::write_end : RowKernels<0>::write_end;
        write(of, is_a, inverse_mass, inverse_inertia_ws[slot], &jacobians_[end_begin(end)],
              &responses_[end_begin(end)], &diagonal_[node.first_row]);
    }
}

void RowMatrix::multiply_out() {
    matrix_.assign(plan().value_count(), 0.0);
    for (const EliminationPlan::Coupling& coupling : plan().couplings()) {
        const double* const response = &responses_[end_begin(coupling.panel_end)];
        const double* const jacobian = &jacobians_[end_begin(coupling.later_end)];
        const Node& panel_node = nodes_[coupling.panel_end / 2];
        const Node& later_node = nodes_[coupling.later_end / 2];
        double* const out = &matrix_[coupling.target];
        if (panel_node.is_point && later_node.is_point) {
            RowKernels<3>::add_point_product(response, jacobian, out, coupling.stride);
        } else {
            RowKernels<0>::add_product(response, panel_node.width, jacobian, later_node.width, out,
                                       coupling.stride);
        }
    }
}

// Writes the hubs' part of the matrix: -J in their rows or columns, -M in their diagonal blocks.
void RowMatrix::write_hubs(std::span<const SolverBody> bodies,
                           std::span<const Mat3> inverse_inertia_ws) {
    for (const EliminationPlan::HubCoupling& coupling : plan().hub_couplings()) {
        const double* const jacobian = &jacobians_[end_begin(coupling.end)];
        const std::uint32_t width = nodes_[coupling.end / 2].width;
        const bool can_rotate = can_rotate_[nodes_[coupling.end / 2].slots[coupling.end % 2]] != 0;
        for (std::uint32_t c = 0; c < (can_rotate ? 6U : 3U); ++c) {
            for (std::uint32_t j = 0; j < width; ++j) {
                const std::uint32_t at =
                    coupling.hub_first ? c * coupling.stride + j : j * coupling.stride + c;
                matrix_[coupling.target + at] = -jacobian[c * width + j];
            }
        }
    }
    for (const EliminationPlan::Hub& hub : plan().hubs()) {
        const double mass = 1.0 / bodies[body_of_slot_[hub.slot]].inverse_mass;
        Mat3 inertia = Mat3::Identity();
        if (can_rotate_[hub.slot] != 0) {
            inertia = inverse_inertia_ws[hub.slot].inverse();
        }
        for (std::uint32_t i = 0; i < 3; ++i) {
            matrix_[hub.target + i * hub.stride + i] = -mass;
            for (std::uint32_t j = i; j < 3; ++j) {
                matrix_[hub.target + (i + 3) * hub.stride + j + 3] = -inertia(i, j);
            }
        }
    }
}

void RowMatrix::assemble(std::span<const SolverBody> bodies,
                         std::span<const Mat3> inverse_inertia_ws, std::span<const Row> rows) {
    group_rows(bodies, inverse_inertia_ws.size(), rows);
    plans_.choose(row_nodes_, can_rotate_);
    write_jacobians(bodies, inverse_inertia_ws, rows);
    multiply_out();
    write_hubs(bodies, inverse_inertia_ws);
    factor_.resize(plan());
    smallest_pivots_.assign(plan().scalar_count(), 0.0);
    unknown_of_row_.resize(rows.size());
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
        const std::uint32_t node = node_of_row_[i];
        unknown_of_row_[i] = plan().panel_of(node).scalar + i - nodes_[node].first_row;
        smallest_pivots_[unknown_of_row_[i]] = k_smallest_pivot * diagonal_[i];
    }
    alpha_.assign(rows.size(), 0.0);
    takes_part_.assign(rows.size(), 0);
    is_factorised_ = false;
    moves_.resize(inverse_inertia_ws.size());
}

// Removes a row from the factor; its multiplier becomes 0.
void RowMatrix::exclude_row(std::uint32_t node, std::size_t row_in_node) {
    const std::span<double> values = factor_.values();
    const EliminationPlan::Panel& panel = plan().panel_of(node);
    for (std::size_t i = 0; i < row_in_node; ++i) {
        values[panel.begin + i * panel.stride + row_in_node] = 0.0;
    }
    const std::size_t diagonal = panel.begin + row_in_node * panel.stride + row_in_node;
    std::ranges::fill(values.subspan(diagonal, panel.stride - row_in_node), 0.0);
    values[diagonal] = 1.0;
    for (const EliminationPlan::Appearance& appearance : plan().appearances(node)) {
        for (std::uint32_t i = 0; i < appearance.rows; ++i) {
            values[appearance.begin + i * appearance.stride + row_in_node] = 0.0;
        }
    }
}

void RowMatrix::factorise(std::span<const std::uint8_t> chosen) {
    for (std::uint32_t i = 0; i < size(); ++i) {
        const std::uint8_t takes_part = chosen[i] != 0 && diagonal_[i] > 0.0 ? 1 : 0;
        is_factorised_ = is_factorised_ && takes_part == takes_part_[i];
        takes_part_[i] = takes_part;
    }
    if (is_factorised_) {
        return;
    }
    is_factorised_ = true;
    const std::span<double> values = factor_.values();
    std::ranges::copy(matrix_, values.begin());
    for (std::uint32_t i = 0; i < size(); ++i) {
        const std::uint32_t node = node_of_row_[i];
        const std::uint32_t m = i - nodes_[node].first_row;
        if (takes_part_[i] != 0) {
            const EliminationPlan::Panel& panel = plan().panel_of(node);
            values[panel.begin + m * panel.stride + m] += alpha_[i];
        } else {
            exclude_row(node, m);
        }
    }
    factor_.factorise(plan(), smallest_pivots_);
}

std::uint64_t RowMatrix::factorisation_cost() const {
    std::uint64_t cost = 0;
    for (const EliminationPlan::Panel& panel : plan().panels()) {
        cost += std::uint64_t{panel.width} * panel.stride * panel.stride / 2;
    }
    return cost;
}

void RowMatrix::solve(std::span<const double> values, std::span<double> lambda) {
    unknowns_.assign(plan().scalar_count(), 0.0);
    for (std::uint32_t i = 0; i < size(); ++i) {
        if (takes_part_[i] != 0) {
            unknowns_[unknown_of_row_[i]] = -values[i];
        }
    }
    factor_.substitute(plan(), unknowns_);
    for (std::uint32_t i = 0; i < size(); ++i) {
        lambda[i] = unknowns_[unknown_of_row_[i]];
    }
}

void RowMatrix::gather_moves(std::span<const double> lambda) {
    std::ranges::fill(moves_, Twist{});
    for (std::uint32_t end = 0; end < 2 * nodes_.size(); ++end) {
        const Node& node = nodes_[end / 2];
        if (node.slots[end % 2] == k_no_slot) {
            continue;
        }
        Twist& move = moves_[node.slots[end % 2]];
        const double* const response = &responses_[end_begin(end)];
        if (node.width == 3) {
            RowKernels<3>::add_move(response, &lambda[node.first_row], 3, move);
        } else {
            RowKernels<0>::add_move(response, &lambda[node.first_row], node.width, move);
        }
    }
}

// Jacobian of one row times the displacements in moves_. After gather_moves: J W J^T lambda.
double RowMatrix::row_motion(std::size_t row) const {
    const std::uint32_t index = node_of_row_[row];
    const Node& node = nodes_[index];
    double sum = 0.0;
    for (std::uint32_t side = 0; side < 2; ++side) {
        if (node.slots[side] == k_no_slot) {
            continue;
        }
        const Twist& move = moves_[node.slots[side]];
        const double* const jacobian =
            &jacobians_[end_begin(2 * index + side) + row - node.first_row];
        for (std::size_t c = 0; c < 6; ++c) {
            sum += jacobian[c * node.width] * move[c];
        }
    }
    return sum;
}

}  // namespace handhold
