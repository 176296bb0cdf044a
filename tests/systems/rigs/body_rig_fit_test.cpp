#include "systems/rigs/body_rig_fit.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "stick_figure.hpp"
#include "tests/places.hpp"

namespace handhold::body_rig_fit_test {
namespace {

using test::any_pose;
using test::expect_at;
using test::StickFigure;

bool has_bone(const BodyRig& rig, BodyBone bone, HandSide side) {
    return std::any_of(rig.carriers.begin(), rig.carriers.end(), [&](const auto& carrier) {
        return carrier.bone == bone && (!is_limb(bone) || carrier.side == side);
    });
}

// Flat files: every joint is a child of the root.
TEST(FitBodyRig, FindsAllBonesOfFlatFigures) {
    StickFigure sticks;
    for (SkinJoint& joint : sticks.figure.joints) {
        joint.parent = std::min(joint.parent, 0);
    }
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_TRUE(rig.ok()) << rig.error().message();
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        for (std::size_t bone = 0; bone < k_body_bone_count; ++bone) {
            EXPECT_TRUE(has_bone(rig.value(), static_cast<BodyBone>(bone), side)) << bone;
        }
    }
}

// The upper arm is found above a forearm that only the map names.
TEST(FitBodyRig, MappedJointsHelpToFindOtherBones) {
    StickFigure sticks;
    sticks.figure.joints[sticks.joint("LeftForeArm")].name = "a";
    sticks.figure.joints[sticks.joint("LeftArm")].name = "LeftShoulderRoll";
    const Result<BodyRig> rig = fit_body_rig(sticks.figure, {{"left_forearm", "a"}});
    ASSERT_TRUE(rig.ok()) << rig.error().message();
    const RenderPose render = any_pose(3);
    SkeletonPose pose;
    pose_skeleton(rig.value(), {}, render, pose);
    expect_at(pose.joint_ws[sticks.joint("LeftShoulderRoll")].position,
              render.arms.arms[index_of(HandSide::left)].upper_ws.position, "upper arm");
}

// A joint that the map assigns to one bone is not assigned to another one by its name.
TEST(FitBodyRig, MappedJointsAreUsedForNoOtherBone) {
    StickFigure sticks;
    sticks.figure.joints[sticks.joint("Neck")].name = "LeftShin";  // above the leg's own
    sticks.figure.joints[sticks.joint("LeftShin")].parent = 0;
    const Result<BodyRig> rig = fit_body_rig(sticks.figure, {{"neck", "LeftShin"}});
    ASSERT_TRUE(rig.ok()) << rig.error().message();
    const RenderPose render = any_pose(5);
    SkeletonPose pose;
    pose_skeleton(rig.value(), {}, render, pose);
    expect_at(pose.joint_ws[sticks.joint("LeftLeg")].position,
              render.spine.legs[index_of(HandSide::left)].shin_ws.position, "shin");
}

// Millimetres or kilometres: absolute lengths are irrelevant.
TEST(FitBodyRig, AcceptsFiguresOfAnySize) {
    for (const double scale : {1e-3, 1e3}) {
        const Result<BodyRig> rig = fit_body_rig(StickFigure(scale).figure);
        ASSERT_TRUE(rig.ok()) << rig.error().message();
        EXPECT_NEAR(rig.value().eye_height_m, 1.68 * scale, 1e-6 * scale);
    }
}

// Hanging arms, hands straight down: the backs of the hands face outwards.
TEST(FitBodyRig, HangingArmsHaveTheBackOfTheHandOutwards) {
    StickFigure sticks;
    for (const double x : {-0.2, 0.2}) {
        const std::string of = x < 0.0 ? "Left" : "Right";
        double y = 1.45;
        for (const char* bone : {"Arm", "ForeArm", "Hand", "HandMiddle1"}) {
            sticks.figure.joints[sticks.joint(of + bone)].bind_ms.position = Vec3(3.0 + x, y, -2.0);
            y -= 0.3;
        }
    }
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_TRUE(rig.ok()) << rig.error().message();
    for (const BodyRig::Carrier& carrier : rig.value().carriers) {
        if (carrier.bone == BodyBone::hand) {
            const double out = carrier.side == HandSide::left ? -1.0 : 1.0;
            EXPECT_NEAR((carrier.rest_ms.rotation * Vec3::UnitY()).x(), out, 1e-9);
        }
    }
}

// Without eye joints, the eyes are at the front of the head's skin.
TEST(FitBodyRig, EyesDefaultToTheFrontOfTheHead) {
    StickFigure sticks;
    for (const char* eye : {"LeftEye", "RightEye"}) {
        sticks.figure.joints[sticks.joint(eye)].name = "a";
    }
    const auto head = static_cast<std::uint16_t>(sticks.joint("Head"));
    const auto chest = static_cast<std::uint16_t>(sticks.joint("Spine"));
    const auto add = [&](const Vec3& at, float of_head) {
        sticks.figure.positions.push_back(Vec3(3.0, 0.0, -2.0) + at);
        sticks.figure.weights.push_back({{chest, head, 0, 0}, {1.0F - of_head, of_head, 0, 0}});
    };
    add(Vec3(0.0, 1.72, -0.10), 0.9F);  // the brow
    add(Vec3(0.0, 1.72, -0.30), 0.2F);  // a visor of the suit
    const auto last = static_cast<std::uint32_t>(sticks.figure.positions.size()) - 1;
    sticks.figure.triangles.push_back({last - 2, last - 1, last});
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_TRUE(rig.ok()) << rig.error().message();
    const Vec3 eyes_ms = rig.value().carriers[BodyRig::k_head].rest_ms.position;
    EXPECT_NEAR(eyes_ms.z(), -2.10, 1e-9);
}

// A skeleton without skin and eye joints: the eyes are where a person's are, at any size and turn.
TEST(FitBodyRig, EyesWithoutSkinAreAboveAndAheadOfTheHeadsJoint) {
    for (unsigned seed = 1; seed < 20; ++seed) {
        const double scale = 0.3 + 0.2 * seed;
        StickFigure sticks(scale, 0.7 * seed, seed);
        for (const char* eye : {"LeftEye", "RightEye"}) {
            const std::size_t i = sticks.joint(eye);
            SkinJoint& joint = sticks.figure.joints[i];
            joint.name = "a";
            joint.bind_ms = sticks.figure.joints[sticks.joint("Head")].bind_ms;
            sticks.figure.positions[i] = joint.bind_ms.position;
        }
        if (seed % 2 == 0) {  // a joint of the face is no face
            const std::size_t jaw = sticks.joint("a");
            const Quat yaw = rotation_about(Vec3::UnitY(), 0.7 * seed);
            sticks.figure.joints[jaw].name = "jaw";
            sticks.figure.joints[jaw].bind_ms.position += yaw * (scale * Vec3(0.0, -0.025, -0.06));
            sticks.figure.positions[jaw] = sticks.figure.joints[jaw].bind_ms.position;
        }
        const Result<BodyRig> rig = fit_body_rig(sticks.figure);
        ASSERT_TRUE(rig.ok()) << rig.error().message();
        const BodyRig::Carrier& head = rig.value().carriers[BodyRig::k_head];
        const Vec3 eyes = head.rest_ms.rotation.conjugate() *
                          (head.rest_ms.position - rig.value().head_joint_ms) / scale;
        EXPECT_NEAR(eyes.x(), 0.0, 1e-9);
        EXPECT_GT(eyes.y(), 0.07);
        EXPECT_LT(eyes.y(), 0.12);
        EXPECT_GT(-eyes.z(), 0.06);
        EXPECT_LT(-eyes.z(), 0.11);
    }
}

TEST(FitBodyRig, ErrorNamesMissingBones) {
    StickFigure sticks;
    sticks.figure.joints[sticks.joint("LeftForeArm")].name = "a";
    sticks.figure.joints[sticks.joint("Head")].name = "b";
    for (SkinJoint& joint : sticks.figure.joints) {  // a flat file: the hierarchy does not help
        joint.parent = std::min(joint.parent, 0);
    }
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_FALSE(rig.ok());
    EXPECT_NE(rig.error().message().find("a map can name"), std::string::npos);
    EXPECT_NE(rig.error().message().find("for left_forearm"), std::string::npos)
        << rig.error().message();
    const Result<BodyRig> told =
        fit_body_rig(sticks.figure, {{"head", "b"}, {"left_forearm", "a"}});
    EXPECT_TRUE(told.ok()) << told.error().message();
    const Result<BodyRig> wrong = fit_body_rig(sticks.figure, {{"head", "nobody"}});
    ASSERT_FALSE(wrong.ok());
    EXPECT_NE(wrong.error().message().find("\"nobody\" for head"), std::string::npos);
}

TEST(FitBodyRig, RefusesZeroLengthBonesAndLyingFigures) {
    StickFigure folded;
    folded.figure.joints[folded.joint("RightHand")].bind_ms.position =
        folded.figure.joints[folded.joint("RightForeArm")].bind_ms.position;
    const Result<BodyRig> short_one = fit_body_rig(folded.figure);
    ASSERT_FALSE(short_one.ok());
    EXPECT_NE(short_one.error().message().find("right_forearm"), std::string::npos);
    StickFigure lying;
    for (SkinJoint& joint : lying.figure.joints) {
        joint.bind_ms.position = rotation_about(Vec3::UnitX(), k_half_pi) * joint.bind_ms.position;
    }
    EXPECT_FALSE(fit_body_rig(lying.figure).ok());
}

TEST(LoadBodyMap, ReadsNamesAndRefusesInvalidEntries) {
    const auto path = std::filesystem::path(testing::TempDir()) / "handhold_body_map.json";
    const auto load = [&](const char* text) {
        std::ofstream(path) << text;
        return load_body_map(path);
    };
    const Result<BodyMap> map = load(R"({"joints": {"head": "Kopf", "left_thigh": "x"}})");
    ASSERT_TRUE(map.ok()) << map.error().message();
    EXPECT_EQ(map.value(), (BodyMap{{"head", "Kopf"}, {"left_thigh", "x"}}));
    EXPECT_FALSE(load(R"({"joints": {"tail": "x"}})").ok());
    EXPECT_FALSE(load(R"({"joints": {"head": 3}})").ok());
    std::filesystem::remove(path);
}

// Real figures: one without named clavicles, one in A-pose facing +Z, one cartoon.
TEST(FitBodyRig, FindsTheBonesOfRealFigures) {
    const auto folder = data_dir() / "body";
    if (!std::filesystem::exists(folder)) {
        GTEST_SKIP() << "no " << folder;
    }
    const auto fit = [&](const char* name) {
        const Result<SkinnedMesh> figure = load_gltf_figure(folder / name);
        EXPECT_TRUE(figure.ok()) << figure.error().message();
        const Result<BodyRig> rig = fit_body_rig(figure.value());
        EXPECT_TRUE(rig.ok()) << rig.error().message();
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            for (std::size_t bone = 0; bone < k_body_bone_count; ++bone) {
                const auto found = std::count_if(rig.value().carriers.begin(),
                                                 rig.value().carriers.end(), [&](const auto& c) {
                                                     return c.bone == static_cast<BodyBone>(bone) &&
                                                            (!is_limb(c.bone) || c.side == side);
                                                 });
                EXPECT_GE(found, 1) << name << " " << bone;
            }
        }
        return rig.value();
    };
    const auto length = [](const BodyRig& rig, BodyBone bone) {
        for (const BodyRig::Carrier& carrier : rig.carriers) {
            if (carrier.bone == bone) {
                return carrier.length_m;
            }
        }
        return 0.0;
    };
    // Expected values are from the data's SOURCE.md.
    const BodyRig valkyrie = fit("nasa_valkyrie.glb");
    EXPECT_NEAR(valkyrie.shoulder_width_m, 0.50, 0.001);
    EXPECT_NEAR(length(valkyrie, BodyBone::upper_arm), 0.33, 0.002);
    EXPECT_NEAR(length(valkyrie, BodyBone::forearm), 0.287, 0.002);
    const BodyRig rocketbox = fit("rocketbox_male_adult_04.glb");
    EXPECT_NEAR(rocketbox.eye_height_m, 1.71, 0.05);  // total height 1.87 m with soles and hair
    EXPECT_GT((rocketbox.carriers[BodyRig::k_head].rest_ms.rotation * -Vec3::UnitZ()).z(), 0.9);
    const BodyRig cartoon = fit("robot_expressive_cc0.glb");
    EXPECT_GT((cartoon.carriers[BodyRig::k_head].rest_ms.rotation * -Vec3::UnitZ()).z(), 0.9);
}

}  // namespace
}  // namespace handhold::body_rig_fit_test
