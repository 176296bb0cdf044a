// The skin of an arm keeps its thickness while wrist and upper arm roll within a person's limits.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "engine/anim/skinning.hpp"
#include "engine/io/gltf_skin.hpp"
#include "systems/rigs/arm_twist.hpp"
#include "systems/rigs/body_rig_fit.hpp"
#include "tests/places.hpp"
#include "tests/systems/rigs/humanoid.hpp"
#include "tests/systems/rigs/rest_trunk.hpp"

namespace handhold::arm_skin_test {
namespace {

constexpr double k_right = 1.0;

// Bones of the right arm in the file.
struct ArmInFile {
    BodyRig::Carrier upper;
    BodyRig::Carrier forearm;
    BodyRig::Carrier hand;

    explicit ArmInFile(const BodyRig& rig) {
        for (const BodyRig::Carrier& carrier : rig.carriers) {
            if (carrier.side == HandSide::right && carrier.bone == BodyBone::upper_arm) {
                upper = carrier;
            } else if (carrier.side == HandSide::right && carrier.bone == BodyBone::forearm) {
                forearm = carrier;
            } else if (carrier.side == HandSide::right && carrier.bone == BodyBone::hand) {
                hand = carrier;
            }
        }
    }
};

// The figure as in the file, except for the right arm: the upper arm is rolled about its bone, and
// the hand about the forearm. All angles count from the file.
RenderPose rolled_arm(const BodyRig& rig, double upper_rad, double wrist_rad) {
    const ArmInFile file(rig);
    RenderPose render = test::rest_trunk(rig);
    ArmPose::Arm& arm = render.arms.arms[index_of(HandSide::right)];
    const auto rolled = [](const Quat& rotation, double angle_rad) {
        return (rotation * rotation_about(Vec3::UnitZ(), angle_rad)).normalized();
    };
    arm.upper_ws = {file.upper.rest_ms.position, rolled(file.upper.rest_ms.rotation, upper_rad)};
    // The elbow is a hinge: the forearm rolls with the upper arm.
    const Vec3 upper_axis = file.upper.rest_ms.rotation * Vec3::UnitZ();
    const Quat with_upper = rotation_about(upper_axis, upper_rad);
    const Vec3 elbow = file.forearm.rest_ms.position;
    const Vec3 wrist = file.hand.rest_ms.position;
    arm.forearm_ws = {elbow, (with_upper * file.forearm.rest_ms.rotation).normalized()};
    const Vec3 axis = file.forearm.rest_ms.rotation * Vec3::UnitZ();
    arm.hand_ws = {
        elbow + with_upper * (wrist - elbow),
        (with_upper * rotation_about(axis, wrist_rad) * file.hand.rest_ms.rotation).normalized()};
    return render;
}

SkeletonPose posed(const BodyRig& rig, const RenderPose& render) {
    BodyMeasures measures;
    measures.eye_height_m = rig.eye_height_m;
    measures.shoulder_width_m = rig.shoulder_width_m;
    SkeletonPose pose;
    pose_skeleton(rig, measures, render, pose);
    return pose;
}

// Mean distance of the skin from a bone, by slices of a tenth of its length. Vertices that follow
// the chest, the hand or another limb wholly are left out.
struct Slices {
    static constexpr int k_count = 10;
    std::array<double, k_count> sum_m{};
    std::array<int, k_count> vertices{};
};
bool follows(const SkinnedMesh& figure, const BodyRig& rig, std::size_t vertex, BodyBone bone) {
    for (std::size_t i = 0; i < 4; ++i) {
        const BodyRig::Carrier& carrier =
            rig.carriers[rig.joints[figure.weights[vertex].joint[i]].carrier];
        if (figure.weights[vertex].weight[i] > 0.05F && carrier.bone == bone &&
            carrier.side == HandSide::right) {
            return true;
        }
    }
    return false;
}
Slices slices_of(const SkinnedMesh& figure, const BodyRig& rig, const SkeletonPose& pose,
                 const BodyRig::Carrier& bone) {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    skin_vertices({figure.positions, figure.normals, figure.weights, pose.carry_ws}, positions,
                  normals);
    Slices slices;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vec3 in_file = inverse_transform_point(bone.rest_ms, figure.positions[i]);
        const double along = -in_file.z() / bone.length_m;
        if (along < 0.0 || along >= 1.0 || !follows(figure, rig, i, bone.bone)) {
            continue;
        }
        const auto slice = static_cast<std::size_t>(along * Slices::k_count);
        const Vec3 now = inverse_transform_point(bone.rest_ms, positions[i]);
        slices.sum_m[slice] += std::hypot(now.x(), now.y());
        ++slices.vertices[slice];
    }
    return slices;
}

// Smallest thickness of a slice with enough vertices / the same in the file.
double thinnest(const SkinnedMesh& figure, const BodyRig& rig, const BodyRig::Carrier& bone,
                double upper_rad, double wrist_rad) {
    constexpr int k_enough = 6;
    const Slices rest = slices_of(figure, rig, posed(rig, rolled_arm(rig, 0.0, 0.0)), bone);
    const Slices now =
        slices_of(figure, rig, posed(rig, rolled_arm(rig, upper_rad, wrist_rad)), bone);
    double least = 1.0;
    for (std::size_t i = 0; i < Slices::k_count; ++i) {
        if (rest.vertices[i] >= k_enough) {
            least = std::min(least, now.sum_m[i] / rest.sum_m[i]);
        }
    }
    return least;
}

struct Thickness {
    double forearm = 1.0;
    double upper_arm = 1.0;
};
// The thinnest slices over rolls of wrist and upper arm from -90 to 90 degrees.
Thickness thinnest_of(const SkinnedMesh& figure, const BodyRig& rig) {
    const ArmInFile file(rig);
    Thickness least;
    for (int degrees = -90; degrees <= 90; degrees += 15) {
        const double roll_rad = degrees * k_pi / 180.0;
        least.forearm = std::min(least.forearm, thinnest(figure, rig, file.forearm, 0.0, roll_rad));
        least.upper_arm =
            std::min(least.upper_arm, thinnest(figure, rig, file.upper, roll_rad, 0.0));
    }
    return least;
}

// A tube of skin around the right arm, from the chest to the hand. Skin within 3 cm of a joint
// follows the bones on both sides of it.
struct TubeArm {
    SkinnedMesh figure;

