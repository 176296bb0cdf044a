#include "systems/rigs/body_rig.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "systems/rigs/body_rig_fit.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/places.hpp"
#include "tests/random.hpp"

namespace handhold::body_rig_test {
namespace {

using test::Random;

// A stick figure in T-pose, scaled and turned about Y, with random joint axes.
struct Sticks {
    SkinnedMesh figure;

    explicit Sticks(double scale = 1.0, double yaw_rad = 0.0, unsigned seed = 1) {
        Random random(seed);
        const Pose stand{Vec3(3.0, 0.0, -2.0), rotation_about(Vec3::UnitY(), yaw_rad)};
        const auto add = [&](const char* name, std::int32_t parent, const Vec3& at) {
            figure.joints.push_back(
                {name, parent, {transform_point(stand, scale * at), random.rotation()}, {}});
            figure.positions.push_back(figure.joints.back().bind_ms.position);
            figure.weights.push_back(
                {{static_cast<std::uint16_t>(figure.joints.size() - 1), 0, 0, 0}, {1, 0, 0, 0}});
            return static_cast<std::int32_t>(figure.joints.size()) - 1;
        };
        figure.file = "sticks.glb";
        const auto root = add("root", -1, Vec3::Zero());
        const auto hips = add("Hips", root, Vec3(0, 0.95, 0));
        const auto spine = add("Spine", hips, Vec3(0, 1.2, 0));
        const auto neck = add("Neck", spine, Vec3(0, 1.5, 0));
        const auto head = add("Head", neck, Vec3(0, 1.6, 0));
        add("LeftEye", head, Vec3(-0.03, 1.68, -0.08));
        add("RightEye", head, Vec3(0.03, 1.68, -0.08));
        for (const double x : {-1.0, 1.0}) {
            const std::string side = x < 0.0 ? "Left" : "Right";
            const auto name = [&](const char* bone) { return side + bone; };
            const auto collar = add(name("Shoulder").c_str(), spine, Vec3(x * 0.04, 1.45, 0));
            const auto arm = add(name("Arm").c_str(), collar, Vec3(x * 0.2, 1.45, 0));
            const auto elbow = add(name("ForeArm").c_str(), arm, Vec3(x * 0.5, 1.45, 0));
            const auto hand = add(name("Hand").c_str(), elbow, Vec3(x * 0.8, 1.45, 0));
            add(name("HandMiddle1").c_str(), hand, Vec3(x * 0.9, 1.45, 0));
            const auto thigh = add(name("UpLeg").c_str(), hips, Vec3(x * 0.1, 0.9, 0));
            const auto shin = add(name("Leg").c_str(), thigh, Vec3(x * 0.1, 0.5, 0));
            const auto foot = add(name("Foot").c_str(), shin, Vec3(x * 0.1, 0.1, 0));
            add(name("ToeBase").c_str(), foot, Vec3(x * 0.1, 0.0, -0.1));
        }
    }
    std::size_t joint(const std::string& name) const {
        for (std::size_t i = 0; i < figure.joints.size(); ++i) {
            if (figure.joints[i].name == name) {
                return i;
            }
        }
        ADD_FAILURE() << name;
        return 0;
    }
};

// A random pose; the bones need not be connected.
RenderPose any_pose(unsigned seed) {
    Random random(seed);
    RenderPose render;
    render.head_ws = random.pose(2.0);
    render.spine.chest_ws = random.pose(2.0);
    render.spine.pelvis_ws = random.pose(2.0);
    for (Pose& link : render.spine.spine_ws) {
        link = random.pose(2.0);
    }
    for (SpinePose::Leg& leg : render.spine.legs) {
        leg = {random.pose(2.0), random.pose(2.0), random.pose(2.0)};
    }
    for (ArmPose::Arm& arm : render.arms.arms) {
        arm = {random.pose(2.0), random.pose(2.0), random.pose(2.0), random.pose(2.0)};
    }
    return render;
}

void expect_at(const Vec3& found, const Vec3& wanted, const char* what) {
    EXPECT_NEAR((found - wanted).norm(), 0.0, 1e-9) << what;
}

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

TEST(PoseSkeleton, PlacesEveryJointAtThePlayersBone) {
    for (unsigned seed = 1; seed < 20; ++seed) {
        const Sticks sticks(seed % 2 == 0 ? 0.4 : 2.5, 0.6 * seed, seed);
        const Result<BodyRig> rig = fit_body_rig(sticks.figure);
        ASSERT_TRUE(rig.ok()) << rig.error().message();
        const RenderPose render = any_pose(seed);
        SkeletonPose pose;
        pose_skeleton(rig.value(), {}, render, pose);
        const auto at = [&](const std::string& name) {
            return pose.joint_ws[sticks.joint(name)].position;
        };
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const std::string of = side == HandSide::left ? "Left" : "Right";
            const ArmPose::Arm& arm = render.arms.arms[index_of(side)];
            expect_at(at(of + "Shoulder"), arm.clavicle_ws.position, "clavicle");
            expect_at(at(of + "Arm"), arm.upper_ws.position, "upper arm");
            expect_at(at(of + "ForeArm"), arm.forearm_ws.position, "forearm");
            expect_at(at(of + "Hand"), arm.hand_ws.position, "hand");
            const SpinePose::Leg& leg = render.spine.legs[index_of(side)];
            expect_at(at(of + "UpLeg"), leg.thigh_ws.position, "thigh");
            expect_at(at(of + "Leg"), leg.shin_ws.position, "shin");
            expect_at(at(of + "Foot"), leg.foot_ws.position, "foot");
        }
        expect_at(0.5 * (at("LeftEye") + at("RightEye")), render.head_ws.position, "eyes");
    }
}

// A bone's skin lies along the player's bone, and the elbow's or knee's side in the file is that
// side on the player.
TEST(PoseSkeleton, JointsFollowDirectionAndRollOfThePlayersBones) {
    for (unsigned seed = 1; seed < 20; ++seed) {
        const double yaw = 0.6 * seed;
        const Sticks sticks(1.4, yaw, seed);
        const Result<BodyRig> rig = fit_body_rig(sticks.figure);
        ASSERT_TRUE(rig.ok()) << rig.error().message();
        const RenderPose render = any_pose(seed);
        SkeletonPose pose;
        pose_skeleton(rig.value(), {}, render, pose);
        const Vec3 back_ms = rotation_about(Vec3::UnitY(), yaw) * Vec3::UnitZ();
        const auto check = [&](const std::string& bone, const std::string& next,
                               const Pose& bone_ws, const Vec3& to_ws, const Vec3& along,
                               const Vec3& back) {
            const Affine& carry = pose.carry_ws[sticks.joint(bone)];
            const Vec3 end_ms = sticks.figure.joints[sticks.joint(next)].bind_ms.position;
            const double length = (to_ws - bone_ws.position).norm();
            expect_at(transform_point(carry, end_ms),
                      transform_point(bone_ws, Vec3(length * along)), bone.c_str());
            const Vec3 turned = (carry.linear * back_ms).normalized();
            EXPECT_NEAR((turned - bone_ws.rotation * back).norm(), 0.0, 1e-9) << bone;
        };
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const std::string of = side == HandSide::left ? "Left" : "Right";
            const ArmPose::Arm& arm = render.arms.arms[index_of(side)];
            const Vec3 ahead = -Vec3::UnitZ();
            check(of + "Arm", of + "ForeArm", arm.upper_ws, arm.forearm_ws.position, ahead,
                  Vec3::UnitY());
            check(of + "ForeArm", of + "Hand", arm.forearm_ws, arm.hand_ws.position, ahead,
                  Vec3::UnitY());
            const SpinePose::Leg& leg = render.spine.legs[index_of(side)];
            check(of + "UpLeg", of + "Leg", leg.thigh_ws, leg.shin_ws.position, -Vec3::UnitY(),
                  Vec3::UnitZ());
            check(of + "Leg", of + "Foot", leg.shin_ws, leg.foot_ws.position, -Vec3::UnitY(),
                  Vec3::UnitZ());
        }
    }
}

