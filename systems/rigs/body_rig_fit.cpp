#include "systems/rigs/body_rig_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "systems/rigs/body_bones.hpp"
#include "systems/rigs/body_fingers.hpp"
#include "systems/rigs/body_joint_names.hpp"
#include "systems/rigs/bone_axes.hpp"

namespace handhold {
namespace {

constexpr double k_shortest_trunk_m = 1e-6;
constexpr double k_shortest = 1e-3;  // shortest bone / trunk length
// Height of the trunk's lower end above the hips / distance from hips to shoulders.
constexpr double k_hips_below = 0.06;

// Axes and trunk of the figure in the file.
struct Stance {
    Quat axes_ms = Quat::Identity();   // +Y up, -Z in the direction that the figure faces
    Vec3 pelvis_ms = Vec3::Zero();     // lower end of the trunk
    Vec3 shoulders_ms = Vec3::Zero();  // upper end of the trunk
    Vec3 up_ms = Vec3::UnitY();
    double trunk_m = 0.0;
};

class BodyFitter {
  public:
    BodyFitter(const SkinnedMesh& figure, const BodyBones& bones)
        : figure_(figure), bones_(bones), prefix_(shared_name_prefix(figure)) {}

    Result<BodyRig> fit() {
        if (const auto error = find_stance()) {
            return *error;
        }
        add({BodyBone::trunk,
             HandSide::left,
             1.0,
             {stance_.shoulders_ms, stance_.axes_ms},
             stance_.trunk_m});
        add({BodyBone::head, HandSide::left, 0.0, {Vec3::Zero(), stance_.axes_ms}, 0.0});
        rig_.head_joint_ms = place(*bones_.of_middle(BodyBone::head));
        carrier_of_.assign(figure_.joints.size(), k_none);
        carrier_of_[*bones_.of_middle(BodyBone::head)] = BodyRig::k_head;
        add_neck();
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            add_arm(side);
            add_leg(side);
        }
        if (!wrong_.empty()) {
            return FileError{figure_.file, "/nodes", "expected a length of " + wrong_};
        }
        carry_joints();
        find_eyes();
        if (!find_eye_height()) {
            return FileError{figure_.file, "/nodes", "expected a head above the pelvis"};
        }
        for (BodyRig::Joint& joint : rig_.joints) {
            joint.in_bone = in_bone(rig_.carriers[joint.carrier].rest_ms, joint.bind_ms);
        }
        return std::move(rig_);
    }

  private:
    static constexpr std::size_t k_none = ~std::size_t{0};

    const Vec3& place(std::size_t joint) const { return place_of(figure_, joint); }
    const Vec3& limb_place(HandSide side, BodyBone bone) const {
        return place(*bones_.limb(side, bone));
    }
    Vec3 back() const { return stance_.axes_ms * Vec3::UnitZ(); }
    // Returns the rotation with +Y along the bone and +Z to the figure's back. For a bone along the
    // back direction, +Z points down or up instead.
    Quat upright_along(const Vec3& along) const {
        const Vec3 bent = along.dot(back()) > 0.0 ? Vec3(-stance_.up_ms) : stance_.up_ms;
        return along_y(along, choose_aside(along, back(), bent));
    }
    Vec3 middle_of(BodyBone bone) const {
        return 0.5 * (limb_place(HandSide::left, bone) + limb_place(HandSide::right, bone));
    }
    bool has_both(BodyBone bone) const {
        return bones_.limb(HandSide::left, bone) && bones_.limb(HandSide::right, bone);
    }

    std::optional<FileError> find_stance() {
        const auto refuse = [&](const char* expected) {
            return FileError{figure_.file, "/nodes", expected};
        };
        stance_.shoulders_ms = middle_of(BodyBone::upper_arm);
        if (has_both(BodyBone::thigh)) {
            const Vec3 hips = middle_of(BodyBone::thigh);
            stance_.pelvis_ms = hips + k_hips_below * (stance_.shoulders_ms - hips);
        } else if (const auto& pelvis = bones_.of_middle(BodyBone::trunk)) {
            stance_.pelvis_ms = place(*pelvis);
        } else {
            return refuse("expected joints of a body, found neither thighs nor a pelvis");
        }
        const Vec3 up = stance_.shoulders_ms - stance_.pelvis_ms;
        const Vec3 right = limb_place(HandSide::right, BodyBone::upper_arm) -
                           limb_place(HandSide::left, BodyBone::upper_arm);
        stance_.trunk_m = up.norm();
        rig_.shoulder_width_m = right.norm();
        shortest_m_ = k_shortest * stance_.trunk_m;
        if (!(stance_.trunk_m > k_shortest_trunk_m) || !(right.norm() > shortest_m_)) {
            return refuse("expected a body with a length between hips and shoulders");
        }
        stance_.up_ms = up / stance_.trunk_m;
        const Vec3 back = right.normalized().cross(stance_.up_ms);
        if (stance_.up_ms.y() < 0.7 || back.norm() < 0.7) {
            return refuse("expected an upright body, +Y up, shoulders level");
        }
        stance_.axes_ms = along_y(stance_.up_ms, back);
        return std::nullopt;
    }

