#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/gltf_skin_writer.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/rigs/body_joint_names.hpp"

// Humanoid figures with the joint names, hierarchies and axes of public rig conventions.
namespace handhold::test {

// Orientation of the joints' own axes in a convention.
enum class JointAxes { world, y_along, x_along, x_along_mirrored };

// One joint. "*" stands for the side: a left and a right joint are made.
struct HumanoidJoint {
    const char* name;
    const char* parent;   // "": the root
    const char* place;    // "upper_arm" or, halfway to its end, "upper_arm/0.5"
    bool is_bone = true;  // true: a body rig must find the bone of `place` at this joint
};
struct HumanoidConvention {
    const char* name;
    const char* left;
    const char* right;
    JointAxes axes;
    std::vector<HumanoidJoint> joints;
};

inline std::vector<HumanoidConvention> humanoid_conventions() {
    return {
        {"biped",
         "L",
         "R",
         JointAxes::x_along,
         {{"Bip01", "", "pelvis", false},
          {"Bip01 Pelvis", "Bip01", "pelvis"},
          {"Bip01 Spine", "Bip01 Pelvis", "spine"},
          {"Bip01 Spine1", "Bip01 Spine", "chest"},
          {"Bip01 Neck", "Bip01 Spine1", "neck"},
          {"Bip01 Head", "Bip01 Neck", "head"},
          {"Bip01 HeadNub", "Bip01 Head", "top", false},
          {"Bip01 * Clavicle", "Bip01 Neck", "clavicle"},
          {"Bip01 * UpperArm", "Bip01 * Clavicle", "upper_arm"},
          {"Bip01 * ForeTwist", "Bip01 * Forearm", "forearm/0.5", false},
          {"Bip01 * Forearm", "Bip01 * UpperArm", "forearm"},
          {"Bip01 * Hand", "Bip01 * Forearm", "hand"},
          {"Bip01 * Finger0", "Bip01 * Hand", "thumb", false},
          {"Bip01 * Finger01", "Bip01 * Finger0", "thumb/0.5", false},
          {"Bip01 * Finger1", "Bip01 * Hand", "index", false},
          {"Bip01 * Finger11", "Bip01 * Finger1", "index/0.5", false},
          {"Bip01 * Thigh", "Bip01 Spine", "thigh"},
          {"Bip01 * Calf", "Bip01 * Thigh", "shin"},
          {"Bip01 * Foot", "Bip01 * Calf", "foot"},
          {"Bip01 * Toe0", "Bip01 * Foot", "toe", false}}},
        {"mixamo",
         "Left",
         "Right",
         JointAxes::y_along,
         {{"mixamorig:Hips", "", "pelvis"},
          {"mixamorig:Spine", "mixamorig:Hips", "spine"},
          {"mixamorig:Spine2", "mixamorig:Spine", "chest"},
          {"mixamorig:Neck", "mixamorig:Spine2", "neck"},
          {"mixamorig:Head", "mixamorig:Neck", "head"},
          {"mixamorig:HeadTop_End", "mixamorig:Head", "top", false},
          {"mixamorig:*Shoulder", "mixamorig:Spine2", "clavicle"},
          {"mixamorig:*Arm", "mixamorig:*Shoulder", "upper_arm"},
          {"mixamorig:*ForeArm", "mixamorig:*Arm", "forearm"},
          {"mixamorig:*Hand", "mixamorig:*ForeArm", "hand"},
          {"mixamorig:*HandThumb1", "mixamorig:*Hand", "thumb", false},
          {"mixamorig:*HandThumb2", "mixamorig:*HandThumb1", "thumb/0.5", false},
          {"mixamorig:*HandIndex1", "mixamorig:*Hand", "index", false},
          {"mixamorig:*HandIndex2", "mixamorig:*HandIndex1", "index/0.5", false},
          {"mixamorig:*UpLeg", "mixamorig:Hips", "thigh"},
          {"mixamorig:*Leg", "mixamorig:*UpLeg", "shin"},
          {"mixamorig:*Foot", "mixamorig:*Leg", "foot"},
          {"mixamorig:*ToeBase", "mixamorig:*Foot", "toe", false},
          {"mixamorig:*Toe_End", "mixamorig:*ToeBase", "toe/1", false}}},
        {"unity",
         "Left",
         "Right",
         JointAxes::world,
         {{"Hips", "", "pelvis"},
          {"Spine", "Hips", "spine"},
          {"Chest", "Spine", "chest"},
          {"Neck", "Chest", "neck"},
          {"Head", "Neck", "head"},
          {"*Shoulder", "Chest", "clavicle"},
          {"*UpperArm", "*Shoulder", "upper_arm"},
          {"*LowerArm", "*UpperArm", "forearm"},
          {"*Hand", "*LowerArm", "hand"},
          {"*IndexProximal", "*Hand", "index", false},
          {"*UpperLeg", "Hips", "thigh"},
          {"*LowerLeg", "*UpperLeg", "shin"},
          {"*Foot", "*LowerLeg", "foot"},
          {"*Toes", "*Foot", "toe", false}}},
        {"unreal",
         "l",
         "r",
         JointAxes::x_along_mirrored,
         {{"root", "", "ground", false},
          {"pelvis", "root", "pelvis"},
          {"spine_01", "pelvis", "spine"},
          {"spine_03", "spine_01", "chest"},
          {"neck_01", "spine_03", "neck"},
          {"head", "neck_01", "head"},
          {"clavicle_*", "spine_03", "clavicle"},
          {"upperarm_*", "clavicle_*", "upper_arm"},
          {"upperarm_twist_01_*", "upperarm_*", "upper_arm/0.5", false},
          {"lowerarm_*", "upperarm_*", "forearm"},
          {"lowerarm_twist_01_*", "lowerarm_*", "forearm/0.7", false},
          {"hand_*", "lowerarm_*", "hand"},
          {"index_01_*", "hand_*", "index", false},
          {"thumb_01_*", "hand_*", "thumb", false},
          {"thigh_*", "pelvis", "thigh"},
          {"thigh_twist_01_*", "thigh_*", "thigh/0.4", false},
          {"calf_*", "thigh_*", "shin"},
          {"calf_twist_01_*", "calf_*", "shin/0.4", false},
          {"foot_*", "calf_*", "foot"},
          {"ball_*", "foot_*", "toe", false},
          {"ik_foot_root", "root", "ground", false},
          {"ik_foot_*", "ik_foot_root", "foot", false},
          {"ik_hand_root", "root", "ground", false},
          {"ik_hand_*", "ik_hand_root", "hand", false}}},
        {"valve",
         "L",
         "R",
         JointAxes::x_along,
         {{"ValveBiped.Bip01_Pelvis", "", "pelvis"},
          {"ValveBiped.Bip01_Spine", "ValveBiped.Bip01_Pelvis", "spine"},
          {"ValveBiped.Bip01_Spine4", "ValveBiped.Bip01_Spine", "chest"},
          {"ValveBiped.Bip01_Neck1", "ValveBiped.Bip01_Spine4", "neck"},
          {"ValveBiped.Bip01_Head1", "ValveBiped.Bip01_Neck1", "head"},
          {"ValveBiped.Bip01_*_Clavicle", "ValveBiped.Bip01_Spine4", "clavicle"},
          {"ValveBiped.Bip01_*_UpperArm", "ValveBiped.Bip01_*_Clavicle", "upper_arm"},
          {"ValveBiped.Bip01_*_Bicep", "ValveBiped.Bip01_*_UpperArm", "upper_arm/0.4", false},
          {"ValveBiped.Bip01_*_Elbow", "ValveBiped.Bip01_*_UpperArm", "forearm", false},
          {"ValveBiped.Bip01_*_Forearm", "ValveBiped.Bip01_*_UpperArm", "forearm"},
          {"ValveBiped.Bip01_*_Ulna", "ValveBiped.Bip01_*_Forearm", "forearm/0.5", false},
          {"ValveBiped.Bip01_*_Wrist", "ValveBiped.Bip01_*_Forearm", "forearm/0.9", false},
          {"ValveBiped.Bip01_*_Hand", "ValveBiped.Bip01_*_Forearm", "hand"},
          {"ValveBiped.Bip01_*_Finger0", "ValveBiped.Bip01_*_Hand", "thumb", false},
          {"ValveBiped.Bip01_*_Finger01", "ValveBiped.Bip01_*_Finger0", "thumb/0.5", false},
          {"ValveBiped.Bip01_*_Finger1", "ValveBiped.Bip01_*_Hand", "index", false},
          {"ValveBiped.Bip01_*_Finger11", "ValveBiped.Bip01_*_Finger1", "index/0.5", false},
          {"ValveBiped.Bip01_*_Thigh", "ValveBiped.Bip01_Pelvis", "thigh"},
          {"ValveBiped.Bip01_*_Calf", "ValveBiped.Bip01_*_Thigh", "shin"},
          {"ValveBiped.Bip01_*_Foot", "ValveBiped.Bip01_*_Calf", "foot"},
          {"ValveBiped.Bip01_*_Toe0", "ValveBiped.Bip01_*_Foot", "toe", false}}},
        {"meta",
         "Left",
         "Right",
         JointAxes::x_along_mirrored,
         {{"Body_Root", "", "ground", false},
          {"Body_Hips", "Body_Root", "pelvis"},
          {"Body_SpineLower", "Body_Hips", "spine"},
          {"Body_Chest", "Body_SpineLower", "chest"},
          {"Body_Neck", "Body_Chest", "neck"},
          {"Body_Head", "Body_Neck", "head"},
          {"Body_*Shoulder", "Body_Chest", "clavicle", false},
          {"Body_*Scapula", "Body_*Shoulder", "clavicle/0.2"},
          {"Body_*ArmUpper", "Body_*Scapula", "upper_arm"},
          {"Body_*ArmLower", "Body_*ArmUpper", "forearm"},
          {"Body_*HandWristTwist", "Body_*ArmLower", "forearm/0.8", false},
          {"Body_*HandWrist", "Body_*ArmLower", "hand"},
          {"Body_*HandPalm", "Body_*HandWrist", "hand/0.4", false},
          {"Body_*HandIndexProximal", "Body_*HandWrist", "index", false},
          {"Body_*UpperLeg", "Body_Hips", "thigh"},
          {"Body_*LowerLeg", "Body_*UpperLeg", "shin"},
          {"Body_*FootAnkleTwist", "Body_*LowerLeg", "shin/0.9", false},
          {"Body_*FootAnkle", "Body_*LowerLeg", "foot"},
          {"Body_*FootBall", "Body_*FootAnkle", "toe", false}}},
        {"rigify",
         "L",
         "R",
         JointAxes::y_along,
         {{"root", "", "ground", false},
          {"DEF-spine", "root", "pelvis", false},
          {"DEF-pelvis.*", "DEF-spine", "pelvis", false},
          {"DEF-spine.001", "DEF-spine", "spine", false},
          {"DEF-spine.003", "DEF-spine.001", "chest", false},
          {"DEF-spine.004", "DEF-spine.003", "neck"},
          {"DEF-spine.006", "DEF-spine.004", "head"},
          {"DEF-shoulder.*", "DEF-spine.003", "clavicle"},
          {"DEF-upper_arm.*", "DEF-shoulder.*", "upper_arm"},
          {"DEF-upper_arm.*.001", "DEF-upper_arm.*", "upper_arm/0.5", false},
          {"DEF-forearm.*", "DEF-upper_arm.*.001", "forearm"},
          {"DEF-forearm.*.001", "DEF-forearm.*", "forearm/0.5", false},
          {"DEF-hand.*", "DEF-forearm.*.001", "hand"},
          {"DEF-palm.01.*", "DEF-hand.*", "hand/0.3", false},
          {"DEF-f_index.01.*", "DEF-palm.01.*", "index", false},
          {"DEF-thumb.01.*", "DEF-palm.01.*", "thumb", false},
          {"ORG-upper_arm.*", "root", "upper_arm", false},
          {"ORG-forearm.*", "ORG-upper_arm.*", "forearm", false},
          {"MCH-upper_arm_ik.*", "root", "upper_arm", false},
          {"DEF-thigh.*", "DEF-spine", "thigh"},
          {"DEF-thigh.*.001", "DEF-thigh.*", "thigh/0.5", false},
          {"DEF-shin.*", "DEF-thigh.*.001", "shin"},
          {"DEF-shin.*.001", "DEF-shin.*", "shin/0.5", false},
          {"DEF-foot.*", "DEF-shin.*.001", "foot"},
          {"DEF-toe.*", "DEF-foot.*", "toe", false}}},
        {"advanced_skeleton",
         "L",
         "R",
         JointAxes::x_along_mirrored,
         {{"Root_M", "", "pelvis", false},
          {"Spine1_M", "Root_M", "spine"},
          {"Chest_M", "Spine1_M", "chest"},
          {"Neck_M", "Chest_M", "neck"},
          {"NeckPart1_M", "Neck_M", "neck/0.5", false},
          {"Head_M", "NeckPart1_M", "head"},
          {"HeadEnd_M", "Head_M", "top", false},
          {"Scapula_*", "Chest_M", "clavicle"},
          {"Shoulder_*", "Scapula_*", "upper_arm"},
          {"ShoulderPart1_*", "Shoulder_*", "upper_arm/0.5", false},
          {"Elbow_*", "ShoulderPart1_*", "forearm"},
          {"ElbowPart1_*", "Elbow_*", "forearm/0.5", false},
          {"Wrist_*", "ElbowPart1_*", "hand"},
          {"IndexFinger1_*", "Wrist_*", "index", false},
          {"ThumbFinger1_*", "Wrist_*", "thumb", false},
          {"Hip_*", "Root_M", "thigh"},
          {"HipPart1_*", "Hip_*", "thigh/0.5", false},
          {"Knee_*", "HipPart1_*", "shin"},
          {"Ankle_*", "Knee_*", "foot"},
          {"Toes_*", "Ankle_*", "toe", false}}},
        {"daz",
         "l",
         "r",
         JointAxes::world,
         {{"hip", "", "pelvis"},
          {"pelvis", "hip", "pelvis", false},
          {"abdomenLower", "hip", "spine"},
          {"chestLower", "abdomenLower", "chest"},
          {"neckLower", "chestLower", "neck"},
          {"neckUpper", "neckLower", "neck/0.5", false},
          {"head", "neckUpper", "head"},
          {"*Eye", "head", "eye", false},
          {"*Collar", "chestLower", "clavicle"},
          {"*ShldrBend", "*Collar", "upper_arm"},
          {"*ShldrTwist", "*ShldrBend", "upper_arm/0.4", false},
          {"*ForearmBend", "*ShldrTwist", "forearm"},
          {"*ForearmTwist", "*ForearmBend", "forearm/0.5", false},
          {"*Hand", "*ForearmTwist", "hand"},
          {"*Index1", "*Hand", "index", false},
          {"*Index2", "*Index1", "index/0.5", false},
          {"*Thumb1", "*Hand", "thumb", false},
          {"*ThighBend", "pelvis", "thigh"},
          {"*ThighTwist", "*ThighBend", "thigh/0.4", false},
          {"*Shin", "*ThighTwist", "shin"},
          {"*Foot", "*Shin", "foot"},
          {"*Toe", "*Foot", "toe", false}}},
        {"makehuman",
         "L",
         "R",
         JointAxes::y_along,
         {{"root", "", "pelvis", false},
          {"spine05", "root", "spine"},
          {"spine01", "spine05", "chest"},
          {"neck01", "spine01", "neck"},
          {"neck02", "neck01", "neck/0.5", false},
          {"head", "neck02", "head"},
          {"clavicle.*", "spine01", "clavicle"},
          {"shoulder01.*", "clavicle.*", "clavicle/0.6", false},
          {"upperarm01.*", "shoulder01.*", "upper_arm"},
          {"upperarm02.*", "upperarm01.*", "upper_arm/0.5", false},
          {"lowerarm01.*", "upperarm02.*", "forearm"},
          {"lowerarm02.*", "lowerarm01.*", "forearm/0.5", false},
          {"wrist.*", "lowerarm02.*", "hand"},
          {"finger2-1.*", "wrist.*", "index", false},
          {"finger2-2.*", "finger2-1.*", "index/0.5", false},
          {"finger1-1.*", "wrist.*", "thumb", false},
          {"finger1-2.*", "finger1-1.*", "thumb/0.5", false},
          {"pelvis.*", "root", "pelvis", false},
          {"upperleg01.*", "pelvis.*", "thigh"},
          {"upperleg02.*", "upperleg01.*", "thigh/0.5", false},
          {"lowerleg01.*", "upperleg02.*", "shin"},
          {"lowerleg02.*", "lowerleg01.*", "shin/0.5", false},
          {"foot.*", "lowerleg02.*", "foot"},
          {"toe1-1.*", "foot.*", "toe", false}}},
        {"character_creator",
         "L",
         "R",
         JointAxes::y_along,
         {{"CC_Base_BoneRoot", "", "ground", false},
          {"CC_Base_Hip", "CC_Base_BoneRoot", "pelvis"},
          {"CC_Base_Pelvis", "CC_Base_Hip", "pelvis", false},
          {"CC_Base_Waist", "CC_Base_Hip", "spine"},
          {"CC_Base_Spine02", "CC_Base_Waist", "chest"},
          {"CC_Base_NeckTwist01", "CC_Base_Spine02", "neck"},
          {"CC_Base_Head", "CC_Base_NeckTwist01", "head"},
          {"CC_Base_*_Eye", "CC_Base_Head", "eye", false},
          {"CC_Base_*_Clavicle", "CC_Base_Spine02", "clavicle"},
          {"CC_Base_*_Upperarm", "CC_Base_*_Clavicle", "upper_arm"},
          {"CC_Base_*_UpperarmTwist01", "CC_Base_*_Upperarm", "upper_arm/0.3", false},
          {"CC_Base_*_Forearm", "CC_Base_*_Upperarm", "forearm"},
          {"CC_Base_*_ElbowShareBone", "CC_Base_*_Forearm", "forearm", false},
          {"CC_Base_*_ForearmTwist01", "CC_Base_*_Forearm", "forearm/0.4", false},
          {"CC_Base_*_Hand", "CC_Base_*_Forearm", "hand"},
          {"CC_Base_*_Index1", "CC_Base_*_Hand", "index", false},
          {"CC_Base_*_Thigh", "CC_Base_Pelvis", "thigh"},
          {"CC_Base_*_ThighTwist01", "CC_Base_*_Thigh", "thigh/0.4", false},
          {"CC_Base_*_KneeShareBone", "CC_Base_*_Calf", "shin", false},
          {"CC_Base_*_Calf", "CC_Base_*_Thigh", "shin"},
          {"CC_Base_*_Foot", "CC_Base_*_Calf", "foot"},
          {"CC_Base_*_ToeBase", "CC_Base_*_Foot", "toe", false}}},
        {"cats",
         "Left",
         "Right",
         JointAxes::y_along,
         {{"Hips", "", "pelvis"},
          {"Spine", "Hips", "spine"},
          {"Chest", "Spine", "chest"},
          {"Neck", "Chest", "neck"},
          {"Head", "Neck", "head"},
          {"* shoulder", "Chest", "clavicle"},
          {"* arm", "* shoulder", "upper_arm"},
          {"* elbow", "* arm", "forearm"},
          {"* wrist", "* elbow", "hand"},
          {"IndexFinger1_*", "* wrist", "index", false},
          {"* leg", "Hips", "thigh"},
          {"* knee", "* leg", "shin"},
          {"* ankle", "* knee", "foot"},
          {"* toe", "* ankle", "toe", false}}},
        {"mmd",
         "左",
         "右",
         JointAxes::world,
         {{"全ての親", "", "ground", false},
          {"センター", "全ての親", "pelvis", false},
          {"下半身", "センター", "pelvis"},
          {"上半身", "センター", "spine"},
          {"上半身2", "上半身", "chest"},
          {"首", "上半身2", "neck"},
          {"頭", "首", "head"},
          {"*目", "頭", "eye", false},
          {"*肩P", "上半身2", "clavicle", false},
          {"*肩", "*肩P", "clavicle"},
          {"*腕", "*肩", "upper_arm"},
          {"*腕捩", "*腕", "upper_arm/0.6", false},
          {"*ひじ", "*腕捩", "forearm"},
          {"*手捩", "*ひじ", "forearm/0.6", false},
          {"*手首", "*手捩", "hand"},
          {"*人指１", "*手首", "index", false},
          {"*親指０", "*手首", "thumb", false},
          {"*足", "下半身", "thigh"},
          {"*ひざ", "*足", "shin"},
          {"*足首", "*ひざ", "foot"},
          {"*つま先", "*足首", "toe", false},
          {"*足D", "下半身", "thigh", false},
          {"*ひざD", "*足D", "shin", false},
          {"*足首D", "*ひざD", "foot", false},
          {"*足ＩＫ", "全ての親", "foot", false}}},
        {"vrm",
         "L",
         "R",
         JointAxes::world,
         {{"Root", "", "ground", false},
          {"J_Bip_C_Hips", "Root", "pelvis"},
          {"J_Bip_C_Spine", "J_Bip_C_Hips", "spine"},
          {"J_Bip_C_UpperChest", "J_Bip_C_Spine", "chest"},
          {"J_Bip_C_Neck", "J_Bip_C_UpperChest", "neck"},
          {"J_Bip_C_Head", "J_Bip_C_Neck", "head"},
          {"J_Adj_*_FaceEye", "J_Bip_C_Head", "eye", false},
          {"J_Bip_*_Shoulder", "J_Bip_C_UpperChest", "clavicle"},
          {"J_Bip_*_UpperArm", "J_Bip_*_Shoulder", "upper_arm"},
          {"J_Bip_*_LowerArm", "J_Bip_*_UpperArm", "forearm"},
          {"J_Bip_*_Hand", "J_Bip_*_LowerArm", "hand"},
          {"J_Bip_*_Index1", "J_Bip_*_Hand", "index", false},
          {"J_Bip_*_UpperLeg", "J_Bip_C_Hips", "thigh"},
          {"J_Bip_*_LowerLeg", "J_Bip_*_UpperLeg", "shin"},
          {"J_Bip_*_Foot", "J_Bip_*_LowerLeg", "foot"},
          {"J_Bip_*_ToeBase", "J_Bip_*_Foot", "toe", false}}},
        {"smpl",
         "L",
         "R",
         JointAxes::world,
         {{"Pelvis", "", "pelvis"},
          {"Spine1", "Pelvis", "spine"},
          {"Spine3", "Spine1", "chest"},
          {"Neck", "Spine3", "neck"},
          {"Head", "Neck", "head"},
          {"*_Collar", "Spine3", "clavicle"},
          {"*_Shoulder", "*_Collar", "upper_arm"},
          {"*_Elbow", "*_Shoulder", "forearm"},
          {"*_Wrist", "*_Elbow", "hand"},
          {"*_Hand", "*_Wrist", "hand/0.5", false},
          {"*_Hip", "Pelvis", "thigh"},
          {"*_Knee", "*_Hip", "shin"},
          {"*_Ankle", "*_Knee", "foot"},
          {"*_Foot", "*_Ankle", "toe", false}}},
    };
}

struct Humanoid {
    SkinnedMesh figure;
    std::map<std::string, std::size_t> joints;    // by name
    std::map<std::string, std::size_t> expected;  // by body_joint_text
};

struct HumanoidOptions {
    double arms_down_rad = 0.0;  // 0: T-pose
    double scale = 1.0;
    double yaw_rad = 0.0;  // 0: faces +Z
    bool is_named = true;
};

// Makes a figure of 1.75 m and gives every part of its skin to the convention's joints.
class HumanoidMaker {
  public:
    HumanoidMaker(const HumanoidConvention& convention, const HumanoidOptions& options)
        : convention_(convention), options_(options) {}

