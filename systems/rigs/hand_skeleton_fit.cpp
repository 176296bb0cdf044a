#include "systems/rigs/hand_skeleton_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/hand_limits.hpp"

namespace handhold {
namespace {

// Weight w of the usual hinge axis in fit_hinge_axis. The usual axis is needed because a straight
// finger does not determine its disc.
constexpr double k_prior_weight = 0.3;

using JointsByBone = std::map<HandBone, std::size_t>;

std::optional<std::size_t> find(const JointsByBone& joints, HandBone bone) {
    const auto found = joints.find(bone);
    return found == joints.end() ? std::nullopt : std::optional(found->second);
}

// Collects a finger's joints. Adds the names of missing joints to `missing`.
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

// True if there is a phalanx or a tip. A metacarpal alone belongs to the palm.
bool is_finger(const JointsByBone& joints) {
    return std::any_of(joints.begin(), joints.end(),
                       [](const auto& joint) { return joint.first != HandBone::metacarpal; });
}

Vec3 bind_position(const SkinnedMesh& skin, std::size_t joint) {
    return skin.joints[joint].bind_ms.position;
}

// First hinges of the fingers. Includes the thumb's only if there is just one other finger.
std::vector<Vec3> knuckles_of(std::span<const Knuckle> fingers) {
    std::vector<Vec3> knuckles;
    std::optional<Vec3> thumb;
    for (const Knuckle& finger : fingers) {
        if (finger.name == FingerName::thumb) {
            thumb = finger.place;
        } else {
            knuckles.push_back(finger.place);
        }
    }
    if (knuckles.size() < 2 && thumb) {
        knuckles.insert(knuckles.begin(), *thumb);
    }
    return knuckles;
}

// Axes from the wrist and the knuckles of a right (to_right = 1) or left (-1) hand: +Z back along
// the palm, +Y out of the back of the hand. Returns none if wrist and knuckles lie on one line.
std::optional<Quat> palm_axes(const Vec3& wrist, const std::vector<Vec3>& knuckles,
                              double to_right) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& knuckle : knuckles) {
        middle += knuckle / static_cast<double>(knuckles.size());
    }
    const Vec3 back = wrist - middle;
    const Vec3 across = to_right * (knuckles.back() - knuckles.front());
    if (back.cross(across).norm() < 1e-6) {
        return std::nullopt;
    }
    Mat3 axes;
    axes.col(2) = back.normalized();
    axes.col(1) = back.cross(across).normalized();
    axes.col(0) = axes.col(1).cross(axes.col(2));
    return Quat(axes).normalized();
}

// Axes of hand space in the file's frame. Ignores the axes of the joints.
std::optional<Quat> hand_axes(const SkinnedMesh& skin, const HandBones& bones, HandSide side) {
    std::vector<Knuckle> knuckles;
    for (const FingerBones& finger : bones.fingers) {
        knuckles.push_back({finger.name, bind_position(skin, finger.hinges.front())});
    }
    return find_hand_axes(bind_position(skin, bones.wrist), knuckles, side);
}

// How far fingers and thumb bend towards the palm's side (-Y): a sum of offsets / lengths. Negative
// if the axes were made for the wrong side.
double reach_to_palm(const SkinnedMesh& skin, const HandBones& bones, const Pose& hand) {
    constexpr double k_thumb_weight = 2.0;
    double reach = 0.0;
    for (const FingerBones& finger : bones.fingers) {
        const auto place = [&](std::size_t joint) {
            return inverse_transform_point(hand, bind_position(skin, joint));
        };
        const Vec3 tip = place(finger.tip);
        if (finger.name == FingerName::thumb) {
            reach -= k_thumb_weight * tip.y() / tip.norm();
            continue;
        }
        const Vec3 first = place(finger.hinges[1]) - place(finger.hinges[0]);
        const Vec3 whole = tip - place(finger.hinges[0]);
        const Vec3 bent = whole - first * (whole.dot(first) / first.squaredNorm());
        reach -= bent.y() / whole.norm();
    }
    return reach;
}

double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
    return arc_tangent2(axis.dot(from.cross(to)), from.dot(to));
}

