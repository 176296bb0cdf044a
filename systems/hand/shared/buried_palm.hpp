#pragma once

#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"

namespace handhold {

// The wrist of a gripping hand that has no surface under its palm, in the body's frame: the tracked
// one; for a fist that is partly in a solid of the first mesh, moved out along the normal of
// the surface nearest to its deepest capsule end, until it is outside of the plane there; in a
// corner once more for each face. A point is inside if all triangles at its nearest point within
// PalmTuning::reach_m face away from it, and a ray away from that point leaves the solid within a
// metre: open sheets have no inside. Precondition: the hand has meshes.
Pose wrist_outside_bs(const HandSurroundings& hand, const PalmTuning& tuning);

}  // namespace handhold
