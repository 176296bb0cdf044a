#include "systems/arm/pose_arms.hpp"

#include "engine/anim/two_bone_ik.hpp"
#include "engine/ecs/join.hpp"

namespace handhold {
namespace {

// The clavicles begin at the base of the neck: this share of the way out to the shoulders.
constexpr double k_clavicle_from = 0.12;

// -Z from `from` to `to`, +Y as near to `up` as that allows.
Pose bone(const Vec3& from, const Vec3& to, const Vec3& up) {
    const Vec3 along = to - from;
    const double length = along.norm();
    if (length < 1e-9) {
        return {from, Quat::Identity()};
    }
    Mat3 axes;
    axes.col(2) = along / -length;
    const Vec3 right = up.cross(Vec3(axes.col(2)));
    const double across = right.norm();
    if (across < 1e-9) {
        return {from, rotation_between(-Vec3::UnitZ(), along / length)};
    }
    axes.col(0) = right / across;
    axes.col(1) = Vec3(axes.col(2)).cross(Vec3(axes.col(0)));
    return {from, Quat(axes).normalized()};
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
        const Vec3 shoulder_ws = transform_point(origin_ws, estimate.shoulder_ps);
        const Vec3 bend_ws = origin_ws.rotation * estimate.bend_ps;
        const Vec3 elbow_ws = solve_two_bone_ik({estimate.stretch * measures.upper_arm_m,
                                                 estimate.stretch * measures.forearm_m, shoulder_ws,
                                                 out.hand_ws.position, bend_ws});
        const Vec3 neck_ws =
            pose.chest_ws.position + k_clavicle_from * (shoulder_ws - pose.chest_ws.position);
        out.clavicle_ws = bone(neck_ws, shoulder_ws, pose.chest_ws.rotation * Vec3::UnitY());
        out.upper_ws = bone(shoulder_ws, elbow_ws, bend_ws);
        out.forearm_ws = bone(elbow_ws, out.hand_ws.position, bend_ws);
    }
}

}  // namespace handhold
