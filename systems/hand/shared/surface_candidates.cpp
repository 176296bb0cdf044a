#include "systems/hand/shared/surface_candidates.hpp"

#include <algorithm>

#include "systems/hand/shared/finger_clearance.hpp"

namespace handhold {
namespace {

// fit_palm iterations per candidate. Few, because the best candidate is refined later.
constexpr int k_evaluation_iterations = 2;
// A first candidate with a larger sync may lie on a surface that the palm has crossed.
constexpr double k_max_direct_sync_m = 0.05;
// A cheaper surface with clearance is accepted: no candidates are listed.
constexpr double k_good_enough_cost_m = 0.02;
constexpr double k_inside_cost_m = 0.05;  // penalty for a backface inside a solid
// Penalty for a path into a solid; as much as 25 mm of palm penetration.
constexpr double k_enters_solid_cost_m = 0.3;
constexpr double k_penetration_cost = 12.0;  // cost per metre of palm penetration
constexpr double k_finger_cost = 9.0;        // cost per metre of finger penetration

}  // namespace

SurfaceCandidates::SurfaceCandidates(PalmFitter& fitter, SurfaceSearch& searcher,
                                     const PalmTuning& tuning, ChainPatch& patch)
    : fitter_(fitter), searcher_(searcher), tuning_(tuning), patch_(patch) {}

GripSurface SurfaceCandidates::run(const GripSurface& last) {
    budget_left_ = frame_budget();
    const auto near = fitter_.candidate_near_last(searcher_, last);
    if (near && last.evaluated_count > 0) {
        restore_progress(*near, last);
    } else if (near) {
        evaluate_last_surface(*near, last);
    }
    bool keeps_last = false;
    if (best_.has_clearance) {
        const auto cheapest = searcher_.cheapest_excluding({});
        keeps_last = cheapest && fitter_.is_near_last(*cheapest, best_.surface);
    }
    const bool is_done = keeps_last || evaluate_others(last);
    if (!has_best_) {
        return {};
    }
    GripSurface surface = best_.surface;
    surface.evaluated_this_frame = evaluated_this_frame_;
    const bool is_cheapest = keeps_last || (evaluated_count_ == 1 && best_.has_clearance && !near);
    surface.candidate_recheck_in_m = is_cheapest ? 0.0 : k_recheck_interval_m;
    surface.pending_finger_samples = {};
    surface.evaluated_count = surface.candidate_count = 0;
    surface.allows_backfaces = false;
    if (!is_done) {
        save_progress(surface);
    }
    return surface;
}

std::size_t SurfaceCandidates::frame_budget() const {
    return fitter_.is_unbudgeted()
               ? 2 * GripSurface::k_max_candidates
               : static_cast<std::size_t>(std::max(1, tuning_.evaluations_per_frame));
}

void SurfaceCandidates::save_progress(GripSurface& surface) const {
    surface.pending_finger_samples = pending_finger_samples_;
    surface.allows_backfaces = allows_backfaces_;
    surface.evaluated_count = static_cast<std::uint32_t>(evaluated_count_);
    surface.candidate_count = static_cast<std::uint32_t>(candidate_count_);
    for (std::size_t i = 0; i < std::max(evaluated_count_, candidate_count_); ++i) {
        surface.candidates[i] = candidates_[i].triangle;
    }
}

// Restores the progress of earlier frames for the hand's current pose. `last` is the best surface
// so far.
void SurfaceCandidates::restore_progress(const Candidate& near, const GripSurface& last) {
    best_.surface = fitter_.refine_unchecked(near, last);
    best_.surface.cost_m = last.cost_m;
    best_.surface.clearance_recheck_in_m = last.clearance_recheck_in_m;
    best_.has_clearance = last.clearance_recheck_in_m > 0.0;
    has_best_ = true;
    evaluated_count_ = last.evaluated_count;
    candidate_count_ = last.candidate_count;
    for (std::size_t i = 0; i < std::max(evaluated_count_, candidate_count_); ++i) {
        candidates_[i] = fitter_.candidate_at(last.candidates[i]);
    }
    pending_finger_samples_ = last.pending_finger_samples;
    allows_backfaces_ = last.allows_backfaces;
}

// Evaluates the surface of `last` as the first candidate. Reuses its fit unless fingers were part
// of the palm's shape.
void SurfaceCandidates::evaluate_last_surface(const Candidate& near, const GripSurface& last) {
    candidates_[evaluated_count_++] = near;
    const bool is_palm_only = last.finger_samples == FingerSamplePoses{} && last.has_fitted_wrist;
    evaluate(near, is_palm_only ? fitter_.refine_at(near, last)
                                : fitter_.fit_at(near, {}, fit_settings()));
    --budget_left_;
}

// Takes one evaluation from this frame's budget. Returns false if the budget is used up.
bool SurfaceCandidates::spend_budget() {
    if (budget_left_ == 0) {
        return false;
    }
    --budget_left_;
    return true;
}

// Evaluates candidates within the frame's budget. Returns true once no candidate is left.
bool SurfaceCandidates::evaluate_others(const GripSurface& last) {
    for (;;) {
        if (has_pending_fingers()) {
            if (!spend_budget()) {
                return false;
            }
            evaluate_with_pending_fingers(last);
        }
        const bool is_good_enough =
            best_.has_clearance && best_.surface.cost_m < k_good_enough_cost_m;
        if (evaluated_count_ > 0 && !is_listed() && !is_good_enough) {
            if (!spend_budget()) {
                return false;
            }
            list_candidates();
        }
        const auto candidate = next_candidate();
        if (!candidate) {
            return true;
        }
        if (!spend_budget()) {
            return false;
        }
        candidates_[evaluated_count_++] = *candidate;
        evaluate(*candidate, fitter_.fit_at(*candidate, {}, fit_settings()));
    }
}

// Returns the next candidate that may be better than the best one: from the list, or before the
// list is made, the cheapest triangle visited. Candidates that it skips count as evaluated.
std::optional<SurfaceCandidates::Candidate> SurfaceCandidates::next_candidate() {
    if (is_listed()) {
        while (evaluated_count_ < candidate_count_ &&
               !is_cheaper(candidates_[evaluated_count_].cost_m)) {
            ++evaluated_count_;
        }
        return evaluated_count_ < candidate_count_ ? std::optional(candidates_[evaluated_count_])
                                                   : std::nullopt;
    }
    while (!is_full()) {
        auto candidate = searcher_.cheapest_excluding(evaluated_so_far());
        if (!candidate || !is_cheaper(candidate->cost_m)) {
            return std::nullopt;
        }
        if (evaluated_count_ == 0 || is_eligible(*candidate)) {
            return candidate;
        }
        candidates_[evaluated_count_++] = *candidate;
    }
    return std::nullopt;
}

// Excludes backfaces, because a palm should not move behind a wall only because its fingers have
// clearance there. Exception: the palm may have crossed the first candidate's surface.
bool SurfaceCandidates::is_eligible(const Candidate& candidate) const {
    return !fitter_.is_backface(candidate) || (allows_backfaces_ && !fitter_.is_inside(candidate));
}

// Lists the candidates around the palm that may be better than the best one so far.
void SurfaceCandidates::list_candidates() {
    seed_from_surroundings();
    const std::size_t count =
        searcher_.append_cheapest_excluding(candidates_, evaluated_count_, best_.surface.cost_m);
    evaluated_this_frame_ = true;
    candidate_count_ = evaluated_count_;
    for (std::size_t i = evaluated_count_; i < count; ++i) {
        const Candidate& candidate = candidates_[i];
        if (is_eligible(candidate)) {
            candidates_[candidate_count_++] = candidate;
        }
    }
}

// Searches from the triangles nearest to six points around the palm. Does not stop early when it
// finds no cheaper triangle.
void SurfaceCandidates::seed_from_surroundings() {
    const double distance_m = 0.5 * tuning_.reach_m;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            const Vec3 point = fitter_.palm().center + side * distance_m * Vec3::Unit(axis);
            const auto near = fitter_.placed().mesh->search_bvh.closest_point(point, distance_m);
            searcher_.add_seed(near ? near->triangle : GripSurface::k_none);
        }
    }
    searcher_.run(SurfaceSearch::k_max_pops);
}

