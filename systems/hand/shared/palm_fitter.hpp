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

// A surface and the palm's fit to it.
struct FittedPalm {
    GripSurface surface;
    double penetration_m = 0.0;  // remaining penetration of the palm
    // Remaining penetration of the fingers in the palm's collision shape.
    double finger_penetration_m = 0.0;
    // Movement of the palm from its tracked pose: translation plus PalmTuning::tilt_cost_m_per_rad
    // times rotation.
    double sync_m = 0.0;
    bool is_warm_started = false;  // the fit started from last frame's fit
};

inline constexpr double k_reused_normal_cosine = 0.7;

// Fits one hand's palm to surfaces of the hand's first mesh, within one frame. search_grip uses it
// to evaluate candidates. Keeps references to its constructor arguments. Precondition: the hand has
// meshes.
class PalmFitter {
  public:
    using Candidate = GripSearchScratch::Candidate;

    // `wrist_bs` is the tracked wrist. `dt_s` is the length of the frame; infinity: no limit on
    // iterations.
    PalmFitter(const HandSurroundings& hand, const Pose& wrist_bs, double dt_s,
               const PalmTuning& tuning);

    const HandSurroundings& hand() const { return hand_; }
    const PlacedMesh& placed() const { return placed_; }
    const PalmFrame& palm() const { return palm_; }  // palm in the mesh's frame
    bool is_unbudgeted() const;                      // dt_s is infinite

    // From now on surface_at() uses this mean normal, instead of computing it, for triangles whose
    // normal has a cosine to it above k_reused_normal_cosine. None: computes every mean normal.
    void reuse_normal(const std::optional<Vec3>& normal_bs) { reused_normal_bs_ = normal_bs; }

    GripSurface surface_at(const Candidate& candidate) const;
    // Returns the candidate of a triangle for the current palm. An index beyond the mesh's
    // triangles is replaced by the last triangle.
    Candidate candidate_at(std::uint32_t triangle) const;

    // Fits the palm, with the fingers in `finger_samples` as part of its shape. The first four fits
    // are cached, because some are requested twice.
    FittedPalm fit_at(const Candidate& candidate, const FingerSamplePoses& finger_samples,
                      const PalmFitSettings& settings);
    // Continues the fit of `last`, on which `candidate` lies, with the same fingers as part of the
    // palm's shape.
    FittedPalm refine_at(const Candidate& candidate, const GripSurface& last);
    // Like refine_at, but does not query the surfaces at the resulting pose.
    GripSurface refine_unchecked(const Candidate& candidate, const GripSurface& last) const;

    // True if the triangle's outside faces away from the palm.
    bool is_backface(const Candidate& candidate) const;
    // For a backface: true if a palm on it would be inside a solid, that is, if a ray from the
    // triangle towards the palm first hits another triangle from inside.
    bool is_inside(const Candidate& candidate) const;
    // True if the straight path from the tracked palm to the fitted one enters the mesh more often
    // than it leaves it.
    bool enters_solid(const FittedPalm& held) const;
    // Returns how deep the palm penetrates surfaces that cross the axis of one of its capsules; 0
    // if none does. For one crossing this is the capsule's radius plus the distance from the
    // crossing to the axis' nearer end. Tests the first crossing from either end, in all of the
    // hand's meshes.
    double crossing_depth_m(const FittedPalm& held) const;

    // True if `candidate` is a duplicate place (is_duplicate_place) of `last`. Precondition:
    // last.triangle is a triangle of this mesh.
    bool is_near_last(const Candidate& candidate, const GripSurface& last) const;
    // Returns the cheapest visited triangle that is a duplicate place of `last`; none if there is
    // none. Precondition: last.triangle is k_none or a triangle of this mesh.
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
