#include "systems/hand/shared/surface_search.hpp"

#include <algorithm>

#include "engine/geometry/closest_point.hpp"

namespace handhold {
namespace {

bool is_later(const GripSearchScratch::Node& a, const GripSearchScratch::Node& b) {
    return a.cost_m != b.cost_m ? a.cost_m > b.cost_m : a.order > b.order;
}

}  // namespace

PalmCost cost_of(const SurfaceGraph& graph, std::uint32_t triangle, const PalmFrame& palm,
                 const PalmTuning& tuning) {
    const Corners corners = corners_of(graph, triangle);
    const bool is_backface = graph.normals[triangle].dot(palm.up) < 0.0;
    const Vec3 normal = is_backface ? Vec3(-graph.normals[triangle]) : graph.normals[triangle];
    const double height_m = (palm.center - corners[0]).dot(normal);
    const Vec3 point = closest_on_triangle(palm.center - height_m * normal, corners);
    const Vec3 moved_center =
        point + std::clamp(height_m, tuning.min_height_m,
                           std::max(tuning.min_height_m, tuning.max_height_m)) *
                    normal;
    const double angle_rad = arc_tangent2(palm.up.cross(normal).norm(), palm.up.dot(normal));
    return {(moved_center - palm.center).norm() +
                tuning.tilt_cost_m_per_rad * std::max(0.0, angle_rad - tuning.max_angle_rad) +
                (is_backface ? tuning.backface_cost_m : 0.0),
            point};
}

bool is_duplicate_place(const Vec3& point, const Vec3& normal, const Vec3& other,
                        const Vec3& other_normal) {
    return (point - other).squaredNorm() < k_duplicate_place_m * k_duplicate_place_m &&
           normal.dot(other_normal) > k_duplicate_place_cosine;
}

SurfaceSearch::SurfaceSearch(const SurfaceGraph& graph, const PalmFrame& palm,
                             const PalmTuning& tuning, GripSearchScratch& scratch)
    : graph_(graph),
      palm_(palm),
      tuning_(tuning),
      open_(scratch.open),
      seen_(scratch.seen),
      visited_(scratch.found),
      remaining_(scratch.remaining) {
    open_.clear();
    open_.reserve(3 * k_max_pops + 16);
    visited_.clear();
    visited_.reserve(k_max_pops);
    remaining_.reserve(k_max_pops);
}

void SurfaceSearch::add_seed(std::uint32_t triangle) {
    if (triangle < graph_.triangles.size()) {
        push(triangle);
    }
}

void SurfaceSearch::run(std::uint32_t max_idle_pops) {
    std::uint32_t idle_pops = 0;
    while (pops_ < k_max_pops && idle_pops < max_idle_pops && !open_.empty()) {
        ++pops_;
        std::pop_heap(open_.begin(), open_.end(), is_later);
        const GripSearchScratch::Node node = open_.back();
        open_.pop_back();
        ++idle_pops;
        if (node.cost_m < best_m_) {
            best_m_ = node.cost_m;
            idle_pops = 0;
        }
        if (!is_behind(node)) {
            visited_.push_back({node.triangle, node.point, node.cost_m});
        }
        for (const std::uint32_t next : graph_.neighbours[node.triangle]) {
            if (next != k_no_triangle) {
                push(next);
            }
        }
    }
}

std::optional<SurfaceSearch::Candidate> SurfaceSearch::cheapest_excluding(
    std::span<const Candidate> excluded) const {
    std::optional<Candidate> best;
    for (const Candidate& found : visited_) {
        const bool is_new =
            std::none_of(excluded.begin(), excluded.end(),
                         [&](const Candidate& other) { return is_duplicate_of(found, other); });
        if (is_new && (!best || found.cost_m < best->cost_m)) {
            best = found;
        }
    }
    return best;
}

std::size_t SurfaceSearch::append_cheapest_excluding(std::span<Candidate> candidates,
                                                     std::size_t count, double max_cost_m) const {
    remaining_.assign(visited_.begin(), visited_.end());
    std::erase_if(remaining_, [&](const Candidate& found) { return !(found.cost_m < max_cost_m); });
    const auto drop_duplicates_of = [&](const Candidate& other) {
        std::erase_if(remaining_,
                      [&](const Candidate& found) { return is_duplicate_of(found, other); });
    };
    for (const Candidate& other : candidates.first(count)) {
        drop_duplicates_of(other);
    }
    while (count < candidates.size() && !remaining_.empty()) {
        candidates[count] = *std::min_element(
            remaining_.begin(), remaining_.end(),
            [](const Candidate& a, const Candidate& b) { return a.cost_m < b.cost_m; });
        drop_duplicates_of(candidates[count]);
        ++count;
    }
    return count;
}

std::optional<SurfaceSearch::Candidate> SurfaceSearch::cheapest_near(
    const Vec3& other, std::uint32_t other_triangle) const {
    std::optional<Candidate> best;
    for (const Candidate& found : visited_) {
        if (is_duplicate_place(found.point, graph_.normals[found.triangle], other,
                               graph_.normals[other_triangle]) &&
            (!best || found.cost_m < best->cost_m)) {
            best = found;
        }
    }
    return best;
}

bool SurfaceSearch::is_duplicate_of(const Candidate& found, const Candidate& other) const {
    return is_duplicate_place(found.point, graph_.normals[found.triangle], other.point,
                              graph_.normals[other.triangle]);
}

bool SurfaceSearch::is_behind(const GripSearchScratch::Node& node) const {
    constexpr double k_behind_m = 0.03;  // the thickness of a hand: nearer surfaces were crossed
    return graph_.normals[node.triangle].dot(palm_.up) < 0.0 &&
           (node.point - palm_.center).dot(palm_.up) > k_behind_m;
}

void SurfaceSearch::push(std::uint32_t triangle) {
    if (!seen_.insert(triangle)) {
        return;
    }
    const PalmCost candidate = cost_of(graph_, triangle, palm_, tuning_);
    if ((candidate.point - palm_.center).squaredNorm() > tuning_.reach_m * tuning_.reach_m) {
        return;
    }
    open_.push_back({candidate.cost_m, triangle, pushed_++, candidate.point});
    std::push_heap(open_.begin(), open_.end(), is_later);
}

}  // namespace handhold
