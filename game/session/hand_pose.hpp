#pragma once

#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// A pose of a palm that touches a surface.
struct PalmTarget {
    Vec3 palm = Vec3::Zero();
    Vec3 away = Vec3::UnitY();  // unit, from the surface into the palm
    // Not parallel to `away`; only the part perpendicular to `away` counts.
    Vec3 fingers = -Vec3::UnitZ();
};

// The wrist of a hand whose palm is at `place`.
inline Pose hand_on(const PalmTarget& place, HandSide side, const HandTuning& tuning) {
    Mat3 axes;
    const Vec3 across = (place.fingers - place.away * place.away.dot(place.fingers)).normalized();
    axes.col(1) = place.away;
    axes.col(2) = -across;
    axes.col(0) = axes.col(1).cross(axes.col(2));
    Pose pose;
    pose.rotation = Quat(axes).normalized();
    Vec3 center = tuning.palm_center_m;
    center.x() *= side == HandSide::right ? 1.0 : -1.0;
    pose.position = place.palm - pose.rotation * center;
    return pose;
}

}  // namespace handhold