    Humanoid make() {
        made_.figure.file = std::string(convention_.name) + ".glb";
        for (const HumanoidJoint& joint : convention_.joints) {
            if (std::string(joint.name).find('*') == std::string::npos) {
                add_joint(joint, 0.0);
                continue;
            }
            add_joint(joint, 1.0);
            add_joint(joint, -1.0);
        }
        find_parents();
        if (!options_.is_named) {
            for (std::size_t i = 0; i < made_.figure.joints.size(); ++i) {
                made_.figure.joints[i].name = "n" + std::to_string(i);
            }
        }
        add_body();
        made_.figure.color_runs = {{0, {0.55F, 0.58F, 0.62F}}};
        finish_normals();
        return std::move(made_);
    }

  private:
    struct Placed {
        std::string bone;
        double along = 0.0;
        double side = 0.0;
    };

    std::string with_side(std::string text, double side) const {
        const std::size_t star = text.find('*');
        if (star != std::string::npos) {
            text.replace(star, 1, side > 0.0 ? convention_.left : convention_.right);
        }
        return text;
    }

    // Joints of the left half (+X is the figure's left), facing +Z, arms level.
    static Vec3 base_place(const std::string& bone) {
        static const std::map<std::string, Vec3> k_places = {{"ground", {0, 0, 0}},
                                                             {"pelvis", {0, 0.98, 0}},
                                                             {"spine", {0, 1.10, 0.01}},
                                                             {"chest", {0, 1.32, 0}},
                                                             {"neck", {0, 1.49, -0.01}},
                                                             {"head", {0, 1.58, 0.01}},
                                                             {"top", {0, 1.75, 0.01}},
                                                             {"eye", {0.03, 1.64, 0.09}},
                                                             {"clavicle", {0.03, 1.45, 0}},
                                                             {"upper_arm", {0.18, 1.44, -0.01}},
                                                             {"forearm", {0.46, 1.44, -0.02}},
                                                             {"hand", {0.71, 1.44, 0}},
                                                             {"index", {0.80, 1.44, 0.03}},
                                                             {"finger_end", {0.88, 1.44, 0.03}},
                                                             {"thumb", {0.74, 1.42, 0.03}},
                                                             {"thumb_end", {0.80, 1.40, 0.09}},
                                                             {"thigh", {0.095, 0.93, 0.01}},
                                                             {"shin", {0.095, 0.51, 0.02}},
                                                             {"foot", {0.095, 0.085, -0.02}},
                                                             {"toe", {0.095, 0.02, 0.10}},
                                                             {"toe_end", {0.095, 0.02, 0.17}}};
        return k_places.at(bone);
    }
    static std::string end_of(const std::string& bone) {
        static const std::map<std::string, std::string> k_ends = {
            {"pelvis", "spine"},      {"spine", "chest"},     {"chest", "neck"},
            {"neck", "head"},         {"head", "top"},        {"clavicle", "upper_arm"},
            {"upper_arm", "forearm"}, {"forearm", "hand"},    {"hand", "index"},
            {"index", "finger_end"},  {"thumb", "thumb_end"}, {"thigh", "shin"},
            {"shin", "foot"},         {"foot", "toe"},        {"toe", "toe_end"}};
        const auto end = k_ends.find(bone);
        return end == k_ends.end() ? bone : end->second;
    }
    static bool is_of_arm(const std::string& bone) {
        return bone == "upper_arm" || bone == "forearm" || bone == "hand" || bone == "index" ||
               bone == "thumb" || bone == "finger_end" || bone == "thumb_end";
    }
    Pose stand() const { return {Vec3::Zero(), rotation_about(Vec3::UnitY(), options_.yaw_rad)}; }
    // Position of the joint of `bone` on that side, posed and scaled.
    Vec3 place(const std::string& bone, double side) const {
        Vec3 at = base_place(bone);
        if (is_of_arm(bone)) {
            const Vec3 shoulder = base_place("upper_arm");
            at = shoulder +
                 rotation_about(Vec3::UnitZ(), -options_.arms_down_rad) * Vec3(at - shoulder);
        }
        at.x() *= side < 0.0 ? -1.0 : 1.0;
        return options_.scale * (stand().rotation * at);
    }
    Vec3 place_along(const std::string& bone, double along, double side) const {
        const Vec3 from = place(bone, side);
        return from + along * (place(end_of(bone), side) - from);
    }

