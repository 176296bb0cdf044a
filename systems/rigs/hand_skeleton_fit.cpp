#include "systems/rigs/hand_skeleton_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "systems/rigs/hand_limits.hpp"

namespace handhold {
namespace {

constexpr double k_min_bone_m = 0.004;
constexpr double k_min_hand_m = 0.05;  // from the wrist to the farthest tip
constexpr double k_max_hand_m = 1.0;
constexpr double k_axes_cosine = 0.819;  // 35 degrees
// How much a joint's x axis says about its finger's plane beside the bones' directions: a straight
// finger has any plane, a bent one only one.
constexpr double k_axis_weight = 0.3;

using JointsByBone = std::map<HandBone, std::size_t>;

std::optional<std::size_t> find(const JointsByBone& joints, HandBone bone) {
    const auto found = joints.find(bone);
    return found == joints.end() ? std::nullopt : std::optional(found->second);
}

// Adds the names that a finger lacks to `missing`.
FingerBones collect_finger(FingerName name, const JointsByBone& joints, std::string& missing) {
    FingerBones finger;
    finger.name = name;
    const bool is_thumb = name == FingerName::thumb;
    finger.metacarpal = find(joints, HandBone::metacarpal);
    const bool has_all = find(joints, HandBone::proximal) && find(joints, HandBone::intermediate) &&
                         find(joints, HandBone::distal);
    if (is_thumb && finger.metacarpal && !has_all) {
        finger.hinges.push_back(*finger.metacarpal);
        finger.metacarpal.reset();
    }
    const auto miss = [&](HandBone bone) {
        missing += (missing.empty() ? "" : ", ") + hand_joint_text({name, bone});
    };
    if (!find(joints, HandBone::proximal)) {
        miss(HandBone::proximal);
    }
    for (const HandBone bone : {HandBone::proximal, HandBone::intermediate, HandBone::distal}) {
        if (const auto joint = find(joints, bone)) {
            finger.hinges.push_back(*joint);
        }
    }
    if (finger.hinges.size() < 2) {
        miss(HandBone::distal);
    }
    if (const auto tip = find(joints, HandBone::tip)) {
        finger.tip = *tip;
    } else {
        miss(HandBone::tip);
    }
    return finger;
}

// Fingers with a phalanx or a tip; a lone metacarpal is a part of the palm.
bool is_finger(const JointsByBone& joints) {
    return std::any_of(joints.begin(), joints.end(),
                       [](const auto& joint) { return joint.first != HandBone::metacarpal; });
}

Vec3 bind_position(const SkinnedMesh& skin, std::size_t joint) {
    return skin.joints[joint].bind_ms.position;
}

// Axes of a hand from its knuckles; those of the wrist's joint where only one finger has one.
Quat axes_from_knuckles(const SkinnedMesh& skin, const HandBones& bones, HandSide side) {
    const Pose& wrist = skin.joints[bones.wrist].bind_ms;
    std::vector<Vec3> knuckles;
    for (const FingerBones& finger : bones.fingers) {
        if (finger.name != FingerName::thumb) {
            knuckles.push_back(bind_position(skin, finger.hinges.front()));
        }
    }
    if (knuckles.size() < 2) {
        return wrist.rotation;
    }
    Vec3 middle = Vec3::Zero();
    for (const Vec3& knuckle : knuckles) {
        middle += knuckle / static_cast<double>(knuckles.size());
    }
    const double to_right = side == HandSide::right ? 1.0 : -1.0;
    const Vec3 back = wrist.position - middle;  // +Z
    const Vec3 across = to_right * (knuckles.back() - knuckles.front());
    if (back.cross(across).norm() < 1e-6) {
        return wrist.rotation;
    }
    Mat3 axes;
    axes.col(2) = back.normalized();
    axes.col(1) = back.cross(across).normalized();
    axes.col(0) = axes.col(1).cross(axes.col(2));
    return Quat(axes).normalized();
}

bool are_near(const Quat& a, const Quat& b) {
    const auto is_near = [&](const Vec3& axis) {
        return (a * axis).dot(b * axis) >= k_axes_cosine;
    };
    return is_near(Vec3::UnitY()) && is_near(Vec3::UnitZ());
}

double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
    return arc_tangent2(axis.dot(from.cross(to)), from.dot(to));
}

// The unit vector least along the bones and most along the joints' x axes: least squares.
Vec3 fit_hinge_axis(const std::vector<Pose>& joints_hs) {
    const std::size_t hinges = joints_hs.size() - 1;
    Vec3 mean = Vec3::Zero();
    Mat3 spread = Mat3::Zero();
    for (std::size_t i = 0; i < hinges; ++i) {
        mean += joints_hs[i].rotation * Vec3::UnitX();
        const Vec3 bone = (joints_hs[i + 1].position - joints_hs[i].position).normalized();
        spread += bone * bone.transpose();
    }
    const Mat3 system = spread + k_axis_weight * Mat3::Identity();
    const Mat3 solved = system.inverse();
    return (solved * mean).normalized();
}

}  // namespace