    std::size_t add(const BodyRig::Carrier& carrier) {
        rig_.carriers.push_back(carrier);
        return rig_.carriers.size() - 1;
    }
    void add_for(std::size_t joint, const BodyRig::Carrier& carrier) {
        carrier_of_[joint] = add(carrier);
    }
    double checked(double length_m, const BodyJointName& name) {
        if (!(length_m > shortest_m_)) {
            wrong_ += (wrong_.empty() ? "" : ", ") + body_joint_text(name);
        }
        return length_m;
    }

    void add_neck() {
        const auto& neck = bones_.of_middle(BodyBone::neck);
        if (!neck) {
            return;
        }
        const Vec3 along = rig_.head_joint_ms - place(*neck);
        const double length = checked(along.norm(), {BodyBone::neck, HandSide::left});
        add_for(
            *neck,
            {BodyBone::neck, HandSide::left, 1.0, {place(*neck), upright_along(along)}, length});
    }

    void add_arm(HandSide side) {
        const auto joint = [&](BodyBone bone) { return *bones_.limb(side, bone); };
        const Vec3 outwards =
            stance_.axes_ms * (side == HandSide::left ? Vec3(-1.0, 0.0, 0.0) : Vec3(Vec3::UnitX()));
        const auto add_bone = [&](BodyBone bone, BodyBone next, const Vec3& aside,
                                  const Vec3& other) {
            const Vec3 along = limb_place(side, next) - limb_place(side, bone);
            const double length = checked(along.norm(), {bone, side});
            const Quat turn = look_rotation(along, choose_aside(along, aside, other));
            const double share = bone == BodyBone::upper_arm ? 1.0 : 0.0;
            add_for(joint(bone), {bone, side, share, {limb_place(side, bone), turn}, length});
        };
        if (bones_.limb(side, BodyBone::clavicle)) {
            add_bone(BodyBone::clavicle, BodyBone::upper_arm, stance_.up_ms, outwards);
        }
        add_bone(BodyBone::upper_arm, BodyBone::forearm, back(), outwards);
        add_bone(BodyBone::forearm, BodyBone::hand, back(), outwards);
        const std::size_t hand = joint(BodyBone::hand);
        const Vec3 ahead = hand_direction(side);
        const auto fingers = find_figure_fingers(figure_, bones_, side);
        const Quat turn =
            figure_hand_axes(figure_, hand, fingers, side)
                .value_or(look_rotation(ahead, choose_aside(ahead, stance_.up_ms, outwards)));
        add_for(hand, {BodyBone::hand, side, 0.0, {place(hand), turn}, 0.0});
        BodyRig::Carrier& forearm = rig_.carriers[carrier_of_[joint(BodyBone::forearm)]];
        forearm.twist_rad = arm_twist(forearm.rest_ms.rotation, turn);
        for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
            const auto guess = parse_body_joint_name(name_of(i));
            const bool is_hand = (guess && !guess->is_part && guess->name.bone == BodyBone::hand) ||
                                 is_digit_name(name_of(i));
            if (is_hand && is_below(figure_, i, joint(BodyBone::forearm))) {
                carrier_of_[i] = carrier_of_[hand];
            }
        }
        add_fingers(side, fingers, {place(hand), turn}, carrier_of_[hand]);
    }

