#pragma once

#include <array>
#include <cstddef>

#include "components/hand.hpp"
#include "components/tuning.hpp"
#include "systems/hand/shared/palm_fitter.hpp"
#include "systems/hand/shared/surface_search.hpp"

namespace handhold {

// Evaluates candidate surfaces for one palm. This is step 2 of search_grip.
//
// Chooses the candidate with the smallest full cost:
//   cost = sync + placement
//        + (without clearance) 12 * palm penetration + 9 * finger penetration
// sync is the movement of the fitted, depenetrated palm (FittedPalm::sync_m). placement is the sum
// of the penalties for backfaces, for palms inside a solid or out of the player's sight, and for
// paths into a solid. A palm has clearance if it and its open fingers penetrate no deeper than the
// tolerances of palm_fitter.hpp. Candidates are evaluated in the order of their closed-form costs
// (cost_of), which rarely exceed the full costs, as long as the closed-form cost is below the best
// full cost.
//
// Keeps references to its constructor arguments.
class SurfaceCandidates {
  public:
    static constexpr std::size_t k_max_count = 14;  // maximum number of evaluated candidates

    SurfaceCandidates(const PalmFitter& fitter, SurfaceSearch& search, const PalmTuning& tuning);

    // Returns the best surface; call once. The first candidate is the place of `last` if the search
    // visits it, else the triangle with the smallest closed-form cost. The result's triangle is
    // k_none if there is no surface within reach, or if a palm on the best one would be hidden (see
    // Placement). Precondition: last.triangle is k_none or a triangle of this mesh.
    GripSurface best(const GripSurface& last);

  private:
    using Candidate = SurfaceSearch::Candidate;
    struct Evaluated {
        GripSurface surface;
        double cost_m = 0.0;
        bool has_clearance = false;
        bool is_hidden = false;  // see Placement
    };
    // The penalty `placement` of the class comment.
    struct Placement {
        double cost_m = 0.0;
        // A palm here would be inside a solid or out of sight (PalmFitter::is_out_of_sight).
        bool is_hidden = false;
    };

    void search_surroundings();
    void evaluate(const Candidate& candidate, FittedPalm held);
    bool is_beside(const Candidate& candidate) const;
    bool is_eligible(const Candidate& candidate) const;
    FittedPalm fit(const Candidate& candidate) const;
    Placement placement_of(const Candidate& candidate, const FittedPalm& held) const;
    void add_crossing_depth(double placement_m, FittedPalm& held) const;
    static Evaluated scored(const FittedPalm& held, double placement_m);
    bool is_cheaper(double cost_m) const { return !has_best_ || cost_m < best_.cost_m; }

    const PalmFitter& fitter_;
    SurfaceSearch& search_;
    const PalmTuning& tuning_;
    Evaluated best_;
    bool has_best_ = false;
    // True if the palm may have crossed the first candidate's surface: backfaces are evaluated too.
    bool allows_backfaces_ = false;
};

}  // namespace handhold