// Evaluates one candidate. Checks the fingers only if the cost of the palm alone is below the best
// cost, since fingers can only add cost. Fingers without clearance become pending: the candidate is
// evaluated again with these fingers as part of the palm's shape.
void SurfaceCandidates::evaluate(const Candidate& candidate, FittedPalm held) {
    const double placement_m = placement_cost_m(candidate, held);
    add_crossing_depth(placement_m, held);
    if (evaluated_count_ == 1) {
        allows_backfaces_ = fitter_.is_backface(candidate) ||
                            held.penetration_m > k_palm_penetration_tolerance_m ||
                            held.sync_m > k_max_direct_sync_m;
    }
    Evaluated result = scored(held, placement_m, 0.0);
    if (is_cheaper(result.surface.cost_m)) {
        const FingerClearance clearance =
            find_finger_clearance(fitter_.hand(), held.surface.fitted_wrist_bs, patch_);
        if (clearance.penetration_m > k_finger_penetration_tolerance_m) {
            result = scored(held, placement_m, clearance.penetration_m);
            pending_finger_samples_ = clearance.finger_samples;
        }
    }
    keep_better(result);
}

// Evaluates the last candidate again with the pending fingers as part of the palm's shape. The
// other fingers had clearance there and are not checked again.
void SurfaceCandidates::evaluate_with_pending_fingers(const GripSurface& last) {
    const Candidate& candidate = candidates_[evaluated_count_ - 1];
    PalmFitSettings from_last = fit_settings();
    if (last.triangle != GripSurface::k_none && fitter_.is_near_last(candidate, last)) {
        from_last.last = &last;
    }
    FittedPalm held = fitter_.fit_at(candidate, pending_finger_samples_, from_last);
    const double placement_m = placement_cost_m(candidate, held);
    add_crossing_depth(placement_m, held);
    Evaluated result = scored(held, placement_m, held.finger_penetration_m);
    if (is_cheaper(result.surface.cost_m)) {
        const double sample_depth_m = sample_pose_depth_m(fitter_.hand(), pending_finger_samples_,
                                                          held.surface.fitted_wrist_bs, patch_);
        result = scored(held, placement_m, std::max(held.finger_penetration_m, sample_depth_m));
    }
    keep_better(result);
    pending_finger_samples_ = {};
}

