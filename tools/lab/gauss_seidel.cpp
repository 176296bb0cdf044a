#include "tools/lab/gauss_seidel.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <Eigen/Cholesky>

namespace handhold::lab {
namespace {

constexpr int k_max_rows = 6;
using BlockMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, k_max_rows, k_max_rows>;
using BlockVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, k_max_rows, 1>;

int g_sweeps = k_sweeps;

// A body's inverse mass and inertia in one block.
struct Mobility {
    double inverse_mass = 0.0;
    Mat3 inverse_inertia_ws = Mat3::Zero();
};

class GaussSeidel {
  public:
    GaussSeidel(const IslandView& island, SolveScratch& scratch)
        : island_(island), rows_(scratch.rows) {
        find_depths();
        for (const std::uint32_t i : island.island_blocks) {
            if (takes_part(island, island.blocks[i])) {
                order_.push_back(i);
            }
        }
        std::stable_sort(order_.begin(), order_.end(), [this](std::uint32_t x, std::uint32_t y) {
            return depth_of_block(x) < depth_of_block(y);
        });
    }

    void pass(bool shock) {
        for (const std::uint32_t i : order_) {
            const RowBlock& block = island_.blocks[i];
            rows_.clear();
            append_rows(island_.bodies, block, i, rows_);
            const Mobility a = mobility(block.a, shock && depth(block.a) < depth(block.b));
            const Mobility b = mobility(block.b, shock && depth(block.b) < depth(block.a));
            solve_equations(block, a, b);
            solve_inequalities(block, a, b);
        }
    }

    double residual_m() {
        double worst = 0.0;
        for (const std::uint32_t i : order_) {
            RowBlock& block = island_.blocks[i];
            worst = std::max(worst, block_error_m(island_.bodies, block));
        }
        return worst;
    }

  private:
    static constexpr std::uint32_t k_far = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t depth(std::uint32_t body) const { return depths_[body]; }
    std::uint32_t depth_of_block(std::uint32_t i) const {
        return std::min(depth(island_.blocks[i].a), depth(island_.blocks[i].b));
    }

    // For each body, the number of blocks to the nearest immovable body (breadth-first search).
    void find_depths() {
        depths_.assign(island_.bodies.size(), k_far);
        std::vector<std::vector<std::uint32_t>> neighbours(island_.bodies.size());
        std::vector<std::uint32_t> queue;
        for (const std::uint32_t i : island_.island_blocks) {
            const RowBlock& block = island_.blocks[i];
            neighbours[block.a].push_back(block.b);
            neighbours[block.b].push_back(block.a);
            for (const std::uint32_t body : {block.a, block.b}) {
                if (island_.bodies[body].inverse_mass <= 0.0 && depths_[body] == k_far) {
                    depths_[body] = 0;
                    queue.push_back(body);
                }
            }
        }
        for (std::size_t next = 0; next < queue.size(); ++next) {
            const std::uint32_t from = queue[next];
            for (const std::uint32_t to : neighbours[from]) {
                if (depths_[to] == k_far) {
                    depths_[to] = depths_[from] + 1;
                    queue.push_back(to);
                }
            }
        }
    }

    Mobility mobility(std::uint32_t index, bool is_nearer) const {
        const SolverBody& body = island_.bodies[index];
        if (is_nearer || body.inverse_mass <= 0.0) {
            return {};
        }
        return {body.inverse_mass, inverse_inertia_ws(body)};
    }

    // The element of J M^-1 J^T (J: Jacobian, M: masses) for rows x and y of one block between
    // bodies a and b.
    static double coupling(const Row& x, const Row& y, const Mobility& a, const Mobility& b) {
        return (a.inverse_mass + b.inverse_mass) * x.linear_a.dot(y.linear_a) +
               x.angular_a.dot(a.inverse_inertia_ws * y.angular_a) +
               x.angular_b.dot(b.inverse_inertia_ws * y.angular_b);
    }

