#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"
#include "systems/hand/shared/palm_fit.hpp"
#include "systems/hand/shared/surface_search.hpp"

namespace handhold {

// A palm has clearance if it penetrates no deeper than this.
inline constexpr double k_palm_penetration_tolerance_m = 1e-3;

// A surface with the palm fitted to it, without a lift.
struct FittedPalm {
    GripSurface surface;
    double penetration_m = 0.0;         // remaining penetration of the palm
    double finger_penetration_m = 0.0;  // of the fingers that are part of its collision shape
    // Movement of the palm from its tracked pose: metres plus PalmTuning::tilt_cost_m_per_rad per
    // radian.
    double sync_m = 0.0;
    bool is_warm_started = false;  // started from last frame's fit
};

// Fits one hand's palm to surfaces of its first mesh, within one frame; used by search_grip to
// evaluate candidates. Keeps references to its constructor arguments. Precondition: the hand has
// meshes.
class PalmFitter {
  public:
    using Candidate = GripSearchScratch::Candidate;

    // For the palm of a wrist at `wrist_bs`. dt_s is the length of the frame; infinity: no limit on
    // iterations.
    PalmFitter(const HandSurroundings& hand, const Pose& wrist_bs, double dt_s,
               const PalmTuning& tuning);

    const HandSurroundings& hand() const { return hand_; }
    const PlacedMesh& placed() const { return placed_; }
    const PalmFrame& palm() const { return palm_; }  // in the mesh's frame
    bool is_unbudgeted() const;                      // dt_s is infinite

    // From now on surface_at() uses this mean normal instead of computing one, for surfaces that
    // face a similar way. None: computes it.
    void reuse_normal(const std::optional<Vec3>& normal_bs) { reused_normal_bs_ = normal_bs; }

    GripSurface surface_at(const Candidate& candidate) const;
    // The candidate of a triangle for the present palm. The triangle may be from an older mesh.
    Candidate candidate_at(std::uint32_t triangle) const;

    // Fits the palm, with the fingers of `finger_samples` as part of its shape. The first few fits
    // are cached, because they are requested again.
    FittedPalm fit_at(const Candidate& candidate, const FingerSamplePoses& finger_samples,
                      const PalmFitSettings& settings);
    // Continues the fit of `last` at its place, with the same fingers.
    FittedPalm refine_at(const Candidate& candidate, const GripSurface& last);
    // As refine_at, but does not query the surfaces at the resulting pose.
    GripSurface refine_unchecked(const Candidate& candidate, const GripSurface& last) const;

    // The triangle's outside faces away from the palm.
    bool is_backface(const Candidate& candidate) const;
    // For a backface: a palm held to it would be inside a solid, because a ray from it towards the
    // palm first hits a triangle from inside.
    bool is_inside(const Candidate& candidate) const;
    // True if the straight path from the tracked palm to the fitted one enters the mesh more often
    // than it leaves it.
    bool enters_solid(const FittedPalm& held) const;
    // Depth of surfaces of any of the hand's meshes that cross the axis of a palm capsule: its
    // radius plus the distance from the crossing to the nearer end. Considers the first crossing
    // from either end; 0: none.
    double crossing_depth_m(const FittedPalm& held) const;

    // Precondition of both: last.triangle is k_none or a triangle of this mesh.
    bool is_near_last(const Candidate& candidate, const GripSurface& last) const;
    std::optional<Candidate> candidate_near_last(const SurfaceSearch& searcher,
                                                 const GripSurface& last) const;

  private:
    FittedPalm fit_uncached(const Candidate& candidate, const FingerSamplePoses& finger_samples,
                            const PalmFitSettings& settings) const;

    const HandSurroundings& hand_;
    const PlacedMesh& placed_;
    PalmFrame palm_;
    double dt_s_;
    const PalmTuning& tuning_;
    std::optional<Vec3> reused_normal_bs_;
    std::array<FittedPalm, 4> cache_;
    std::size_t cache_count_ = 0;
};

}  // namespace handhold