TEST(PoseSkeleton, DoesNotAllocateOnceWarm) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "a sanitizer has operators of its own";
    }
    const Result<BodyRig> rig = fit_body_rig(Sticks().figure);
    ASSERT_TRUE(rig.ok());
    SkeletonPose pose;
    pose_skeleton(rig.value(), {}, any_pose(1), pose);
    const RenderPose render = any_pose(2);
    const std::size_t before = allocation_count();
    pose_skeleton(rig.value(), {}, render, pose);
    EXPECT_EQ(allocation_count(), before);
}

// The upper arm's skin ends at the forearm's start for any arm length.
TEST(PoseSkeleton, StretchesVerticesFromJointToJoint) {
    const Sticks sticks(1.3);
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_TRUE(rig.ok());
    RenderPose render = any_pose(4);
    ArmPose::Arm& arm = render.arms.arms[index_of(HandSide::right)];
    arm.forearm_ws.position =
        transform_point(arm.upper_ws, Vec3(0.0, 0.0, -0.37));  // along the bone
    SkeletonPose pose;
    pose_skeleton(rig.value(), {}, render, pose);
    const Vec3 elbow_ms = sticks.figure.joints[sticks.joint("RightForeArm")].bind_ms.position;
    expect_at(transform_point(pose.carry_ws[sticks.joint("RightArm")], elbow_ms),
              arm.forearm_ws.position, "the upper arm's end");
}