Result<HandBones> find_hand_bones(const SkinnedMesh& skin) {
    HandBones bones;
    std::optional<std::size_t> wrist;
    std::map<FingerName, JointsByBone> fingers;
    const auto refuse = [&](const std::string& expected) {
        return FileError{skin.file, "/skins", expected};
    };
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        const std::string& name = skin.joints[i].name;
        const std::optional<HandJointName> parsed = parse_hand_joint_name(name);
        if ((!parsed && is_wrist_name(name) && std::exchange(wrist, i)) ||
            (parsed && !fingers[parsed->finger].emplace(parsed->bone, i).second)) {
            return refuse("expected every joint of one hand once, found \"" + name + "\" again");
        }
    }
    std::string missing = wrist ? "" : "wrist";
    for (const auto& [name, joints] : fingers) {
        if (is_finger(joints)) {
            bones.fingers.push_back(collect_finger(name, joints, missing));
        }
    }
    if (!missing.empty()) {
        return refuse("expected joints with WebXR's names, missing: " + missing);
    }
    if (bones.fingers.size() < 2) {
        return refuse("expected 2 to 5 fingers with joints of WebXR's names, found " +
                      std::to_string(bones.fingers.size()));
    }
    bones.wrist = *wrist;
    return bones;
}

Result<Pose> find_hand_frame(const SkinnedMesh& skin, const HandBones& bones, HandSide side) {
    const Pose& wrist = skin.joints[bones.wrist].bind_ms;
    const Quat from_knuckles = axes_from_knuckles(skin, bones, side);
    const HandSide other = side == HandSide::right ? HandSide::left : HandSide::right;
    bool is_other = !are_near(wrist.rotation, from_knuckles) &&
                    are_near(wrist.rotation, axes_from_knuckles(skin, bones, other));
    const Pose hand = {wrist.position,
                       are_near(wrist.rotation, from_knuckles) ? wrist.rotation : from_knuckles};
    double reach_m = 0.0;
    double thumb_x = 0.0;
    double fingers_x = 0.0;
    for (const FingerBones& finger : bones.fingers) {
        std::vector<std::size_t> chain = finger.hinges;
        chain.push_back(finger.tip);
        for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
            const double bone_m =
                (bind_position(skin, chain[i]) - bind_position(skin, chain[i + 1])).norm();
            if (bone_m < k_min_bone_m) {
                return FileError{skin.file, "/skins",
                                 "expected bones of at least 4 mm, found another at \"" +
                                     skin.joints[chain[i]].name + "\""};
            }
        }
        const Vec3 tip = inverse_transform_point(hand, bind_position(skin, finger.tip));
        reach_m = std::max(reach_m, tip.norm());
        (finger.name == FingerName::thumb ? thumb_x : fingers_x) += tip.x();
    }
    if (!(reach_m >= k_min_hand_m && reach_m <= k_max_hand_m)) {
        return FileError{skin.file, "/skins",
                         "expected a hand of 0.05 to 1 m, found " + std::to_string(reach_m) + " m"};
    }
    const bool has_thumb = bones.fingers.front().name == FingerName::thumb;
    fingers_x /= static_cast<double>(bones.fingers.size() - (has_thumb ? 1 : 0));
    is_other = is_other || (has_thumb && (thumb_x > fingers_x) == (side == HandSide::right));
    if (is_other) {
        return FileError{skin.file, "/skins",
                         std::string("expected a ") + (side == HandSide::right ? "right" : "left") +
                             " hand, found one of the other side"};
    }
    return hand;
}

FingerRig fit_finger(const FingerBones& bones, const std::vector<Pose>& joints_hs, HandSide side,
                     FingerAngles& bind) {
    FingerRig finger;
    finger.name = bones.name;
    finger.link_count = static_cast<std::uint32_t>(bones.hinges.size());
    set_hand_limits(side, finger);
    const bool is_thumb = finger.name == FingerName::thumb;
    const Vec3 hinge = fit_hinge_axis(joints_hs);
    // All joints into the plane through their middle.
    Vec3 middle = Vec3::Zero();
    for (const Pose& joint : joints_hs) {
        middle += joint.position / static_cast<double>(joints_hs.size());
    }
    std::vector<Vec3> points;
    points.reserve(joints_hs.size());
    for (const Pose& joint : joints_hs) {
        points.push_back(joint.position - hinge * hinge.dot(joint.position - middle));
    }
    const auto flattened = [&](const Vec3& v) {
        return Vec3((v - hinge * hinge.dot(v)).normalized());
    };
    const Vec3 first = flattened(points[1] - points[0]);
    const Vec3 forward =
        is_thumb ? rotation_about(hinge, finger.rest_rad[0]) * first : flattened(-Vec3::UnitZ());
    Mat3 axes;
    axes.col(0) = hinge;
    axes.col(2) = -forward;
    axes.col(1) = axes.col(2).cross(axes.col(0));
    finger.base_hs = {points[0], Quat(axes).normalized()};
    Vec3 before = forward;
    for (std::size_t link = 0; link < finger.link_count; ++link) {
        const Vec3 bone = points[link + 1] - points[link];
        finger.length_m[link] = bone.norm();
        bind.curl_rad[link] = angle_about(-hinge, before, bone.normalized());
        finger.lower_rad[link] = std::min(finger.lower_rad[link], bind.curl_rad[link]);
        before = bone.normalized();
    }
    if (is_thumb) {
        // About the axis, from the thumb's side of the hand towards the palm's.
        const Vec3& axis = finger.opposition_axis_hs;
        const auto across = [&](const Vec3& v) { return Vec3(v - axis * axis.dot(v)); };
        const Vec3 beside = side == HandSide::right ? Vec3(-Vec3::UnitX()) : Vec3(Vec3::UnitX());
        const double below_rad = angle_about(axis, across(beside), across(first));
        bind.opposition_rad = std::clamp(below_rad - k_thumb_below_rad, finger.lower_opposition_rad,
                                         finger.upper_opposition_rad);
        finger.base_hs.rotation =
            (rotation_about(axis, -bind.opposition_rad) * finger.base_hs.rotation).normalized();
    }
    return finger;
}

}  // namespace handhold
