#include "engine/geometry/hull_builder.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace handhold {
namespace {

// Tolerance relative to the hull's size. It is far above rounding errors, so that every triangle
// has a normal and every point is on a definite side. It is far below anything visible.
constexpr double k_flat = 1e-6;

}  // namespace

HullBuilder::Plane HullBuilder::plane_through(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = (b - a).cross(c - a).normalized();
    return {normal, normal.dot(a)};
}

std::optional<ConvexHull> HullBuilder::build() {
    if (!start()) {
        return std::nullopt;
    }
    std::size_t corners = 4;
    for (Index face = outermost(); face != k_none; face = outermost()) {
        if (corners == k_max_hull_corners) {
            break;
        }
        corners += add_point(face) ? 1U : 0U;
    }
    return collect();
}

bool HullBuilder::start() {
    Vec3 low = points_.front();
    Vec3 high = low;
    for (const Vec3& point : points_) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    flat_m_ = k_flat * (high - low).norm();
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const Index a = farthest_by([&](const Vec3& p) { return high[axis] - p[axis]; }).first;
    const Index b = farthest_by([&](const Vec3& p) { return (p - points_[a]).norm(); }).first;
    const Vec3 along = (points_[b] - points_[a]).normalized();
    const auto [c, width_m] =
        farthest_by([&](const Vec3& p) { return along.cross(p - points_[a]).norm(); });
    if (!(width_m > flat_m_)) {
        return false;
    }
    const Plane plane = plane_through(points_[a], points_[b], points_[c]);
    const auto [d, height_m] =
        farthest_by([&](const Vec3& p) { return std::abs(plane.height(p)); });
    if (!(height_m > flat_m_)) {
        return false;
    }
    const bool above = plane.height(points_[d]) > 0.0;
    const std::array<Index, 4> v = {a, above ? c : b, above ? b : c, d};
    add_triangle(v[0], v[1], v[2]);
    add_triangle(v[0], v[3], v[1]);
    add_triangle(v[1], v[3], v[2]);
    add_triangle(v[2], v[3], v[0]);
    triangles_[0].neighbour = {1, 2, 3};
    triangles_[1].neighbour = {3, 2, 0};
    triangles_[2].neighbour = {1, 3, 0};
    triangles_[3].neighbour = {2, 1, 0};
    std::vector<Index> all(points_.size());
    for (Index i = 0; i < all.size(); ++i) {
        all[i] = i;
    }
    assign(all, 0);
    return true;
}

HullBuilder::Index HullBuilder::add_triangle(Index a, Index b, Index c) {
    Triangle triangle;
    triangle.corner = {a, b, c};
    triangle.plane = plane_through(points_[a], points_[b], points_[c]);
    triangles_.push_back(std::move(triangle));
    return static_cast<Index>(triangles_.size() - 1);
}

// Appends each point to the list of the triangle that it is farthest outside of, among the
// triangles from first_triangle on.
void HullBuilder::assign(std::span<const Index> candidates, Index first_triangle) {
    for (const Index point : candidates) {
        Index best_triangle = k_none;
        double max_height_m = flat_m_;
        for (Index i = first_triangle; i < triangles_.size(); ++i) {
            if (const double height = triangles_[i].plane.height(points_[point]);
                height > max_height_m) {
                max_height_m = height;
                best_triangle = i;
            }
        }
        if (best_triangle == k_none) {
            continue;  // inside the hull
        }
        Triangle& triangle = triangles_[best_triangle];
        triangle.outside.push_back(point);
        if (max_height_m > triangle.farthest_m) {
            triangle.farthest_m = max_height_m;
            triangle.farthest = point;
        }
    }
}

HullBuilder::Index HullBuilder::outermost() const {
    Index best_triangle = k_none;
    double max_height_m = 0.0;
    for (Index i = 0; i < triangles_.size(); ++i) {
        if (!triangles_[i].gone && triangles_[i].farthest_m > max_height_m) {
            max_height_m = triangles_[i].farthest_m;
            best_triangle = i;
        }
    }
    return best_triangle;
}

