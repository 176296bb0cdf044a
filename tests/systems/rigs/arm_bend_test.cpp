// The skin around a wrist and a shoulder keeps its thickness while the joint twists, and around a
// shoulder also while it bends. Bent wrists are only printed: the hand's skin is not drawn.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/anim/skinning.hpp"
#include "engine/io/gltf_skin.hpp"
#include "systems/rigs/arm_twist.hpp"
#include "systems/rigs/body_rig_fit.hpp"
#include "tests/places.hpp"
#include "tests/systems/rigs/humanoid.hpp"
#include "tests/systems/rigs/rest_trunk.hpp"

namespace handhold::arm_bend_test {
namespace {

const BodyRig::Carrier& right_bone(const BodyRig& rig, BodyBone bone) {
    const auto found = std::find_if(
        rig.carriers.begin(), rig.carriers.end(), [bone](const BodyRig::Carrier& carrier) {
            return carrier.bone == bone && carrier.side == HandSide::right;
        });
    return *found;
}

// The right arm against the file: the whole arm turned about the shoulder, then the hand about the
// wrist, in the frames of the bones (x to the right hand's inner side, z back along the bone).
struct ArmMove {
    Quat shoulder = Quat::Identity();
    Quat wrist = Quat::Identity();
};

RenderPose moved_arm(const BodyRig& rig, const ArmMove& move) {
    RenderPose render = test::rest_trunk(rig);
    for (const BodyRig::Carrier& carrier : rig.carriers) {
        ArmPose::Arm& arm = render.arms.arms[index_of(carrier.side)];
        if (carrier.bone == BodyBone::upper_arm) {
            arm.upper_ws = carrier.rest_ms;
        } else if (carrier.bone == BodyBone::forearm) {
            arm.forearm_ws = carrier.rest_ms;
        } else if (carrier.bone == BodyBone::hand) {
            arm.hand_ws = carrier.rest_ms;
        }
    }
    ArmPose::Arm& arm = render.arms.arms[index_of(HandSide::right)];
    const auto turn = [](const Quat& in_bone, const Quat& bone) {
        return (bone * in_bone * bone.conjugate()).normalized();
    };
    const auto about = [](const Vec3& center, const Quat& by, const Pose& pose) {
        return Pose{center + by * (pose.position - center), (by * pose.rotation).normalized()};
    };
    arm.hand_ws =
        about(arm.hand_ws.position, turn(move.wrist, arm.forearm_ws.rotation), arm.hand_ws);
    const Quat whole = turn(move.shoulder, arm.upper_ws.rotation);
    const Vec3 shoulder = arm.upper_ws.position;
    arm.upper_ws = about(shoulder, whole, arm.upper_ws);
    arm.forearm_ws = about(shoulder, whole, arm.forearm_ws);
    arm.hand_ws = about(shoulder, whole, arm.hand_ws);
    return render;
}

double distance_to_line(const Vec3& point, const Vec3& from, const Vec3& to) {
    const Vec3 along = to - from;
    const double share = std::clamp(along.dot(point - from) / along.squaredNorm(), 0.0, 1.0);
    return (from + share * along - point).norm();
}

// Skin around one joint: mean distance from the two bones that meet there, by slices of 2 % of the
// eye height along the bones in the file.
class JointSkin {
  public:
    JointSkin(const SkinnedMesh& figure, const BodyRig& rig, BodyBone upper, BodyBone lower)
        : figure_(figure), rig_(rig), upper_(upper), lower_(lower) {
        rest_ = slices(ArmMove());
    }

    // Thinnest slice / the same in the file.
    double thinnest(const ArmMove& move) const {
        constexpr int k_enough = 6;
        const Slices now = slices(move);
        double least = 1.0;
        for (std::size_t i = 0; i < k_slices; ++i) {
            if (rest_.vertices[i] >= k_enough) {
                least = std::min(least, now.sum_m[i] / rest_.sum_m[i]);
            }
        }
        return least;
    }

  private:
    static constexpr std::size_t k_slices = 8;  // half of them beyond the joint
    struct Slices {
        std::array<double, k_slices> sum_m{};
        std::array<int, k_slices> vertices{};
    };

    bool follows(std::size_t vertex) const {
        for (std::size_t i = 0; i < 4; ++i) {
            const BodyRig::Carrier& carrier =
                rig_.carriers[rig_.joints[figure_.weights[vertex].joint[i]].carrier];
            if (figure_.weights[vertex].weight[i] > 0.05F && is_limb(carrier.bone) &&
                carrier.side == HandSide::right &&
                (carrier.bone == upper_ || carrier.bone == lower_)) {
                return true;
            }
        }
        return false;
    }

