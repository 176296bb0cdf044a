#include "systems/rigs/arm_twist.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/anim/skinning.hpp"
#include "systems/rigs/body_rig_fit.hpp"
#include "tests/places.hpp"
#include "tests/random.hpp"

namespace handhold::arm_twist_test {
namespace {

using test::Random;

constexpr double k_elbow_x_m = 0.5;
constexpr double k_wrist_x_m = 0.8;
constexpr double k_skin_m = 0.04;  // distance from the bone

// A figure in T-pose facing -Z with palms down. A strip of skin lies above the bone of its right
// forearm, from elbow to wrist.
struct Figure {
    SkinnedMesh mesh;

    Figure() {
        mesh.file = "figure.glb";
        const auto root = add("root", -1, Vec3::Zero());
        const auto hips = add("Hips", root, Vec3(0, 0.95, 0));
        add("Head", hips, Vec3(0, 1.6, 0));
        for (const double x : {-1.0, 1.0}) {
            const std::string side = x < 0.0 ? "Left" : "Right";
            const auto arm = add(side + "Arm", hips, Vec3(x * 0.2, 1.45, 0));
            const auto elbow = add(side + "ForeArm", arm, Vec3(x * k_elbow_x_m, 1.45, 0));
            add(side + "Hand", elbow, Vec3(x * k_wrist_x_m, 1.45, 0));
            const auto thigh = add(side + "UpLeg", hips, Vec3(x * 0.1, 0.9, 0));
            add(side + "Leg", thigh, Vec3(x * 0.1, 0.5, 0));
        }
    }
    std::int32_t add(const std::string& name, std::int32_t parent, const Vec3& at) {
        mesh.joints.push_back({name, parent, {at, Quat::Identity()}, {}});
        return static_cast<std::int32_t>(mesh.joints.size()) - 1;
    }
    std::uint16_t joint(const std::string& name) const {
        for (std::size_t i = 0; i < mesh.joints.size(); ++i) {
            if (mesh.joints[i].name == name) {
                return static_cast<std::uint16_t>(i);
            }
        }
        ADD_FAILURE() << name;
        return 0;
    }
    void add_skin(double along, const SkinWeights& weights) {
        const double x = k_elbow_x_m + along * (k_wrist_x_m - k_elbow_x_m);
        mesh.positions.emplace_back(x, 1.45 + k_skin_m, 0.0);
        mesh.normals.push_back(Vec3::UnitY());
        mesh.weights.push_back(weights);
    }
    // The last vertex is shared with the upper arm, as in common skins.
    void add_strip() {
        const std::uint16_t forearm = joint("RightForeArm");
        for (int i = 0; i <= 12; ++i) {
            add_skin(i / 12.0, {{forearm, 0, 0, 0}, {1, 0, 0, 0}});
        }
        add_skin(0.0, {{joint("RightArm"), forearm, 0, 0}, {0.5F, 0.5F, 0, 0}});
    }
    BodyRig fitted() {
        const Result<BodyRig> rig = fit_body_rig(mesh);
        EXPECT_TRUE(rig.ok()) << rig.error().message();
        return rig.value();
    }
};

// The right arm as in the file, with the hand turned about the forearm.
RenderPose with_twist(const BodyRig& rig, double twist_rad) {
    RenderPose render;
    ArmPose::Arm& arm = render.arms.arms[index_of(HandSide::right)];
    for (const BodyRig::Carrier& carrier : rig.carriers) {
        if (carrier.side != HandSide::right) {
            continue;
        }
        if (carrier.bone == BodyBone::upper_arm) {
            arm.upper_ws = carrier.rest_ms;
        } else if (carrier.bone == BodyBone::forearm) {
            arm.forearm_ws = carrier.rest_ms;
        } else if (carrier.bone == BodyBone::hand) {
            arm.hand_ws = carrier.rest_ms;
        }
    }
    arm.hand_ws.rotation = rotation_about(Vec3::UnitX(), -twist_rad) * arm.hand_ws.rotation;
    return render;
}

// The posed skin of a player with the figure's thickness.
std::vector<Vec3> skin_of(const Figure& figure, const BodyRig& rig, double twist_rad) {
    BodyMeasures measures;
    measures.eye_height_m = rig.eye_height_m;
    measures.shoulder_width_m = rig.shoulder_width_m;
    SkeletonPose pose;
    pose_skeleton(rig, measures, with_twist(rig, twist_rad), pose);
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    const SkinnedMesh& mesh = figure.mesh;
    skin_vertices({mesh.positions, mesh.normals, mesh.weights, pose.carry_ws}, positions, normals);
    return positions;
}

// Rotation of a point above the forearm's bone about the bone.
double turned_rad(const Vec3& point) { return arc_tangent2(-point.z(), point.y() - 1.45); }

TEST(FollowedTwist, IgnoresTheBendOfTheWrist) {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const Quat forearm = random.rotation();
        const double twist_rad = random.between(-2.09, 2.09);
        const Vec3 across =
            rotation_about(Vec3::UnitZ(), random.between(-3.0, 3.0)) * Vec3::UnitX();
        const Quat bend = rotation_about(across, random.between(-1.5, 1.5));
        const Quat hand = forearm * bend * rotation_about(Vec3::UnitZ(), twist_rad);
        EXPECT_NEAR(followed_twist(forearm, hand, 0.0), twist_rad, 1e-6);
    }
}

TEST(FollowedTwist, IsContinuousOverAFullTurn) {
    const Quat forearm = Quat::Identity();
    for (const double bend_rad : {0.0, 1.0, 2.5, 3.14}) {
        const Quat bend = rotation_about(Vec3::UnitX(), bend_rad);
        double before = followed_twist(forearm, bend, 0.4);
        for (int i = 0; i <= 2 * 360; ++i) {
            const double twist_rad = i * k_pi / 360.0;
            const double now =
                followed_twist(forearm, bend * rotation_about(Vec3::UnitZ(), twist_rad), 0.4);
            EXPECT_LT(std::abs(now - before), 0.02) << bend_rad << " " << twist_rad;
            before = now;
        }
    }
}

TEST(SpreadArmTwist, TwistGrowsFromElbowToWrist) {
    Figure figure;
    figure.add_strip();
    const std::vector<Vec3> file = figure.mesh.positions;
    BodyRig rig = figure.fitted();
    spread_arm_twist(figure.mesh, rig);
    ASSERT_EQ(rig.joints.size(), figure.mesh.joints.size());
    for (const SkinWeights& weights : figure.mesh.weights) {
        EXPECT_NEAR(weights.weight[0] + weights.weight[1] + weights.weight[2] + weights.weight[3],
                    1.0F, 1e-6F);
    }
    const std::vector<Vec3> rest = skin_of(figure, rig, 0.0);
    for (std::size_t i = 0; i < file.size(); ++i) {
        EXPECT_NEAR((rest[i] - file[i]).norm(), 0.0, 1e-9) << i;
    }
    // A quarter turn from palms down to thumbs up, and a small turn the other way.
    for (const double twist_rad : {-k_half_pi, 0.4}) {
        const std::vector<Vec3> now = skin_of(figure, rig, twist_rad);
        for (std::size_t i = 0; i <= 12; i += 4) {  // at the joints: exactly the joint's share
            const double share = static_cast<double>(i) / 12.0;
            EXPECT_NEAR(std::abs(turned_rad(now[i])), share * std::abs(twist_rad), 1e-6);
            EXPECT_NEAR(std::hypot(now[i].y() - 1.45, now[i].z()), k_skin_m, 1e-9);
            EXPECT_NEAR(now[i].x(), file[i].x(), 1e-9);
        }
        for (std::size_t i = 1; i <= 12; ++i) {  // between them: interpolated, without thinning
            EXPECT_LT(std::abs(turned_rad(now[i]) - turned_rad(now[i - 1])), 0.15);
            EXPECT_GT(std::hypot(now[i].y() - 1.45, now[i].z()), 0.96 * k_skin_m);
        }
        // The wrist's skin turns with the hand.
        EXPECT_NEAR((now[12] - (Vec3(k_wrist_x_m, 1.45, 0.0) +
                                rotation_about(Vec3::UnitX(), -twist_rad) * Vec3(0, k_skin_m, 0)))
                        .norm(),
                    0.0, 1e-9);
    }
}

TEST(SpreadArmTwist, RigidForearmTakesHalfOfTheTwist) {
    Figure figure;
    const std::uint16_t forearm = figure.joint("RightForeArm");
    figure.add_skin(0.0, {{forearm, 0, 0, 0}, {1, 0, 0, 0}});
    figure.add_skin(1.0, {{forearm, 0, 0, 0}, {1, 0, 0, 0}});
    BodyRig rig = figure.fitted();
    spread_arm_twist(figure.mesh, rig);
    EXPECT_EQ(rig.joints.size(), 13U);
    const std::vector<Vec3> now = skin_of(figure, rig, k_half_pi);
    EXPECT_NEAR(std::abs(turned_rad(now[0])), 0.5 * k_half_pi, 1e-6);
    EXPECT_NEAR(turned_rad(now[1]), turned_rad(now[0]), 1e-9);
}

// A rig with a joint in the middle of the forearm.
TEST(SpreadArmTwist, KeepsExistingTwistJointsWhichTakeTheirShare) {
    Figure figure;
    const auto twist =
        static_cast<std::uint16_t>(figure.add("RightForeArmTwist", figure.joint("RightForeArm"),
                                              Vec3(0.5 * (k_elbow_x_m + k_wrist_x_m), 1.45, 0.0)));
    figure.add_strip();
    figure.add_skin(0.5, {{twist, 0, 0, 0}, {1, 0, 0, 0}});
    BodyRig rig = figure.fitted();
    spread_arm_twist(figure.mesh, rig);
    EXPECT_TRUE(std::none_of(rig.joints.begin(), rig.joints.end(), [](const auto& joint) {
        return joint.name == "RightForeArm_twist_1";
    }));
    const std::vector<Vec3> now = skin_of(figure, rig, k_half_pi);
    EXPECT_NEAR(std::abs(turned_rad(now.back())), 0.5 * k_half_pi, 1e-6);
    EXPECT_NEAR(turned_rad(now[12]), 0.0, 1e-9);  // bound to the elbow's joint only
}

}  // namespace
}  // namespace handhold::arm_twist_test
