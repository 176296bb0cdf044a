// Skeletons that hosts give as arrays.
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>

#include "systems/host/host_call.hpp"
#include "tests/systems/host/host_scene.hpp"
#include "tests/systems/rigs/stick_figure.hpp"

namespace handhold::host_given_skeleton_test {
namespace {

using namespace test;

// The stick figure with an index finger and a thumb on each hand.
SkinnedMesh figure_with_fingers(unsigned seed) {
    StickFigure sticks(1.0, 0.4 * seed, seed);
    SkinnedMesh& figure = sticks.figure;
    Random random(seed);
    for (const std::string side : {"Left", "Right"}) {
        const std::size_t hand = sticks.joint(side + "Hand");
        const Vec3 wrist = figure.joints[hand].bind_ms.position;
        const Vec3 ahead =
            (wrist - figure.joints[sticks.joint(side + "ForeArm")].bind_ms.position).normalized();
        const Vec3 aside = ahead.cross(Vec3::UnitY()) * (side == "Left" ? -1.0 : 1.0);
        figure.joints[sticks.joint(side + "HandMiddle1")].name = "prop" + side;
        for (const bool is_thumb : {true, false}) {
            auto parent = static_cast<std::int32_t>(hand);
            for (int i = 1; i <= 4; ++i) {
                const double along_m = (is_thumb ? 0.0 : 0.06) + 0.03 * i;
                const Vec3 at = wrist + along_m * ahead +
                                (is_thumb ? 0.03 + 0.01 * i : 0.02) * aside -
                                0.002 * i * Vec3::UnitY();
                const std::string name =
                    side + "Hand" + (is_thumb ? "Thumb" : "Index") + std::to_string(i);
                figure.joints.push_back({name, parent, {at, random.rotation()}, {}});
                parent = static_cast<std::int32_t>(figure.joints.size()) - 1;
            }
        }
    }
    return figure;
}

std::vector<hh_skeleton_joint> as_array(const SkinnedMesh& figure, hh_space space) {
    std::vector<hh_skeleton_joint> joints;
    for (const SkinJoint& joint : figure.joints) {
        Pose bind = joint.bind_ms;
        if (space == HH_SPACE_PARENT && joint.parent >= 0) {
            bind = inverse(figure.joints[static_cast<std::size_t>(joint.parent)].bind_ms) * bind;
        }
        joints.push_back({joint.name.c_str(), joint.parent, HH_IS_BY_NAME, to_c(bind)});
    }
    return joints;
}

std::vector<hh_pose> posed(HostScene& scene, std::size_t count) {
    std::vector<hh_pose> poses(count);
    std::size_t found = 0;
    EXPECT_EQ(hh_player_skeleton(scene.world.get(), scene.player, HH_SPACE_WORLD, poses.data(),
                                 poses.size(), &found),
              HH_OK);
    EXPECT_EQ(found, count);
    return poses;
}

void expect_equal(const std::vector<hh_pose>& a, const std::vector<hh_pose>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_LT(distance_m(a[i].position, b[i].position), 1e-9) << i;
    }
}

std::string text_of_error() { return hh_last_error(); }

TEST(GivenSkeleton, FollowsThePlayerInEitherSpaceAndItsFingersTheShownHand) {
    for (unsigned seed = 1; seed < 8; ++seed) {
        HostScene scene;
        scene.add_wall();
        const SkinnedMesh figure = figure_with_fingers(seed);
        const auto in_world = as_array(figure, HH_SPACE_WORLD);
        ASSERT_TRUE(scene.world.set_body_skeleton(scene.player, in_world, HH_SPACE_WORLD))
            << hh_last_error();
        scene.step(5);
        scene.closed = {true, true};
        scene.step(60);
        const auto poses = posed(scene, in_world.size());
        const auto in_parent = as_array(figure, HH_SPACE_PARENT);
        ASSERT_TRUE(scene.world.set_body_skeleton(scene.player, in_parent, HH_SPACE_PARENT));
        expect_equal(posed(scene, in_world.size()), poses);
        std::size_t fingers = 0;
        ASSERT_EQ(hh_player_skeleton_fingers(scene.world.get(), scene.player, HH_LEFT, &fingers),
                  HH_OK);
        EXPECT_EQ(fingers, 2U);
        const auto hand = *scene.world.hand_joints(scene.player, HH_RIGHT, HH_SPACE_WORLD);
        for (std::size_t i = 0; i < figure.joints.size(); ++i) {
            if (figure.joints[i].name == "RightHandIndex2") {
                const hh::Vec3 found = poses[i + 1].position - poses[i].position;
                const hh::Vec3 wanted =
                    hand[HH_INDEX_DISTAL].pose.position - hand[HH_INDEX_INTERMEDIATE].pose.position;
                EXPECT_LT(distance_m(hh::normalized(found), hh::normalized(wanted)), 1e-9);
            }
        }
    }
}

TEST(GivenSkeleton, AMapReplacesNames) {
    HostScene scene;
    const SkinnedMesh figure = figure_with_fingers(3);
    auto joints = as_array(figure, HH_SPACE_WORLD);
    ASSERT_TRUE(scene.world.set_body_skeleton(scene.player, joints, HH_SPACE_WORLD));
    scene.step(10);
    const auto named = posed(scene, joints.size());
    struct Known {
        const char* name;
        std::int32_t is;
    };
    constexpr std::array k_known = {
        Known{"Head", HH_IS_BODY + HH_HEAD},
        Known{"Neck", HH_IS_BODY + HH_NECK},
        Known{"LeftShoulder", HH_IS_BODY + HH_LEFT_SHOULDER},
        Known{"LeftArm", HH_IS_BODY + HH_LEFT_UPPER_ARM},
        Known{"LeftForeArm", HH_IS_BODY + HH_LEFT_LOWER_ARM},
        Known{"LeftHand", HH_IS_BODY + HH_LEFT_HAND},
        Known{"RightShoulder", HH_IS_BODY + HH_RIGHT_SHOULDER},
        Known{"RightArm", HH_IS_BODY + HH_RIGHT_UPPER_ARM},
        Known{"RightForeArm", HH_IS_BODY + HH_RIGHT_LOWER_ARM},
        Known{"RightHand", HH_IS_RIGHT_HAND + HH_HAND_WRIST},
        Known{"LeftUpLeg", HH_IS_BODY + HH_LEFT_UPPER_LEG},
        Known{"LeftLeg", HH_IS_BODY + HH_LEFT_LOWER_LEG},
        Known{"LeftFoot", HH_IS_BODY + HH_LEFT_FOOT},
        Known{"RightUpLeg", HH_IS_BODY + HH_RIGHT_UPPER_LEG},
        Known{"RightLeg", HH_IS_BODY + HH_RIGHT_LOWER_LEG},
        Known{"RightFoot", HH_IS_BODY + HH_RIGHT_FOOT},
        Known{"LeftHandThumb1", HH_IS_LEFT_HAND + HH_THUMB_METACARPAL},
        Known{"LeftHandThumb2", HH_IS_LEFT_HAND + HH_THUMB_PROXIMAL},
        Known{"LeftHandThumb3", HH_IS_LEFT_HAND + HH_THUMB_DISTAL},
        Known{"LeftHandThumb4", HH_IS_LEFT_HAND + HH_THUMB_TIP},
        Known{"LeftHandIndex1", HH_IS_LEFT_HAND + HH_INDEX_PROXIMAL},
        Known{"LeftHandIndex2", HH_IS_LEFT_HAND + HH_INDEX_INTERMEDIATE},
        Known{"LeftHandIndex3", HH_IS_LEFT_HAND + HH_INDEX_DISTAL},
        Known{"LeftHandIndex4", HH_IS_LEFT_HAND + HH_INDEX_TIP},
        Known{"RightHandThumb1", HH_IS_RIGHT_HAND + HH_THUMB_METACARPAL},
        Known{"RightHandThumb2", HH_IS_RIGHT_HAND + HH_THUMB_PROXIMAL},
        Known{"RightHandThumb3", HH_IS_RIGHT_HAND + HH_THUMB_DISTAL},
        Known{"RightHandThumb4", HH_IS_RIGHT_HAND + HH_THUMB_TIP},
        Known{"RightHandIndex1", HH_IS_RIGHT_HAND + HH_INDEX_PROXIMAL},
        Known{"RightHandIndex2", HH_IS_RIGHT_HAND + HH_INDEX_INTERMEDIATE},
        Known{"RightHandIndex3", HH_IS_RIGHT_HAND + HH_INDEX_DISTAL},
        Known{"RightHandIndex4", HH_IS_RIGHT_HAND + HH_INDEX_TIP},
    };
    for (std::size_t i = 0; i < joints.size(); ++i) {
        if (std::string_view(joints[i].name).ends_with("Eye")) {
            continue;  // eyes have names
        }
        for (const Known& known : k_known) {
            if (figure.joints[i].name == known.name) {
                joints[i].is = known.is;
            }
        }
        joints[i].name = nullptr;
    }
    ASSERT_TRUE(scene.world.set_body_skeleton(scene.player, joints, HH_SPACE_WORLD))
        << hh_last_error();
    expect_equal(posed(scene, joints.size()), named);
}

TEST(GivenSkeleton, ErrorsNameJointsAndNoFile) {
    HostScene scene;
    const SkinnedMesh figure = figure_with_fingers(2);
    const auto refusal = [&](const auto& change) {
        auto joints = as_array(figure, HH_SPACE_WORLD);
        change(joints);
        EXPECT_FALSE(scene.world.set_body_skeleton(scene.player, joints, HH_SPACE_WORLD));
        const std::string text = text_of_error();
        for (const char* const wrong : {"/nodes", "file", "--body-map", "glb"}) {
            EXPECT_EQ(text.find(wrong), std::string::npos) << text;
        }
        return text;
    };
    using Joints = std::vector<hh_skeleton_joint>;
    EXPECT_NE(refusal([](Joints& joints) { joints[3].parent = 4; }).find("joint 3 (Neck)"),
              std::string::npos);
    EXPECT_NE(refusal([](Joints& joints) { joints[3].parent = 999; }).find("joint 3 (Neck)"),
              std::string::npos);
    EXPECT_NE(refusal([](Joints& joints) { joints[4].is = 77; }).find("joint 4 (Head)"),
              std::string::npos);
    EXPECT_NE(refusal([](Joints& joints) {
                  joints[3].is = joints[4].is = HH_IS_BODY + HH_HEAD;
              }).find("joint 4 (Head)"),
              std::string::npos);
    EXPECT_NE(refusal([](Joints& joints) { joints.resize(5); }).find("left_upper_arm"),
              std::string::npos);
    EXPECT_TRUE(scene.world.set_body_skeleton(scene.player, {}, HH_SPACE_WORLD));
}

}  // namespace
}  // namespace handhold::host_given_skeleton_test
