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

// A hand goes so far before it looks again for room, or for another surface.
inline constexpr double k_recheck_interval_m = 0.016;

// Tries surfaces for one palm, a few in each frame: search_grip's choice among what it found.
//
// The surface is the one where what it takes to hold the palm there is least, pushes out of what it
// is sunk in included; where palm or fingers have no room, so is what stays sunk. They are tried in
// the order of their costs in closed form, which are rarely more, until those are. Refers to all
// that it is made of; the patch is only worked in.
class SurfaceCandidates {
  public:
    SurfaceCandidates(PalmFitter& fitter, SurfaceSearch& searcher, const PalmTuning& tuning,
                      ChainPatch& patch);

    // Once. Goes on from where `last` came to, or begins with where that is; the state of the
    // search is in what it returns. No triangle: nothing was found. Precondition: a `last` that has
    // a triangle has one of this mesh.
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
    double placement_cost_m(const Candidate& found, const FittedPalm& held) const;
    static Evaluated scored(const FittedPalm& held, double placement_cost_m, double fingers_m);
    void keep_better(const Evaluated& scored);
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

    // Those that were tried or passed over, then those that are to be tried, the cheapest first,
    // once they are listed.
    std::array<Candidate, GripSurface::k_max_candidates> candidates_;
    std::size_t evaluated_count_ = 0;
    std::size_t candidate_count_ = 0;  // with those to be tried; 0: not listed
    Evaluated best_;
    bool has_best_ = false;
    bool evaluated_this_frame_ = false;  // in this frame
    FingerSamplePoses pending_finger_samples_ =
        {};                          // at the last of those tried, which is to be judged so as well
    bool allows_backfaces_ = false;  // GripSurface::goes_through
    std::size_t budget_left_ = 0;    // in this frame
};

}  // namespace handhold
