#include "systems/rigs/body_joint_names.hpp"

#include <gtest/gtest.h>

namespace handhold::body_joint_names_test {
namespace {

TEST(BodyJointNames, AreReadFromCommonRigs) {
    const auto expect = [](const char* text, BodyBone bone, HandSide side, int doubt = 0) {
        const auto guess = parse_body_joint_name(text);
        ASSERT_TRUE(guess) << text;
        EXPECT_EQ(guess->name, (BodyJointName{bone, side})) << text;
        EXPECT_EQ(guess->doubt, doubt) << text;
    };
    expect("Bip01 L UpperArm", BodyBone::upper_arm, HandSide::left);
    expect("mixamorig:RightForeArm", BodyBone::forearm, HandSide::right);
    expect("mixamorig:RightArm", BodyBone::upper_arm, HandSide::right, 1);
    expect("mixamorig:LeftUpLeg", BodyBone::thigh, HandSide::left);
    expect("mixamorig:LeftLeg", BodyBone::shin, HandSide::left, 1);
    expect("LowerArm.R", BodyBone::forearm, HandSide::right);
    expect("upper_arm.L", BodyBone::upper_arm, HandSide::left);
    expect("J_Bip_R_LowerLeg", BodyBone::shin, HandSide::right);
    expect("leftKneePitchLink", BodyBone::shin, HandSide::left);
    expect("hand_right", BodyBone::hand, HandSide::right);
    expect("Bip01 Pelvis", BodyBone::trunk, HandSide::left);
    expect("mixamorig:Hips", BodyBone::trunk, HandSide::left);
    expect("Bip01 Head", BodyBone::head, HandSide::left);
    // Namespaces are ignored.
    expect("Handyman:LeftForeArm", BodyBone::forearm, HandSide::left);
    expect("Engineering|Ship:UpperArm.R", BodyBone::upper_arm, HandSide::right);
    expect("LeftLeague:Pelvis", BodyBone::trunk, HandSide::left);
    for (const char* other :
         {"Bip01 L Finger0", "mixamorig:LeftHandThumb1", "mixamorig:LeftToeBase", "Head_end",
          "PoleTarget.L", "head_imu_link", "torso", ""}) {
        EXPECT_FALSE(parse_body_joint_name(other)) << other;
    }
}

}  // namespace
}  // namespace handhold::body_joint_names_test
