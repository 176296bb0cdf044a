#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/render.hpp"
#include "systems/rigs/hand_joints.hpp"

// Body rigs: the joints of a humanoid figure, and for each joint the bone of the player's body that
// it follows.
namespace handhold {

// Bones of a body. There are a left and a right one of the clavicle and of all bones after it. The
// trunk extends from the pelvis to midway between the shoulders.
enum class BodyBone : std::uint8_t {
    trunk,
    neck,
    head,
    clavicle,
    upper_arm,
    forearm,
    hand,
    thigh,
    shin,
    foot,
    finger  // a bone of a finger; only carriers have it
};
inline constexpr std::size_t k_body_bone_count = 10;  // fingers do not count
inline bool is_limb(BodyBone bone) { return bone >= BodyBone::clavicle; }

// A body rig; made by fit_body_rig. Bones have the same frames as in RenderPose. Arm bones lie
// along -Z with +Y on the elbow's side. The hand's frame is hand space. Legs and trunk lie along Y
// with -Z to the front. The head's origin is between the eyes. _ms: the frame of the file's scene.
struct BodyRig {
    // A bone, or a position along a bone, that joints follow.
    struct Carrier {
        BodyBone bone = BodyBone::trunk;
        HandSide side = HandSide::left;  // limbs only
        // Trunk: position from 0 (pelvis) to 1 (between the shoulders). Forearm: share of the
        // hand's twist that the joint follows, from 0 (at the elbow) to 1 (at the wrist). Upper
        // arm: share of its own twist, from 0 (at the shoulder) to 1 (at the elbow).
        double along = 0.0;
        Pose rest_ms;            // the bone's frame in the file
        double length_m = 0.0;   // length of the bone; 0: it has no end joint (head and hands)
        double twist_rad = 0.0;  // forearm: arm_twist of the hand in the file
        // Fingers: the bone has the direction from one joint of the shown hand to another (indices
        // into PosedHandJoints), and begins where the carrier `above` (index into carriers) ends.
        // The rest frame has -Z along the bone and +X along the hinge.
        std::size_t from_joint = 0;
        std::size_t to_joint = 0;
        std::size_t above = 0;
    };
    struct Joint {
        std::string name;
        // Index into joints; may be larger than the joint's own; -1: none.
        std::int32_t parent = -1;
        Pose bind_ms;             // pose in the file
        std::size_t carrier = 0;  // index into carriers
        Pose in_bone;             // pose in the carrier's rest frame, unscaled
    };
    // Indices of the two carriers that every rig has. k_chest is the trunk's upper end.
    static constexpr std::size_t k_chest = 0;
    static constexpr std::size_t k_head = 1;

    // Number of fingers of this hand that follow the shown hand's.
    std::size_t finger_count(HandSide side) const;

    std::vector<Joint> joints;          // joints in the file's order
    std::vector<Carrier> carriers;      // a finger's carriers follow those above them
    Vec3 head_joint_ms = Vec3::Zero();  // upper end of the neck
    double eye_height_m = 1.6;          // height of the eyes above the figure's soles; > 0
    double shoulder_width_m = 0.4;      // distance between the upper arms' joints; > 0
};

// Pose of a rig's joints in the world. Joint poses are rigid. `carry_ws` transforms vertices; it
// also scales along and across each bone, because the player's proportions differ from the file's.
struct SkeletonPose {
    std::vector<Pose> joint_ws;     // indexed by BodyRig::joints
    std::vector<Pose> joint_ls;     // pose in the parent joint's frame; roots: joint_ws
    std::vector<Affine> carry_ws;   // transform of each joint from the file's frame to the world
    std::vector<Pose> carrier_ws;   // frames of the bones, indexed like BodyRig::carriers
    std::vector<Affine> stretched;  // transform of each carrier from the file's frame to the world
};

// Poses the joints of `rig` like the player's head, chest, arms, hands, spine and legs (talk rows
// 19 to 23). Bones get the player's lengths. The thickness of the legs scales with the ratio of the
// eye heights, and that of the trunk with the ratio of the shoulder widths. The other bones use the
// smaller of these ratios. Joints along an arm take their share of its twist. A hand
// joint whose axes are those of hand space equals RenderPose's hand exactly. Allocates only when
// the vectors of `out` grow.
//
// Bones of fingers get the directions and hinges of the shown hands' joints, `hands`, and keep the
// file's lengths, scaled like the hand. A finger that the shown hand lacks follows its neighbour
// towards the index finger, else towards the little one. Without valid joints, fingers keep the
// file's pose.
void pose_skeleton(const BodyRig& rig, const BodyMeasures& measures, const RenderPose& render,
                   const std::array<PosedHandJoints, k_hand_count>& hands, SkeletonPose& out);
inline void pose_skeleton(const BodyRig& rig, const BodyMeasures& measures,
                          const RenderPose& render, SkeletonPose& out) {
    pose_skeleton(rig, measures, render, {}, out);
}

// Angle by which `child` is twisted about the Z axis of `parent`, in (-pi, pi], whatever the bend
// between both. 0 if the bend is half a turn.
double arm_twist(const Quat& parent, const Quat& child);

inline constexpr double k_wholly_followed_rad = 2.0 / 3.0 * k_pi;

// The twist that joints between `parent` and `child` distribute among themselves: the twist of
// `child` about the Z axis of `parent`, minus the twist `rest_rad` in the figure's file, in
// radians. Up to k_wholly_followed_rad to either side it is the whole difference. Beyond that it
// decreases to 0 at half a turn, so that the result is continuous. Fades out if the bend exceeds
// k_wholly_followed_rad.
double followed_twist(const Quat& parent, const Quat& child, double rest_rad);

// Rotation of a finger's bone: -Z along it, +X as close to its hinge's axis as possible.
inline Quat hinge_rotation(const Vec3& along, const Vec3& hinge) {
    return look_rotation(along, hinge.cross(along));
}

// Pose of the player's trunk at `along`: 0 is the pelvis, 1 midway between the shoulders.
Pose trunk_at(const SpinePose& spine, double along);

}  // namespace handhold