    Quat axes_of(const std::string& bone, double side) const {
        const Vec3 along = place(end_of(bone), side) - place(bone, side);
        if (convention_.axes == JointAxes::world || !(along.norm() > 0.0)) {
            return Quat::Identity();
        }
        const Vec3 axis = convention_.axes == JointAxes::y_along ? Vec3::UnitY() : Vec3::UnitX();
        const bool is_reversed = convention_.axes == JointAxes::x_along_mirrored && side < 0.0;
        return rotation_between(is_reversed ? Vec3(-axis) : axis, along.normalized());
    }

    void add_joint(const HumanoidJoint& joint, double side) {
        const std::string text = joint.place;
        const std::size_t cut = text.find('/');
        Placed placed{text.substr(0, cut), 0.0, side};
        if (cut != std::string::npos) {
            placed.along = std::stod(text.substr(cut + 1));
        }
        const std::string name = with_side(joint.name, side);
        made_.joints[name] = made_.figure.joints.size();
        if (joint.is_bone) {
            static const std::map<std::string, BodyBone> k_bones = {
                {"pelvis", BodyBone::trunk},        {"neck", BodyBone::neck},
                {"head", BodyBone::head},           {"clavicle", BodyBone::clavicle},
                {"upper_arm", BodyBone::upper_arm}, {"forearm", BodyBone::forearm},
                {"hand", BodyBone::hand},           {"thigh", BodyBone::thigh},
                {"shin", BodyBone::shin},           {"foot", BodyBone::foot}};
            if (const auto bone = k_bones.find(placed.bone); bone != k_bones.end()) {
                made_.expected[body_joint_text(
                    {bone->second, side < 0.0 ? HandSide::right : HandSide::left})] =
                    made_.figure.joints.size();
            }
        }
        made_.figure.joints.push_back(
            {name,
             -1,
             {place_along(placed.bone, placed.along, side), axes_of(placed.bone, side)},
             {}});
        parents_.push_back(with_side(joint.parent, side));
        placed_.push_back(placed);
        is_control_.push_back(name.starts_with("ORG") || name.starts_with("MCH") ||
                              name.starts_with("ik_") || name.find("ＩＫ") != std::string::npos ||
                              placed.bone == "ground");
    }
    void find_parents() {
        for (std::size_t i = 0; i < parents_.size(); ++i) {
            const auto parent = made_.joints.find(parents_[i]);
            made_.figure.joints[i].parent =
                parent == made_.joints.end() ? -1 : static_cast<std::int32_t>(parent->second);
        }
    }

