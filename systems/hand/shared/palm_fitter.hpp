#pragma once

#include <limits>
#include <optional>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"
#include "systems/hand/shared/palm_fit.hpp"
#include "systems/hand/shared/surface_search.hpp"

namespace handhold {

// A palm has clearance if it and its open fingers penetrate no deeper than these.
inline constexpr double k_palm_penetration_tolerance_m = 1e-3;
inline constexpr double k_finger_penetration_tolerance_m = 1.5e-3;

// A surface and the palm's fit to it.
struct FittedPalm {
    GripSurface surface;
    double penetration_m = 0.0;  // remaining penetration of the palm
    // Remaining penetration of the open fingers.
    double finger_penetration_m = 0.0;
    // Movement of the palm from its tracked pose: translation plus PalmTuning::tilt_cost_m_per_rad
    // times rotation.
    double sync_m = 0.0;
};

// Fits one hand's palm to surfaces of the hand's first mesh. search_grip uses it to evaluate
// candidates. Keeps references to its constructor arguments. Precondition: the hand has meshes.
class PalmFitter {
  public:
    using Candidate = GripSearchScratch::Candidate;

    // `wrist_bs`: the wrist at which palm() is; the tracked one, or that of an authored grip. fit()
    // always starts at the hand's tracked wrist.
    PalmFitter(const HandSurroundings& hand, const Pose& wrist_bs, const PalmTuning& tuning);

    const HandSurroundings& hand() const { return hand_; }
    const PlacedMesh& placed() const { return placed_; }
    const PalmFrame& palm() const { return palm_; }  // palm in the mesh's frame

    // Leaves GripSurface::fitted_wrist_bs unset.
    GripSurface surface_at(const Candidate& candidate) const;
    // Fits the palm; see fit_palm.
    FittedPalm fit(const Candidate& candidate,
                   double max_penetration_m = std::numeric_limits<double>::infinity()) const;

    // True if the triangle's outside faces away from the palm.
    bool is_backface(const Candidate& candidate) const;
    // For a backface: true if a palm on it would be inside a solid, that is, if a ray from the
    // triangle towards the palm first hits another triangle from inside.
    bool is_inside(const Candidate& candidate) const;
    // True if the straight path from palm() to the fitted palm enters the first mesh more often
    // than it leaves it, or crosses it more than 32 times.
    bool enters_solid(const FittedPalm& held) const;
    // True if the fitted palm is on the side of the first mesh that the player does not see, unless
    // palm() is there too and a tip of the open fingers is in sight. The side is that of palm()
    // (is_behind), or the other one if the straight path between the palms crosses the mesh an odd
    // number of times. False if the eye is unknown.
    bool is_out_of_sight(const FittedPalm& held) const;
    // Returns how deep the palm penetrates surfaces that cross the axis of one of its capsules; 0
    // if none does. For one crossing this is the capsule's radius plus the distance from the
    // crossing to the axis' nearer end. Tests the first crossing from either end, in all of the
    // hand's meshes.
    double crossing_depth_m(const FittedPalm& held) const;
    // The same for the open fingers.
    double finger_crossing_depth_m(const FittedPalm& held) const;

    // Returns the cheapest visited triangle that is a duplicate place (is_duplicate_place) of
    // `last`; none if there is none. Precondition: last.triangle is k_none or a triangle of this
    // mesh.
    std::optional<Candidate> candidate_near_last(const SurfaceSearch& searcher,
                                                 const GripSurface& last) const;

  private:
    // True if the tips of all open fingers, without the thumb, are behind the first mesh
    // (is_behind). Precondition: the eye is known.
    bool are_tips_behind(const Pose& wrist_bs) const;
    // Depth of surfaces that cross one capsule's axis.
    double crossing_depth_of(const PalmCapsule& capsule, const Pose& wrist_bs) const;

    const HandSurroundings& hand_;
    const PlacedMesh& placed_;
    PalmFrame palm_;
    const PalmTuning& tuning_;
};

}  // namespace handhold
