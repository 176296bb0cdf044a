#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/block_factor.hpp"
#include "engine/solver/elimination_plan.hpp"
#include "engine/solver/rows.hpp"

// The normal equations of one island's rows, (J W J^T + diag(alpha)) lambda = -value, factorised as
// a sparse matrix of blocks, with unilateral rows by an active set. Equal bits on every compiler.
namespace handhold {

class RowSystem {
  public:
    // A move and a turn, about the body's centre.
    using Twist = std::array<double, 6>;

    // Fills J W J^T. Unilateral rows that the rows before had too begin as they ended there.
    // `inverse_inertia_ws` by the bodies' slots, as many as the island has bodies.
    void assemble(std::span<const SolverBody> bodies, std::span<const Mat3> inverse_inertia_ws,
                  std::span<const Row> rows);

    // The next rows are no later state of those before: nothing is known of who acts.
    void forget_active_set() { keys_.clear(); }

    std::size_t size() const { return diagonal_.size(); }
    double diagonal(std::size_t row) const { return diagonal_[row]; }
    // Added to the diagonal from now on; one number a row, >= 0.
    std::span<double> alpha() { return alpha_; }

    // Solves for all rows; unilateral ones push (lambda >= 0) or are left out. At most 40 changes
    // of the active set, then rows are only left out. The result is valid until the next solve or
    // assemble.
    // Rows that nothing can move (zero diagonal) get lambda 0.
    std::span<const double> solve(std::span<const Row> rows);
    // The same factor and active set against other values: for refinement.
    std::span<const double> solve_again(std::span<const double> values);
    bool is_active(std::size_t row) const { return active_[row] != 0 && held_[row] == 0; }
    // The row's multiplier is given, not solved for, from the next solve until the next assemble or
    // release: a friction that slides.
    void hold(std::size_t row, double lambda);
    void release(std::size_t row);
    // How the last solve moves the bodies: W J^T lambda, by slot.
    std::span<const Twist> moves() const { return moves_; }
    // What is left of a row's value after the last solve: value + J W J^T lambda.
    double remainder(std::size_t row, double value) const;

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
    void choose_plan();
    void write_jacobians(std::span<const SolverBody> bodies,
                         std::span<const Mat3> inverse_inertia_ws, std::span<const Row> rows);
    void multiply_out();
    void write_hubs(std::span<const SolverBody> bodies, std::span<const Mat3> inverse_inertia_ws);
    void take_over_active_set(std::span<const Row> rows);
    void factorise();
    void leave_out(std::uint32_t node, std::size_t row_in_node);
    void substitute(std::span<const double> values);
    void gather_moves(std::span<const double> lambda);
    double row_motion(std::size_t row) const;
    void solve_active();
    bool find_active_set(std::span<const Row> rows);
    bool is_wrong(const Row& row, std::size_t index) const;
    const EliminationPlan& plan() const { return plans_[plan_]; }
    // J of a node's side, six rows of the node's width, and W J^T, a row of six for each of its
    // rows.
    std::size_t end_begin(std::uint32_t end) const {
        const Node& node = nodes_[end / 2];
        return 12 * std::size_t{node.first_row} + (end % 2) * std::size_t{6} * node.width;
    }

    std::vector<Node> nodes_;
    std::vector<RowNode> row_nodes_;  // the same, for the plan
    std::vector<std::uint8_t> turns_;
    std::vector<std::uint32_t> body_of_slot_;
    std::vector<std::uint32_t> node_of_row_;
    std::vector<std::uint32_t> unknown_of_row_;

    // Structures come back: with and without contacts, with the player held still or not. Which
    // were kept changes nothing but the cost.
    static constexpr std::size_t k_plans = 6;
    std::array<EliminationPlan, k_plans> plans_;
    std::array<std::uint64_t, k_plans> plan_used_{};
    std::uint64_t uses_ = 0;
    std::size_t plan_ = 0;

    std::vector<double> jacobians_;  // by end_begin
    std::vector<double> responses_;
    std::vector<double> matrix_;  // the plan's panels
    std::vector<double> diagonal_;
    std::vector<double> alpha_;
    std::vector<double> smallest_pivots_;  // by unknown
    BlockFactor factor_;

    std::vector<double> lambda_;
    std::vector<double> values_;
    std::vector<double> unknowns_;
    std::vector<Twist> moves_;  // W J^T lambda of the last solve, by slot
    std::vector<std::uint8_t> active_;
    // Of the rows before these: which of a block's rows, and whether it acted.
    std::vector<std::uint64_t> keys_;
    std::vector<std::uint64_t> previous_keys_;
    std::vector<std::uint8_t> previous_active_;
    std::vector<std::uint8_t> held_;
    std::vector<double> held_lambda_;
    std::vector<std::uint32_t> wrong_rows_;
};

}  // namespace handhold