TEST(PoseSkeleton, LocalPosesComposeToWorldPoses) {
    const Sticks sticks;
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_TRUE(rig.ok());
    SkeletonPose pose;
    pose_skeleton(rig.value(), {}, any_pose(7), pose);
    for (std::size_t i = 0; i < rig.value().joints.size(); ++i) {
        Pose made = pose.joint_ls[i];
        for (std::int32_t at = rig.value().joints[i].parent; at >= 0;
             at = rig.value().joints[static_cast<std::size_t>(at)].parent) {
            made = pose.joint_ls[static_cast<std::size_t>(at)] * made;
        }
        EXPECT_NEAR((made.position - pose.joint_ws[i].position).norm(), 0.0, 1e-12);
        EXPECT_LT(made.rotation.angularDistance(pose.joint_ws[i].rotation), 1e-7);
    }
}

// The rig's hand joint has hand space's axes: -Z to the fingers, +Y out of the back.
TEST(PoseSkeleton, HandJointInHandSpaceEqualsThePlayersHandExactly) {
    Sticks sticks;
    for (const char* name : {"LeftHand", "RightHand"}) {
        const double out = std::string(name) == "LeftHand" ? -1.0 : 1.0;
        Mat3 axes;
        axes.col(2) = Vec3(-out, 0.0, 0.0);
        axes.col(1) = Vec3::UnitY();
        axes.col(0) = Vec3(axes.col(1)).cross(Vec3(axes.col(2)));
        sticks.figure.joints[sticks.joint(name)].bind_ms.rotation = Quat(axes);
    }
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_TRUE(rig.ok());
    SkeletonPose pose;
    for (unsigned seed = 1; seed < 50; ++seed) {
        const RenderPose render = any_pose(seed);
        pose_skeleton(rig.value(), {}, render, pose);
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const Pose& hand = render.arms.arms[index_of(side)].hand_ws;
            const char* const name = side == HandSide::left ? "LeftHand" : "RightHand";
            const Pose& joint = pose.joint_ws[sticks.joint(name)];
            EXPECT_EQ(joint.position, hand.position);
            EXPECT_EQ(joint.rotation.coeffs(), hand.rotation.coeffs());
        }
    }
}

bool has_bone(const BodyRig& rig, BodyBone bone, HandSide side) {
    return std::any_of(rig.carriers.begin(), rig.carriers.end(), [&](const auto& carrier) {
        return carrier.bone == bone && (!is_limb(bone) || carrier.side == side);
    });
}

// Flat files: every joint is a child of the root.
TEST(FitBodyRig, FindsAllBonesOfFlatFigures) {
    Sticks sticks;
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
    Sticks sticks;
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
    Sticks sticks;
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
        const Result<BodyRig> rig = fit_body_rig(Sticks(scale).figure);
        ASSERT_TRUE(rig.ok()) << rig.error().message();
        EXPECT_NEAR(rig.value().eye_height_m, 1.68 * scale, 1e-6 * scale);
    }
}

// Hanging arms, hands straight down: the backs of the hands face outwards.
TEST(FitBodyRig, HangingArmsHaveTheBackOfTheHandOutwards) {
    Sticks sticks;
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
    Sticks sticks;
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
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_TRUE(rig.ok()) << rig.error().message();
    const Vec3 eyes_ms = rig.value().carriers[BodyRig::k_head].rest_ms.position;
    EXPECT_NEAR(eyes_ms.z(), -2.10, 1e-9);
}

TEST(FitBodyRig, ErrorNamesMissingBones) {
    Sticks sticks;
    sticks.figure.joints[sticks.joint("LeftForeArm")].name = "a";
    sticks.figure.joints[sticks.joint("Head")].name = "b";
    for (SkinJoint& joint : sticks.figure.joints) {  // a flat file: the hierarchy does not help
        joint.parent = std::min(joint.parent, 0);
    }
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_FALSE(rig.ok());
    EXPECT_NE(rig.error().message().find("--body-map"), std::string::npos);
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
    Sticks folded;
    folded.figure.joints[folded.joint("RightHand")].bind_ms.position =
        folded.figure.joints[folded.joint("RightForeArm")].bind_ms.position;
    const Result<BodyRig> short_one = fit_body_rig(folded.figure);
    ASSERT_FALSE(short_one.ok());
    EXPECT_NE(short_one.error().message().find("right_forearm"), std::string::npos);
    Sticks lying;
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
}  // namespace handhold::body_rig_test
