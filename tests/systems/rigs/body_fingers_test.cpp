#include "systems/rigs/body_fingers.hpp"

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "stick_figure.hpp"
#include "systems/rigs/body_rig_fit.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/finger_joint_names.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold::body_fingers_test {
namespace {

using test::any_pose;
using test::Random;
using test::StickFigure;

constexpr std::array k_sides = {HandSide::left, HandSide::right};

// Names of one finger's joints from the hand outwards; "*": the side. `palm`: joints inside the
// palm; `tip`: the last joint is the fingertip.
struct FingerNames {
    std::vector<std::string> joints;
    std::size_t palm = 0;
    bool tip = false;
};
struct Names {
    const char* rig;
    const char* left;
    const char* right;
    std::array<FingerNames, k_finger_count> fingers;
};

// "#" stands for the finger's own word, "$" for the joint's number.
FingerNames series(const std::string& pattern, const std::string& finger, int from, int to,
                   std::size_t palm = 0, bool tip = false) {
    FingerNames names;
    for (int i = from; i <= to; ++i) {
        std::string name = pattern;
        name.replace(name.find('#'), 1, finger);
        name.replace(name.find('$'), 1, std::to_string(i));
        names.joints.push_back(name);
    }
    names.palm = palm;
    names.tip = tip;
    return names;
}
Names counted(const char* rig, const char* left, const char* right, const std::string& pattern,
              const std::array<const char*, 5>& words, int from = 1, int to = 3, bool tip = false) {
    Names names{rig, left, right, {}};
    for (std::size_t i = 0; i < words.size(); ++i) {
        names.fingers[i] = series(pattern, words[i], from, to, 0, tip);
    }
    return names;
}
Names put_before(Names names, const char* rig, const std::string& pattern,
                 const std::array<const char*, 5>& words) {
    names.rig = rig;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] != nullptr) {
            std::string name = pattern;
            name.replace(name.find('#'), 1, words[i]);
            names.fingers[i].joints.insert(names.fingers[i].joints.begin(), name);
            names.fingers[i].palm = 1;
        }
    }
    return names;
}

