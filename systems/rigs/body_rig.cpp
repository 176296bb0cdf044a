#include "systems/rigs/body_rig.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace handhold {
namespace {

// Pose and length of a player's bone; length 0: the bone has no end joint.
struct PlacedBone {
    Pose frame_ws;
    double length_m = 0.0;
};

// End points of the trunk's links, from the pelvis up.
std::array<Vec3, k_spine_links + 1> trunk_points(const SpinePose& spine) {
    std::array<Vec3, k_spine_links + 1> points;
    points[0] = spine.pelvis_ws.position;
    for (std::size_t i = 0; i < k_spine_links; ++i) {
        points[k_spine_links - i] = spine.spine_ws[i].position;
    }
    return points;
}

double trunk_length(const SpinePose& spine) {
    const auto points = trunk_points(spine);
    double length = 0.0;
    for (std::size_t i = 0; i < k_spine_links; ++i) {
        length += (points[i + 1] - points[i]).norm();
    }
    return length;
}

// A rotation turned about its own Z axis.
Quat rolled(const Quat& rotation, double angle_rad) {
    return (rotation * rotation_about(Vec3::UnitZ(), angle_rad)).normalized();
}

// Rotation of a carrier on the forearm, which follows its share of the hand's twist. The twist is
// relative to that in the file.
Quat twisted_forearm(const BodyRig::Carrier& carrier, const ArmPose::Arm& arm) {
    const double twist_rad =
        followed_twist(arm.forearm_ws.rotation, arm.hand_ws.rotation, carrier.twist_rad);
    return rolled(arm.forearm_ws.rotation, carrier.along * twist_rad);
}

// Rotation of a carrier on the upper arm. It follows its share of the upper arm's twist: none at
// the shoulder, all at the elbow. The twist is measured against the chest, relative to the pose in
// the file.
Quat twisted_upper_arm(const BodyRig::Carrier& carrier, const ArmPose::Arm& arm,
                       const Quat& chest_from_file) {
    const Quat& whole = arm.upper_ws.rotation;
    const double twist_rad = followed_twist(chest_from_file * carrier.rest_ms.rotation, whole, 0.0);
    return rolled(whole, (carrier.along - 1.0) * twist_rad);
}

// `chest_from_file`: rotation from the file's frame to the world for what is fixed to the chest.
PlacedBone place_arm(const ArmPose::Arm& arm, const BodyRig::Carrier& carrier,
                     const Quat& chest_from_file) {
    switch (carrier.bone) {
        case BodyBone::clavicle:
            return {arm.clavicle_ws, (arm.upper_ws.position - arm.clavicle_ws.position).norm()};
        case BodyBone::upper_arm: {
            const Quat rotation = carrier.along < 1.0
                                      ? twisted_upper_arm(carrier, arm, chest_from_file)
                                      : arm.upper_ws.rotation;
            return {{arm.upper_ws.position, rotation},
                    (arm.forearm_ws.position - arm.upper_ws.position).norm()};
        }
        case BodyBone::forearm: {
            const Quat rotation =
                carrier.along > 0.0 ? twisted_forearm(carrier, arm) : arm.forearm_ws.rotation;
            return {{arm.forearm_ws.position, rotation},
                    (arm.hand_ws.position - arm.forearm_ws.position).norm()};
        }
        default:
            return {arm.hand_ws, 0.0};
    }
}

PlacedBone place_leg(const SpinePose::Leg& leg, BodyBone bone) {
    switch (bone) {
        case BodyBone::thigh:
            return {leg.thigh_ws, (leg.shin_ws.position - leg.thigh_ws.position).norm()};
        case BodyBone::shin:
            return {leg.shin_ws, (leg.foot_ws.position - leg.shin_ws.position).norm()};
        default:
            return {leg.foot_ws, 0.0};
    }
}

PlacedBone place_bone(const BodyRig::Carrier& carrier, const RenderPose& render,
                      const Quat& chest_from_file) {
    switch (carrier.bone) {
        case BodyBone::trunk:
            return {trunk_at(render.spine, carrier.along), trunk_length(render.spine)};
        case BodyBone::neck:  // see place_neck
        case BodyBone::head:
            return {render.head_ws, 0.0};
        case BodyBone::clavicle:
        case BodyBone::upper_arm:
        case BodyBone::forearm:
        case BodyBone::hand:
            return place_arm(render.arms.arms[index_of(carrier.side)], carrier, chest_from_file);
        case BodyBone::thigh:
        case BodyBone::shin:
        case BodyBone::foot:
        case BodyBone::finger:  // see place_finger
            break;
    }
    return place_leg(render.spine.legs[index_of(carrier.side)], carrier.bone);
}

// Places the neck between its lower end, which follows the chest, and its upper end, which follows
// the head.
PlacedBone place_neck(const Vec3& from_ws, const Vec3& to_ws, const Quat& chest, const Quat& head) {
    const Vec3 along = to_ws - from_ws;
    const double length = along.norm();
    const Quat between = interpolate(chest, head, 0.5);
    if (length < 1e-6) {
        return {{from_ws, between}, 0.0};
    }
    const Quat onto = rotation_between(between * Vec3::UnitY(), along / length);
    return {{from_ws, (onto * between).normalized()}, length};
}

// The first valid joint of the shown hand's finger from `joint` on; none if all are missing.
std::optional<std::size_t> valid_from(const PosedHandJoints& hand, FingerName finger,
                                      std::size_t joint) {
    const std::size_t tip = hand_joint_index(finger, HandBone::tip);
    for (; joint <= tip; ++joint) {
        if (hand[joint].is_valid) {
            return joint;
        }
    }
    return std::nullopt;
}

// Axes of a bone of the shown hand: -Z from one joint to the next, +X along the hinge.
std::optional<Quat> bone_axes(const PosedHandJoints& hand, FingerName finger, std::size_t from,
                              std::size_t to) {
    const auto start = valid_from(hand, finger, from);
    const auto end = start ? valid_from(hand, finger, std::max(to, *start + 1)) : start;
    if (!end) {
        return std::nullopt;
    }
    const Pose& start_ws = hand[*start].pose_ws;
    return hinge_rotation(hand[*end].pose_ws.position - start_ws.position,
                          start_ws.rotation * Vec3::UnitX());
}

// Rotation of a finger's bone: that of the shown hand's bone, or of a neighbour if the shown hand
// lacks the finger. None if it has no fingers.
std::optional<Quat> turn_of_finger(const PosedHandJoints& hand, std::size_t from, std::size_t to) {
    const FingerName own = finger_of_hand_joint(from);
    if (own == FingerName::thumb) {
        return bone_axes(hand, own, from, to);
    }
    const auto turn_of = [&](int finger) {
        const auto name = static_cast<FingerName>(finger);
        const std::size_t there = hand_joint_index(name, HandBone::metacarpal);
        const std::size_t here = hand_joint_index(own, HandBone::metacarpal);
        return bone_axes(hand, name, there + (from - here), there + (to - here));
    };
    std::optional<Quat> turn;
    for (int finger = static_cast<int>(own); !turn && finger > 0; --finger) {
        turn = turn_of(finger);
    }
    for (int finger = static_cast<int>(own) + 1; !turn && finger < static_cast<int>(k_finger_count);
         ++finger) {
        turn = turn_of(finger);
    }
    return turn;
}

// Thickness of the player's body parts / thickness of the rig's.
struct Girth {
    double legs = 1.0;
    double trunk = 1.0;
    double others = 1.0;

