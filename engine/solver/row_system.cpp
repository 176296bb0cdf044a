// Sources: active set: block principal pivoting of Judice and Pires (1994), whose steps of one row,
// after Murty (1974), end it where changing all wrong rows at once goes round in a circle.
#include "engine/solver/row_system.hpp"

#include <algorithm>

namespace handhold {
namespace {

constexpr int k_active_set_changes = 40;  // three or four do nearly always
// Murty's steps of one row take as many as there are rows: for larger sets there is no waiting.
constexpr std::ptrdiff_t k_small_set = 96;
constexpr std::uint8_t k_undecided = 2;  // acts in the first solve where it overlaps
constexpr int k_drops = 6;               // of all pulling rows at once
constexpr int k_block_changes = 3;  // of all wrong rows at once that may fail to make them fewer
// Relative to the diagonal: smaller pivots belong to rows that repeat others beyond what alpha
// tells apart.
constexpr double k_smallest_pivot = 1e-14;

// Nodes are three rows wide nearly always: loops of a length known to the compiler cost half. 0:
// known at run time only. The order of operations is the same.
template <std::size_t KnownWidth>
struct Kernels {
    // J and W J^T of one side of a node; adds J W J^T to its rows' diagonal.
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

    // out += response^T jacobian over the six directions of a body's motion.
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

