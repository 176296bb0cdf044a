#pragma once

#include "engine/solver/model/rows.hpp"

namespace handhold {

// Where a body's collider is: only a player's is not where he is himself.
inline Pose collider_pose(const SolverBody& body) {
    if (body.collider_offset_bs.isZero(0.0)) {
        return body.pose_ws;
    }
    return {transform_point(body.pose_ws, body.collider_offset_bs), body.pose_ws.rotation};
}

}  // namespace handhold
