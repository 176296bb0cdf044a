#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "components/hand.hpp"
#include "components/tuning.hpp"
#include "systems/hand/shared/palm_fitter.hpp"
#include "systems/hand/shared/surface_search.hpp"

namespace handhold {

// Travel of the hand after which the clearance and the choice among candidates are checked again.
inline constexpr double k_recheck_interval_m = 0.016;

// Evaluates candidate surfaces for one palm, a few per frame. This is step 2 of search_grip.
//
// Chooses the candidate with the smallest full cost:
//   cost = sync + placement
//        + (without clearance) 12 * palm penetration + 9 * finger penetration
// sync is the movement of the fitted, depenetrated palm (FittedPalm::sync_m). placement is a
// penalty for backfaces and for palms inside a solid. Candidates are evaluated in the order of
// their closed-form costs (cost_of), which rarely exceed the full costs. The evaluation ends when
// the next closed-form cost is not below the best full cost.
//
// Keeps references to its constructor arguments; `patch` is scratch.
class SurfaceCandidates {
  public:
    SurfaceCandidates(PalmFitter& fitter, SurfaceSearch& searcher, const PalmTuning& tuning,
                      ChainPatch& patch);

    // Runs one frame's share of the search; call once. Resumes the search whose progress is stored
    // in `last`, or starts a new one with the surface of `last` as the first candidate. Returns the
    // best surface so far, with the search's progress. Its triangle is k_none if no surface was
    // found. Precondition: last.triangle is k_none or a triangle of this mesh.
    GripSurface run(const GripSurface& last);

  private:
    using Candidate = SurfaceSearch::Candidate;
    struct Evaluated {
        GripSurface surface;
        bool has_clearance = false;
    };

    std::size_t frame_budget() const;
    void restore_progress(const Candidate& near, const GripSurface& last);
    void evaluate_last_surface(const Candidate& near, const GripSurface& last);
    bool evaluate_others(const GripSurface& last);
    bool spend_budget();
    std::optional<Candidate> next_candidate();
    bool is_eligible(const Candidate& candidate) const;
    void list_candidates();
    void seed_from_surroundings();
    void evaluate(const Candidate& candidate, FittedPalm held);
    void evaluate_with_pending_fingers(const GripSurface& last);
    void add_crossing_depth(double placement_m, FittedPalm& held) const;
    double placement_cost_m(const Candidate& candidate, const FittedPalm& held) const;
    static Evaluated scored(const FittedPalm& held, double placement_m, double finger_depth_m);
    void keep_better(const Evaluated& candidate);
    PalmFitSettings fit_settings() const;
    void save_progress(GripSurface& surface) const;

    bool has_pending_fingers() const { return pending_finger_samples_ != FingerSamplePoses{}; }
    bool is_full() const { return evaluated_count_ == candidates_.size(); }
    bool is_listed() const { return candidate_count_ > 0; }
    std::span<const Candidate> evaluated_so_far() const {
        return {candidates_.data(), evaluated_count_};
    }
    bool is_cheaper(double cost_m) const { return !has_best_ || cost_m < best_.surface.cost_m; }

    PalmFitter& fitter_;
    SurfaceSearch& searcher_;
    const PalmTuning& tuning_;
    ChainPatch& patch_;

    // [0, evaluated_count_): evaluated or skipped. [evaluated_count_, candidate_count_): still to
    // be evaluated, cheapest first.
    std::array<Candidate, GripSurface::k_max_candidates> candidates_;
    std::size_t evaluated_count_ = 0;
    std::size_t candidate_count_ = 0;  // 0: the candidates are not listed yet
    Evaluated best_;
    bool has_best_ = false;
    bool evaluated_this_frame_ = false;
    FingerSamplePoses pending_finger_samples_ = {};  // GripSurface::pending_finger_samples
    bool allows_backfaces_ = false;                  // GripSurface::allows_backfaces
    std::size_t budget_left_ = 0;                    // evaluations left in this frame
};

}  // namespace handhold
