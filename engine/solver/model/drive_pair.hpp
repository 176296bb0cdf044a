// Solver, model: two drives on one free body, without a least-squares compromise. The first drive
// holds a point (drive_point, 3 rows). drive_direction (3 rows) holds the body's rotation at the
// one computed here. Six equations for six degrees of freedom can always be satisfied.

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
// `near` is any rotation within half a turn of both drives' rotations; it selects among results
// that differ by whole turns. Returns `near` if the drives or the anchors are closer together than
// a micrometre.
Quat rotation_from_drive_pair(const DrivePair& drives, const Quat& near);

}  // namespace handhold
