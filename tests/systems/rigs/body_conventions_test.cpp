// Figures with the names, hierarchies and axes of public rig conventions.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "engine/core/text_file.hpp"
#include "engine/io/gltf_skin_writer.hpp"
#include "systems/rigs/body_bones.hpp"
#include "systems/rigs/body_rig_fit.hpp"
#include "tests/random.hpp"
#include "tests/systems/rigs/humanoid.hpp"

namespace handhold::body_conventions_test {
namespace {

using test::Humanoid;
using test::HumanoidConvention;
using test::make_humanoid;
using test::Random;

// Every expected bone is found at its joint.
void expect_bones(const Humanoid& humanoid, const BodyMap& map = {}) {
    const Result<BodyBones> found =
        find_body_bones(humanoid.figure, find_mapped_bones(humanoid.figure, map).value());
    ASSERT_TRUE(found.ok()) << found.error().message();
    BodyBones bones = found.value();
    for (std::size_t bone = 0; bone < k_body_bone_count; ++bone) {
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const BodyJointName name{static_cast<BodyBone>(bone), side};
            const auto expected = humanoid.expected.find(body_joint_text(name));
            if (expected == humanoid.expected.end() || name.bone == BodyBone::trunk) {
                continue;
            }
            const auto joint = bones.at(name);
            const std::string wanted = humanoid.figure.joints[expected->second].name;
            EXPECT_TRUE(joint) << body_joint_text(name) << ", expected " << wanted;
            if (joint) {
                EXPECT_EQ(humanoid.figure.joints[*joint].name, wanted) << body_joint_text(name);
            }
        }
    }
}

// Arm length.
double arm_of(const Humanoid& humanoid) {
    const auto at = [&](const char* bone) {
        return place_of(humanoid.figure, humanoid.expected.at(bone));
    };
    return (at("left_hand") - at("left_upper_arm")).norm();
}

class EveryConvention : public ::testing::TestWithParam<std::size_t> {
  protected:
    HumanoidConvention convention() const { return test::humanoid_conventions()[GetParam()]; }
};

TEST_P(EveryConvention, NamesGiveTheBones) {
    Random random(GetParam() + 1);
    for (int i = 0; i < 10; ++i) {
        const Humanoid humanoid =
            make_humanoid(convention(), {.arms_down_rad = random.between(0.0, 0.9),
                                         .scale = std::exp(random.between(-4.0, 4.0)),
                                         .yaw_rad = random.between(-3.0, 3.0)});
        SCOPED_TRACE(humanoid.figure.file);
        expect_bones(humanoid);
    }
}

TEST_P(EveryConvention, OrderOfJointsIsIrrelevant) {
    Random random(GetParam() + 31);
    Humanoid humanoid = make_humanoid(convention());
    SCOPED_TRACE(humanoid.figure.file);
    std::vector<std::size_t> order(humanoid.figure.joints.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    for (std::size_t i = order.size(); i-- > 1;) {
        std::swap(
            order[i],
            order[static_cast<std::size_t>(random.between(0.0, 1.0) * static_cast<double>(i + 1))]);
    }
    std::vector<std::size_t> place(order.size());
    std::vector<SkinJoint> joints;
    for (std::size_t i = 0; i < order.size(); ++i) {
        place[order[i]] = i;
        joints.push_back(humanoid.figure.joints[order[i]]);
    }
    for (SkinJoint& joint : joints) {
        if (joint.parent >= 0) {
            joint.parent = static_cast<std::int32_t>(place[static_cast<std::size_t>(joint.parent)]);
        }
    }
    humanoid.figure.joints = joints;
    for (SkinWeights& weights : humanoid.figure.weights) {
        for (std::uint16_t& joint : weights.joint) {
            joint = static_cast<std::uint16_t>(place[joint]);
        }
    }
    for (auto& [bone, joint] : humanoid.expected) {
        joint = place[joint];
    }
    expect_bones(humanoid);
}

// Words of figures of nobody's convention: one of each row for each limb, after the name of the
// figure, with the side as a letter. Beside them stand joints that are no bones.
struct LimbWords {
    const char* clavicle;
    const char* upper_arm;
    const char* forearm;
    const char* hand;
    const char* thigh;
    const char* shin;
    const char* foot;
};
constexpr std::array<LimbWords, 11> k_limb_words = {{
    {"Shoulder", "Arm", "ForeArm", "Hand", "Leg", "Knee", "Foot"},
    {"Shoulder", "UpperArm", "LowerArm", "Hand", "Thigh", "Shin", "Foot"},
    {"Clavicle", "Arm", "Elbow", "Hand", "UpLeg", "Leg", "Foot"},
    {"", "Arm", "Elbow", "Wrist", "UpperLeg", "LowerLeg", "Ankle"},
    {"", "Arm1", "Arm2", "Hand", "Leg1", "Leg2", "Foot"},
    {"Shoulder", "Arm_01", "Arm_02", "Hand", "Leg_01", "Leg_02", "Foot"},
    {"Collar", "Arm_Up", "Arm_Down", "Palm", "Leg_Up", "Leg_Down", "Foot"},
    {"", "ArmUpper", "ArmLower", "Hand", "Leg_Upper", "Leg_Lower", "Foot"},
    {"Clavicle", "Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle"},
    {"", "Arm", "Arm_Low", "Hand", "Leg", "Leg_Low", "Foot"},
    {"Shoulder", "Bicep", "Forearm", "Hand", "Leg", "Calf", "Foot"},
}};

TEST(BodyConventions, SidesByALetterAndAnyFiguresNameGiveTheBones) {
    Random random(97);
    const auto any = [&](const auto& list) {
        return list[static_cast<std::size_t>(random.between(0.0, 1.0) *
                                             static_cast<double>(std::size(list)))];
    };
    constexpr std::array<const char*, 9> k_figures = {"",          "Robot_",       "Shinobi_",
                                                      "Handyman_", "LittleGuy_",   "Prop_",
                                                      "Palmer-",   "Footman_Rig_", "rig:"};
    constexpr std::array<const char*, 6> k_forms = {"%_*", "*_%", "%.*", "%_*_01", "%-*", "% *"};
    for (int i = 0; i < 300; ++i) {
        std::vector<std::string> texts;
        texts.reserve(64);
        const std::string figure = any(k_figures);
        const std::string form = any(k_forms);
        const bool is_capital = random.between(0.0, 1.0) < 0.5;
        const auto middle = [&](const char* word) {
            texts.push_back(figure + word);
            return texts.back().c_str();
        };
        const auto limb = [&](const char* word) {
            texts.push_back(figure + std::string(form).replace(form.find('%'), 1, word));
            return texts.back().c_str();
        };
        HumanoidConvention convention{"letters",
                                      is_capital ? "L" : "l",
                                      is_capital ? "R" : "r",
                                      test::JointAxes::y_along,
                                      {}};
        std::vector<test::HumanoidJoint>& joints = convention.joints;
        constexpr std::array<const char*, 3> k_roots = {"Hips", "Root", "Body"};
        const char* const root = middle(any(k_roots));
        const char* const spine = middle("Spine");
        const char* const chest = middle("Chest");
        const char* const neck = middle("Neck");
        const char* const head = middle("Head");
        joints = {{root, "", "pelvis", false},
                  {spine, root, "spine", false},
                  {chest, spine, "chest", false},
                  {neck, chest, "neck"},
                  {head, neck, "head"}};
        const LimbWords arm = any(k_limb_words);
        const LimbWords leg = any(k_limb_words);
        const char* above = chest;
        for (const auto& [word, place] : {std::pair(arm.clavicle, "clavicle"),
                                          {arm.upper_arm, "upper_arm"},
                                          {arm.forearm, "forearm"},
                                          {arm.hand, "hand"}}) {
            if (*word != '\0') {
                joints.push_back({limb(word), above, place});
                above = joints.back().name;
            }
        }
        const char* const hand = above;
        above = root;
        for (const auto& [word, place] :
             {std::pair(leg.thigh, "thigh"), {leg.shin, "shin"}, {leg.foot, "foot"}}) {
            joints.push_back({limb(word), above, place});
            above = joints.back().name;
        }
        const auto kind = static_cast<int>(random.between(0.0, 5.0));
        if (kind == 1) {
            joints.push_back({limb("Toe"), above, "toe", false});
            joints.push_back({limb("Finger"), hand, "index", false});
            joints.push_back({limb("Thumb"), hand, "thumb", false});
        } else if (kind == 2) {
            joints.push_back({limb("IK_Hand"), "", "hand", false});
            joints.push_back({limb("Foot_IK"), "", "foot", false});
            joints.push_back({limb("Knee_Target"), "", "shin", false});
        } else if (kind == 3) {
            joints.push_back({limb("Eye"), head, "eye", false});
            joints.push_back({limb("Skirt"), root, "thigh/0.5", false});
        } else if (kind == 4) {
            joints.push_back({limb("Hand_end"), hand, "finger_end", false});
            joints.push_back({limb("Foot_end"), above, "toe_end", false});
        }
        SCOPED_TRACE(figure + " " + form + " " + arm.upper_arm + " " + leg.thigh);
        expect_bones(make_humanoid(convention, {.arms_down_rad = random.between(0.0, 0.9),
                                                .scale = std::exp(random.between(-2.0, 2.0)),
                                                .yaw_rad = random.between(-3.0, 3.0)}));
    }
}

// Without names, hierarchy and joint positions decide: the limbs are right, or the figure is
// refused.
TEST_P(EveryConvention, ShapeGivesTheLimbsOrTheFigureIsRefused) {
    Random random(GetParam() + 61);
    for (int i = 0; i < 10; ++i) {
        const Humanoid humanoid =
            make_humanoid(convention(), {.arms_down_rad = random.between(0.0, 0.7),
                                         .scale = std::exp(random.between(-2.0, 2.0)),
                                         .yaw_rad = random.between(-3.0, 3.0),
                                         .is_named = false});
        SCOPED_TRACE(humanoid.figure.file);
        const Result<BodyBones> found = find_body_bones(humanoid.figure, {});
        if (!found) {
            EXPECT_NE(found.error().expected.find("a map can name"), std::string::npos);
            continue;
        }
        BodyBones bones = found.value();
        const auto at = [&](const BodyJointName& name) {
            return place_of(humanoid.figure, *bones.at(name));
        };
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            for (const BodyBone bone : {BodyBone::upper_arm, BodyBone::forearm, BodyBone::hand,
                                        BodyBone::thigh, BodyBone::shin, BodyBone::foot}) {
                const BodyJointName name{bone, side};
                ASSERT_TRUE(bones.at(name)) << body_joint_text(name);
                const Vec3 expected =
                    place_of(humanoid.figure, humanoid.expected.at(body_joint_text(name)));
                EXPECT_LT((at(name) - expected).norm(), 0.1 * arm_of(humanoid))
                    << body_joint_text(name);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Figures, EveryConvention,
                         ::testing::Range<std::size_t>(0, test::humanoid_conventions().size()),
                         [](const auto& test) {
                             return std::string(
                                 handhold::test::humanoid_conventions()[test.param].name);
                         });

// A VRM table finds the bones of a figure whose names say nothing, or something else.
TEST(BodyMapOfVrm, GivesTheBones) {
    const std::map<std::string, std::string> vrm_names = {
        {"pelvis", "hips"},       {"neck", "neck"},          {"head", "head"},
        {"clavicle", "Shoulder"}, {"upper_arm", "UpperArm"}, {"forearm", "LowerArm"},
        {"hand", "Hand"},         {"thigh", "UpperLeg"},     {"shin", "LowerLeg"},
        {"foot", "Foot"}};
    for (const HumanoidConvention& convention : test::humanoid_conventions()) {
        SCOPED_TRACE(convention.name);
        Humanoid humanoid = make_humanoid(convention, {.is_named = false});
        humanoid.figure.joints[humanoid.expected.at("left_hand")].name = "RightUpLeg";
        std::map<std::string, std::string> table;
        for (const auto& [bone, joint] : humanoid.expected) {
            const bool is_left = bone.starts_with("left_");
            const bool is_limb = is_left || bone.starts_with("right_");
            const std::string text = is_limb ? bone.substr(is_left ? 5 : 6) : bone;
            table[(is_left   ? "left"
                   : is_limb ? "right"
                             : "") +
                  vrm_names.at(text)] = humanoid.figure.joints[joint].name;
        }
        expect_bones(humanoid, body_map_of_vrm(table));
    }
}

// A wrong joint in a map gives implausible proportions.
TEST(FindBodyBones, MapsWithWrongJointsAreRefused) {
    const HumanoidConvention convention = test::humanoid_conventions()[1];
    const Humanoid humanoid = make_humanoid(convention);
    const auto refused = [&](const BodyMap& map) {
        const Result<BodyBones> found =
            find_body_bones(humanoid.figure, find_mapped_bones(humanoid.figure, map).value());
        return !found && found.error().expected.find("a map can name") != std::string::npos;
    };
    EXPECT_TRUE(refused({{"left_upper_arm", "mixamorig:LeftShoulder"},
                         {"right_upper_arm", "mixamorig:RightShoulder"}}));
    EXPECT_TRUE(refused({{"left_upper_arm", "mixamorig:RightArm"}}));
    EXPECT_TRUE(refused({{"left_hand", "mixamorig:RightHand"}}));
    EXPECT_TRUE(refused({{"head", "mixamorig:Hips"}}));
    EXPECT_TRUE(refused({{"left_shin", "mixamorig:RightLeg"}}));
    EXPECT_TRUE(
        refused({{"left_thigh", "mixamorig:LeftFoot"}, {"left_foot", "mixamorig:LeftUpLeg"}}));
    EXPECT_TRUE(refused({{"left_forearm", "mixamorig:LeftHand"}}));
}

// Round trip through files. Keeps the files if HANDHOLD_FIGURES names a folder, for pictures.
TEST(HumanoidFiles, AreReadBackAndFitted) {
    const char* const keep = std::getenv("HANDHOLD_FIGURES");
    const std::filesystem::path folder = keep != nullptr ? keep : testing::TempDir();
    for (const HumanoidConvention& convention : test::humanoid_conventions()) {
        SCOPED_TRACE(convention.name);
        const Humanoid humanoid = make_humanoid(convention, {.arms_down_rad = 0.5});
        const auto path = folder / (std::string("humanoid_") + convention.name + ".glb");
        ASSERT_FALSE(write_file_atomically(path, test::write_humanoid(humanoid)));
        const Result<SkinnedMesh> figure = load_gltf_figure(path);
        ASSERT_TRUE(figure.ok()) << figure.error().message();
        const Result<BodyRig> rig = fit_body_rig(figure.value());
        ASSERT_TRUE(rig.ok()) << rig.error().message();
        EXPECT_NEAR(rig.value().shoulder_width_m, 0.36, 1e-3);
        EXPECT_NEAR(rig.value().eye_height_m, 1.65, 0.07);
        if (keep == nullptr) {
            std::filesystem::remove(path);
        }
    }
}

}  // namespace
}  // namespace handhold::body_conventions_test