// Sources: the listed programs' own exports, as quoted in public repositories.
std::vector<Names> known_names() {
    constexpr std::array k_usual = {"Thumb", "Index", "Middle", "Ring", "Pinky"};
    constexpr std::array k_little = {"Thumb", "Index", "Middle", "Ring", "Little"};
    constexpr std::array k_low = {"thumb", "index", "middle", "ring", "pinky"};
    constexpr std::array k_palms = {static_cast<const char*>(nullptr), "index", "middle", "ring",
                                    "pinky"};
    constexpr std::array k_numbered_palms = {static_cast<const char*>(nullptr), "1", "2", "3", "4"};
    const Names unreal_4 = counted("Unreal 4", "l", "r", "#_0$_*", k_low);
    const Names genesis_9 =
        counted("Daz Genesis 9", "l", "r", "*_#$", {"thumb", "index", "mid", "ring", "pinky"});
    Names unity{"Unity", "Left", "Right", {}};
    Names vrm{"VRM 1", "left", "right", {}};
    Names meta_body{"Meta body", "Left", "Right", {}};
    for (std::size_t i = 0; i < k_finger_count; ++i) {
        const std::string word = k_little[i];
        const auto three = [&](const std::string& before, std::array<const char*, 3> bones) {
            FingerNames names;
            for (const char* const bone : bones) {
                names.joints.push_back(before + word + bone);
            }
            return names;
        };
        unity.fingers[i] = three("* ", {" Proximal", " Intermediate", " Distal"});
        const bool is_thumb = i == 0;
        vrm.fingers[i] = is_thumb ? three("*", {"Metacarpal", "Proximal", "Distal"})
                                  : three("*", {"Proximal", "Intermediate", "Distal"});
        FingerNames& meta = meta_body.fingers[i];
        meta = three("Body_*Hand", is_thumb ? std::array{"Metacarpal", "Proximal", "Distal"}
                                            : std::array{"Proximal", "Intermediate", "Distal"});
        meta.joints.push_back("Body_*Hand" + word + "Tip");
        meta.tip = true;
        if (!is_thumb) {
            meta.joints.insert(meta.joints.begin(), "Body_*Hand" + word + "Metacarpal");
            meta.palm = 1;
        }
    }
    Names meta_hand = counted("Meta hand", "l", "r", "b_*_#$", k_low);
    for (FingerNames* const finger : {meta_hand.fingers.data(), &meta_hand.fingers[4]}) {
        const std::string word = finger == meta_hand.fingers.data() ? "thumb" : "pinky";
        finger->joints.insert(finger->joints.begin(), "b_*_" + word + "0");
        finger->palm = 1;
    }
    Names biped{"3ds Max Biped", "L", "R", {}};
    Names mmd{"MMD", "左", "右", {}};
    constexpr std::array k_japanese = {"親指", "人指", "中指", "薬指", "小指"};
    constexpr std::array k_digits = {"０", "１", "２", "３"};
    for (std::size_t i = 0; i < k_finger_count; ++i) {
        const std::string number = std::to_string(i);
        biped.fingers[i].joints = {"Bip01 * Finger" + number, "Bip01 * Finger" + number + "1",
                                   "Bip01 * Finger" + number + "2"};
        for (std::size_t joint = 0; joint < 3; ++joint) {
            mmd.fingers[i].joints.push_back(std::string("*") + k_japanese[i] +
                                            k_digits[joint + (i == 0 ? 0 : 1)]);
        }
    }
    return {
        unity,
        vrm,
        counted("VRoid", "L", "R", "J_Bip_*_#$", k_little),
        unreal_4,
        put_before(unreal_4, "Unreal 5, MetaHuman", "#_metacarpal_*", k_palms),
        counted("Mixamo", "Left", "Right", "mixamorig:*Hand#$", k_usual, 1, 4, true),
        counted("Ready Player Me", "Left", "Right", "*Hand#$", k_usual, 1, 4, true),
        meta_hand,
        meta_body,
        put_before(
            counted("Daz Genesis 8", "l", "r", "*#$", {"Thumb", "Index", "Mid", "Ring", "Pinky"}),
            "Daz Genesis 8", "*Carpal#", k_numbered_palms),
        put_before(genesis_9, "Daz Genesis 9", "*_#metacarpal",
                   {nullptr, "index", "mid", "ring", "pinky"}),
        put_before(counted("MakeHuman", "L", "R", "finger#-$.*", {"1", "2", "3", "4", "5"}),
                   "MakeHuman", "metacarpal#.*", k_numbered_palms),
        put_before(counted("Rigify", "L", "R", "DEF-#.0$.*",
                           {"thumb", "f_index", "f_middle", "f_ring", "f_pinky"}),
                   "Rigify", "DEF-palm.0#.*", k_numbered_palms),
        counted("Character Creator", "L", "R", "CC_Base_*_#$",
                {"Thumb", "Index", "Mid", "Ring", "Pinky"}),
        biped,
        mmd,
    };
}

// A figure whose hands have fingers; `hinges`: indices of the joints, then of the tip if it has
// one.
struct FingeredFigure {
    StickFigure sticks;
    std::array<std::array<std::vector<std::size_t>, k_finger_count>, k_hand_count> hinges;
    std::array<std::vector<std::size_t>, k_hand_count> wanted;  // indices of fingers

    std::size_t hand(HandSide side) const {
        return sticks.joint(side == HandSide::left ? "LeftHand" : "RightHand");
    }
};

std::string with_side(std::string text, const Names& names, HandSide side) {
    const std::size_t star = text.find('*');
    return text.replace(star, 1, side == HandSide::left ? names.left : names.right);
}

// Hands of random proportions: two to five fingers of each.
FingeredFigure make_figure(const Names& names, unsigned seed, double scale) {
    FingeredFigure made{StickFigure(scale, 0.7 * seed, seed), {}, {}};
    SkinnedMesh& figure = made.sticks.figure;
    for (const char* const hand : {"LeftHandMiddle1", "RightHandMiddle1"}) {
        figure.joints[made.sticks.joint(hand)].name = "prop";
    }
    Random random(seed);
    for (const HandSide side : k_sides) {
        const std::size_t hand = made.hand(side);
        const HandRig usual = builtin_hand_rig(side);
        const Pose hand_ms{place_of(figure, hand), random.rotation()};
        const auto without = static_cast<std::size_t>(random.between(0.0, 4.0));
        for (std::size_t i = 0; i < usual.fingers.size(); ++i) {
            if (i >= 5 - without && i > 1) {
                continue;
            }
            const FingerRig& finger = usual.fingers[i];
            const auto number = static_cast<std::size_t>(finger.name);
            const FingerNames& own = names.fingers[number];
            FingerAngles angles = coupled_angles(finger, random.between(0.0, 0.3));
            const auto points = finger_points(finger, angles);
            const Vec3 aside = random.vector(0.004);
            const double size = random.between(0.7, 1.3);
            auto parent = static_cast<std::int32_t>(hand);
            made.wanted[index_of(side)].push_back(number);
            for (std::size_t joint = 0; joint < own.joints.size(); ++joint) {
                const bool is_palm = joint < own.palm;
                const Vec3 knuckle = points[0] + aside;
                const Vec3 at = is_palm
                                    ? Vec3(0.2 * knuckle)
                                    : Vec3(knuckle + size * (points[joint - own.palm] - points[0]));
                figure.joints.push_back(
                    {with_side(own.joints[joint], names, side),
                     parent,
                     {transform_point(hand_ms, Vec3(scale * at)), random.rotation()},
                     {}});
                parent = static_cast<std::int32_t>(figure.joints.size()) - 1;
                if (!is_palm) {
                    made.hinges[index_of(side)][number].push_back(figure.joints.size() - 1);
                }
            }
        }
    }
    return made;
}

