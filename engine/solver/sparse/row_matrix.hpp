// Solver, sparse: the matrix of one island's rows. Used by RowSystem (newton/active_set.hpp).

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/model/rows.hpp"
#include "engine/solver/sparse/block_factor.hpp"
#include "engine/solver/sparse/elimination_plan.hpp"
#include "engine/solver/sparse/plan_cache.hpp"

namespace handhold {

// J W J^T + diag(alpha) of one island's rows as a sparse block matrix, which can be factorised for
// any subset of the rows. The same bits on every compiler.
class RowMatrix {
  public:
    // Translation and rotation vector of a body about its centre; metres and radians.
    using Twist = std::array<double, 6>;

    // Assembles J W J^T. `inverse_inertia_ws` is by slot and has one entry per body of the island.
    void assemble(std::span<const SolverBody> bodies, std::span<const Mat3> inverse_inertia_ws,
                  std::span<const Row> rows);

    std::size_t size() const { return diagonal_.size(); }
    // Diagonal of J W J^T, without alpha.
    double diagonal(std::size_t row) const { return diagonal_[row]; }
    // The diagonal `alpha` in the equation above (regularisation): one value per row, >= 0. Takes
    // effect with the next `factorise`. Do not write to the span after that: call alpha() again.
    std::span<double> alpha() {
        is_factorised_ = false;
        return alpha_;
    }
    std::span<const double> alpha() const { return alpha_; }

    // Factorises the matrix of the rows with a non-zero `chosen`, as if the others did not exist.
    // Also omits rows that no body can move (zero diagonal). Keeps the last factor if it is that of
    // the same rows and alpha.
    void factorise(std::span<const std::uint8_t> chosen);
    // Multiply-adds of one factorisation, an upper bound. Depends on the rows only.
    std::uint64_t factorisation_cost() const;
    // Solves (J W J^T + diag(alpha)) lambda = -values with the last factor; 0 for omitted rows.
    void solve(std::span<const double> values, std::span<double> lambda);

    // Computes the bodies' moves W J^T lambda and keeps them until the next call.
    void gather_moves(std::span<const double> lambda);
    std::span<const Twist> moves() const { return moves_; }  // indexed by slot
    // Lets a caller write other moves; row_motion then returns J times those.
    std::span<Twist> edit_moves() { return moves_; }
    // Jacobian of one row times the displacements in moves(). After gather_moves: J W J^T lambda.
    double row_motion(std::size_t row) const;

  private:
    // Consecutive rows between the same two bodies, at most k_widest_node.
    struct Node {
        std::uint32_t first_row = 0;
        std::uint32_t width = 0;
        std::uint32_t slots[2] = {k_no_slot, k_no_slot};
        bool is_point = false;  // a point triad: its rows are along the world axes
    };
    void group_rows(std::span<const SolverBody> bodies, std::size_t slot_count,
                    std::span<const Row> rows);
    void write_jacobians(std::span<const SolverBody> bodies,
                         std::span<const Mat3> inverse_inertia_ws, std::span<const Row> rows);
    void multiply_out();
    void write_hubs(std::span<const SolverBody> bodies, std::span<const Mat3> inverse_inertia_ws);
    void exclude_row(std::uint32_t node, std::size_t row_in_node);
    const EliminationPlan& plan() const { return plans_.current(); }
    // Index at which the values of an end (2 * node + side) begin: J in jacobians_ (six rows of the
    // node's width), W J^T in responses_ (six values for each row of the node).
    std::size_t end_begin(std::uint32_t end) const {
        const Node& node = nodes_[end / 2];
        return 12 * std::size_t{node.first_row} + (end % 2) * std::size_t{6} * node.width;
    }

    std::vector<Node> nodes_;
    std::vector<RowNode> row_nodes_;  // nodes_ in the format of the plan
    std::vector<std::uint8_t> can_rotate_;
    std::vector<std::uint32_t> body_of_slot_;
    std::vector<std::uint32_t> node_of_row_;
    std::vector<std::uint32_t> unknown_of_row_;

    PlanCache<EliminationPlan> plans_;

    std::vector<double> jacobians_;  // indexed by end_begin
    std::vector<double> responses_;
    std::vector<double> matrix_;  // matrix in the plan's panels
    std::vector<double> diagonal_;
    std::vector<double> alpha_;
    std::vector<double> smallest_pivots_;  // indexed by unknown
    BlockFactor factor_;
    std::vector<std::uint8_t> takes_part_;  // one per row; 1: part of the last factor
    bool is_factorised_ = false;            // factor_ is of takes_part_ and alpha_
    std::vector<double> unknowns_;
    std::vector<Twist> moves_;
};

}  // namespace handhold
