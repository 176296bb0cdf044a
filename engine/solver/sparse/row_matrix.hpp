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

// J W J^T + diag(alpha) of one island's rows as a sparse matrix of blocks, factorised for any
// choice of its rows. Equal bits on every compiler.
class RowMatrix {
  public:
    // A move and a turn, about the body's centre.
    using Twist = std::array<double, 6>;

    // Fills J W J^T. `inverse_inertia_ws` by the bodies' slots, as many as the island has bodies.
    void assemble(std::span<const SolverBody> bodies, std::span<const Mat3> inverse_inertia_ws,
                  std::span<const Row> rows);

    std::size_t size() const { return diagonal_.size(); }
    // Of J W J^T alone.
    double diagonal(std::size_t row) const { return diagonal_[row]; }
    // Added to the diagonal from the next factorise on; one number a row, >= 0.
    std::span<double> alpha() { return alpha_; }

    // Of the rows chosen (not 0) that anything can move; as if the others were not there.
    void factorise(std::span<const std::uint8_t> chosen);
    // lambda of (J W J^T + diag(alpha)) lambda = -value with the last factor; 0 for rows left out.
    void solve(std::span<const double> values, std::span<double> lambda);

    // How multipliers of all rows move the bodies: W J^T lambda, kept until the next call.
    void gather_moves(std::span<const double> lambda);
    std::span<const Twist> moves() const { return moves_; }  // by slot
    // How far the moves gathered carry a row: J W J^T lambda.
    double row_motion(std::size_t row) const;

  private:
    // Rows of one pair of bodies.
    struct Node {
        std::uint32_t first_row = 0;
        std::uint32_t width = 0;
        std::uint32_t slots[2] = {k_no_slot, k_no_slot};
        bool is_point = false;  // a point held on a point: its rows go along the world's axes
    };
    void group_rows(std::span<const SolverBody> bodies, std::size_t slot_count,
                    std::span<const Row> rows);
    void write_jacobians(std::span<const SolverBody> bodies,
                         std::span<const Mat3> inverse_inertia_ws, std::span<const Row> rows);
    void multiply_out();
    void write_hubs(std::span<const SolverBody> bodies, std::span<const Mat3> inverse_inertia_ws);
    void exclude_row(std::uint32_t node, std::size_t row_in_node);
    const EliminationPlan& plan() const { return plans_.current(); }
    // J of a node's side, six rows of the node's width, and W J^T, a row of six for each of its
    // rows.
    std::size_t end_begin(std::uint32_t end) const {
        const Node& node = nodes_[end / 2];
        return 12 * std::size_t{node.first_row} + (end % 2) * std::size_t{6} * node.width;
    }

    std::vector<Node> nodes_;
    std::vector<RowNode> row_nodes_;  // the same, for the plan
    std::vector<std::uint8_t> can_rotate_;
    std::vector<std::uint32_t> body_of_slot_;
    std::vector<std::uint32_t> node_of_row_;
    std::vector<std::uint32_t> unknown_of_row_;

    PlanCache<EliminationPlan> plans_;

    std::vector<double> jacobians_;  // by end_begin
    std::vector<double> responses_;
    std::vector<double> matrix_;  // the plan's panels
    std::vector<double> diagonal_;
    std::vector<double> alpha_;
    std::vector<double> smallest_pivots_;  // by unknown
    BlockFactor factor_;
    std::vector<std::uint8_t> takes_part_;  // in the last factor
    std::vector<double> unknowns_;
    std::vector<Twist> moves_;
};

}  // namespace handhold
