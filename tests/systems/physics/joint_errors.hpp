#pragma once

#include <algorithm>

#include "tests/systems/frame/column_scene.hpp"
#include "tests/systems/frame/scenario.hpp"

// Errors of joints, taken from the poses, not from what the runtime says of itself.
namespace handhold::test {

inline Vec3 joint_point(const Scenario& s, Entity body, const Pose& frame_bs) {
    return is_null(body) ? frame_bs.position
                         : transform_point(s.world.body_pose.at(body).pose_ws, frame_bs.position);
}
inline Quat joint_frame(const Scenario& s, Entity body, const Pose& frame_bs) {
    return is_null(body) ? frame_bs.rotation
                         : s.world.body_pose.at(body).pose_ws.rotation * frame_bs.rotation;
}

struct JointErrors {
    double m = 0.0;
    double rad = 0.0;
    void take(const JointErrors& other) {
        m = std::max(m, other.m);
        rad = std::max(rad, other.rad);
    }
};

inline JointErrors error_of(const Scenario& s, Entity entity) {
    const Joint& joint = s.world.joint.at(entity);
    const Vec3 apart =
        joint_point(s, joint.a, joint.frame_a_bs) - joint_point(s, joint.b, joint.frame_b_bs);
    const Quat a = joint_frame(s, joint.a, joint.frame_a_bs);
    const Quat b = joint_frame(s, joint.b, joint.frame_b_bs);
    const Vec3 axis = a * Vec3::UnitX();
    switch (joint.kind) {
        case JointKind::ball:
            return {apart.norm(), 0.0};
        case JointKind::hinge:
            return {apart.norm(), axis.cross(b * Vec3::UnitX()).norm()};
        case JointKind::slider:
            return {axis.cross(apart).norm(), angle_between(a, b)};
        case JointKind::fixed:
            return {apart.norm(), angle_between(a, b)};
        case JointKind::distance:
            break;
    }
    const double length = apart.norm();
    return {std::max({0.0, joint.lower - length, length - joint.upper}), 0.0};
}

}  // namespace handhold::test
