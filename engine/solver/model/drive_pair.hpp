// Solver, model: the rotation of a free body that two drives hold. The rows of the first drive hold
// a point of the body (drive_point, 3 rows). The rows of the second drive hold the body's rotation
// at the value computed here (drive_direction, 3 rows). Six equations for six degrees of freedom
// can always be satisfied, so the solver needs no least-squares compromise between the drives.

#pragma once

#include "engine/math/math.hpp"

namespace handhold {

// Both drive poses in one space, in which the resulting rotation is also expressed. Anchors are in
// the body's frame. Preconditions: the two drive positions differ, and so do the two anchor
// positions.
struct DrivePair {
    Pose first;
    Pose second;
    Pose first_anchor_bs;
    Pose second_anchor_bs;
};

// Returns the body rotation for which
// - The line between the anchors is parallel to the line between the drives. If the first drive is
//   on its anchor, the second drive is on the line through both anchors and may slide along it.
// - The rotation about that line is a weighted mean of the rotations of both drives about it. A
//   drive's weight is the cosine of half its swing, the angle by which it would tilt that line. A
//   drive that is swung by half a turn has no rotation about the line, and weight 0.
//
// A drive's rotation about the line is known only up to whole turns; the one closest to `near` is
// taken. `near` must be within half a turn of both drives' rotations. Returns `near` if the drives
// or the anchors are closer together than a micrometre.
Quat rotation_from_drive_pair(const DrivePair& drives, const Quat& near);

}  // namespace handhold