// The axis about which a straight finger curls towards the palm: parallel to the palm and
// perpendicular to the finger's first bone. For a thumb: the built-in thumb's axis. A turn about
// the opposition axis and then the shortest rotation move the built-in thumb's first bone onto this
// thumb's.
Vec3 usual_hinge_axis(FingerName name, const Vec3& first_bone, HandSide side) {
    if (name == FingerName::thumb) {
        const HandRig usual = builtin_hand_rig(side);
        const FingerRig& thumb = usual.fingers.front();
        const Vec3& axis = thumb.opposition_axis_hs;
        const auto across = [&](const Vec3& v) { return Vec3(v - axis * axis.dot(v)); };
        const Quat rest = finger_link_frames(thumb, relaxed_angles(thumb))[0].rotation;
        const Vec3 bone = rest * -Vec3::UnitZ();
        const Quat opposed =
            rotation_about(axis, angle_about(axis, across(bone), across(first_bone)));
        return rotation_between(opposed * bone, first_bone) * (opposed * (rest * Vec3::UnitX()));
    }
    constexpr double k_upright = 0.2;  // a bone nearly perpendicular to the palm determines no axis
    const Vec3 axis = first_bone.cross(Vec3::UnitY());
    return axis.norm() > k_upright ? Vec3(axis.normalized()) : Vec3(Vec3::UnitX());
}

// Finds the hinge axis h that minimises sum_i (h . b_i)^2 + w |h - p|^2. Here b_i are the bones'
// unit directions, p is the usual axis, and w = k_prior_weight. Solves
//   (sum_i b_i b_i^T + w I) h = w p.
Vec3 fit_hinge_axis(const std::vector<Vec3>& points_hs, const Vec3& usual_axis) {
    Mat3 system = k_prior_weight * Mat3::Identity();
    for (std::size_t i = 0; i + 1 < points_hs.size(); ++i) {
        const Vec3 bone = (points_hs[i + 1] - points_hs[i]).normalized();
        system += bone * bone.transpose();
    }
    const Mat3 solved = system.inverse();
    return (solved * usual_axis).normalized();
}

}  // namespace

std::optional<Quat> find_hand_axes(const Vec3& wrist, std::span<const Knuckle> knuckles,
                                   HandSide side) {
    const double to_right = side == HandSide::right ? 1.0 : -1.0;
    std::vector<Knuckle> usual_knuckles;
    for (const FingerRig& finger : builtin_hand_rig(side).fingers) {
        if (std::any_of(knuckles.begin(), knuckles.end(),
                        [&](const Knuckle& own) { return own.name == finger.name; })) {
            usual_knuckles.push_back({finger.name, finger.base_hs.position});
        }
    }
    const std::vector<Vec3> places = knuckles_of(knuckles);
    if (places.size() < 2) {
        return std::nullopt;
    }
    const auto found = palm_axes(wrist, places, to_right);
    const auto usual = palm_axes(Vec3::Zero(), knuckles_of(usual_knuckles), to_right);
    return found && usual ? std::optional((*found * usual->conjugate()).normalized())
                          : std::nullopt;
}

Vec3 find_hinge_axis(FingerName name, const std::vector<Vec3>& joints_hs, HandSide side) {
    return fit_hinge_axis(joints_hs,
                          usual_hinge_axis(name, (joints_hs[1] - joints_hs[0]).normalized(), side));
}

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
    const std::optional<Quat> axes = hand_axes(skin, bones, side);
    if (!axes) {
        return FileError{skin.file, "/skins",
                         "expected knuckles beside each other, found them in line with the wrist"};
    }
    const Pose hand = {bind_position(skin, bones.wrist), *axes};
    double reach_m = 0.0;
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
    }
    if (!(reach_m >= k_min_hand_m && reach_m <= k_max_hand_m)) {
        return FileError{skin.file, "/skins",
                         "expected a hand of 0.05 to 1 m, found " + std::to_string(reach_m) + " m"};
    }
    // A flat hand does not determine its side.
    constexpr double k_flat = -0.05;
    if (reach_to_palm(skin, bones, hand) < k_flat) {
        return FileError{skin.file, "/skins",
                         std::string("expected a ") + (side == HandSide::right ? "right" : "left") +
                             " hand, found one of the other side"};
    }
    return hand;
}

FingerRig fit_finger(const FingerBones& bones, const std::vector<Vec3>& joints_hs, HandSide side,
                     FingerAngles& bind) {
    FingerRig finger;
    finger.name = bones.name;
    finger.link_count = static_cast<std::uint32_t>(bones.hinges.size());
    set_hand_limits(side, finger);
    const bool is_thumb = finger.name == FingerName::thumb;
    const Vec3 hinge = find_hinge_axis(bones.name, joints_hs, side);
    // Projects the joints onto the plane through their mean that is perpendicular to the hinge
    // axis.
    Vec3 middle = Vec3::Zero();
    for (const Vec3& joint : joints_hs) {
        middle += joint / static_cast<double>(joints_hs.size());
    }
    std::vector<Vec3> points;
    points.reserve(joints_hs.size());
    for (const Vec3& joint : joints_hs) {
        points.push_back(joint - hinge * hinge.dot(joint - middle));
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
        // Angle of the first bone about the opposition axis, from the thumb's side of the hand to
        // the palm's side.
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
