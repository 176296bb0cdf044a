#ifndef HANDHOLD_SKELETONS_H
#define HANDHOLD_SKELETONS_H

#include <handhold/base.h>

/* Joints of players' hands and bodies, skeletons that follow them, and authored grips. */

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Joints of hands and bodies ------------------------------------------------------------- */

typedef enum hh_space {
    HH_SPACE_WORLD = 0,
    HH_SPACE_PARENT = 1, /* in the parent joint's frame; roots: in the world */
    HH_SPACE_32_BITS = 0x7fffffff
} hh_space;

/* Joints as XR_EXT_hand_tracking has them, in its order and with its axes. The parent of palm and
 * metacarpals is the wrist. */
typedef enum hh_hand_joint_name {
    HH_HAND_PALM,
    HH_HAND_WRIST,
    HH_THUMB_METACARPAL,
    HH_THUMB_PROXIMAL,
    HH_THUMB_DISTAL,
    HH_THUMB_TIP,
    HH_INDEX_METACARPAL,
    HH_INDEX_PROXIMAL,
    HH_INDEX_INTERMEDIATE,
    HH_INDEX_DISTAL,
    HH_INDEX_TIP,
    HH_MIDDLE_METACARPAL,
    HH_MIDDLE_PROXIMAL,
    HH_MIDDLE_INTERMEDIATE,
    HH_MIDDLE_DISTAL,
    HH_MIDDLE_TIP,
    HH_RING_METACARPAL,
    HH_RING_PROXIMAL,
    HH_RING_INTERMEDIATE,
    HH_RING_DISTAL,
    HH_RING_TIP,
    HH_LITTLE_METACARPAL,
    HH_LITTLE_PROXIMAL,
    HH_LITTLE_INTERMEDIATE,
    HH_LITTLE_DISTAL,
    HH_LITTLE_TIP,
    HH_HAND_JOINT_NAME_32_BITS = 0x7fffffff
} hh_hand_joint_name;
#define HH_HAND_JOINT_COUNT 26
typedef struct hh_hand_joint {
    hh_pose pose;
    double radius_m;
    uint8_t is_valid; /* false: the hand's rig has no such joint */
} hh_hand_joint;
/* How far the fingers of a tracked hand are bent, for hh_tracking_sample.curls. `joints`:
 * HH_HAND_JOINT_COUNT elements, by hh_hand_joint_name, in any one space; only positions are read.
 * Curl is the sum of a finger's bends over that of a fist; -1 if a joint of the finger is not
 * valid. Any thread. */
HH_API hh_result hh_finger_curls_of(const hh_hand_joint* joints, hh_finger_curls* curls);
/* The shown hand's joints. `joints`: HH_HAND_JOINT_COUNT elements, by hh_hand_joint_name. */
HH_API hh_result hh_player_hand_joints(const hh_world* world, hh_player player, hh_side side,
                                       hh_space space, hh_hand_joint* joints);

/* Joints of a humanoid, with VRM's names. Trunk, head and legs: +Y up along the bone, -Z to the
 * front. Arms: -Z along the bone, +Y on the elbow's side. Hands: the wrist's axes. */
typedef enum hh_body_joint {
    HH_HIPS,
    HH_SPINE,
    HH_CHEST,
    HH_UPPER_CHEST,
    HH_NECK,
    HH_HEAD,
    HH_LEFT_SHOULDER,
    HH_LEFT_UPPER_ARM,
    HH_LEFT_LOWER_ARM,
    HH_LEFT_HAND,
    HH_RIGHT_SHOULDER,
    HH_RIGHT_UPPER_ARM,
    HH_RIGHT_LOWER_ARM,
    HH_RIGHT_HAND,
    HH_LEFT_UPPER_LEG,
    HH_LEFT_LOWER_LEG,
    HH_LEFT_FOOT,
    HH_RIGHT_UPPER_LEG,
    HH_RIGHT_LOWER_LEG,
    HH_RIGHT_FOOT,
    HH_BODY_JOINT_COUNT,
    HH_BODY_JOINT_32_BITS = 0x7fffffff
} hh_body_joint;
/* "leftUpperArm"; null beyond the last. Any thread. */
HH_API const char* hh_body_joint_name(size_t joint);
/* The parent's index; -1 for the hips and beyond the last. */
HH_API int32_t hh_body_joint_parent(size_t joint);
/* `joints`: HH_BODY_JOINT_COUNT elements. */
HH_API hh_result hh_player_body_joints(const hh_world* world, hh_player player, hh_space space,
                                       hh_pose* joints);

/* ---- Rigs and authored grips ---------------------------------------------------------------- */

/* The player's hand gets the proportions of the skeleton in a glTF file (.glb, or .gltf with its
 * data inside) whose joints have WebXR's or OpenXR's names. Null bytes: the built-in hand.
 * HH_ERROR_DATA says what the file lacks. */