bool HullBuilder::add_point(Index face) {
    const Index point = triangles_[face].farthest;
    find_visible(face, points_[point]);
    if (!order_horizon()) {
        forget_farthest(triangles_[face]);
        return false;
    }
    add_cone(point);
    return true;
}

void HullBuilder::forget_farthest(Triangle& triangle) const {
    std::erase(triangle.outside, triangle.farthest);
    triangle.farthest = k_none;
    triangle.farthest_m = 0.0;
    for (const Index point : triangle.outside) {
        if (const double height = triangle.plane.height(points_[point]);
            height > triangle.farthest_m) {
            triangle.farthest_m = height;
            triangle.farthest = point;
        }
    }
}

// Finds all triangles that the point sees, and the boundary edges of that region (the horizon).
void HullBuilder::find_visible(Index face, const Vec3& point) {
    visible_ = {face};
    horizon_.clear();
    for (std::size_t i = 0; i < visible_.size(); ++i) {
        const Triangle& triangle = triangles_[visible_[i]];
        for (std::size_t k = 0; k < 3; ++k) {
            const Index beyond = triangle.neighbour[k];
            if (triangles_[beyond].plane.height(point) <= flat_m_) {
                horizon_.push_back({triangle.corner[k], triangle.corner[(k + 1) % 3], beyond});
            } else if (std::find(visible_.begin(), visible_.end(), beyond) == visible_.end()) {
                visible_.push_back(beyond);
            }
        }
    }
}

// Sorts the horizon's edges into a loop. False if they do not form one loop.
bool HullBuilder::order_horizon() {
    for (std::size_t i = 0; i + 1 < horizon_.size(); ++i) {
        const Index to = horizon_[i].to;
        const auto rest = horizon_.begin() + static_cast<std::ptrdiff_t>(i) + 1;
        const auto next =
            std::find_if(rest, horizon_.end(), [to](const Edge& e) { return e.from == to; });
        if (next == horizon_.end()) {
            return false;
        }
        std::iter_swap(rest, next);
    }
    return horizon_.size() >= 3 && horizon_.back().to == horizon_.front().from;
}

// Replaces the visible triangles by triangles that connect the horizon to the point.
void HullBuilder::add_cone(Index point) {
    const auto first = static_cast<Index>(triangles_.size());
    const auto count = static_cast<Index>(horizon_.size());
    for (Index i = 0; i < count; ++i) {
        const Edge& edge = horizon_[i];
        add_triangle(edge.from, edge.to, point);
        triangles_.back().neighbour = {edge.beyond, first + (i + 1) % count,
                                       first + (i + count - 1) % count};
        Triangle& beyond = triangles_[edge.beyond];
        for (std::size_t k = 0; k < 3; ++k) {
            if (beyond.corner[k] == edge.to && beyond.corner[(k + 1) % 3] == edge.from) {
                beyond.neighbour[k] = first + i;
            }
        }
    }
    for (const Index gone : visible_) {
        triangles_[gone].gone = true;
        triangles_[gone].farthest_m = 0.0;
        const std::vector<Index> candidates = std::exchange(triangles_[gone].outside, {});
        assign(candidates, first);
    }
}

// The triangles in the seed's plane that are connected to the seed.
std::vector<HullBuilder::Index> HullBuilder::flat_group(Index seed,
                                                        std::vector<bool>& taken) const {
    constexpr double k_same_side = 0.99;
    const Plane& plane = triangles_[seed].plane;
    std::vector<Index> group = {seed};
    taken[seed] = true;
    for (std::size_t i = 0; i < group.size(); ++i) {
        for (const Index other : triangles_[group[i]].neighbour) {
            const Triangle& triangle = triangles_[other];
            const bool flat = std::all_of(
                triangle.corner.begin(), triangle.corner.end(),
                [&](Index c) { return std::abs(plane.height(points_[c])) <= 2.0 * flat_m_; });
            if (!taken[other] && flat && triangle.plane.normal.dot(plane.normal) > k_same_side) {
                taken[other] = true;
                group.push_back(other);
            }
        }
    }
    return group;
}