    // Joints of a finger follow its bones; all joints below them follow the nearest of these.
    void add_fingers(HandSide side, const std::vector<FigureFinger>& fingers, const Pose& hand_ms,
                     std::size_t hand) {
        for (const FigureFinger& finger : fingers) {
            const std::size_t first = rig_.carriers.size();
            for (const BodyRig::Carrier& bone :
                 finger_carriers(figure_, finger, hand_ms, side, first, hand)) {
                const std::size_t joint = finger.hinges[rig_.carriers.size() - first].joint;
                for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
                    if (i == joint || is_below(figure_, i, joint)) {
                        carrier_of_[i] = rig_.carriers.size();
                    }
                }
                add(bone);
            }
            if (finger.tip) {
                carrier_of_[*finger.tip] = rig_.carriers.size() - 1;
            }
        }
    }

    // Direction from the hand to the mean of its child joints; along the forearm if there are none.
    Vec3 hand_direction(HandSide side) const {
        const std::size_t hand = *bones_.limb(side, BodyBone::hand);
        Vec3 sum = Vec3::Zero();
        int count = 0;
        for (const SkinJoint& joint : figure_.joints) {
            if (joint.parent == static_cast<std::int32_t>(hand)) {
                sum += joint.bind_ms.position - place(hand);
                ++count;
            }
        }
        if (count > 0 && sum.norm() > shortest_m_) {
            return sum;
        }
        return place(hand) - limb_place(side, BodyBone::forearm);
    }

    void add_leg(HandSide side) {
        if (!bones_.limb(side, BodyBone::thigh) || !bones_.limb(side, BodyBone::shin)) {
            return;
        }
        const Vec3 hip = limb_place(side, BodyBone::thigh);
        const Vec3 knee = limb_place(side, BodyBone::shin);
        const auto& foot = bones_.limb(side, BodyBone::foot);
        // A missing foot is assumed as far below the knee as the hip is above it.
        const Vec3 ankle = foot ? place(*foot) : Vec3(2.0 * knee - hip);
        const double thigh_m = checked((knee - hip).norm(), {BodyBone::thigh, side});
        const double shin_m = checked((ankle - knee).norm(), {BodyBone::shin, side});
        add_for(*bones_.limb(side, BodyBone::thigh),
                {BodyBone::thigh, side, 0.0, {hip, upright_along(hip - knee)}, thigh_m});
        add_for(*bones_.limb(side, BodyBone::shin),
                {BodyBone::shin, side, 0.0, {knee, upright_along(knee - ankle)}, shin_m});
        if (foot) {
            add_for(*foot, {BodyBone::foot, side, 0.0, {ankle, stance_.axes_ms}, 0.0});
        }
    }

    // Assigns every joint the bone frame (BodyRig::carriers) that it follows.
    void carry_joints() {
        for (std::size_t i = 0; i < figure_.joints.size(); ++i) {
            const SkinJoint& joint = figure_.joints[i];
            rig_.joints.push_back({joint.name, joint.parent, joint.bind_ms, find_carrier(i), {}});
        }
    }

    std::size_t find_carrier(std::size_t joint) {
        auto at = static_cast<std::int32_t>(joint);
        for (; at >= 0; at = figure_.joints[static_cast<std::size_t>(at)].parent) {
            const std::size_t carrier = carrier_of_[static_cast<std::size_t>(at)];
            if (carrier != k_none) {
                return at == static_cast<std::int32_t>(joint) ? carrier
                                                              : carry_along(joint, carrier);
            }
        }
        if (const auto part = part_carrier(joint)) {
            return *part;
        }
        const double above =
            (place(joint) - stance_.pelvis_ms).dot(stance_.up_ms) / stance_.trunk_m;
        const double along = std::clamp(above, 0.0, 1.0);
        return add({BodyBone::trunk,
                    HandSide::left,
                    along,
                    {stance_.pelvis_ms + along * stance_.trunk_m * stance_.up_ms, stance_.axes_ms},
                    stance_.trunk_m});
    }

    // Returns the carrier of the limb in a joint's name. Some rigs keep twist joints and duplicates
    // beside the limb instead of below it.
    std::optional<std::size_t> part_carrier(std::size_t joint) {
        const auto guess = parse_body_joint_name(name_of(joint));
        if (!guess || !is_limb(guess->name.bone)) {
            return std::nullopt;
        }
        const auto& bone = bones_.limb(guess->name.side, guess->name.bone);
        if (!bone || carrier_of_[*bone] == k_none) {
            return std::nullopt;
        }
        return carry_along(joint, carrier_of_[*bone]);
    }

    // Returns the carrier of a joint below a bone. On a forearm it is a new carrier with the share
    // of twist at the joint's position.
    std::size_t carry_along(std::size_t joint, std::size_t above) {
        constexpr double k_at_elbow = 0.02;
        BodyRig::Carrier carrier = rig_.carriers[above];
        if (carrier.bone != BodyBone::forearm) {
            return above;
        }
        const double along = -inverse_transform_point(carrier.rest_ms, place(joint)).z();
        carrier.along = std::clamp(along / carrier.length_m, 0.0, 1.0);
        return carrier.along < k_at_elbow ? above : add(carrier);
    }

    void find_eyes() {
        Vec3 sum = Vec3::Zero();
        int eyes = 0;
        for (const BodyRig::Joint& joint : rig_.joints) {
            if (joint.carrier == BodyRig::k_head && is_eye_name(joint.name)) {
                sum += joint.bind_ms.position;
                ++eyes;
            }
        }
        rig_.carriers[BodyRig::k_head].rest_ms.position =
            eyes > 0 ? Vec3(sum / eyes) : estimated_eyes();
    }

    // Sets the eye height: above the lowest vertex, or for figures without legs estimated from the
    // pelvis. Returns false if the head is not above the pelvis.
    static constexpr double k_share_above_pelvis = 0.43;  // share of the height of a person's eyes
    bool find_eye_height() {
        const auto above = [&](const Vec3& point) {
            return (rig_.carriers[BodyRig::k_head].rest_ms.position - point).dot(stance_.up_ms);
        };
        const double above_pelvis = above(stance_.pelvis_ms);
        rig_.eye_height_m = above_pelvis / k_share_above_pelvis;
        if (has_both(BodyBone::shin)) {
            rig_.eye_height_m = above_pelvis;
            for (const Vec3& point : figure_.positions) {
                rig_.eye_height_m = std::max(rig_.eye_height_m, above(point));
            }
        }
        return above_pelvis > shortest_m_;
    }

    // Returns the middle of the front of the head's skin. Without skin, or where none lies ahead of
    // the head's joint: where a person's eyes are from the joint.
    Vec3 estimated_eyes() const {
        // Shares of the joint's height above the lowest vertex. Of a figure with eye joints,
        // Rocketbox's first adult.
        constexpr double k_up_share = 0.06;
        constexpr double k_ahead_share = 0.055;
        constexpr double k_least_ahead_share = 0.02;
        double height_m = 0.0;
        Vec3 low = Vec3::Constant(1e30);
        Vec3 high = Vec3::Constant(-1e30);
        for (std::size_t i = 0; i < figure_.positions.size(); ++i) {
            const Vec3 p =
                stance_.axes_ms.conjugate() * (figure_.positions[i] - rig_.head_joint_ms);
            height_m = std::max(height_m, -p.y());
            const std::uint16_t joint = heaviest_joint(figure_.weights[i]);
            if (rig_.joints[joint].carrier == BodyRig::k_head) {
                low = low.cwiseMin(p);
                high = high.cwiseMax(p);
            }
        }
        if (!has_both(BodyBone::shin)) {
            height_m =
                (rig_.head_joint_ms - stance_.pelvis_ms).dot(stance_.up_ms) / k_share_above_pelvis;
        }
        const bool has_face = !figure_.triangles.empty() && low.x() <= high.x() &&
                              -low.z() >= k_least_ahead_share * height_m;
        const Vec3 eyes =
            has_face ? Vec3(0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), low.z())
                     : Vec3(0.0, k_up_share * height_m, -k_ahead_share * height_m);
        return rig_.head_joint_ms + stance_.axes_ms * eyes;
    }

    // Returns the joint's pose in the bone's frame; exactly the identity if it differs only by
    // float rounding.
    Pose in_bone(const Pose& bone_ms, const Pose& joint_ms) const {
        const Pose pose = inverse(bone_ms) * joint_ms;
        const bool is_there =
            pose.position.norm() < 2e-6 * stance_.trunk_m && pose.rotation.vec().norm() < 1e-6;
        return is_there ? Pose() : pose;
    }

    std::string_view name_of(std::size_t joint) const {
        return bare_name(figure_.joints[joint].name, prefix_);
    }

    const SkinnedMesh& figure_;
    const BodyBones& bones_;
    std::string prefix_;
    Stance stance_;
    BodyRig rig_;
    // By joint of the figure: index into rig_.carriers of the bone frame that the joint follows.
    // k_none: the joint is neither a bone nor part of a hand. find_carrier then chooses a frame.
    std::vector<std::size_t> carrier_of_;
    double shortest_m_ = 0.0;
    std::string wrong_;
};

}  // namespace

Result<BodyRig> fit_body_rig(const SkinnedMesh& figure, const BodyMap& map) {
    const Result<BodyBones> mapped = find_mapped_bones(figure, map);
    return mapped ? fit_body_rig_with(figure, mapped.value()) : mapped.error();
}

Result<BodyRig> fit_body_rig_with(const SkinnedMesh& figure, const BodyBones& mapped,
                                  const char* names) {
    const Result<BodyBones> bones = find_body_bones(figure, mapped, names);
    if (!bones) {
        return bones.error();
    }
    return BodyFitter(figure, bones.value()).fit();
}

}  // namespace handhold