    // The last joint with skin before `along` on a bone. A bone that the convention lacks is
    // represented by the one above.
    std::uint16_t joint_at(std::string bone, double along, double side) const {
        static const std::map<std::string, std::string> k_above = {
            {"index", "hand"},        {"thumb", "hand"},         {"hand", "forearm"},
            {"forearm", "upper_arm"}, {"upper_arm", "clavicle"}, {"clavicle", "chest"},
            {"toe", "foot"},          {"foot", "shin"},          {"shin", "thigh"},
            {"thigh", "pelvis"},      {"head", "neck"},          {"neck", "chest"},
            {"chest", "spine"},       {"spine", "pelvis"}};
        for (;;) {
            std::optional<std::size_t> best;
            for (std::size_t i = 0; i < placed_.size(); ++i) {
                const Placed& placed = placed_[i];
                if (placed.bone == bone && placed.along <= along + 1e-9 && !is_control_[i] &&
                    (placed.side == 0.0 || placed.side == side) &&
                    (!best || placed.along >= placed_[*best].along)) {
                    best = i;
                }
            }
            if (best) {
                return static_cast<std::uint16_t>(*best);
            }
            if (!k_above.contains(bone)) {
                return 0;
            }
            bone = k_above.at(bone);
            along = 1.0;
        }
    }