    Slices slices(const ArmMove& move) const {
        const RenderPose render = moved_arm(rig_, move);
        BodyMeasures measures;
        measures.eye_height_m = rig_.eye_height_m;
        measures.shoulder_width_m = rig_.shoulder_width_m;
        SkeletonPose pose;
        pose_skeleton(rig_, measures, render, pose);
        std::vector<Vec3> positions;
        std::vector<Vec3> normals;
        skin_vertices({figure_.positions, figure_.normals, figure_.weights, pose.carry_ws},
                      positions, normals);
        const double reach_m = 0.04 * rig_.eye_height_m;
        // The bones that meet at the joint: `above` comes from the trunk's side, `beyond` leads to
        // the fingers.
        const Pose rest = right_bone(rig_, lower_).rest_ms;
        const Vec3 axis = lower_ == BodyBone::hand
                              ? Vec3(right_bone(rig_, upper_).rest_ms.rotation * -Vec3::UnitZ())
                              : Vec3(rest.rotation * -Vec3::UnitZ());
        const ArmPose::Arm& arm = render.arms.arms[index_of(HandSide::right)];
        const bool is_wrist = lower_ == BodyBone::hand;
        const Vec3 joint = is_wrist ? arm.hand_ws.position : arm.upper_ws.position;
        const Quat carried =
            is_wrist ? arm.forearm_ws.rotation *
                           right_bone(rig_, BodyBone::forearm).rest_ms.rotation.conjugate()
                     : Quat::Identity();
        const Quat bent = is_wrist ? arm.hand_ws.rotation * rest.rotation.conjugate()
                                   : arm.upper_ws.rotation * rest.rotation.conjugate();
        const Vec3 above = joint - 3.0 * reach_m * (carried * axis);
        const Vec3 beyond = joint + 3.0 * reach_m * (bent * axis);
        Slices found;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const double along = axis.dot(figure_.positions[i] - rest.position) / reach_m;
            if (along < -1.0 || along >= 1.0 || !follows(i)) {
                continue;
            }
            const auto slice =
                static_cast<std::size_t>((along + 1.0) * 0.5 * static_cast<double>(k_slices));
            found.sum_m[slice] += std::min(distance_to_line(positions[i], above, joint),
                                           distance_to_line(positions[i], joint, beyond));
            ++found.vertices[slice];
        }
        return found;
    }

    const SkinnedMesh& figure_;
    const BodyRig& rig_;
    BodyBone upper_;
    BodyBone lower_;
    Slices rest_;
};

double radians(double degrees) { return degrees * k_pi / 180.0; }

// The thinnest skin over moves of the joint.
struct Thinnest {
    double twist = 1.0;      // by at most 120 degrees
    double far_twist = 1.0;  // by 150 degrees
    double bend = 1.0;
};
Thinnest thinnest_wrist(const JointSkin& wrist) {
    Thinnest least;
    for (const double degrees : {-150.0, -120.0, -90.0, 90.0, 120.0, 150.0}) {
        const Quat turn = rotation_about(Vec3::UnitZ(), radians(degrees));
        double& twist = std::abs(degrees) > 120.0 ? least.far_twist : least.twist;
        twist = std::min(twist, wrist.thinnest({Quat::Identity(), turn}));
    }
    for (const double degrees : {-90.0, 90.0}) {
        for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY())}) {
            const Quat turn = rotation_about(axis, radians(degrees));
            least.bend = std::min(least.bend, wrist.thinnest({Quat::Identity(), turn}));
        }
    }
    return least;
}
Thinnest thinnest_shoulder(const JointSkin& shoulder) {
    Thinnest least;
    for (const double degrees : {-120.0, -90.0, 90.0, 120.0}) {
        const Quat turn = rotation_about(Vec3::UnitZ(), radians(degrees));
        least.twist = std::min(least.twist, shoulder.thinnest({turn, Quat::Identity()}));
    }
    for (const double degrees : {-80.0, 80.0}) {
        for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY())}) {
            const Quat turn = rotation_about(axis, radians(degrees));
            least.bend = std::min(least.bend, shoulder.thinnest({turn, Quat::Identity()}));
        }
    }
    return least;
}

void expect_thickness(const std::string& name, SkinnedMesh figure) {
    BodyRig rig = fit_body_rig(figure).value();
    spread_arm_twist(figure, rig);
    const JointSkin wrist(figure, rig, BodyBone::forearm, BodyBone::hand);
    const JointSkin shoulder(figure, rig, BodyBone::clavicle, BodyBone::upper_arm);
    const Thinnest at_wrist = thinnest_wrist(wrist);
    const Thinnest at_shoulder = thinnest_shoulder(shoulder);
    std::printf(
        "%-28s wrist: twist %.2f, by 150 degrees %.2f, bend %.2f; shoulder: twist %.2f, bend "
        "%.2f\n",
        name.c_str(), at_wrist.twist, at_wrist.far_twist, at_wrist.bend, at_shoulder.twist,
        at_shoulder.bend);
    // Skin that is blended linearly between two bones thins to cos(angle / 2): 0.5 at 120 degrees,
    // 0.26 at 150 degrees.
    EXPECT_GT(at_wrist.twist, 0.85) << name;
    EXPECT_GT(at_wrist.far_twist, 0.65) << name;
    EXPECT_GT(at_shoulder.twist, 0.8) << name;
    EXPECT_GT(at_shoulder.bend, 0.45) << name;
}

TEST(ArmBend, FiguresOfAllConventionsKeepTheirThickness) {
    int figures = 0;
    for (const test::HumanoidConvention& convention : test::humanoid_conventions()) {
        const test::Humanoid made = test::make_humanoid(convention);
        if (!fit_body_rig(made.figure)) {
            continue;  // conventions without names that tell the bones: see body_conventions_test
        }
        expect_thickness(convention.name, made.figure);
        ++figures;
    }
    EXPECT_GE(figures, 10);
}

TEST(ArmBend, RealFiguresKeepTheirThickness) {
    const auto folder = data_dir() / "body";
    if (!std::filesystem::exists(folder)) {
        GTEST_SKIP() << "no data";
    }
    for (const char* const name : {"rocketbox_male_adult_04.glb", "robot_expressive_cc0.glb"}) {
        expect_thickness(name, load_gltf_figure(folder / name).value());
    }
}

}  // namespace
}  // namespace handhold::arm_bend_test
