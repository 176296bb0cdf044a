#include "systems/hand/shared/surface_candidates.hpp"

#include <algorithm>

#include "systems/hand/shared/finger_clearance.hpp"

namespace handhold {
namespace {

constexpr int k_evaluation_iterations = 2;    // of a palm that is taken only if it is better
constexpr double k_max_direct_sync_m = 0.05;  // of sync: a palm that comes out farther went through
constexpr double k_good_enough_cost_m = 0.02;  // with room: nothing farther is looked for
constexpr double k_inside_cost_m = 0.05;       // of a back that is seen from inside
constexpr double k_enters_solid_cost_m = 0.3;  // as of a palm that is sunk 25 mm
constexpr double k_penetration_cost = 12.0;    // of a metre that a palm stays sunk
constexpr double k_finger_cost = 9.0;          // and a finger

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

// What was tried in the frames before, where the hand is now; the best of it is near `last`.
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

// Where the palm is, by the fit that it has, if that is the palm's alone.
void SurfaceCandidates::evaluate_last_surface(const Candidate& near, const GripSurface& last) {
    candidates_[evaluated_count_++] = near;
    const bool is_alone = last.finger_samples == FingerSamplePoses{} && last.has_fitted_wrist;
    evaluate(near,
             is_alone ? fitter_.refine_at(near, last) : fitter_.fit_at(near, {}, fit_settings()));
    --budget_left_;
}

// False where the frame has none left.
bool SurfaceCandidates::spend_budget() {
    if (budget_left_ == 0) {
        return false;
    }
    --budget_left_;
    return true;
}

// As many as there are turns. True where there is none to try any more.
bool SurfaceCandidates::evaluate_others(const GripSurface& last) {
    for (;;) {
        if (has_pending_fingers()) {
            if (!spend_budget()) {
                return false;
            }
            evaluate_with_pending_fingers(last);
        }
        const bool is_near = best_.has_clearance && best_.surface.cost_m < k_good_enough_cost_m;
        if (evaluated_count_ > 0 && !is_listed() && !is_near) {
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

// The next one in the list, or else the cheapest that is left, that may be cheaper than the best;
// those passed over are done with.
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

// No backs, but where the palm may have gone through what it came to first: fingers have room
// behind walls as well, but no palm goes there for it.
bool SurfaceCandidates::is_eligible(const Candidate& candidate) const {
    return !fitter_.is_backface(candidate) || (allows_backfaces_ && !fitter_.is_inside(candidate));
}

// All around, what may be cheaper than the best.
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

// From the nearest triangles to places around the palm, as long as there is anything to see.
void SurfaceCandidates::seed_from_surroundings() {
    const double apart_m = 0.5 * tuning_.reach_m;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            const Vec3 place = fitter_.palm().center + side * apart_m * Vec3::Unit(axis);
            const auto near = fitter_.placed().mesh->search_bvh.closest_point(place, apart_m);
            searcher_.add_seed(near ? near->triangle : GripSurface::k_none);
        }
    }
    searcher_.run(SurfaceSearch::k_max_pops);
}

// Where the palm alone costs more than the best its fingers are not asked: they make it no cheaper.
// Where they have no room they are to be held clear with the palm, in their own turn.
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

// The last that was tried; the others of its fingers had room there, and mostly still have it.
void SurfaceCandidates::evaluate_with_pending_fingers(const GripSurface& last) {
    const Candidate& found = candidates_[evaluated_count_ - 1];
    PalmFitSettings from_last = fit_settings();
    if (last.triangle != GripSurface::k_none && fitter_.is_near_last(found, last)) {
        from_last.last = &last;
    }
    FittedPalm held = fitter_.fit_at(found, pending_finger_samples_, from_last);
    const double placement_m = placement_cost_m(found, held);
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

// The spheres that a palm is held by see no thin wall, no rod and no rim between them. Where it
// costs more than the best already it is not asked.
void SurfaceCandidates::add_crossing_depth(double placement_m, FittedPalm& held) const {
    if (is_cheaper(scored(held, placement_m, held.finger_penetration_m).surface.cost_m)) {
        held.penetration_m = std::max(held.penetration_m, fitter_.crossing_depth_m(held));
    }
}

// What stays sunk so deep that it is no better is given up soon.
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

// What the place costs, wherever the fingers are; less where that is dearer than the best already.
double SurfaceCandidates::placement_cost_m(const Candidate& found, const FittedPalm& held) const {
    double cost_m = 0.0;
    if (fitter_.is_backface(found)) {
        cost_m += tuning_.backface_cost_m + (fitter_.is_inside(found) ? k_inside_cost_m : 0.0);
    }
    if (is_cheaper(held.sync_m + cost_m) && fitter_.enters_solid(held)) {
        cost_m += k_enters_solid_cost_m;
    }
    return cost_m;
}

SurfaceCandidates::Evaluated SurfaceCandidates::scored(const FittedPalm& held,
                                                       double placement_cost_m, double fingers_m) {
    Evaluated result = {held.surface, held.penetration_m <= k_palm_penetration_tolerance_m &&
                                          fingers_m <= k_finger_penetration_tolerance_m};
    result.surface.cost_m = held.sync_m + placement_cost_m;
    if (result.has_clearance) {
        result.surface.clearance_recheck_in_m = k_recheck_interval_m;
    } else {
        result.surface.cost_m +=
            k_penetration_cost * held.penetration_m + k_finger_cost * fingers_m;
    }
    return result;
}

void SurfaceCandidates::keep_better(const Evaluated& scored) {
    if (is_cheaper(scored.surface.cost_m)) {
        best_ = scored;
    }
    has_best_ = true;
    evaluated_this_frame_ = true;
}

}  // namespace handhold
