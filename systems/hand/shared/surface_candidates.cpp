#include "systems/hand/shared/surface_candidates.hpp"

#include <algorithm>
#include <optional>

namespace handhold {
namespace {

// The first search ends after this many pops in a row without a cheaper triangle.
constexpr std::uint32_t k_max_idle_pops = 24;
// A first candidate with a larger sync may lie on a surface that the palm has crossed.
constexpr double k_max_direct_sync_m = 0.05;
// A cheaper surface with clearance is good enough: the surroundings are not searched.
constexpr double k_good_enough_cost_m = 0.02;
constexpr double k_inside_cost_m = 0.05;  // penalty for a backface inside a solid
// Penalty for a path into a solid, or for a palm out of the player's sight; as much as 25 mm
// of palm penetration.
constexpr double k_enters_solid_cost_m = 0.3;
constexpr double k_penetration_cost = 12.0;  // cost per metre of palm penetration
constexpr double k_finger_cost = 9.0;        // cost per metre of finger penetration

}  // namespace

SurfaceCandidates::SurfaceCandidates(const PalmFitter& fitter, SurfaceSearch& search,
                                     const PalmTuning& tuning)
    : fitter_(fitter), search_(search), tuning_(tuning) {}

GripSurface SurfaceCandidates::best(const GripSurface& last) {
    search_.run(k_max_idle_pops);
    auto first = fitter_.candidate_near_last(search_, last);
    if (!first) {
        first = search_.cheapest_excluding({});
    }
    if (!first || is_beside(*first)) {
        return {};
    }
    FittedPalm held = fit(*first);
    allows_backfaces_ = fitter_.is_backface(*first) || held.sync_m > k_max_direct_sync_m ||
                        std::max(held.penetration_m, fitter_.crossing_depth_m(held)) >
                            k_palm_penetration_tolerance_m;
    evaluate(*first, held);
    if (!best_.has_clearance || best_.cost_m >= k_good_enough_cost_m) {
        search_surroundings();
    }
    std::array<Candidate, k_max_count> candidates;
    candidates[0] = *first;
    const std::size_t count = search_.append_cheapest_excluding(candidates, 1, best_.cost_m);
    for (std::size_t i = 1; i < count && is_cheaper(candidates[i].cost_m); ++i) {
        if (is_eligible(candidates[i])) {
            evaluate(candidates[i], fit(candidates[i]));
        }
    }
    return best_.is_hidden ? GripSurface{} : best_.surface;
}

// Searches from the triangles nearest to six points around the palm. Does not stop early when it
// finds no cheaper triangle.
void SurfaceCandidates::search_surroundings() {
    const double distance_m = 0.5 * tuning_.reach_m;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            const Vec3 point = fitter_.palm().center + side * distance_m * Vec3::Unit(axis);
            const auto near = fitter_.placed().mesh->search_bvh.closest_point(point, distance_m);
            search_.add_seed(near ? near->triangle : GripSurface::k_none);
        }
    }
    search_.run(SurfaceSearch::k_max_pops);
}

// True if the candidate is beside the palm, with its face to the hand's edge, as for the edge of a
// hand on a wall. A palm does not turn that far.
bool SurfaceCandidates::is_beside(const Candidate& candidate) const {
    constexpr double k_least_m = 0.03;    // nearer surfaces may have crossed the hand
    constexpr double k_most_sine = 0.26;  // 15 degrees
    const PalmFrame& palm = fitter_.palm();
    const Vec3 offset = candidate.point - palm.center;
    const Vec3& normal = fitter_.placed().mesh->search.normals[candidate.triangle];
    return offset.norm() > k_least_m && offset.dot(palm.up) > -k_most_sine * offset.norm() &&
           normal.dot(palm.up) < k_most_sine;
}

// Excludes backfaces, because a palm should not move behind a wall only because its fingers have
// clearance there. Exception: the palm may have crossed the first candidate's surface.
bool SurfaceCandidates::is_eligible(const Candidate& candidate) const {
    return !fitter_.is_backface(candidate) || (allows_backfaces_ && !fitter_.is_inside(candidate));
}

// Evaluates a candidate; `held` is its fit.
void SurfaceCandidates::evaluate(const Candidate& candidate, FittedPalm held) {
    const Placement placement = placement_of(candidate, held);
    add_crossing_depth(placement.cost_m, held);
    Evaluated evaluated = scored(held, placement.cost_m);
    evaluated.is_hidden = placement.is_hidden;
    if (is_cheaper(evaluated.cost_m)) {
        best_ = evaluated;
        has_best_ = true;
    }
}

// A fit is abandoned early if its deepest penetration, at the palm's cost, costs more than the best
// candidate.
FittedPalm SurfaceCandidates::fit(const Candidate& candidate) const {
    return has_best_ ? fitter_.fit(candidate, best_.cost_m / k_penetration_cost)
                     : fitter_.fit(candidate);
}

// Raises the penetrations of `held` to the depth of surfaces that cross the capsules of the palm
// and the open fingers. The spheres that fit_palm uses miss thin walls, rods and rims between them.
// Skipped if the candidate already costs more than the best one.
void SurfaceCandidates::add_crossing_depth(double placement_m, FittedPalm& held) const {
    if (is_cheaper(scored(held, placement_m).cost_m)) {
        held.penetration_m = std::max(held.penetration_m, fitter_.crossing_depth_m(held));
        held.finger_penetration_m =
            std::max(held.finger_penetration_m, fitter_.finger_crossing_depth_m(held));
    }
}

// Only a lower bound of the cost if the candidate already costs more than the best one.
SurfaceCandidates::Placement SurfaceCandidates::placement_of(const Candidate& candidate,
                                                             const FittedPalm& held) const {
    Placement placement;
    if (fitter_.is_backface(candidate)) {
        placement.is_hidden = fitter_.is_inside(candidate);
        placement.cost_m = tuning_.backface_cost_m + (placement.is_hidden ? k_inside_cost_m : 0.0);
    }
    if (!is_cheaper(held.sync_m + placement.cost_m)) {
        return placement;
    }
    const bool is_out_of_sight = fitter_.is_out_of_sight(held);
    placement.is_hidden |= is_out_of_sight;
    if (is_out_of_sight || fitter_.enters_solid(held)) {
        placement.cost_m += k_enters_solid_cost_m;
    }
    return placement;
}

SurfaceCandidates::Evaluated SurfaceCandidates::scored(const FittedPalm& held, double placement_m) {
    const bool has_clearance = held.penetration_m <= k_palm_penetration_tolerance_m &&
                               held.finger_penetration_m <= k_finger_penetration_tolerance_m;
    const double depth_cost_m = has_clearance ? 0.0
                                              : k_penetration_cost * held.penetration_m +
                                                    k_finger_cost * held.finger_penetration_m;
    return {held.surface, held.sync_m + placement_m + depth_cost_m, has_clearance};
}

}  // namespace handhold