    void apply(std::uint32_t index, const Mobility& mobility, const Vec3& linear,
               const Vec3& angular) const {
        SolverBody& body = island_.bodies[index];
        body.pose_ws.position += mobility.inverse_mass * linear;
        const Vec3 turn = mobility.inverse_inertia_ws * angular;
        body.pose_ws.rotation = (rotation_from_vector(turn) * body.pose_ws.rotation).normalized();
    }

    void apply(const RowBlock& block, const Row& row, double lambda, const Mobility& a,
               const Mobility& b) const {
        apply(block.a, a, lambda * row.linear_a, lambda * row.angular_a);
        apply(block.b, b, -lambda * row.linear_a, lambda * row.angular_b);
    }

    // Solves a block's equality rows together, so the result does not depend on a joint's axes.
    void solve_equations(const RowBlock& block, const Mobility& a, const Mobility& b) const {
        std::array<const Row*, k_max_rows> equations{};
        Eigen::Index count = 0;
        for (const Row& row : rows_) {
            if (!row.unilateral && count < k_max_rows) {
                equations[static_cast<std::size_t>(count++)] = &row;
            }
        }
        if (count == 0) {
            return;
        }
        BlockMatrix system(count, count);
        BlockVector values(count);
        for (Eigen::Index i = 0; i < count; ++i) {
            const Row& row = *equations[static_cast<std::size_t>(i)];
            values[i] = -row.residual;
            for (Eigen::Index j = 0; j < count; ++j) {
                system(i, j) = coupling(row, *equations[static_cast<std::size_t>(j)], a, b);
            }
        }
        system.diagonal() += 1e-12 * system.diagonal().maxCoeff() * BlockVector::Ones(count);
        const BlockVector lambda = system.ldlt().solve(values);
        if (!lambda.allFinite()) {
            return;
        }
        Vec3 linear = Vec3::Zero();
        Vec3 angular_a = Vec3::Zero();
        Vec3 angular_b = Vec3::Zero();
        for (Eigen::Index i = 0; i < count; ++i) {
            const Row& row = *equations[static_cast<std::size_t>(i)];
            linear += lambda[i] * row.linear_a;
            angular_a += lambda[i] * row.angular_a;
            angular_b += lambda[i] * row.angular_b;
        }
        apply(block.a, a, linear, angular_a);
        apply(block.b, b, -linear, angular_b);
    }

    void solve_inequalities(const RowBlock& block, const Mobility& a, const Mobility& b) const {
        for (const Row& row : rows_) {
            const double stiffness = coupling(row, row, a, b);
            if (row.unilateral && row.residual < 0.0 && stiffness > 0.0) {
                apply(block, row, -row.residual / stiffness, a, b);
            }
        }
    }

    const IslandView& island_;
    std::vector<Row>& rows_;
    std::vector<std::uint32_t> depths_;  // indexed by body
    std::vector<std::uint32_t> order_;   // indices of blocks, in the order in which they are solved
};

NewtonResult solve(const IslandView& island, const NewtonSettings& settings, SolveScratch& scratch,
                   bool shock) {
    GaussSeidel solver(island, scratch);
    NewtonResult result;
    result.residual_m = solver.residual_m();
    while (result.iterations < g_sweeps && result.residual_m >= settings.tolerance_m) {
        ++result.iterations;
        solver.pass(shock && result.iterations == g_sweeps);
        result.residual_m = solver.residual_m();
    }
    result.converged = result.residual_m < settings.tolerance_m;
    return result;
}

}  // namespace

NewtonResult solve_plain(const IslandView& island, const NewtonSettings& settings,
                         SolveScratch& scratch) {
    return solve(island, settings, scratch, false);
}

NewtonResult solve_sweep(const IslandView& island, const NewtonSettings& settings,
                         SolveScratch& scratch) {
    return solve(island, settings, scratch, true);
}

void set_sweeps(int count) { g_sweeps = count; }

}  // namespace handhold::lab