HH_API hh_result hh_player_set_hand_rig(hh_world* world, hh_player player, hh_side side,
                                        const void* gltf, size_t size);
/* The player's body drives a humanoid skeleton from a glTF file; the table of a VRM file says which
 * joint is which. Null bytes: none. */
HH_API hh_result hh_player_set_body_rig(hh_world* world, hh_player player, const void* gltf,
                                        size_t size);

/* Which joint of ours a joint of a skeleton is, for hh_skeleton_joint.is: one of the lower three
 * plus an hh_body_joint or an hh_hand_joint_name. */
#define HH_IS_BY_NAME 0 /* found by names, hierarchy and places */
#define HH_IS_BODY 100
#define HH_IS_LEFT_HAND 200
#define HH_IS_RIGHT_HAND 300
typedef struct hh_skeleton_joint {
    const char* name; /* as in the engine's file; null: none */
    int32_t parent;   /* index; -1: a root */
    /* HH_IS_..., for names that nobody can guess. Spine and palms need none: joints of the
     * trunk follow by their height, joints of the palm follow the hand. */
    int32_t is;
    /* In the space given, without scale: T-pose or A-pose, +Y up, of any size and heading. */
    hh_pose bind;
} hh_skeleton_joint;
/* hh_player_set_body_rig for a skeleton as an array, of an engine that has no glTF file: 1 to 1024
 * joints, in any order. In other axes: handhold/convert.h. No joints: none. The tracked head lies
 * between the eyes: at joints below the head whose names end in "eye", "eyes", "eye_l", "eye_r",
 * "eye.l" or "eye.r", in any case, else estimated from the head's joint and its children.
 * HH_ERROR_VALUE for parents that do not exist or form a ring; HH_ERROR_DATA says by name or index
 * which joints are missing or implausible. */
HH_API hh_result hh_player_set_body_skeleton(hh_world* world, hh_player player,
                                             const hh_skeleton_joint* joints, size_t count,
                                             hh_space space);
/* Joints of the player's body rig, in the order in which they were given. Fingers follow the shown
 * hand's; a figure with both hands' fingers needs no second pair of hands
 * (hh_player_skeleton_fingers). HH_ERROR_STATE without a rig. */
HH_API hh_result hh_player_skeleton(hh_world* world, hh_player player, hh_space space,
                                    hh_pose* joints, size_t capacity, size_t* count);
/* Name and parent (-1: none) of one of these joints. The name is valid while the rig is set. */
HH_API hh_result hh_player_skeleton_joint(const hh_world* world, hh_player player, size_t joint,
                                          const char** name, int32_t* parent);
/* Number of fingers of a hand of the body rig that follow the shown hand's, 0 to 5: 0 is a figure
 * whose hands the host draws by hh_player_hand_joints. */
HH_API hh_result hh_player_skeleton_fingers(const hh_world* world, hh_player player, hh_side side,
                                            size_t* count);

typedef struct hh_finger {
    uint8_t is_posed;      /* false: the finger closes on the surface as usual */
    double curl_rad[3];    /* of its hinges, from the knuckle; each within pi */
    double opposition_rad; /* thumb; of a finger: spread towards the thumb, clamped to 0.17 */
    /* The finger moves from these angles to the pressed ones as far as the sample's `trigger` is
     * pressed. The pressed angles may reach into the body: a trigger gives way. */
    uint8_t follows_trigger;
    double pressed_curl_rad[3];
    double pressed_opposition_rad;
} hh_finger;
typedef struct hh_grip_hand {
    uint8_t is_used;      /* false: this hand cannot take the grip */
    hh_pose wrist;        /* in the body's frame */
    hh_finger fingers[5]; /* thumb, index, middle, ring, little */
} hh_grip_hand;
typedef struct hh_grip_def {
    uint32_t struct_size;
    hh_grip_hand hands[2]; /* by hh_side */
    int32_t priority;      /* of several in reach, the highest is taken */
    double snap_radius_m;  /* of the palm, [0, 10]; default 0.08 */
    double snap_angle_rad; /* [0, pi]; default pi / 3 */
} hh_grip_def;
HH_API hh_result hh_default_grip_def_sized(hh_grip_def* filled, size_t size);
static inline hh_grip_def hh_default_grip_def(void) {
    hh_grip_def filled;
    hh_default_grip_def_sized(&filled, sizeof(filled));
    return filled;
}
/* Adds an authored grip to a body: hands that close near it take it. HH_ERROR_STATE if the body has
 * 4 already. */
HH_API hh_result hh_body_add_grip(hh_world* world, hh_body body, const hh_grip_def* def);

#ifdef __cplusplus
}
#endif

#endif