// Raises held.penetration_m to the depth of surfaces that cross the palm's capsules. The spheres
// that fit_palm uses miss thin walls, rods and rims between them. Skipped if the candidate already
// costs more than the best one.
void SurfaceCandidates::add_crossing_depth(double placement_m, FittedPalm& held) const {
    if (is_cheaper(scored(held, placement_m, held.finger_penetration_m).surface.cost_m)) {
        held.penetration_m = std::max(held.penetration_m, fitter_.crossing_depth_m(held));
    }
}

// A fit is abandoned early if its penetration alone costs more than the best candidate.
PalmFitSettings SurfaceCandidates::fit_settings() const {
    PalmFitSettings fit_settings;
    if (!fitter_.is_unbudgeted()) {
        fit_settings.max_iterations = k_evaluation_iterations;
    }
    if (has_best_) {
        fit_settings.max_penetration_m = best_.surface.cost_m / k_penetration_cost;
    }
    return fit_settings;
}

// Returns the penalty `placement` of the class comment. Only a lower bound if the candidate already
// costs more than the best one.
double SurfaceCandidates::placement_cost_m(const Candidate& candidate,
                                           const FittedPalm& held) const {
    double cost_m = 0.0;
    if (fitter_.is_backface(candidate)) {
        cost_m += tuning_.backface_cost_m + (fitter_.is_inside(candidate) ? k_inside_cost_m : 0.0);
    }
    if (is_cheaper(held.sync_m + cost_m) && fitter_.enters_solid(held)) {
        cost_m += k_enters_solid_cost_m;
    }
    return cost_m;
}

SurfaceCandidates::Evaluated SurfaceCandidates::scored(const FittedPalm& held, double placement_m,
                                                       double finger_depth_m) {
    Evaluated result = {held.surface, held.penetration_m <= k_palm_penetration_tolerance_m &&
                                          finger_depth_m <= k_finger_penetration_tolerance_m};
    result.surface.cost_m = held.sync_m + placement_m;
    if (result.has_clearance) {
        result.surface.clearance_recheck_in_m = k_recheck_interval_m;
    } else {
        result.surface.cost_m +=
            k_penetration_cost * held.penetration_m + k_finger_cost * finger_depth_m;
    }
    return result;
}

void SurfaceCandidates::keep_better(const Evaluated& candidate) {
    if (is_cheaper(candidate.surface.cost_m)) {
        best_ = candidate;
    }
    has_best_ = true;
    evaluated_this_frame_ = true;
}

}  // namespace handhold
