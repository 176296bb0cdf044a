#include "engine/geometry/simplify_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/core/parallel.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/graph_links.hpp"
#include "engine/geometry/simplify.hpp"
#include "engine/geometry/surface_distance.hpp"

namespace handhold {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr std::size_t k_smallest_part = 8;  // smaller components are kept as they are
// Each attempt locks the vertices around deviations of the last. Every fourth one also halves the
// error.
constexpr int k_max_attempts = 9;

// Components of at least k_divided_from triangles are divided into tiles of at most k_largest_tile
// triangles, which are simplified separately. A failed attempt is then repeated for one tile only,
// and a tile fits into a processor's cache. Vertices on the borders of tiles are locked.
constexpr std::size_t k_divided_from = 100000;
constexpr std::size_t k_largest_tile = 16384;

// A connected component or a tile of one, with its own list of vertices.
struct Part {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> vertex;  // vertex index in the graph
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> locked;  // vertices that must stay
};

// Number of equilateral triangles of the target size with the part's area. A source triangle counts
// as at most one.
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
// the limit everywhere.
class Locks {
  public:
    explicit Locks(const Part& part)
        : part_(part),
          bvh_(part.positions, part.triangles),
          is_locked_(part.positions.size(), false) {
        for (const std::uint32_t vertex : part.locked) {
            lock_vertex(vertex);
        }
    }

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
    // Radius of locking around a deviation, in units of the limit.
    static constexpr double k_around = 2.0;

    void lock(std::uint32_t triangle) {
        for (const std::uint32_t corner : part_.triangles[triangle]) {
            lock_vertex(corner);
        }
    }
    void lock_vertex(std::uint32_t vertex) {
        if (!is_locked_[vertex]) {
            is_locked_[vertex] = true;
            points_.push_back(vertex);
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

// Splits a graph into its connected components. Triangles keep their order.
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

// Halves a part's triangles, by their centroids along the widest axis, until tiles are small
// enough.
class TileDivider {
  public:
    explicit TileDivider(const Part& part) : part_(part), order_(part.triangles.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
    }

    std::vector<Part> divide() {
        std::vector<std::vector<std::uint32_t>> tiles;
        std::vector<std::span<std::uint32_t>> open = {order_};
        while (!open.empty()) {
            const std::span<std::uint32_t> all = open.back();
            open.pop_back();
            if (all.size() <= k_largest_tile) {
                std::ranges::sort(all);
                tiles.emplace_back(all.begin(), all.end());
                continue;
            }
            const auto half = static_cast<std::ptrdiff_t>(all.size() / 2);
            const Eigen::Index axis = widest_axis(all);
            std::ranges::nth_element(all, all.begin() + half, {}, [&](std::uint32_t triangle) {
                return std::pair(middle(triangle)[axis], triangle);
            });
            open.push_back(all.subspan(all.size() / 2));
            open.push_back(all.first(all.size() / 2));
        }
        return make_parts(tiles);
    }

  private:
    Vec3 middle(std::uint32_t triangle) const {
        const auto& [a, b, c] = part_.triangles[triangle];
        return part_.positions[a] + part_.positions[b] + part_.positions[c];
    }
    Eigen::Index widest_axis(std::span<const std::uint32_t> triangles) const {
        Vec3 low = middle(triangles[0]);
        Vec3 high = low;
        for (const std::uint32_t triangle : triangles) {
            low = low.cwiseMin(middle(triangle));
            high = high.cwiseMax(middle(triangle));
        }
        Eigen::Index axis = 0;
        (high - low).maxCoeff(&axis);
        return axis;
    }
    std::vector<Part> make_parts(const std::vector<std::vector<std::uint32_t>>& tiles) const {
        constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();
        constexpr std::uint32_t k_shared = k_none - 1;
        std::vector<std::uint32_t> tile_of(part_.positions.size(), k_none);
        for (std::uint32_t tile = 0; tile < tiles.size(); ++tile) {
            for (const std::uint32_t triangle : tiles[tile]) {
                for (const std::uint32_t corner : part_.triangles[triangle]) {
                    std::uint32_t& owner = tile_of[corner];
                    owner = owner == k_none || owner == tile ? tile : k_shared;
                }
            }
        }
        std::vector<Part> parts(tiles.size());
        std::vector<std::uint32_t> place(part_.positions.size(), k_none);
        for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
            Part& made = parts[tile];
            std::vector<std::uint32_t> used;
            for (const std::uint32_t triangle : tiles[tile]) {
                Triangle corners = part_.triangles[triangle];
                for (std::uint32_t& corner : corners) {
                    if (place[corner] == k_none) {
                        place[corner] = static_cast<std::uint32_t>(used.size());
                        used.push_back(corner);
                    }
                    corner = place[corner];
                }
                made.triangles.push_back(corners);
            }
            for (std::uint32_t i = 0; i < used.size(); ++i) {
                made.positions.push_back(part_.positions[used[i]]);
                made.vertex.push_back(part_.vertex[used[i]]);
                if (tile_of[used[i]] == k_shared) {
                    made.locked.push_back(i);
                }
                place[used[i]] = k_none;
            }
        }
        return parts;
    }

    const Part& part_;
    std::vector<std::uint32_t> order_;
};

std::vector<Part> with_tiles(std::vector<Part> parts) {
    std::vector<Part> made;
    for (Part& part : parts) {
        if (part.triangles.size() < k_divided_from) {
            made.push_back(std::move(part));
            continue;
        }
        for (Part& tile : TileDivider(part).divide()) {
            made.push_back(std::move(tile));
        }
        part = {};
    }
    return made;
}

}  // namespace

SurfaceGraph simplify_surface(const SurfaceGraph& graph, const DetailLimits& limits,
                              const TriangleBvh* graph_bvh) {
    HH_CHECK(limits.deviation_m > 0.0, "a deviation must be above 0", limits.deviation_m);
    Mesh mesh;
    {
        const std::vector<Part> parts = with_tiles(take_apart(graph));
        std::vector<std::vector<Triangle>> coarse(parts.size());
        auto simplify_one = [&](std::size_t i) {
            coarse[i] = coarser_part(parts[i], limits);
            work_meter().done += parts[i].triangles.size();
        };
        parallel_for(parts.size(), simplify_one);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            for (const auto& [a, b, c] : coarse[i]) {
                mesh.triangles.push_back(
                    {parts[i].vertex[a], parts[i].vertex[b], parts[i].vertex[c]});
            }
        }
    }
    mesh.positions = graph.positions;
    // Builds the graph without welding. This drops duplicates and triangles that collapsed onto a
    // line.
    SurfaceGraph result = build_surface_graph(mesh, {0.0, 0.0, 0.0, 0.0});
    mesh = {};
    std::optional<TriangleBvh> own_bvh;
    if (graph_bvh == nullptr) {
        graph_bvh = &own_bvh.emplace(graph.positions, graph.triangles);
    }
    auto find_source = [&](std::size_t t) {
        const auto& [a, b, c] = result.triangles[t];
        const Vec3 middle = (result.positions[a] + result.positions[b] + result.positions[c]) / 3.0;
        const auto hit = graph_bvh->closest_point(middle, std::numeric_limits<double>::infinity());
        result.source_triangle[t] = graph.source_triangle[hit->triangle];
    };
    parallel_for(result.triangles.size(), find_source);
    return result;
}

}  // namespace handhold