    TubeArm() {
        figure.file = "tube.glb";
        const auto hips = add("Hips", -1, Vec3(0, 0.95, 0));
        add("Head", hips, Vec3(0, 1.6, 0));
        for (const double x : {-k_right, k_right}) {
            const std::string side = x < 0.0 ? "Left" : "Right";
            const auto arm = add(side + "Arm", hips, Vec3(x * 0.2, 1.45, 0));
            const auto elbow = add(side + "ForeArm", arm, Vec3(x * 0.5, 1.45, 0));
            add(side + "Hand", elbow, Vec3(x * 0.8, 1.45, 0));
            const auto thigh = add(side + "UpLeg", hips, Vec3(x * 0.1, 0.9, 0));
            add(side + "Leg", thigh, Vec3(x * 0.1, 0.5, 0));
        }
        add_tube();
    }
    std::int32_t add(const std::string& name, std::int32_t parent, const Vec3& at) {
        figure.joints.push_back({name, parent, {at, Quat::Identity()}, {}});
        return static_cast<std::int32_t>(figure.joints.size()) - 1;
    }
    std::uint16_t joint(const std::string& name) const {
        const auto found = std::find_if(figure.joints.begin(), figure.joints.end(),
                                        [&](const SkinJoint& one) { return one.name == name; });
        return static_cast<std::uint16_t>(found - figure.joints.begin());
    }
    void add_tube() {
        constexpr double k_blend_m = 0.03;
        const std::array<std::uint16_t, 4> chain = {joint("Hips"), joint("RightArm"),
                                                    joint("RightForeArm"), joint("RightHand")};
        const std::array<double, 3> joints_m = {0.2, 0.5, 0.8};
        for (int ring = 0; ring <= 70; ++ring) {
            const double x = 0.16 + 0.01 * ring;
            std::size_t below = 0;
            double share = 0.0;
            for (std::size_t i = 0; i < joints_m.size(); ++i) {
                if (x >= joints_m[i] - k_blend_m) {
                    below = i;
                    share = std::min(1.0, (x - joints_m[i] + k_blend_m) / (2.0 * k_blend_m));
                }
            }
            for (int i = 0; i < 12; ++i) {
                const double a = 2.0 * k_pi * i / 12.0;
                figure.positions.emplace_back(x, 1.45 + 0.04 * std::cos(a), 0.04 * std::sin(a));
                figure.normals.emplace_back(0.0, std::cos(a), std::sin(a));
                figure.weights.push_back(
                    {{chain[below], chain[below + 1], 0, 0},
                     {static_cast<float>(1.0 - share), static_cast<float>(share), 0, 0}});
            }
        }
    }
};

TEST(ArmSkin, TubeKeepsItsThicknessOnlyWithSpreadTwist) {
    TubeArm tube;
    BodyRig rig = fit_body_rig(tube.figure).value();
    const Thickness before = thinnest_of(tube.figure, rig);
    EXPECT_LT(before.forearm, 0.9);
    EXPECT_LT(before.upper_arm, 0.9);
    spread_arm_twist(tube.figure, rig);
    const Thickness after = thinnest_of(tube.figure, rig);
    EXPECT_GT(after.forearm, 0.95);
    EXPECT_GT(after.upper_arm, 0.95);
}

// Turns of successive joints along the arm against each other, by rolls of upper arm and wrist.
TEST(ArmSkin, TwistBetweenSuccessiveJointsIsBounded) {
    TubeArm tube;
    BodyRig rig = fit_body_rig(tube.figure).value();
    spread_arm_twist(tube.figure, rig);
    for (const BodyBone bone : {BodyBone::upper_arm, BodyBone::forearm}) {
        std::map<double, std::size_t> by_share;
        for (std::size_t i = 0; i < rig.joints.size(); ++i) {
            const BodyRig::Carrier& carrier = rig.carriers[rig.joints[i].carrier];
            if (carrier.bone == bone && carrier.side == HandSide::right) {
                by_share[carrier.along] = i;
            }
        }
        ASSERT_EQ(by_share.size(), k_arm_twists + 1);
        for (int degrees = -120; degrees <= 120; degrees += 5) {
            const double roll_rad = degrees * k_pi / 180.0;
            const bool is_upper = bone == BodyBone::upper_arm;
            const SkeletonPose pose =
                posed(rig, rolled_arm(rig, is_upper ? roll_rad : 0.0, is_upper ? 0.0 : roll_rad));
            const Pose* last = nullptr;
            for (const auto& [share, joint] : by_share) {
                const Pose& now = pose.carrier_ws[rig.joints[joint].carrier];
                if (last != nullptr) {
                    const double turn =
                        rotation_to_vector(last->rotation.conjugate() * now.rotation).norm();
                    EXPECT_NEAR(turn, std::abs(roll_rad) / k_arm_twists, 1e-6);
                }
                last = &now;
            }
        }
    }
}

// A palm that faces down while the elbow points down is 160 degrees from one that faces the elbow,
// but within 90 degrees of the file's.
TEST(ArmSkin, TwistCountsFromTheFile) {
    for (const double rest_rad : {-k_half_pi, 0.3, k_half_pi}) {
        for (int degrees = -115; degrees <= 115; degrees += 5) {
            const double roll_rad = degrees * k_pi / 180.0;
            const Quat hand = rotation_about(Vec3::UnitZ(), rest_rad + roll_rad);
            EXPECT_NEAR(followed_twist(Quat::Identity(), hand, rest_rad), roll_rad, 1e-9);
        }
    }
}

// The figures of the data folder whose arms are skinned.
TEST(ArmSkin, RealFiguresKeepTheirThickness) {
    const auto folder = data_dir() / "body";
    if (!std::filesystem::exists(folder)) {
        GTEST_SKIP() << "no data";
    }
    for (const char* const name : {"rocketbox_male_adult_04.glb", "robot_expressive_cc0.glb"}) {
        SkinnedMesh figure = load_gltf_figure(folder / name).value();
        BodyRig rig = fit_body_rig(figure).value();
        const Thickness before = thinnest_of(figure, rig);
        spread_arm_twist(figure, rig);
        const Thickness after = thinnest_of(figure, rig);
        const auto percent = [](double share) { return static_cast<int>(100.0 * share); };
        std::printf("%s forearm %d -> %d %%, upper arm %d -> %d %%\n", name,
                    percent(before.forearm), percent(after.forearm), percent(before.upper_arm),
                    percent(after.upper_arm));
        EXPECT_GT(after.forearm, 0.85) << name;
        EXPECT_GT(after.upper_arm, 0.85) << name;
    }
}

}  // namespace
}  // namespace handhold::arm_skin_test
