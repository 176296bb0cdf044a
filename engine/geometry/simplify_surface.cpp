#include "engine/geometry/simplify_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/closest_point.hpp"
#include "engine/core/check.hpp"
#include "engine/geometry/graph_links.hpp"
#include "engine/geometry/simplify.hpp"
#include "engine/geometry/surface_distance.hpp"

namespace handhold {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr std::size_t k_smallest_part = 8;  // smaller components are kept as they are
// Each attempt locks what deviated before. Every fourth one also halves the error.
constexpr int k_max_attempts = 9;

// One connected component with its own vertices.
struct Part {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> vertex;  // vertex index in the graph
    std::vector<Triangle> triangles;
};

// Number of target-size equilateral triangles with the component's area; each source triangle
// counts as one at most.
std::size_t target_count(const Part& part, double edge_m) {
    if (!(edge_m > 0.0)) {
        return 0;
    }
    const double full = std::sqrt(3.0) / 4.0 * edge_m * edge_m;
    double sum = 0.0;
    for (const auto& [a, b, c] : part.triangles) {
        const double area =
            0.5 * area_vector({part.positions[a], part.positions[b], part.positions[c]}).norm();
        sum += std::min(1.0, area / full);
    }
    return static_cast<std::size_t>(sum);
}

// Locks vertices around deviations. add_where_apart returns false if the coarse surface is within
// the limit.
class Locks {
  public:
    explicit Locks(const Part& part)
        : part_(part),
          bvh_(part.positions, part.triangles),
          is_locked_(part.positions.size(), false) {}

    const std::vector<std::uint32_t>& points() const { return points_; }

    bool add_where_apart(const std::vector<Triangle>& coarse, double limit_m) {
        const TriangleBvh coarse_bvh(part_.positions, coarse);
        const TriangleSurface fine_set = {part_.positions, part_.triangles, bvh_};
        const TriangleSurface coarse_set = {part_.positions, coarse, coarse_bvh};
        const std::vector<Uncovered> uncovered_fine = find_uncovered(fine_set, coarse_set, limit_m);
        for (const Uncovered& triangle : uncovered_fine) {
            lock(triangle.triangle);
        }
        const std::vector<Uncovered> uncovered_coarse =
            find_uncovered(coarse_set, fine_set, limit_m);
        for (const Uncovered& triangle : uncovered_coarse) {
            bvh_.visit_in_sphere(triangle.point, k_around * limit_m,
                                 [&](std::uint32_t near) { lock(near); });
        }
        return !uncovered_fine.empty() || !uncovered_coarse.empty();
    }

  private:
    static constexpr double k_around = 2.0;  // in units of the limit

    void lock(std::uint32_t triangle) {
        for (const std::uint32_t corner : part_.triangles[triangle]) {
            if (!is_locked_[corner]) {
                is_locked_[corner] = true;
                points_.push_back(corner);
            }
        }
    }

    const Part& part_;
    TriangleBvh bvh_;
    std::vector<bool> is_locked_;
    std::vector<std::uint32_t> points_;
};

std::vector<Triangle> coarser_part(const Part& part, const DetailLimits& limits) {
    const std::size_t target = target_count(part, limits.edge_m);
    if (part.triangles.size() < k_smallest_part || target >= part.triangles.size()) {
        return part.triangles;
    }
    Locks locks(part);
    double error_m = 0.5 * limits.deviation_m;
    for (int i = 0; i < k_max_attempts; ++i) {
        std::vector<Triangle> coarse =
            simplify({part.positions, part.triangles, locks.points()}, error_m, target);
        if (coarse.size() >= part.triangles.size()) {
            break;
        }
        if (!coarse.empty() && !locks.add_where_apart(coarse, limits.deviation_m)) {
            return coarse;
        }
        if (i % 4 == 3 || coarse.empty()) {
            error_m *= 0.5;
        }
    }
    return part.triangles;
}

// Splits a graph into its connected components; triangles keep their order.
std::vector<Part> take_apart(const SurfaceGraph& graph) {
    const GraphComponents numbers = find_components(graph);
    std::vector<Part> parts(numbers.count);
    for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
        parts[numbers.of_triangle[t]].triangles.push_back(graph.triangles[t]);
    }
    constexpr std::uint32_t k_unused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> place(graph.positions.size(), k_unused);
    for (Part& part : parts) {
        for (Triangle& triangle : part.triangles) {
            for (std::uint32_t& corner : triangle) {
                if (place[corner] == k_unused) {
                    place[corner] = static_cast<std::uint32_t>(part.vertex.size());
                    part.vertex.push_back(corner);
                    part.positions.push_back(graph.positions[corner]);
                }
                corner = place[corner];
            }
        }
        for (const std::uint32_t vertex : part.vertex) {
            place[vertex] = k_unused;
        }
    }
    return parts;
}

}  // namespace

SurfaceGraph simplify_surface(const SurfaceGraph& graph, const DetailLimits& limits) {
    HH_CHECK(limits.deviation_m > 0.0, "a deviation must be above 0", limits.deviation_m);
    Mesh mesh;
    mesh.positions = graph.positions;
    for (const Part& part : take_apart(graph)) {
        for (const auto& [a, b, c] : coarser_part(part, limits)) {
            mesh.triangles.push_back({part.vertex[a], part.vertex[b], part.vertex[c]});
        }
    }
    // No welding here. Triangles that collapsed onto a line or a duplicate are dropped.
    SurfaceGraph result = build_surface_graph(mesh, {0.0, 0.0, 0.0, 0.0});
    const TriangleBvh bvh(graph.positions, graph.triangles);
    for (std::size_t t = 0; t < result.triangles.size(); ++t) {
        const auto& [a, b, c] = result.triangles[t];
        const Vec3 middle = (result.positions[a] + result.positions[b] + result.positions[c]) / 3.0;
        const auto hit = bvh.closest_point(middle, std::numeric_limits<double>::infinity());
        result.source_triangle[t] = graph.source_triangle[hit->triangle];
    }
    return result;
}

}  // namespace handhold
