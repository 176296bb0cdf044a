#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/render.hpp"

// Body rigs: the joints of any humanoid figure, and the bone of the player's body that carries
// each.
namespace handhold {

// Bones of a body. From clavicle on, each side has its own. The trunk extends from the pelvis to
// midway between the shoulders.
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

// Frames of bones are those of RenderPose: arm bones lie along -Z with +Y on the elbow's side, the
// hand's frame is hand space, legs and trunk lie along Y with -Z to the front, and the head's
// origin is between the eyes. Made by fit_body_rig. (_ms: the frame of the file's scene.)
struct BodyRig {
    // A bone, or a place along one, that joints follow.
    struct Carrier {
        BodyBone bone = BodyBone::trunk;
        HandSide side = HandSide::left;  // limbs only
        // Trunk: place from 0 (pelvis) to 1 (between the shoulders). Forearm: share of the hand's
        // twist, from 0 (elbow) to 1 (wrist).
        double along = 0.0;
        Pose rest_ms;            // the bone's frame in the file
        double length_m = 0.0;   // of the bone; 0: no end joint, as for head and hands
        double twist_rad = 0.0;  // forearm: followed_twist in the file
    };
    struct Joint {
        std::string name;
        std::int32_t parent = -1;  // index into joints, in any order; -1: none
        Pose bind_ms;              // pose in the file
        std::size_t carrier = 0;   // index into carriers
        Pose in_bone;              // pose in the carrier's rest frame, unscaled
    };
    // Carriers that every rig has.
    static constexpr std::size_t k_chest = 0;  // the trunk's upper end
    static constexpr std::size_t k_head = 1;

    std::vector<Joint> joints;  // in the file's order
    std::vector<Carrier> carriers;
    Vec3 head_joint_ms = Vec3::Zero();  // upper end of the neck
    double eye_height_m = 1.6;          // above the figure's soles; > 0
    double shoulder_width_m = 0.4;      // between the upper arms' joints; > 0
};

// A rig's joints in the world. Joint poses are rigid. `carry_ws`, for vertices, also scales along
// and across each bone, since the player's proportions differ from the file's.
struct SkeletonPose {
    std::vector<Pose> joint_ws;     // by BodyRig::joints
    std::vector<Pose> joint_ls;     // in the parent joint's frame; roots: joint_ws
    std::vector<Affine> carry_ws;   // by joint: from the file's frame to the world
    std::vector<Pose> carrier_ws;   // by BodyRig::carriers: the bones' frames
    std::vector<Affine> stretched;  // by carrier: from the file's frame to the world
};

// Poses the joints of `rig` by the player's head, chest, arms, hands, spine and legs (talk rows 19
// to 23). Bone lengths are the player's. Thickness scales with the ratio of eye heights for legs,
// of shoulder widths for the trunk, and the smaller of both elsewhere. Joints along a forearm take
// their share of the hand's twist. A hand joint whose axes are hand space's equals RenderPose's
// hand exactly. Allocates only when the vectors of `out` grow.
void pose_skeleton(const BodyRig& rig, const BodyMeasures& measures, const RenderPose& render,
                   SkeletonPose& out);

// Twist of a hand about its forearm's axis that the forearm follows, radians; 0 where the back of
// the hand is on the elbow's side. Follows fully up to 120 degrees, then less, and not at all at
// 180, so that the result is continuous there. Fades out likewise if the wrist is bent by more than
// 120 degrees.
double followed_twist(const Quat& forearm, const Quat& hand);

// Pose of the player's trunk at `along`, from 0 at the pelvis to 1 between the shoulders.
Pose trunk_at(const SpinePose& spine, double along);

}  // namespace handhold
