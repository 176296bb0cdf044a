#pragma once

#include <limits>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"

// A palm held over a surface: what search_grip judges surfaces by, and constrain_palms holds to.
namespace handhold {

struct PalmFit {
    Pose wrist_bs;  // within the limits, then out of what it was sunk in as far as that goes
    double penetration_m = 0.0;  // how deep the palm still is, at least 0
    double finger_penetration_m =
        0.0;                   // and the deepest of the fingers that were held clear with it
    bool is_converged = true;  // false: with more pushes it would be another
};

// How hard fit_palm tries.
struct PalmFitSettings {
    // Of the same hand a frame ago, or now without its lift: begins with the move that held the
    // palm there, which is mostly nearly the one.
    const GripSurface* last = nullptr;
    // After as many it ends, settled or not.
    int max_iterations = 6;
    // Palms that stay sunk deeper soon are given up.
    double max_penetration_m = std::numeric_limits<double>::infinity();
    // False: where the last push leads to, if that is near, is taken without a look; the depths are
    // those before it, and it is not settled.
    bool verifies_last_step = true;
};

// The least move of the tracked wrist that holds the palm over `surface`, lift_m higher than else:
// along the surface's normal into the range of heights, tilted into the range of angles about the
// palm's own centre; then, where the palm's capsules are sunk in something, moved and turned about
// that centre, PalmTuning::rotation_arm_m apart, until they and the limits are clear. Fingers that
// the surface has bends for are held clear as if they were of the palm. Precondition: the hand has
// meshes, and the surfaces are of the first one.
PalmFit fit_palm(const HandSurroundings& hand, const GripSurface& surface, double lift_m,
                 const PalmTuning& tuning, const PalmFitSettings& settings = {});

}  // namespace handhold