    double of(BodyBone bone) const {
        const bool is_leg = bone >= BodyBone::thigh && bone <= BodyBone::foot;
        return bone == BodyBone::trunk ? trunk : is_leg ? legs : others;
    }
};

// Map from the file's frame to the world: transforms into the bone's rest frame, scales there, then
// transforms to the bone's world frame.
Affine stretch_onto(const BodyRig::Carrier& carrier, const PlacedBone& placed, const Girth& girth) {
    Vec3 scale = Vec3::Constant(girth.of(carrier.bone));
    if (carrier.length_m > 0.0 && placed.length_m > 0.0) {
        const bool is_arm = carrier.bone == BodyBone::clavicle ||
                            carrier.bone == BodyBone::upper_arm ||
                            carrier.bone == BodyBone::forearm;
        scale[is_arm ? 2 : 1] = placed.length_m / carrier.length_m;
    }
    const Affine scaling{scale.asDiagonal(), Vec3::Zero()};
    return to_affine(placed.frame_ws) * scaling * to_affine(inverse(carrier.rest_ms));
}

bool is_identity(const Pose& pose) {
    return pose.position == Vec3::Zero() && pose.rotation.coeffs() == Quat::Identity().coeffs();
}

}  // namespace

double arm_twist(const Quat& parent, const Quat& child) {
    const Quat turn = parent.conjugate() * child;
    // Cosine and sine of half the twist, both times the cosine of half the bend.
    return 2.0 * arc_tangent2(turn.w() < 0.0 ? -turn.z() : turn.z(), std::abs(turn.w()));
}

double followed_twist(const Quat& parent, const Quat& child, double rest_rad) {
    const Quat turn = parent.conjugate() * child;
    const double twist_rad = std::remainder(arm_twist(parent, child) - rest_rad, 2.0 * k_pi);
    const double size = std::abs(twist_rad);
    const double followed = size <= k_wholly_followed_rad ? size
                                                          : k_wholly_followed_rad * (k_pi - size) /
                                                                (k_pi - k_wholly_followed_rad);
    const double bent = smooth_step(turn.w() * turn.w() + turn.z() * turn.z(), 0.0, 0.25);
    return std::copysign(bent * std::max(followed, 0.0), twist_rad);
}

