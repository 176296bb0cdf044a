#include "engine/geometry/weld.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/core/check.hpp"
#include "engine/core/hash.hpp"

namespace handhold {
namespace {

constexpr std::uint32_t k_no_vertex = std::numeric_limits<std::uint32_t>::max();
// Cell size in units of the longest reach. It is large so that few points have to query
// neighbouring cells.
constexpr double k_cell_per_reach = 8.0;

// Lists of points by hashed grid cell. Cells with equal hashes share a list, so callers must check
// distances.
class CellLists {
  public:
    CellLists(std::size_t points, double cell_m)
        : per_cell_(1.0 / cell_m),
          mask_(std::bit_ceil(2 * points + 1) - 1),
          heads_(mask_ + 1, k_no_vertex),
          next_(points, k_no_vertex) {}

    void add(std::uint32_t index, const Vec3& point) {
        std::uint32_t& head = heads_[slot(cell(point.x()), cell(point.y()), cell(point.z()))];
        next_[index] = head;
        head = index;
    }
    // Calls visit(index) for every point in the cells that the ball touches. May visit a point
    // twice.
    template <typename Visit>
    void near(const Vec3& point, double reach_m, const Visit& visit) const {
        const Vec3 low = point - Vec3::Constant(reach_m);
        const Vec3 high = point + Vec3::Constant(reach_m);
        for (double x = cell(low.x()); x <= cell(high.x()); x += 1.0) {
            for (double y = cell(low.y()); y <= cell(high.y()); y += 1.0) {
                for (double z = cell(low.z()); z <= cell(high.z()); z += 1.0) {
                    for (std::uint32_t i = heads_[slot(x, y, z)]; i != k_no_vertex; i = next_[i]) {
                        visit(i);
                    }
                }
            }
        }
    }

  private:
    double cell(double coordinate) const { return std::floor(coordinate * per_cell_); }
    std::size_t slot(double x, double y, double z) const {
        // Adding 0.0 turns -0.0 into 0.0, so that both are one cell.
        const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value + 0.0); };
        return mix64(mix64(mix64(bits(x)) + bits(y)) + bits(z)) & mask_;
    }

    double per_cell_;
    std::size_t mask_;
    std::vector<std::uint32_t> heads_;
    std::vector<std::uint32_t> next_;
};

}  // namespace

std::vector<std::uint32_t> find_representatives(std::span<const Vec3> points,
                                                std::span<const double> reaches_m) {
    HH_CHECK(points.size() == reaches_m.size(), "a reach for each point", reaches_m.size());
    double longest_m = 1e-9;
    double farthest_m = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (is_finite(points[i]) && reaches_m[i] >= 0.0) {
            longest_m = std::max(longest_m, reaches_m[i]);
            farthest_m = std::max(farthest_m, points[i].cwiseAbs().maxCoeff());
        }
    }
    // The lower bound on the cell size keeps cell indices small enough to be exact in a double.
    const double cell_m = std::max(k_cell_per_reach * longest_m, farthest_m * 0x1p-48);
    CellLists cells(points.size(), cell_m);
    std::vector<std::uint32_t> result(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        result[i] = i;
        if (!is_finite(points[i]) || !(reaches_m[i] >= 0.0)) {
            continue;
        }
        double nearest = std::numeric_limits<double>::infinity();
        cells.near(points[i], reaches_m[i], [&](std::uint32_t other) {
            const double squared = (points[other] - points[i]).squaredNorm();
            const double reach = std::min(reaches_m[i], reaches_m[other]);
            if (squared <= reach * reach &&
                (squared < nearest || (squared == nearest && other < result[i]))) {
                nearest = squared;
                result[i] = other;
            }
        });
        if (result[i] == i) {
            cells.add(i, points[i]);
        }
    }
    return result;
}

}  // namespace handhold
