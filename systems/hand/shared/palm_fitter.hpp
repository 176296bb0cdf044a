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

// A palm that is sunk no deeper has room.
inline constexpr double k_palm_penetration_tolerance_m = 1e-3;

// A surface with the palm held to it, without a lift.
struct FittedPalm {
    GripSurface surface;
    double penetration_m = 0.0;         // how deep the palm is that is held to it
    double finger_penetration_m = 0.0;  // and the fingers that are held clear with it
    double sync_m = 0.0;                // how far it is moved for that, turning counted as a way
    bool is_warm_started = false;       // from where it was held a frame ago
};

// Holds one hand's palm to surfaces of the first of the hand's meshes, in one frame: what
// search_grip judges surfaces with. Precondition: the hand has meshes. Refers to all that it is
// made of.
class PalmFitter {
  public:
    using Candidate = GripSearchScratch::Candidate;

    // The palm of a wrist at `wrist_bs`. dt_s: of the frame; infinity: palms settle at once.
    PalmFitter(const HandSurroundings& hand, const Pose& wrist_bs, double dt_s,
               const PalmTuning& tuning);

    const HandSurroundings& hand() const { return hand_; }
    const PlacedMesh& placed() const { return placed_; }
    const PalmFrame& palm() const { return palm_; }  // in the mesh's frame
    bool is_unbudgeted() const;

    // Surfaces found from here on have this mean normal, where they look that way; none: their own.
    void reuse_normal(const std::optional<Vec3>& normal_bs) { reused_normal_bs_ = normal_bs; }

    GripSurface surface_at(const Candidate& found) const;
    // What the palm would be held to there now. The triangle may be of an older mesh.
    Candidate candidate_at(std::uint32_t triangle) const;

    // Held with the fingers of `bends` clear. Of the first few that are asked for, which are asked
    // for again, it is known.
    FittedPalm fit_at(const Candidate& found, const FingerSamplePoses& finger_samples,
                      const PalmFitSettings& settings);
    // As `last` is held, if it is there and with the same fingers held clear.
    FittedPalm refine_at(const Candidate& found, const GripSurface& last);
    // As refine_at, but where the palm comes to by its push is not looked at.
    GripSurface refine_unchecked(const Candidate& found, const GripSurface& last) const;

    bool is_backface(const Candidate& found) const;
    // A palm there would be in something solid: what is over it is seen from inside.
    bool is_inside(const Candidate& found) const;
    // On its way from where the hand is tracked the palm comes in through surfaces of the mesh more
    // often than out of them.
    bool enters_solid(const FittedPalm& held) const;
    // How deep the palm is in surfaces, of any of the hand's meshes, that go through the middles of
    // its capsules: the radius, and from where one goes through the way to the nearer end. 0: none
    // does. Of each capsule the first from either end count.
    double crossing_depth_m(const FittedPalm& held) const;

    // Precondition of both: a `last` that has a triangle has one of this mesh.
    bool is_near_last(const Candidate& found, const GripSurface& last) const;
    std::optional<Candidate> candidate_near_last(const SurfaceSearch& searcher,
                                                 const GripSurface& last) const;

  private:
    FittedPalm fit_uncached(const Candidate& found, const FingerSamplePoses& finger_samples,
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