struct ShownHands {
    RenderPose render;
    std::array<PosedHandJoints, k_hand_count> joints;
};
ShownHands random_hands(unsigned seed) {
    ShownHands shown{any_pose(seed), {}};
    Random random(seed + 1000);
    for (const HandSide side : k_sides) {
        const HandRig rig = builtin_hand_rig(side);
        std::array<FingerAngles, k_finger_count> angles;
        for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
            for (double& curl : angles[i].curl_rad) {
                curl = random.between(-0.2, 1.6);
            }
            angles[i].opposition_rad = random.between(-0.3, 0.3);
        }
        Pose& wrist_ws = shown.render.arms.arms[index_of(side)].hand_ws;
        shown.render.hands[index_of(side)].shown_ws = wrist_ws;
        shown.joints[index_of(side)] = pose_hand_joints(rig, 1.0, angles, wrist_ws);
    }
    return shown;
}

// Every joint of a finger of the figure lies in the direction of the shown hand's joint, and bones
// keep the file's lengths.
void expect_fingers(const FingeredFigure& made, const BodyRig& rig, unsigned seed) {
    const ShownHands shown = random_hands(seed);
    BodyMeasures measures;
    SkeletonPose pose;
    pose_skeleton(rig, measures, shown.render, shown.joints, pose);
    const double girth = std::min(measures.eye_height_m / rig.eye_height_m,
                                  measures.shoulder_width_m / rig.shoulder_width_m);
    for (const HandSide side : k_sides) {
        ASSERT_EQ(rig.finger_count(side), made.wanted[index_of(side)].size());
        for (const std::size_t finger : made.wanted[index_of(side)]) {
            const std::vector<std::size_t>& chain = made.hinges[index_of(side)][finger];
            const auto name = static_cast<FingerName>(finger);
            const std::size_t first = hand_joint_index(
                name, name == FingerName::thumb ? HandBone::metacarpal : HandBone::proximal);
            for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
                const PosedHandJoints& hand = shown.joints[index_of(side)];
                const Vec3 wanted =
                    (hand[first + i + 1].pose_ws.position - hand[first + i].pose_ws.position)
                        .normalized();
                const Vec3 found =
                    pose.joint_ws[chain[i + 1]].position - pose.joint_ws[chain[i]].position;
                const double bind_m = (place_of(made.sticks.figure, chain[i + 1]) -
                                       place_of(made.sticks.figure, chain[i]))
                                          .norm();
                EXPECT_LT((found.normalized() - wanted).norm(), 1e-9) << finger << " " << i;
                EXPECT_NEAR(found.norm(), girth * bind_m, 1e-9) << finger << " " << i;
            }
        }
    }
}

TEST(BodyFingers, EndWhereTheShownHandsAreInDirection) {
    const std::vector<Names> all = known_names();
    for (unsigned seed = 1; seed <= 64; ++seed) {
        const Names& names = all[seed % all.size()];
        const FingeredFigure made = make_figure(names, seed, seed % 3 == 0 ? 0.3 : 1.0 + seed);
        const Result<BodyRig> rig = fit_body_rig(made.sticks.figure);
        ASSERT_TRUE(rig.ok()) << names.rig << ": " << rig.error().message();
        SCOPED_TRACE(std::string(names.rig) + ", seed " + std::to_string(seed));
        expect_fingers(made, rig.value(), seed);
    }
}

