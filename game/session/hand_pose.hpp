#pragma once

#include <array>

#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

namespace handhold {

// A pose of a palm that touches a surface.
struct PalmTarget {
    hh::Vec3 palm = hh::Vec3{};
    hh::Vec3 away = hh::k_y;  // unit, from the surface into the palm
    // Not parallel to `away`; only the part perpendicular to `away` counts.
    hh::Vec3 fingers = -hh::k_z;
};

// The wrist of a hand whose palm is at `place`. `palm_center_m`: of the right hand, the tuning's
// hand.palm_center_m.
inline hh::Pose hand_on(const PalmTarget& place, hh::Side side, hh::Vec3 palm_center_m) {
    const hh::Vec3 across =
        hh::normalized(place.fingers - place.away * hh::dot(place.away, place.fingers));
    hh::Pose pose;
    pose.rotation =
        hh::normalized(hh::rotation_from_axes(hh::cross(place.away, -across), place.away, -across));
    palm_center_m.x *= side == HH_RIGHT ? 1.0 : -1.0;
    pose.position = place.palm - pose.rotation * palm_center_m;
    return pose;
}

// How hands sit in controllers and where their palms are, by a world's tuning.
struct HandShape {
    hh::Vec3 palm_center_m{};                 // palm of the right hand in the wrist's frame
    std::array<hh::Pose, 2> in_controller{};  // indexed by hh::Side
};
inline HandShape hand_shape(const hh::World& world) {
    return {*world.tuning_vector("hand.palm_center_m"),
            {*world.hand_in_controller(HH_LEFT), *world.hand_in_controller(HH_RIGHT)}};
}

}  // namespace handhold
