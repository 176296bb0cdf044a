#pragma once

#include "engine/math/math.hpp"

// Two hands on one free body, without a compromise: the first hand's point is on its anchor, and
// the body is turned as here. That is six equations for six degrees of freedom, met whatever the
// hands do.
namespace handhold {

// The hands in one space, which the rotations below are seen in too; anchors in the body's frame.
// Both the hands and the anchors lie apart.
struct DrivePair {
    Pose first;
    Pose second;
    Pose first_anchor_bs;
    Pose second_anchor_bs;
};

// How the body has to be turned so that
// - the line between the anchors lies along that between the hands: with the first hand on its
//   anchor the second is on the line through both, and may slide along it;
// - about that line the hands' twists against their anchors are as much to one side as to the
//   other. A hand counts by the cosine of half its swing out of the line: one that is turned about
//   by half a turn has no twist, and no say.
// `near`, any rotation within half a turn of both hands' twists, says which turns are meant.
// Returns `near` where hands or anchors are closer than a micrometre.
Quat rotation_from_drive_pair(const DrivePair& drives, const Quat& near);

}  // namespace handhold