// Boundary of a group of triangles; empty if the boundary is not a single loop.
std::vector<HullBuilder::Index> HullBuilder::outline(const std::vector<Index>& group) const {
    std::vector<Edge> edges;
    for (const Index i : group) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Index beyond = triangles_[i].neighbour[k];
            if (std::find(group.begin(), group.end(), beyond) == group.end()) {
                edges.push_back({triangles_[i].corner[k], triangles_[i].corner[(k + 1) % 3], 0});
            }
        }
    }
    std::vector<Index> loop;
    Index at = edges.front().from;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto next =
            std::find_if(edges.begin(), edges.end(), [at](const Edge& e) { return e.from == at; });
        if (next == edges.end() || std::find(loop.begin(), loop.end(), at) != loop.end()) {
            return {};
        }
        loop.push_back(at);
        at = next->to;
    }
    return loop;
}

std::vector<HullFace> HullBuilder::flat_faces() const {
    std::vector<Index> by_area;
    for (Index i = 0; i < triangles_.size(); ++i) {
        if (!triangles_[i].gone) {
            by_area.push_back(i);
        }
    }
    const auto area = [&](Index i) {
        const auto& [a, b, c] = triangles_[i].corner;
        return (points_[b] - points_[a]).cross(points_[c] - points_[a]).norm();
    };
    std::stable_sort(by_area.begin(), by_area.end(),
                     [&](Index i, Index j) { return area(i) > area(j); });
    std::vector<HullFace> faces;
    std::vector<bool> taken(triangles_.size(), false);
    for (const Index seed : by_area) {
        if (taken[seed]) {
            continue;
        }
        const std::vector<Index> group = flat_group(seed, taken);
        std::vector<Index> loop = outline(group);
        if (!loop.empty()) {
            faces.push_back({std::move(loop), triangles_[seed].plane.normal, 0.0});
            continue;
        }
        for (const Index i : group) {
            const auto& corner = triangles_[i].corner;
            faces.push_back({{corner.begin(), corner.end()}, triangles_[i].plane.normal, 0.0});
        }
    }
    return faces;
}

// Removes corners that only two faces share: they lie inside an edge. Such a corner may come from
// the initial tetrahedron.
void HullBuilder::drop_edge_points(std::vector<HullFace>& faces) {
    std::map<Index, std::vector<HullFace*>> around;
    for (HullFace& face : faces) {
        for (const Index corner : face.loop) {
            around[corner].push_back(&face);
        }
    }
    for (const auto& [corner, both] : around) {
        if (both.size() == 2 && both[0]->loop.size() > 3 && both[1]->loop.size() > 3) {
            std::erase(both[0]->loop, corner);
            std::erase(both[1]->loop, corner);
        }
    }
}

ConvexHull HullBuilder::collect() const {
    ConvexHull hull;
    hull.faces = flat_faces();
    drop_edge_points(hull.faces);
    // Keeps only used corners, numbered in sorted order.
    std::vector<Index> number(points_.size(), k_none);
    for (const HullFace& face : hull.faces) {
        for (const Index corner : face.loop) {
            number[corner] = 0;
        }
    }
    for (Index i = 0; i < points_.size(); ++i) {
        if (number[i] != k_none) {
            number[i] = static_cast<Index>(hull.corners.size());
            hull.corners.push_back(points_[i]);
        }
    }
    for (HullFace& face : hull.faces) {
        for (Index& corner : face.loop) {
            corner = number[corner];
        }
    }
    hull = moved_hull(hull, {});
    for (const HullFace& face : hull.faces) {
        for (const Vec3& point : points_) {
            hull.omitted_m = std::max(hull.omitted_m, face.normal.dot(point) - face.offset_m);
        }
    }
    return hull;
}

}  // namespace handhold
