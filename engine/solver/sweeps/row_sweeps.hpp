// Solver, sweeps: bounded iterative solve for islands with many contacts (heaps). Joints and drives
// are eliminated exactly, contacts, limits and friction are solved by projected Gauss-Seidel:
//   rows E (joints, drives), rows U (contacts, limits, friction), v = W J^T lambda
//   P = I - W J_E^T (J_E W J_E^T + R_E)^-1 J_E        removes the motions that E does not allow
//   sweep over i in U:
//     lambda_i <- bound(lambda_i - (C_i + J_i v + R_i lambda_i) / (J_i w_i + R_i))
//     v += w_i (change of lambda_i),     w_i = P W J_i^T
// The last sweeps visit only the stiff rows, which move a body that is not in a heap. The error
// that then remains is overlap within the heap. The rows E are satisfied exactly after every sweep,
// so a held body moves as one body with its player. If neither body of row i has rows in E, w_i = W
// J_i^T has an entry for each of the two bodies. Otherwise w_i has one for each body that E
// connects with them.
// Sources: Jean, The Non-Smooth Contact Dynamics Method (1999): Gauss-Seidel per contact with
// Coulomb's cone. docs/reference/solver.md has the derivation.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/model/rows.hpp"
#include "engine/solver/sparse/row_matrix.hpp"

namespace handhold {

// Rows whose multipliers, as a vector, are bounded in length: friction, motors, locks.
struct BoundedRows {
    std::size_t row = 0;     // index of the first row
    std::size_t width = 1;   // number of rows, at most 3
    double limit = 0.0;      // N s or N m s; used if `coefficient` is 0
    std::size_t normal = 0;  // row whose multiplier times `coefficient` is the limit
    double coefficient = 0.0;
};

struct SweepLimits {
    // no sweep starts once work() has reached this; a running sweep is completed
    std::uint64_t max_work = 0;
    // maximum number of sweeps over all rows, and again over the stiff rows
    int max_sweeps = 0;
    // Sweeps end when a sweep changes every residual by less than this: the sweeps over all rows,
    // and those over the stiff rows only.
    double heap_tolerance = 0.0;
    double tolerance = 0.0;
};

class RowSweeps {
  public:
    using Twist = RowMatrix::Twist;

    // Takes an island's rows. `inverse_inertia_ws` is indexed by slot, one entry per body.
    // `bounded` is sorted by row. Rows that are neither unilateral nor bounded are solved exactly.
    void assemble(std::span<const SolverBody> bodies, std::span<const Mat3> inverse_inertia_ws,
                  std::span<const Row> rows, std::span<const BoundedRows> bounded);

    std::size_t size() const { return kinds_.size(); }
    // Diagonal of J W J^T.
    double diagonal(std::size_t row) const { return diagonal_[row]; }
    // R's diagonal, one value per row, >= 0. Takes effect with the next `factorise`.
    std::span<double> alpha() { return alpha_; }

    // Factorises the matrix of the exact rows E. Also computes the responses w_i of the other rows
    // to impulses, unless that is too expensive. In that case `solve` satisfies the rows E after
    // each sweep.
    void factorise();
    // Solves for all multipliers with residuals `values`, from zero. Valid until the next call.
    std::span<const double> solve(std::span<const double> values, const SweepLimits& limits);
    // Moves of the bodies in the last solve, W J^T lambda; by slot.
    std::span<const Twist> moves() const { return std::span(moves_).first(moves_.size() - 1); }
    // A row's residual after the last solve: value + J W J^T lambda.
    double remaining_residual(std::size_t row, double value) const {
        return value + motion_of(packed_[row]);
    }
    // Work since the last `assemble`: visits of rows, weighted by their responses.
    std::uint64_t work() const { return work_; }

  private:
    enum class Kind : std::uint8_t { exact, unilateral, bounded };
    // A row's Jacobian and its bodies' responses to it. A body that cannot move has the slot past
    // the last body's.
    struct PackedRow {
        std::array<double, 6> jacobian_a{};
        std::array<double, 6> jacobian_b{};
        std::array<double, 6> response_a{};  // W J^T
        std::array<double, 6> response_b{};
        // inverse of the diagonal of J w + R; 0: nothing can move this row
        double inverse_diagonal = 0.0;
        std::uint32_t slot_a = 0;
        std::uint32_t slot_b = 0;
        // Range in `responses_` that replaces response_a and response_b; empty: not replaced.
        std::uint32_t responses_begin = 0;
        std::uint32_t responses_end = 0;
    };
    struct Response {
        std::uint32_t slot = 0;
        Twist move{};
    };
    // Consecutive rows that are projected together.
    struct Group {
        std::uint32_t row = 0;
        std::uint32_t width = 1;
        bool is_unilateral = true;
        bool is_stiff = true;  // moves a body that is not in a heap
        BoundedRows bound;
    };

    void group_rows(std::span<const SolverBody> bodies, std::span<const Row> rows,
                    std::span<const BoundedRows> bounded);
    void pack_rows(std::span<const SolverBody> bodies, std::span<const Mat3> inverse_inertia_ws,
                   std::span<const Row> rows);
    void find_clusters();
    bool may_condense() const;
    void respond(PackedRow& row);
    double motion_of(const PackedRow& row) const;
    void push(const PackedRow& row, double impulse);
    double visit(const Group& group);
    double sweep(bool forwards, bool only_stiff);
    void accelerate(double& last_square);
    void sweep_until(double tolerance, bool only_stiff, const SweepLimits& limits);
    void satisfy_exact_rows();

    std::vector<Kind> kinds_;        // indexed by row
    std::vector<PackedRow> packed_;  // indexed by row
    std::vector<double> diagonal_;   // indexed by row
    std::vector<double> alpha_;      // indexed by row
    std::vector<double> lambda_;     // indexed by row
    std::vector<double> values_;     // indexed by row
    // Conjugate gradients: the state before the last sweep, and the search direction.
    std::vector<double> last_lambda_;
    std::vector<Twist> last_moves_;
    std::vector<double> direction_;
    std::vector<Twist> direction_moves_;
    std::vector<Group> groups_;
    std::vector<Response> responses_;
    bool is_condensed_ = true;  // the responses include the exact rows
    std::vector<Twist> moves_;  // one per slot, and one for bodies that cannot move

    RowMatrix exact_;
    std::vector<Row> exact_rows_;
    // index of each exact row among the rows of `assemble`
    std::vector<std::uint32_t> exact_indices_;
    std::vector<std::uint8_t> chosen_;
    std::vector<double> exact_values_;
    std::vector<double> exact_lambda_;
    // Clusters are the sets of bodies that exact rows connect, numbered by their lowest slot.
    std::vector<std::uint32_t> cluster_of_slot_;
    std::vector<std::uint32_t> cluster_size_;   // indexed by cluster
    std::vector<std::uint32_t> cluster_begin_;  // index of each cluster in cluster_slots_
    std::vector<std::uint32_t> cluster_slots_;
    std::vector<std::uint8_t> is_exact_body_;  // one per slot; 1: has an exact row
    std::uint64_t work_ = 0;
    // Work of one sweep: over all groups, and over the stiff groups.
    std::uint64_t sweep_work_ = 0;
    std::uint64_t stiff_work_ = 0;
};

}  // namespace handhold