TEST(BodyFingers, ConstantTurnsOfLocalFramesChangeNoPosedFinger) {
    const std::vector<Names> all = known_names();
    for (unsigned seed = 1; seed <= 32; ++seed) {
        FingeredFigure made = make_figure(all[seed % all.size()], seed, 1.0);
        const Result<BodyRig> rig = fit_body_rig(made.sticks.figure);
        Random random(seed);
        std::vector<Quat> turns;
        for (SkinJoint& joint : made.sticks.figure.joints) {
            turns.push_back(random.rotation());
            joint.bind_ms.rotation = (joint.bind_ms.rotation * turns.back()).normalized();
        }
        const Result<BodyRig> turned = fit_body_rig(made.sticks.figure);
        ASSERT_TRUE(rig.ok() && turned.ok());
        const ShownHands shown = random_hands(seed);
        SkeletonPose before;
        SkeletonPose after;
        pose_skeleton(rig.value(), {}, shown.render, shown.joints, before);
        pose_skeleton(turned.value(), {}, shown.render, shown.joints, after);
        for (std::size_t i = 0; i < turns.size(); ++i) {
            EXPECT_LT((after.joint_ws[i].position - before.joint_ws[i].position).norm(), 1e-9);
            const Quat wanted = before.joint_ws[i].rotation * turns[i];
            EXPECT_LT(after.joint_ws[i].rotation.angularDistance(wanted), 1e-6);
        }
    }
}

// A figure with the proportions of the shown hand has its joints exactly where that has them.
TEST(BodyFingers, EqualProportionsGiveEqualJoints) {
    const Names names = known_names()[5];
    for (unsigned seed = 1; seed <= 8; ++seed) {
        StickFigure sticks(1.0, 0.7 * seed, seed);
        for (const char* const hand : {"LeftHandMiddle1", "RightHandMiddle1"}) {
            sticks.figure.joints[sticks.joint(hand)].name = "prop";
        }
        std::array<std::array<std::size_t, k_finger_count>, k_hand_count> first{};
        Random random(seed);
        for (const HandSide side : k_sides) {
            const std::size_t hand =
                sticks.joint(side == HandSide::left ? "LeftHand" : "RightHand");
            const Pose hand_ms{place_of(sticks.figure, hand), random.rotation()};
            for (const FingerRig& finger : builtin_hand_rig(side).fingers) {
                const auto points = finger_points(finger, coupled_angles(finger, 0.1));
                const auto number = static_cast<std::size_t>(finger.name);
                first[index_of(side)][number] = sticks.figure.joints.size();
                for (std::size_t i = 0; i < points.size(); ++i) {
                    const auto parent =
                        static_cast<std::int32_t>(i == 0 ? hand : sticks.figure.joints.size() - 1);
                    sticks.figure.joints.push_back(
                        {with_side(names.fingers[number].joints[i], names, side),
                         parent,
                         {transform_point(hand_ms, points[i]), random.rotation()},
                         {}});
                }
            }
        }
        const Result<BodyRig> rig = fit_body_rig(sticks.figure);
        ASSERT_TRUE(rig.ok()) << rig.error().message();
        BodyMeasures measures;
        measures.eye_height_m = rig.value().eye_height_m;
        measures.shoulder_width_m = rig.value().shoulder_width_m;
        const ShownHands shown = random_hands(seed);
        SkeletonPose pose;
        pose_skeleton(rig.value(), measures, shown.render, shown.joints, pose);
        for (const HandSide side : k_sides) {
            for (std::size_t finger = 0; finger < k_finger_count; ++finger) {
                const auto name = static_cast<FingerName>(finger);
                const std::size_t from =
                    hand_joint_index(name, finger == 0 ? HandBone::metacarpal : HandBone::proximal);
                for (std::size_t i = 0; i < 4; ++i) {
                    const Vec3 found = pose.joint_ws[first[index_of(side)][finger] + i].position;
                    EXPECT_LT(
                        (found - shown.joints[index_of(side)][from + i].pose_ws.position).norm(),
                        1e-9)
                        << finger << " " << i;
                }
            }
        }
    }
}

TEST(FingerJointNames, HelpersAndOtherBonesAreNoFingers) {
    for (const char* const name :
         {"index_01_half_l", "index_01_mcp_l", "index_02_pip_l", "thumb_01_bulge_l", "palm.01.L",
          "metacarpal1.L", "lCarpal1", "l_index_finger_pad_marker", "f_index.01_master.L",
          "MCH-f_index.01.L", "LeftHand", "weapon_l", "toe1-1.L", "lSmallToe1", "string_l"}) {
        EXPECT_FALSE(parse_finger_joint_name(name)) << name;
    }
}

}  // namespace
}  // namespace handhold::body_fingers_test
