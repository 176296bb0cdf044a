#pragma once

#include <array>

#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

namespace handhold {

// Pose of a palm that touches a surface.
struct PalmTarget {
    hh::Vec3 palm = hh::Vec3{};
    hh::Vec3 away = hh::k_y;  // unit, from the surface into the palm
    // Direction of the fingers, not parallel to `away`. Only the part perpendicular to `away`
    // counts.
    hh::Vec3 fingers = -hh::k_z;
};

// Returns the pose of the wrist of a hand whose palm is at `place`. `palm_center_m`: the right
// hand's palm in the wrist's frame (tuning hand.palm_center_m).
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

// A world's geometry of hands: where the palm is, and how a hand is placed in its controller.
struct HandShape {
    hh::Vec3 palm_center_m{};                 // palm of the right hand in the wrist's frame
    std::array<hh::Pose, 2> in_controller{};  // wrist in the controller, indexed by hh::Side
};
inline HandShape hand_shape(const hh::World& world) {
    return {*world.tuning_vector("hand.palm_center_m"),
            {*world.hand_in_controller(HH_LEFT), *world.hand_in_controller(HH_RIGHT)}};
}

}  // namespace handhold
