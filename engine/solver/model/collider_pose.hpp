// Solver, model: pose of a body's collider, which may be offset from the body's centre.

#pragma once

#include "engine/solver/model/rows.hpp"

namespace handhold {

// The collider's centre is at `collider_offset_bs` in the body's frame; its rotation is the body's.
inline Pose collider_pose(const SolverBody& body) {
    if (body.collider_offset_bs.isZero(0.0)) {
        return body.pose_ws;
    }
    return {transform_point(body.pose_ws, body.collider_offset_bs), body.pose_ws.rotation};
}

}  // namespace handhold
