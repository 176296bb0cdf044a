// Checks the proportions of a figure. If a wrong joint was taken for a bone, the proportions are
// not those of a body.
#include <cmath>
#include <cstdio>

#include "systems/rigs/body_bones.hpp"

namespace handhold {
namespace {

// The bounds are twice as wide as the range that was measured on people, cartoon figures and
// robots.
struct RatioBound {
    double low, high;
};
constexpr RatioBound k_shoulder_bound = {0.35, 2.0};   // shoulder width / trunk length
constexpr RatioBound k_arm_bound = {0.6, 3.5};         // (upper arm + forearm) / trunk length
constexpr RatioBound k_arm_parts_bound = {0.35, 2.9};  // upper arm / forearm
constexpr RatioBound k_leg_bound = {0.4, 4.5};         // (thigh + shin) / trunk length
constexpr RatioBound k_leg_parts_bound = {0.35, 2.9};  // thigh / shin
// Largest distance of a joint from the other side's mirror image / trunk length.
constexpr double k_max_mirror_error = 0.45;
constexpr double k_max_side_ratio = 1.3;  // largest ratio of the left and right bones' lengths

std::string two_digits(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.2f", value);
    return text;
}

class Plausibility {
  public:
    Plausibility(const SkinnedMesh& figure, const BodyBones& bones)
        : figure_(figure), bones_(bones) {}

    std::optional<std::string> check() {
        find_frame();
        if (!(trunk_m_ > 0.0)) {
            return std::nullopt;  // fit_body_rig refuses it
        }
        check_trunk();
        check_limb(BodyBone::upper_arm, BodyBone::forearm, BodyBone::hand, k_arm_bound,
                   k_arm_parts_bound);
        if (has_both(BodyBone::thigh) && has_both(BodyBone::shin)) {
            check_limb(BodyBone::thigh, BodyBone::shin, BodyBone::foot, k_leg_bound,
                       k_leg_parts_bound);
            check_order();
        }
        return wrong_.empty() ? std::nullopt : std::optional(wrong_);
    }

  private:
    bool has_both(BodyBone bone) const {
        return bones_.limb(HandSide::left, bone) && bones_.limb(HandSide::right, bone);
    }
    Vec3 at(HandSide side, BodyBone bone) const {
        return place_of(figure_, *bones_.limb(side, bone));
    }
    Vec3 middle(BodyBone bone) const {
        return 0.5 * (at(HandSide::left, bone) + at(HandSide::right, bone));
    }
    // Bone and joint name for messages, such as: left_hand "lHand".
    std::string quoted(HandSide side, BodyBone bone) const {
        const auto& joint = bones_.limb(side, bone);
        return body_joint_text({bone, side}) +
               (joint ? " \"" + figure_.joints[*joint].name + "\"" : std::string());
    }
    std::string both(BodyBone bone) const {
        return quoted(HandSide::left, bone) + " and " + quoted(HandSide::right, bone);
    }
    void refuse(const std::string& what) {
        if (wrong_.empty()) {
            wrong_ = "expected a body's proportions, found " + what;
        }
    }
    void check_ratio(double value, const RatioBound& bound, const std::string& what) {
        if (!(value >= bound.low && value <= bound.high)) {
            refuse(what + " " + two_digits(value) + ", outside " + two_digits(bound.low) + " to " +
                   two_digits(bound.high));
        }
    }

    void find_frame() {
        const Vec3 shoulders = middle(BodyBone::upper_arm);
        pelvis_ = has_both(BodyBone::thigh) ? middle(BodyBone::thigh)
                                            : place_of(figure_, *bones_.of_middle(BodyBone::trunk));
        const Vec3 up = shoulders - pelvis_;
        const Vec3 right =
            at(HandSide::right, BodyBone::upper_arm) - at(HandSide::left, BodyBone::upper_arm);
        trunk_m_ = up.norm();
        width_m_ = right.norm();
        if (!(width_m_ > 0.0) || !(trunk_m_ > 0.0)) {
            trunk_m_ = 0.0;
            return;
        }
        up_ = up / trunk_m_;
        right_ = right / width_m_;
    }

    void check_trunk() {
        check_ratio(width_m_ / trunk_m_, k_shoulder_bound,
                    both(BodyBone::upper_arm) + " apart by the trunk's length times");
        const Vec3 head = place_of(figure_, *bones_.of_middle(BodyBone::head));
        if ((head - pelvis_).dot(up_) < 0.9 * trunk_m_) {
            refuse("head \"" + figure_.joints[*bones_.of_middle(BodyBone::head)].name +
                   "\" below the shoulders");
        }
    }

    void check_limb(BodyBone upper, BodyBone lower, BodyBone end, const RatioBound& length,
                    const RatioBound& parts) {
        std::array<double, 2> upper_m{};
        std::array<double, 2> lower_m{};
        const bool has_end = has_both(end);
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const std::size_t i = index_of(side);
            upper_m[i] = (at(side, lower) - at(side, upper)).norm();
            lower_m[i] = has_end ? (at(side, end) - at(side, lower)).norm() : upper_m[i];
            if (!(upper_m[i] > 0.0) || !(lower_m[i] > 0.0)) {
                return;  // fit_body_rig refuses it
            }
            check_ratio(
                (upper_m[i] + lower_m[i]) / trunk_m_, length,
                quoted(side, upper) + " to " + quoted(side, end) + " of the trunk's length times");
            check_ratio(upper_m[i] / lower_m[i], parts,
                        quoted(side, upper) + " as long as " + quoted(side, lower) + " times");
        }
        check_sides(upper_m, upper);
        check_sides(lower_m, lower);
        check_mirrored(upper);
        check_mirrored(lower);
        if (has_end) {
            check_mirrored(end);
        }
    }
    void check_sides(const std::array<double, 2>& length_m, BodyBone bone) {
        const double ratio = length_m[0] / length_m[1];
        check_ratio(ratio, {1.0 / k_max_side_ratio, k_max_side_ratio},
                    both(bone) + " with lengths in ratio");
    }
    // Compares the right joint with the mirror image of the left one.
    void check_mirrored(BodyBone bone) {
        const Vec3 left = at(HandSide::left, bone) - pelvis_;
        const Vec3 mirrored = left - 2.0 * right_ * right_.dot(left);
        const double off = (at(HandSide::right, bone) - pelvis_ - mirrored).norm();
        if (off > k_max_mirror_error * trunk_m_) {
            refuse(both(bone) + " off their mirror images by the trunk's length times " +
                   two_digits(off / trunk_m_));
        }
    }
    void check_order() {
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const double hip = at(side, BodyBone::thigh).dot(up_);
            const double knee = at(side, BodyBone::shin).dot(up_);
            if (knee >= hip) {
                refuse(quoted(side, BodyBone::shin) + " above " + quoted(side, BodyBone::thigh));
            }
            if (bones_.limb(side, BodyBone::foot) && at(side, BodyBone::foot).dot(up_) >= knee) {
                refuse(quoted(side, BodyBone::foot) + " above " + quoted(side, BodyBone::shin));
            }
        }
    }

    const SkinnedMesh& figure_;
    const BodyBones& bones_;
    Vec3 pelvis_ = Vec3::Zero();
    Vec3 up_ = Vec3::UnitY();
    Vec3 right_ = Vec3::UnitX();
    double trunk_m_ = 0.0;
    double width_m_ = 0.0;
    std::string wrong_;
};

}  // namespace

std::optional<std::string> find_implausible_bone(const SkinnedMesh& figure,
                                                 const BodyBones& bones) {
    return Plausibility(figure, bones).check();
}

}  // namespace handhold
