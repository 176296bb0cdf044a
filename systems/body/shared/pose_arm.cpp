#include "systems/body/shared/pose_arm.hpp"

#include <cmath>

#include "engine/anim/two_bone_ik.hpp"
#include "engine/math/scalar_rotation.hpp"

namespace handhold {
namespace {

// Returns the frame at `from` with -Z towards `to` and +Y as close to `up` as possible.
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
    return {from, rotation_from_axes(x, back.cross(x), back)};
}

// Returns the rotation of a bone in the arm's plane. `frame` has -Z towards the hand and +Y on the
// elbow's side. The bone points `ahead` along -Z and `aside` along +Y of that frame.
Quat in_plane(const Quat& frame, double ahead, double aside) {
    // Half-angle formula: cos(a / 2) : sin(a / 2) = length + ahead : aside.
    const double cosine = std::sqrt(ahead * ahead + aside * aside) + ahead;
    const double by = 1.0 / std::sqrt(cosine * cosine + aside * aside);
    const double w = cosine * by;
    const double x = aside * by;
    return {frame.w() * w - frame.x() * x, frame.w() * x + frame.x() * w,
            frame.y() * w + frame.z() * x, frame.z() * w - frame.y() * x};
}

}  // namespace

void pose_arm(const ArmFrames& frames, const ArmEstimate::Arm& estimate, const Pose& palm_ws,
              ArmPose::Arm& out) {
    const Mat3 to_ws = frames.origin_ws.rotation.toRotationMatrix();
    out.hand_ws = palm_ws;
    const Vec3& hand_ws = palm_ws.position;
    const Vec3 shoulder_ws = frames.origin_ws.position + to_ws * estimate.shoulder_ps;
    const Vec3& middle_ws = frames.chest_ws.position;
    const Vec3 neck_ws = middle_ws + k_clavicle_from * (shoulder_ws - middle_ws);
    out.clavicle_ws = bone(neck_ws, shoulder_ws, frames.chest_ws.rotation * Vec3::UnitY());

    const double upper_m = estimate.stretch * frames.measures.upper_arm_m;
    const double forearm_m = estimate.stretch * frames.measures.forearm_m;
    const Vec3 bend_ws = to_ws * estimate.bend_ps;
    const Vec3 reach = hand_ws - shoulder_ws;
    const double distance = reach.norm();
    const MiddleJoint elbow = middle_joint(distance, upper_m, forearm_m);
    const Vec3 axis = distance > 0.0 ? Vec3(reach * (1.0 / distance)) : Vec3(Vec3::Zero());
    const Vec3 elbow_ws = shoulder_ws + elbow.along_m * axis + elbow.aside_m * bend_ws;
    const double rest_m = distance - elbow.along_m;
    // `in_plane` is singular for a bone that points backwards along the line from shoulder to hand:
    // the half angle is 90 degrees.
    if (!(elbow.along_m > 0.01 * upper_m && rest_m > 0.01 * forearm_m)) {
        out.upper_ws = bone(shoulder_ws, elbow_ws, bend_ws);
        out.forearm_ws = bone(elbow_ws, hand_ws, bend_ws);
        return;
    }
    const Quat frame = rotation_from_axes(bend_ws.cross(-axis), bend_ws, -axis);
    out.upper_ws = {shoulder_ws, in_plane(frame, elbow.along_m, elbow.aside_m)};
    out.forearm_ws = {elbow_ws, in_plane(frame, rest_m, -elbow.aside_m)};
}

}  // namespace handhold
