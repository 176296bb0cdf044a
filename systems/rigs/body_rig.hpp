#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/render.hpp"

// Bodies as data: the joints of any humanoid, and which part of the runtime's body carries each.
namespace handhold {

// The parts of a body. Limbs are of one side; the trunk goes from the pelvis to between the
// shoulders.
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
    foot
};
inline constexpr std::size_t k_body_bone_count = 10;
inline bool is_limb(BodyBone bone) { return bone >= BodyBone::clavicle; }

// Frames of bones are those of RenderPose: arms lie along -Z with +Y to the elbow's side, the hand
// is hand space; legs and trunk lie along Y with -Z to the front, the head's origin is between the
// eyes. Made by fit_body_rig.
struct BodyRig {
    // Part of a body as the file has it (_ms: the frame of the file's scene).
    struct Carrier {
        BodyBone bone = BodyBone::trunk;
        HandSide side = HandSide::left;  // of a limb
        // On the trunk: 0 pelvis .. 1 between the shoulders. On a forearm: how much of the hand's
        // twist it takes, 0 elbow .. 1 wrist.
        double along = 0.0;
        Pose rest_ms;            // the bone's frame
        double length_m = 0.0;   // the bone's; 0: it ends in itself, as head and hands do
        double twist_rad = 0.0;  // of a forearm: followed_twist in the file
    };
    struct Joint {
        std::string name;
        std::int32_t parent = -1;  // into joints, before this one or after
        Pose bind_ms;              // as it stands in the file
        std::size_t carrier = 0;   // into carriers
        Pose in_bone;              // the joint in its carrier's frame, unscaled
    };
    static constexpr std::size_t k_chest = 0;  // carriers that are there always: the trunk's end
    static constexpr std::size_t k_head = 1;

    std::vector<Joint> joints;  // in the file's order
    std::vector<Carrier> carriers;
    Vec3 head_joint_ms = Vec3::Zero();  // to which the neck goes
    double eye_height_m = 1.6;          // > 0: above the floor
    double shoulder_width_m = 0.4;      // > 0: between the upper arms' joints
};

// A rig's joints in the world. Poses are rigid; where the player's proportions are not the file's,
// vertices go by `carry_ws`, which scales along each bone and about it.
struct SkeletonPose {
    std::vector<Pose> joint_ws;     // by BodyRig::joints
    std::vector<Pose> joint_ls;     // in the parent joint's frame; a root's is joint_ws
    std::vector<Affine> carry_ws;   // by joint: from the file's frame into the world
    std::vector<Pose> carrier_ws;   // by BodyRig::carriers: where the bones are
    std::vector<Affine> stretched;  // by carrier: as carry_ws
};

// Talk rows 19 to 23 for any rig: joints of `rig` where the player's head, chest, arms, hands,
// spine and legs are. How long bones are goes by the player, how thick legs are by eye heights, the
// trunk by shoulders, all else by the lesser of both. Joints along a forearm take its share of
// the hand's twist. A hand's joint whose axes are hand space's is RenderPose's hand bit for bit.
// The vectors of `out` are filled, without allocating from the second call on.
void pose_skeleton(const BodyRig& rig, const BodyMeasures& measures, const RenderPose& render,
                   SkeletonPose& out);

// How far a hand is turned about its forearm's length, as the forearm follows it: from where the
// hand's back is on the elbow's side. An arm turns by 90 degrees either way; from 120 on the
// forearm follows less, at 180 not at all, so that neither side of that is a jump. Likewise where
// the wrist is bent back by more than 120.
double followed_twist(const Quat& forearm, const Quat& hand);

// Trunk of a player: where it is at `along`, in [0, 1] from the pelvis up.
Pose trunk_at(const SpinePose& spine, double along);

}  // namespace handhold