Pose trunk_at(const SpinePose& spine, double along) {
    const auto points = trunk_points(spine);
    const double link = std::clamp(along, 0.0, 1.0) * static_cast<double>(k_spine_links);
    const auto below = std::min(static_cast<std::size_t>(link), k_spine_links - 1);
    const double share = link - static_cast<double>(below);
    Pose at;
    at.position = points[below] + share * (points[below + 1] - points[below]);
    // The rotation is interpolated between these knots: the links' middles, with pelvis and chest
    // at the ends.
    std::array<double, k_spine_links + 2> knots;
    std::array<Quat, k_spine_links + 2> turns;
    knots.front() = 0.0;
    knots.back() = static_cast<double>(k_spine_links);
    turns.front() = spine.pelvis_ws.rotation;
    turns.back() = spine.chest_ws.rotation;
    for (std::size_t i = 0; i < k_spine_links; ++i) {
        knots[i + 1] = static_cast<double>(i) + 0.5;
        turns[i + 1] = spine.spine_ws[k_spine_links - 1 - i].rotation;
    }
    std::size_t k = 0;
    while (k + 2 < knots.size() && link > knots[k + 1]) {
        ++k;
    }
    at.rotation =
        interpolate(turns[k], turns[k + 1], (link - knots[k]) / (knots[k + 1] - knots[k]));
    return at;
}

std::size_t BodyRig::finger_count(HandSide side) const {
    return static_cast<std::size_t>(std::ranges::count_if(carriers, [&](const Carrier& carrier) {
        return carrier.bone == BodyBone::finger && carrier.side == side &&
               carriers[carrier.above].bone == BodyBone::hand;
    }));
}

void pose_skeleton(const BodyRig& rig, const BodyMeasures& measures, const RenderPose& render,
                   const std::array<PosedHandJoints, k_hand_count>& hands, SkeletonPose& out) {
    Girth girth;
    girth.legs = measures.eye_height_m / rig.eye_height_m;
    girth.trunk = measures.shoulder_width_m / rig.shoulder_width_m;
    girth.others = std::min(girth.legs, girth.trunk);
    const Quat chest_from_file = render.spine.chest_ws.rotation *
                                 rig.carriers[BodyRig::k_chest].rest_ms.rotation.conjugate();
    out.carrier_ws.resize(rig.carriers.size());
    out.stretched.resize(rig.carriers.size());
    const auto place = [&](const BodyRig::Carrier& carrier) -> PlacedBone {
        if (carrier.bone == BodyBone::neck) {
            return place_neck(
                transform_point(out.stretched[BodyRig::k_chest], carrier.rest_ms.position),
                transform_point(out.stretched[BodyRig::k_head], rig.head_joint_ms),
                out.carrier_ws[BodyRig::k_chest].rotation, render.head_ws.rotation);
        }
        if (carrier.bone == BodyBone::finger) {
            const Quat& above_ms = rig.carriers[carrier.above].rest_ms.rotation;
            const Quat with_above = out.carrier_ws[carrier.above].rotation *
                                    (above_ms.conjugate() * carrier.rest_ms.rotation);
            const auto turn =
                turn_of_finger(hands[index_of(carrier.side)], carrier.from_joint, carrier.to_joint);
            return {{transform_point(out.stretched[carrier.above], carrier.rest_ms.position),
                     turn.value_or(with_above.normalized())},
                    0.0};
        }
        return place_bone(carrier, render, chest_from_file);
    };
    for (std::size_t i = 0; i < rig.carriers.size(); ++i) {
        const PlacedBone placed = place(rig.carriers[i]);
        out.carrier_ws[i] = placed.frame_ws;
        out.stretched[i] = stretch_onto(rig.carriers[i], placed, girth);
    }
    const std::size_t joints = rig.joints.size();
    out.joint_ws.resize(joints);
    out.joint_ls.resize(joints);
    out.carry_ws.resize(joints);
    for (std::size_t i = 0; i < joints; ++i) {
        const BodyRig::Joint& joint = rig.joints[i];
        out.carry_ws[i] = out.stretched[joint.carrier];
        const Pose& bone_ws = out.carrier_ws[joint.carrier];
        out.joint_ws[i] = is_identity(joint.in_bone)
                              ? bone_ws
                              : Pose{transform_point(out.carry_ws[i], joint.bind_ms.position),
                                     (bone_ws.rotation * joint.in_bone.rotation).normalized()};
    }
    for (std::size_t i = 0; i < joints; ++i) {
        const std::int32_t parent = rig.joints[i].parent;
        out.joint_ls[i] =
            parent < 0 ? out.joint_ws[i]
                       : inverse(out.joint_ws[static_cast<std::size_t>(parent)]) * out.joint_ws[i];
    }
}

}  // namespace handhold