    struct Thickness {
        double from_x, from_z, to_x, to_z;
    };
    // A tube of elliptic rings from one place to the other; ends blend with the bones beside it.
    void add_tube(const std::string& bone, const std::string& before, double side,
                  const Thickness& thick, bool is_closed) {
        constexpr int k_rings = 7;
        constexpr int k_around = 12;
        const Vec3 a = place(bone, side);
        const Vec3 b = place(end_of(bone), side);
        const Vec3 along = (b - a).normalized();
        const Vec3 front = stand().rotation * Vec3::UnitZ();
        Vec3 v = front - along * front.dot(along);
        v = v.norm() > 0.2 ? Vec3(v.normalized()) : any_perpendicular(along);
        const Vec3 u = v.cross(along);
        const auto first = static_cast<std::uint32_t>(made_.figure.positions.size());
        for (int ring = 0; ring < k_rings; ++ring) {
            const double t = static_cast<double>(ring) / (k_rings - 1);
            const double shrink = is_closed && (ring == 0 || ring == k_rings - 1) ? 0.35 : 1.0;
            for (int k = 0; k < k_around; ++k) {
                const double angle = 2.0 * k_pi * k / k_around;
                const double x = thick.from_x + t * (thick.to_x - thick.from_x);
                const double z = thick.from_z + t * (thick.to_z - thick.from_z);
                made_.figure.positions.push_back(
                    a + t * (b - a) +
                    options_.scale * shrink * (x * std::cos(angle) * u + z * std::sin(angle) * v));
                made_.figure.weights.push_back(weights_at(bone, before, t, side));
            }
        }
        for (std::uint32_t ring = 0; ring + 1 < k_rings; ++ring) {
            for (std::uint32_t k = 0; k < k_around; ++k) {
                const std::uint32_t next = (k + 1) % k_around;
                const std::uint32_t p = first + ring * k_around + k;
                const std::uint32_t q = first + ring * k_around + next;
                made_.figure.triangles.push_back({p, q, q + k_around});
                made_.figure.triangles.push_back({p, q + k_around, p + k_around});
            }
        }
    }
    SkinWeights weights_at(const std::string& bone, const std::string& before, double t,
                           double side) const {
        const std::uint16_t own = joint_at(bone, t, side);
        if (t > 0.01 || before.empty()) {
            return {{own, 0, 0, 0}, {1.0F, 0.0F, 0.0F, 0.0F}};
        }
        return {{own, joint_at(before, 1.0, side), 0, 0}, {0.5F, 0.5F, 0.0F, 0.0F}};
    }