    // The same of two points: along the axes they share only their mass.
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
                         RowSystem::Twist& move) {
        const std::size_t width = KnownWidth != 0 ? KnownWidth : node_width;
        RowSystem::Twist sum = move;
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

void RowSystem::group_rows(std::span<const SolverBody> bodies, std::size_t slot_count,
                           std::span<const Row> rows) {
    nodes_.clear();
    row_nodes_.clear();
    node_of_row_.resize(rows.size());
    turns_.assign(slot_count, 0);
    body_of_slot_.assign(slot_count, 0);
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
        const bool joins = i > 0 && rows[i].a == rows[i - 1].a && rows[i].b == rows[i - 1].b &&
                           nodes_.back().width < k_widest_node;
        if (!joins) {
            Node node{i, 0, {slot_of(bodies[rows[i].a]), slot_of(bodies[rows[i].b])}};
            for (std::size_t side = 0; side < 2; ++side) {
                const std::uint32_t body = side == 0 ? rows[i].a : rows[i].b;
                if (node.slots[side] != k_no_slot) {
                    turns_[node.slots[side]] =
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
        node.is_point = node.width == 3 && begins_point(rows[node.first_row]);
        const bool is_soft = has_only_contacts(rows.subspan(node.first_row, node.width));
        row_nodes_.push_back({{node.slots[0], node.slots[1]}, node.width, is_soft});
    }
}

// The plan of this structure: a kept one, or a new one in place of the one used longest ago.
void RowSystem::choose_plan() {
    ++uses_;
    std::size_t oldest = plan_;
    for (std::size_t i = 0; i < k_plans; ++i) {
        const std::size_t candidate = (plan_ + i) % k_plans;
        if (plan_used_[candidate] != 0 && plans_[candidate].fits(row_nodes_, turns_)) {
            plan_ = candidate;
            plan_used_[plan_] = uses_;
            return;
        }
        oldest = plan_used_[candidate] < plan_used_[oldest] ? candidate : oldest;
    }
    plan_ = oldest;
    plan_used_[plan_] = uses_;
    plans_[plan_].build(row_nodes_, turns_);
}

void RowSystem::write_jacobians(std::span<const SolverBody> bodies,
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
        const auto write = node.width == 3 ? Kernels<3>::write_end : Kernels<0>::write_end;
        write(of, is_a, inverse_mass, inverse_inertia_ws[slot], &jacobians_[end_begin(end)],
              &responses_[end_begin(end)], &diagonal_[node.first_row]);
    }
}

void RowSystem::multiply_out() {
    matrix_.assign(plan().value_count(), 0.0);
    for (const EliminationPlan::Coupling& coupling : plan().couplings()) {
        const double* const response = &responses_[end_begin(coupling.panel_end)];
        const double* const jacobian = &jacobians_[end_begin(coupling.later_end)];
        const Node& panel_node = nodes_[coupling.panel_end / 2];
        const Node& later_node = nodes_[coupling.later_end / 2];
        double* const out = &matrix_[coupling.target];
        if (panel_node.is_point && later_node.is_point) {
            Kernels<3>::add_point_product(response, jacobian, out, coupling.stride);
        } else {
            Kernels<0>::add_product(response, panel_node.width, jacobian, later_node.width, out,
                                    coupling.stride);
        }
    }
}

// Hubs as unknowns: -J at their rows or columns, -M on their diagonal.
void RowSystem::write_hubs(std::span<const SolverBody> bodies,
                           std::span<const Mat3> inverse_inertia_ws) {
    for (const EliminationPlan::HubCoupling& coupling : plan().hub_couplings()) {
        const double* const jacobian = &jacobians_[end_begin(coupling.end)];
        const std::uint32_t width = nodes_[coupling.end / 2].width;
        const bool turns = turns_[nodes_[coupling.end / 2].slots[coupling.end % 2]] != 0;
        for (std::uint32_t c = 0; c < (turns ? 6U : 3U); ++c) {
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
        if (turns_[hub.slot] != 0) {
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

// Both lists are in the order of their blocks.
void RowSystem::take_over_active_set(std::span<const Row> rows) {
    std::swap(keys_, previous_keys_);
    std::swap(active_, previous_active_);
    keys_.clear();
    active_.clear();
    std::size_t before = 0;
    for (const Row& row : rows) {
        const std::uint64_t block = std::uint64_t{row.block} << 32U;
        const bool is_first = keys_.empty() || keys_.back() < block;
        keys_.push_back(is_first ? block : keys_.back() + 1);
        while (before < previous_keys_.size() && previous_keys_[before] < keys_.back()) {
            ++before;
        }
        const bool is_known =
            before < previous_keys_.size() && previous_keys_[before] == keys_.back();
        // What acted in the rows before acts at first.
        active_.push_back(!row.unilateral ? 1 : is_known ? previous_active_[before] : k_undecided);
    }
}

void RowSystem::assemble(std::span<const SolverBody> bodies,
                         std::span<const Mat3> inverse_inertia_ws, std::span<const Row> rows) {
    group_rows(bodies, inverse_inertia_ws.size(), rows);
    choose_plan();
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
    lambda_.assign(rows.size(), 0.0);
    values_.resize(rows.size());
    take_over_active_set(rows);
    held_.assign(rows.size(), 0);
    held_lambda_.assign(rows.size(), 0.0);
    moves_.resize(inverse_inertia_ws.size());
}

// As if the row were not there: its multiplier is 0.
void RowSystem::leave_out(std::uint32_t node, std::size_t row_in_node) {
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

void RowSystem::factorise() {
    const std::span<double> values = factor_.values();
    std::ranges::copy(matrix_, values.begin());
    for (std::uint32_t i = 0; i < size(); ++i) {
        const std::uint32_t node = node_of_row_[i];
        const std::uint32_t m = i - nodes_[node].first_row;
        if (is_active(i) && diagonal_[i] > 0.0) {
            const EliminationPlan::Panel& panel = plan().panel_of(node);
            values[panel.begin + m * panel.stride + m] += alpha_[i];
        } else {
            leave_out(node, m);
        }
    }
    factor_.factorise(plan(), smallest_pivots_);
}

void RowSystem::substitute(std::span<const double> values) {
    unknowns_.assign(plan().scalar_count(), 0.0);
    for (std::uint32_t i = 0; i < size(); ++i) {
        if (is_active(i) && diagonal_[i] > 0.0) {
            unknowns_[unknown_of_row_[i]] = -values[i];
        }
    }
    factor_.substitute(plan(), unknowns_);
    for (std::uint32_t i = 0; i < size(); ++i) {
        lambda_[i] = unknowns_[unknown_of_row_[i]];
    }
}

void RowSystem::gather_moves(std::span<const double> lambda) {
    std::ranges::fill(moves_, Twist{});
    for (std::uint32_t end = 0; end < 2 * nodes_.size(); ++end) {
        const Node& node = nodes_[end / 2];
        if (node.slots[end % 2] == k_no_slot) {
            continue;
        }
        Twist& move = moves_[node.slots[end % 2]];
        const double* const response = &responses_[end_begin(end)];
        if (node.width == 3) {
            Kernels<3>::add_move(response, &lambda[node.first_row], 3, move);
        } else {
            Kernels<0>::add_move(response, &lambda[node.first_row], node.width, move);
        }
    }
}

// How far the moves gathered carry a row: J W J^T lambda.
double RowSystem::row_motion(std::size_t row) const {
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

void RowSystem::hold(std::size_t row, double lambda) {
    held_[row] = 1;
    held_lambda_[row] = lambda;
}

void RowSystem::release(std::size_t row) {
    held_[row] = 0;
    held_lambda_[row] = 0.0;
}

double RowSystem::remainder(std::size_t row, double value) const { return value + row_motion(row); }

// A unilateral row is wrong where it acts and pulls, or is left out and the solution would overlap
// it.
bool RowSystem::is_wrong(const Row& row, std::size_t index) const {
    constexpr double k_overlap = 1e-10;
    if (!row.unilateral || held_[index] != 0) {
        return false;
    }
    if (active_[index] != 0) {
        return lambda_[index] < 0.0;
    }
    return remainder(index, row.value_m) < -k_overlap;
}

void RowSystem::solve_active() {
    factorise();
    substitute(values_);
    for (std::size_t i = 0; i < size(); ++i) {
        lambda_[i] = held_[i] != 0 ? held_lambda_[i] : lambda_[i];
    }
    gather_moves(lambda_);
}

std::span<const double> RowSystem::solve(std::span<const Row> rows) {
    // What the held rows do to the others.
    const bool holds = std::ranges::any_of(held_, [](std::uint8_t held) { return held != 0; });
    if (holds) {
        gather_moves(held_lambda_);
    }
    for (std::size_t i = 0; i < size(); ++i) {
        values_[i] = rows[i].value_m + (holds ? row_motion(i) : 0.0);
        if (active_[i] == k_undecided) {
            active_[i] = values_[i] < 0.0 ? 1 : 0;
        }
    }
    if (find_active_set(rows)) {
        return lambda_;
    }
    // No agreement: what pulls is left out for good. What that overlaps is the next step's.
    for (int drop = 0; drop < k_drops; ++drop) {
        bool pulls = false;
        for (std::size_t i = 0; i < size(); ++i) {
            if (rows[i].unilateral && is_active(i) && lambda_[i] < 0.0) {
                active_[i] = 0;
                pulls = true;
            }
        }
        if (!pulls) {
            return lambda_;
        }
        solve_active();
    }
    for (std::size_t i = 0; i < size(); ++i) {
        lambda_[i] = rows[i].unilateral && is_active(i) ? std::max(0.0, lambda_[i]) : lambda_[i];
    }
    gather_moves(lambda_);
    return lambda_;
}

// True where every acting row pushes and no other overlaps.
bool RowSystem::find_active_set(std::span<const Row> rows) {
    const bool is_small = std::ranges::count_if(rows, &Row::unilateral) <= k_small_set;
    std::size_t fewest = size() + 1;
    int blocks_left = k_block_changes;
    for (int change = 0; change < k_active_set_changes; ++change) {
        solve_active();
        wrong_rows_.clear();
        for (std::uint32_t i = 0; i < size(); ++i) {
            if (is_wrong(rows[i], i)) {
                wrong_rows_.push_back(i);
            }
        }
        if (wrong_rows_.empty()) {
            return true;
        }
        if (wrong_rows_.size() < fewest) {
            fewest = wrong_rows_.size();
            blocks_left = k_block_changes;
        } else if (blocks_left > 0) {
            --blocks_left;
        } else if (is_small) {
            wrong_rows_.assign(1, wrong_rows_.back());
        } else {
            return false;
        }
        for (const std::uint32_t i : wrong_rows_) {
            active_[i] ^= 1U;
        }
    }
    solve_active();
    return false;
}

std::span<const double> RowSystem::solve_again(std::span<const double> values) {
    substitute(values);
    gather_moves(lambda_);
    return lambda_;
}

}  // namespace handhold
