#include "systems/hand/shared/surface_search.hpp"

#include <algorithm>

#include "engine/collision/closest_point.hpp"

namespace handhold {
namespace {

bool is_later(const GripSearchScratch::Node& a, const GripSearchScratch::Node& b) {
    return a.cost_m != b.cost_m ? a.cost_m > b.cost_m : a.order > b.order;
}

}  // namespace

SurfaceCandidate cost_of(const SurfaceGraph& graph, std::uint32_t triangle, const PalmPlace& palm,
                         const PalmTuning& tuning) {
    const Corners corners = corners_of(graph, triangle);
    const bool turned_away = graph.normals[triangle].dot(palm.up) < 0.0;
    const Vec3 normal = turned_away ? Vec3(-graph.normals[triangle]) : graph.normals[triangle];
    const double height_m = (palm.center - corners[0]).dot(normal);
    const Vec3 point = closest_on_triangle(palm.center - height_m * normal, corners);
    const Vec3 moved = point + std::clamp(height_m, tuning.min_height_m,
                                          std::max(tuning.min_height_m, tuning.max_height_m)) *
                                   normal;
    const double angle_rad = arc_tangent2(palm.up.cross(normal).norm(), palm.up.dot(normal));
    return {(moved - palm.center).norm() +
                tuning.tilt_cost_m_per_rad * std::max(0.0, angle_rad - tuning.max_angle_rad) +
                (turned_away ? tuning.back_cost_m : 0.0),
            point};
}

bool is_beside(const Vec3& point, const Vec3& normal, const Vec3& other, const Vec3& other_normal) {
    constexpr double k_near_m = 0.025;
    constexpr double k_alike = 0.7;
    return (point - other).squaredNorm() < k_near_m * k_near_m &&
           normal.dot(other_normal) > k_alike;
}

SurfaceSearch::SurfaceSearch(const SurfaceGraph& graph, const PalmPlace& palm,
                             const PalmTuning& tuning, GripSearchScratch& scratch)
    : graph_(graph),
      palm_(palm),
      tuning_(tuning),
      open_(scratch.open),
      seen_(scratch.seen),
      found_(scratch.found),
      unlisted_(scratch.unlisted) {
    open_.clear();
    open_.reserve(3 * k_most_pops + 16);
    found_.clear();
    found_.reserve(k_most_pops);
    unlisted_.reserve(k_most_pops);
}

void SurfaceSearch::add_seed(std::uint32_t triangle) {
    if (triangle < graph_.triangles.size()) {
        push(triangle);
    }
}

void SurfaceSearch::run(std::uint32_t patience) {
    std::uint32_t idle = 0;
    while (pops_ < k_most_pops && idle < patience && !open_.empty()) {
        ++pops_;
        std::pop_heap(open_.begin(), open_.end(), is_later);
        const GripSearchScratch::Node node = open_.back();
        open_.pop_back();
        ++idle;
        if (found_.empty() || node.cost_m < best_m_) {
            best_m_ = node.cost_m;
            idle = 0;
        }
        found_.push_back({node.triangle, node.point, node.cost_m});
        for (const std::uint32_t next : graph_.neighbours[node.triangle]) {
            if (next != k_no_triangle) {
                push(next);
            }
        }
    }
}

std::optional<SurfaceSearch::Found> SurfaceSearch::cheapest_beside(
    std::span<const Found> tried) const {
    std::optional<Found> best;
    for (const Found& found : found_) {
        const bool is_new = std::none_of(tried.begin(), tried.end(), [&](const Found& other) {
            return is_beside_of(found, other);
        });
        if (is_new && (!best || found.cost_m < best->cost_m)) {
            best = found;
        }
    }
    return best;
}

std::size_t SurfaceSearch::add_cheapest_beside(std::span<Found> tried, std::size_t count,
                                               double most_m) const {
    unlisted_.assign(found_.begin(), found_.end());
    std::erase_if(unlisted_, [&](const Found& found) { return !(found.cost_m < most_m); });
    const auto drop_beside = [&](const Found& other) {
        std::erase_if(unlisted_, [&](const Found& found) { return is_beside_of(found, other); });
    };
    for (const Found& other : tried.first(count)) {
        drop_beside(other);
    }
    while (count < tried.size() && !unlisted_.empty()) {
        tried[count] =
            *std::min_element(unlisted_.begin(), unlisted_.end(),
                              [](const Found& a, const Found& b) { return a.cost_m < b.cost_m; });
        drop_beside(tried[count]);
        ++count;
    }
    return count;
}

std::optional<SurfaceSearch::Found> SurfaceSearch::cheapest_near(
    const Vec3& other, std::uint32_t other_triangle) const {
    std::optional<Found> best;
    for (const Found& found : found_) {
        if (is_beside(found.point, graph_.normals[found.triangle], other,
                      graph_.normals[other_triangle]) &&
            (!best || found.cost_m < best->cost_m)) {
            best = found;
        }
    }
    return best;
}

bool SurfaceSearch::is_beside_of(const Found& found, const Found& other) const {
    return is_beside(found.point, graph_.normals[found.triangle], other.point,
                     graph_.normals[other.triangle]);
}

void SurfaceSearch::push(std::uint32_t triangle) {
    if (!seen_.insert(triangle)) {
        return;
    }
    const SurfaceCandidate candidate = cost_of(graph_, triangle, palm_, tuning_);
    if ((candidate.point - palm_.center).squaredNorm() > tuning_.reach_m * tuning_.reach_m) {
        return;
    }
    open_.push_back({candidate.cost_m, triangle, pushed_++, candidate.point});
    std::push_heap(open_.begin(), open_.end(), is_later);
}

}  // namespace handhold