    void add_body() {
        add_tube("pelvis", "", 1.0, {0.15, 0.11, 0.14, 0.10}, false);
        add_tube("spine", "pelvis", 1.0, {0.14, 0.10, 0.17, 0.12}, false);
        add_tube("chest", "spine", 1.0, {0.17, 0.12, 0.07, 0.07}, false);
        add_tube("neck", "chest", 1.0, {0.05, 0.05, 0.05, 0.05}, false);
        add_tube("head", "neck", 1.0, {0.075, 0.095, 0.06, 0.08}, true);
        for (const double side : {1.0, -1.0}) {
            add_tube("clavicle", "chest", side, {0.05, 0.05, 0.06, 0.06}, false);
            add_tube("upper_arm", "clavicle", side, {0.055, 0.06, 0.04, 0.045}, true);
            add_tube("forearm", "upper_arm", side, {0.042, 0.045, 0.025, 0.03}, false);
            add_tube("hand", "forearm", side, {0.02, 0.035, 0.018, 0.045}, true);
            add_tube("index", "hand", side, {0.012, 0.04, 0.008, 0.03}, true);
            add_tube("thumb", "hand", side, {0.012, 0.012, 0.009, 0.009}, true);
            add_tube("thigh", "pelvis", side, {0.085, 0.09, 0.06, 0.06}, true);
            add_tube("shin", "thigh", side, {0.055, 0.06, 0.035, 0.04}, false);
            add_tube("foot", "shin", side, {0.045, 0.045, 0.045, 0.03}, true);
            add_tube("toe", "foot", side, {0.045, 0.02, 0.03, 0.015}, true);
        }
        add_nose();
    }
    // A part that shows where the figure looks.
    void add_nose() {
        const auto first = static_cast<std::uint32_t>(made_.figure.positions.size());
        const std::array<Vec3, 4> corners = {Vec3(-0.02, 1.60, 0.09), Vec3(0.02, 1.60, 0.09),
                                             Vec3(0.0, 1.66, 0.09), Vec3(0.0, 1.61, 0.14)};
        for (const Vec3& corner : corners) {
            made_.figure.positions.push_back(options_.scale * (stand().rotation * corner));
            made_.figure.weights.push_back(
                {{joint_at("head", 0.5, 1.0), 0, 0, 0}, {1.0F, 0.0F, 0.0F, 0.0F}});
        }
        made_.figure.triangles.push_back({first, first + 1, first + 3});
        made_.figure.triangles.push_back({first + 1, first + 2, first + 3});
        made_.figure.triangles.push_back({first + 2, first, first + 3});
    }
    void finish_normals() {
        SkinnedMesh& figure = made_.figure;
        figure.normals.assign(figure.positions.size(), Vec3::Zero());
        for (const auto& [a, b, c] : figure.triangles) {
            const Vec3 area = (figure.positions[b] - figure.positions[a])
                                  .cross(figure.positions[c] - figure.positions[a]);
            for (const std::uint32_t corner : {a, b, c}) {
                figure.normals[corner] += area;
            }
        }
        for (Vec3& normal : figure.normals) {
            normal = normal.norm() > 0.0 ? Vec3(normal.normalized()) : Vec3(Vec3::UnitY());
        }
    }

