#include "systems/arm/pose_arms.hpp"

#include <cmath>

#include "engine/anim/two_bone_ik.hpp"
#include "engine/ecs/join.hpp"
#include "engine/math/scalar_rotation.hpp"

namespace handhold {
namespace {

// -Z from `from` to `to`, +Y as near to `up` as that allows.
Pose bone(const Vec3& from, const Vec3& to, const Vec3& up) {
    const Vec3 along = to - from;
    const double length = along.norm();
    if (length < 1e-9) {
        return {from, Quat::Identity()};
    }
    const Vec3 back = along * (-1.0 / length);
    const Vec3 right = up.cross(back);
    const double across = right.norm();
    if (across < 1e-9) {
        return {from, rotation_between(Vec3::UnitZ(), back)};
    }
    const Vec3 x = right * (1.0 / across);
    return {from, rotation_of_axes(x, back.cross(x), back)};
}

// Both bones of an arm lie in one plane: its frame has -Z to the hand and +Y to the elbow's side,
// theirs are turned about its X.
struct ArmPlane {
    Quat frame;
    Vec3 axis;  // unit: from the shoulder to the hand
    Vec3 bend;  // unit, square to it
};
ArmPlane arm_plane(const Vec3& reach, double distance, const Vec3& bend) {
    const Vec3 back = reach * (-1.0 / distance);
    return {rotation_of_axes(bend.cross(back), bend, back), -back, bend};
}

// As bone(from, to, plane.bend) for bones in the plane.
Pose bone_in(const ArmPlane& plane, const Vec3& from, const Vec3& to) {
    const Vec3 along = to - from;
    const double ahead = along.dot(plane.axis);
    const double aside = along.dot(plane.bend);
    const double length = std::sqrt(ahead * ahead + aside * aside);
    if (!(ahead > 0.01 * length)) {
        return bone(from, to, plane.bend);
    }
    // Half the angle: its cosine and sine are as length + ahead to aside.
    const double cosine = length + ahead;
    const double by = 1.0 / std::sqrt(cosine * cosine + aside * aside);
    const double w = cosine * by;
    const double x = aside * by;
    const Quat& f = plane.frame;
    return {from, Quat(f.w() * w - f.x() * x, f.w() * x + f.x() * w, f.y() * w + f.z() * x,
                       f.z() * w - f.y() * x)};
}

}  // namespace

void pose_arms(const PoseArmsIo& io) {
    join(
        io.arms,
        [](Entity, ArmPose& out, const ArmEstimate& estimate, const PlayerOrigin& origin) {
            out.chest_ws = origin.pose_ws * estimate.chest_ps;
        },
        io.estimate, io.origin);
    for (std::size_t row = 0; row < io.owner.size(); ++row) {
        const HandOwner& owner = io.owner.rows()[row];
        const std::size_t side = index_of(owner.side);
        const Pose& origin_ws = io.origin.at(owner.player).pose_ws;
        const BodyMeasures& measures = io.measures.at(owner.player);
        const ArmEstimate::Arm& estimate = io.estimate.at(owner.player).arms[side];
        ArmPose& pose = io.arms.at(owner.player);
        ArmPose::Arm& out = pose.arms[side];
        out.hand_ws = io.palm.at(io.owner.owners()[row]).pose_ws;
        const Mat3 to_ws = origin_ws.rotation.toRotationMatrix();
        const Vec3 shoulder_ws = origin_ws.position + to_ws * estimate.shoulder_ps;
        const Vec3 bend_ws = to_ws * estimate.bend_ps;
        const Vec3& hand_ws = out.hand_ws.position;
        const Vec3 elbow_ws = solve_two_bone_ik({estimate.stretch * measures.upper_arm_m,
                                                 estimate.stretch * measures.forearm_m, shoulder_ws,
                                                 hand_ws, bend_ws});
        const Vec3& middle_ws = pose.chest_ws.position;
        const Vec3 neck_ws = middle_ws + k_clavicle_from * (shoulder_ws - middle_ws);
        out.clavicle_ws = bone(neck_ws, shoulder_ws, pose.chest_ws.rotation * Vec3::UnitY());
        const Vec3 reach = hand_ws - shoulder_ws;
        const double distance = reach.norm();
        if (distance < 1e-6) {
            out.upper_ws = bone(shoulder_ws, elbow_ws, bend_ws);
            out.forearm_ws = bone(elbow_ws, hand_ws, bend_ws);
            continue;
        }
        const ArmPlane plane = arm_plane(reach, distance, bend_ws);
        out.upper_ws = bone_in(plane, shoulder_ws, elbow_ws);
        out.forearm_ws = bone_in(plane, elbow_ws, hand_ws);
    }
}

}  // namespace handhold