    const HumanoidConvention& convention_;
    HumanoidOptions options_;
    Humanoid made_;
    std::vector<std::string> parents_;
    std::vector<Placed> placed_;
    std::vector<bool> is_control_;
};

inline Humanoid make_humanoid(const HumanoidConvention& convention,
                              const HumanoidOptions& options = {}) {
    return HumanoidMaker(convention, options).make();
}

// The bytes of a .glb.
inline std::string write_humanoid(const Humanoid& humanoid) {
    const SkinnedMesh& figure = humanoid.figure;
    // Parents before children.
    std::vector<std::size_t> order;
    std::vector<std::int32_t> place(figure.joints.size(), -1);
    while (order.size() < figure.joints.size()) {
        for (std::size_t i = 0; i < figure.joints.size(); ++i) {
            const std::int32_t parent = figure.joints[i].parent;
            if (place[i] < 0 && (parent < 0 || place[static_cast<std::size_t>(parent)] >= 0)) {
                place[i] = static_cast<std::int32_t>(order.size());
                order.push_back(i);
            }
        }
    }
    GltfSkin skin;
    skin.name = "body";
    for (const std::size_t i : order) {
        SkinJoint joint = figure.joints[i];
        joint.parent = joint.parent < 0 ? -1 : place[static_cast<std::size_t>(joint.parent)];
        skin.joints.push_back(joint);
    }
    GltfSkinSurface surface;
    for (std::size_t i = 0; i < figure.positions.size(); ++i) {
        const auto to_float = [](const Vec3& v) {
            return std::array<float, 3>{static_cast<float>(v.x()), static_cast<float>(v.y()),
                                        static_cast<float>(v.z())};
        };
        surface.vertices.push_back({to_float(figure.positions[i]), to_float(figure.normals[i])});
        SkinWeights weights = figure.weights[i];
        for (std::uint16_t& joint : weights.joint) {
            joint = static_cast<std::uint16_t>(place[joint]);
        }
        surface.weights.push_back(weights);
    }
    for (const auto& triangle : figure.triangles) {
        surface.indices.insert(surface.indices.end(), triangle.begin(), triangle.end());
    }
    skin.surfaces.push_back(surface);
    const GltfMaterial material{"skin", {0.55F, 0.6F, 0.68F}};
    return write_skinned_glb({&material, 1}, skin);
}

}  // namespace handhold::test
