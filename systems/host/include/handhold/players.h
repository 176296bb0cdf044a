#ifndef HANDHOLD_PLAYERS_H
#define HANDHOLD_PLAYERS_H

#include <handhold/base.h>
#include <handhold/skeletons.h>

/* Players: their bodies, hands, grips and events. A player is a play space that hands pull through
 * the world; head and hands sit in it where the tracking says. Joints: skeletons.h. */

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Players -------------------------------------------------------------------------------- */

/* Sizes of a player's body, each in [0.05, 5] m times hh_player_def.scale. */
typedef struct hh_measures {
    double eye_height_m;     /* standing */
    double shoulder_width_m; /* between the shoulder joints */
    double upper_arm_m;
    double forearm_m; /* to the wrist */
} hh_measures;

typedef struct hh_player_def {
    uint32_t struct_size;
    const char* name; /* unique in the world; null: by its id */
    hh_pose origin;   /* the space of the samples in the world */
    hh_vec3 velocity_mps;
    double mass_kg;       /* default 80 */
    /* Before scale: each in [0.05, 5] m. Default: unknown, the size is estimated from head and hands
     * while the player plays, within 20 s and by less than 1 mm a step. Other measures stay. */
    hh_measures measures;
    /* Size of the player, [0.01, 100], default 1; else HH_ERROR_VALUE. Body, head, hands, reach and
     * every number with hh_tuning_info.scales are times this. Samples and all results stay in the
     * world's metres: a host gives the tracked poses times the scale. Tested from 0.1 to 20. The
     * first hand of another scale than 1 that grips a shape copies its surface, at about 0.2
     * microseconds a triangle. */
    double scale;
    uint8_t head_collides; /* the head is a sphere of head.radius_m times scale; default true */
    /* Layers of the head; it touches a body if each one's layers meet the other's mask. */
    uint32_t layers, mask;
    uint32_t grab_layers; /* the hands grip bodies with one of these layers; default all */
    uint64_t user_data;
} hh_player_def;
HH_API hh_result hh_default_player_def_sized(hh_player_def* filled, size_t size);
static inline hh_player_def hh_default_player_def(void) {
    hh_player_def filled;
    hh_default_player_def_sized(&filled, sizeof(filled));
    return filled;
}
HH_API hh_result hh_player_add(hh_world* world, const hh_player_def* def, hh_player* player);
HH_API hh_result hh_player_remove(hh_world* world, hh_player player);
HH_API uint8_t hh_player_is_valid(const hh_world* world, hh_player player);
HH_API hh_result hh_world_players(const hh_world* world, hh_player* players, size_t capacity,
                                  size_t* count);
/* The headset's runtime, or the host, has recentred: from the next sample on, poses are given in a
 * space that lies at `new_in_old` in the space before (OpenXR: poseInPreviousSpace). It turns about
 * +Y only, else HH_ERROR_VALUE: x and z of the quaternion within 0.001. Before the player's first
 * sample there is nothing to recentre. View, hands and grips stay where they are in the world;
 * hh_player_pose.origin changes at once, HH_EVENT_RECENTRED follows in the next step. From now on
 * the host announces all recentrings, as after hh_player_set_recenter_guess(world, player, 0). */
HH_API hh_result hh_player_recenter(hh_world* world, hh_player player, hh_pose new_in_old);
/* `guesses` 1, the default: if head and hands jump by one turn about +Y and one translation, or the
 * head by more than tracking.max_jump_m, the runtime has recentred, and nothing in the world moves.
 * 0: the host announces recentrings, and every other jump is meant, such as a turn that the host
 * puts into its samples: view and hands follow it, and gripping hands take new anchors. Part of the
 * state. */
HH_API hh_result hh_player_set_recenter_guess(hh_world* world, hh_player player, uint8_t guesses);
/* Moves the play space at once; it is then at rest relative to the scene. Dynamic bodies in the hands
 * that no joint holds come along; hands let go of everything else, and hands of other players let go
 * of this player and of those bodies. */
HH_API hh_result hh_player_teleport(hh_world* world, hh_player player, hh_pose origin);
HH_API hh_result hh_player_velocity(const hh_world* world, hh_player player, hh_vec3* velocity_mps);
HH_API hh_result hh_player_set_velocity(hh_world* world, hh_player player, hh_vec3 velocity_mps);
/* The velocity that counts as rest for the player: that of the body last gripped, at the gripped
 * point, else the scene's. A player feels the speed relative to it: for vignettes and wind. */
HH_API hh_result hh_player_reference_velocity(const hh_world* world, hh_player player,
                                              hh_vec3* velocity_mps);
/* How far contacts moved the play space in the last step, against its hands and its velocity. */
HH_API hh_result hh_player_push_back(const hh_world* world, hh_player player, double* distance_m);
/* hh_player_def.mass_kg. */
HH_API hh_result hh_player_mass(const hh_world* world, hh_player player, double* mass_kg);
/* The sphere with which the head collides, in the world. Null outputs are skipped. is_tracked:
 * false before the head's first sample, and while it is lost or inferred. */
HH_API hh_result hh_player_head(const hh_world* world, hh_player player, hh_vec3* center,
                                double* radius_m, uint8_t* is_tracked);
/* The measures times the player's scale, in the world's metres: those given or measured in a T-pose,
 * else what is believed of the player's size by now. */
HH_API hh_result hh_player_measures(const hh_world* world, hh_player player, hh_measures* measures);
/* Replaces the measures, which are then no longer estimated. `measures`, not null: times the player's
 * scale, each in [0.05, 5] m times the scale. */
HH_API hh_result hh_player_set_measures(hh_world* world, hh_player player,
                                        const hh_measures* measures);
HH_API hh_result hh_player_set_user_data(hh_world* world, hh_player player, uint64_t user_data);
HH_API hh_result hh_player_user_data(const hh_world* world, hh_player player, uint64_t* user_data);
/* Sets the hand's wrist in the frame of hh_tracking_sample.hands: identity if the samples are wrists
 * with OpenXR's axes (-Z to the fingers, +Y the back of the hand). The pose is in the world's metres,
 * like the samples, and does not scale with the player; within 10 m. Null: the default, which is the
 * tuning's hand.controller_ numbers, for a controller's grip pose, times the player's scale. */
HH_API hh_result hh_player_set_hand_in_controller(hh_world* world, hh_player player, hh_side side,
                                                  const hh_pose* hand_in_controller);
/* Returns the wrist in the frame of the player's samples, in the world's metres: the pose set by
 * hh_player_set_hand_in_controller or, without one, the tuning's times the player's scale. For hosts
 * that have wrists and need controllers. */
HH_API hh_result hh_player_hand_in_controller(const hh_world* world, hh_player player, hh_side side,
                                              hh_pose* hand_in_controller);
/* Returns the tuning's pose of the wrist in a controller. Players of scale 1 without a pose of their
 * own have it. */
HH_API hh_result hh_world_hand_in_controller(const hh_world* world, hh_side side,
                                             hh_pose* hand_in_controller);

/* ---- Hands ---------------------------------------------------------------------------------- */

typedef enum hh_grip_kind {
    HH_GRIP_NONE = 0,
    HH_GRIP_SURFACE = 1,  /* something static, kinematic or heavy: the player moves */
    HH_GRIP_HELD = 2,     /* a dynamic body: it moves with the hand */
    HH_GRIP_AUTHORED = 3, /* in one of the body's authored grips */
    HH_GRIP_PLAYER = 4,   /* another player: head, arm, trunk or leg */
    HH_GRIP_KIND_32_BITS = 0x7fffffff
} hh_grip_kind;

/* Grows: see base.h. */
typedef struct hh_hand_state {
    hh_grip_kind grip;
    hh_body body;    /* gripped; null: none */
    hh_player other; /* gripped player; null: none */
    hh_pose tracked; /* the wrist in the world, as the devices say */
    /* The wrist to draw. While it grips it is fitted to the surface near the anchor: centimetres
     * from it, so that palm and fingers touch. A lost or never tracked hand that grips nothing
     * hangs beside the trunk; it goes there and comes back at a bounded speed. */
    hh_pose shown;
    /* The wrist in the frame of what it grips (a body, or a part of a player), from when the hand
     * closed. The hand takes a new anchor after tracking errors, when the other hand of a shared grip
     * lets go, and when the body's kind or mass changes. */
    hh_pose anchor;
    /* Distance of the tracked wrist from the anchor: 0 unless something blocks it. */
    double error_m;
    /* Impulse of the hand on what it grips in the last step, for haptics. 0 if the host's solver
     * moved the player (hh_world_end_step): read it there. While hands move only light bodies, the
     * reported impulses of hands and contacts are limited to the momentum that the players and
     * bodies involved have at their speeds plus the hands' speed. */
    hh_vec3 force_impulse_ns;
    uint8_t is_tracked; /* false while the hand is lost or inferred */
    uint8_t is_closed;  /* the button is down */
    /* The runtime guesses where the hand is (hh_tracking_sample.hand_inferred). `tracked` is the
     * guess for an empty hand, and for a body in it while no hand of the player moves the player;
     * else the last pose that was measured. */
    uint8_t is_inferred;
} hh_hand_state;

/* Grows: see base.h. Later fields come behind `hands`. */
typedef struct hh_player_pose {
    /* The space of the samples in the world: put the camera rig here. Controllers at origin *
     * sample are where the hands are, also after a recentring, which changes it so that nothing in
     * the world moves. */
    hh_pose origin;
    hh_pose head;           /* between the eyes, in the world */
    hh_vec3 velocity_mps;   /* of the play space */
    hh_hand_state hands[2]; /* by hh_side */
} hh_player_pose;

/* One hand. `hand_size`: bytes of hh_hand_state as the host knows it. */
HH_API hh_result hh_player_hand_sized(const hh_world* world, hh_player player, hh_side side,
                                      hh_hand_state* hand, size_t hand_size);
static inline hh_result hh_player_hand(const hh_world* world, hh_player player, hh_side side,
                                       hh_hand_state* hand) {
    return hh_player_hand_sized(world, player, side, hand, sizeof(hh_hand_state));
}
/* True if the player can pull on what the hand grips: something static, kinematic or heavy, another
 * player, or a body that joints connect to something fixed, such as a lever. False if the hand is
 * empty, or what it holds comes along. */
HH_API hh_result hh_hand_moves_player(const hh_world* world, hh_player player, hh_side side,
                                      uint8_t* moves_player);
/* Poses of many players in one call; HH_ERROR_HANDLE, and nothing written, if one is stale.
 * `pose_size`, `hand_size`: bytes of hh_player_pose and hh_hand_state as the host knows them. */
HH_API hh_result hh_world_player_poses_sized(const hh_world* world, const hh_player* players,
                                             size_t count, hh_player_pose* poses, size_t pose_size,
                                             size_t hand_size);
static inline hh_result hh_world_player_poses(const hh_world* world, const hh_player* players,
                                              size_t count, hh_player_pose* poses) {
    return hh_world_player_poses_sized(world, players, count, poses, sizeof(hh_player_pose),
                                       sizeof(hh_hand_state));
}
/* In the next step the hand grips `body` where both are, at any distance, whatever the grab rules
 * say; only a body for two hands needs an order for both. No grip begins while the player opens the
 * hand. It holds until hh_hand_release or until the player opens the hand. If the player closes the
 * hand before that, it grips what is in reach instead; with nothing in reach, the grip stays.
 * HH_ERROR_STATE for a hand that was never tracked. */
HH_API hh_result hh_hand_grip(hh_world* world, hh_player player, hh_side side, hh_body body);
/* In the next step the hand lets go, without a throw. It grips again when the player opens and
 * closes it. HH_OK also for an empty hand. */
HH_API hh_result hh_hand_release(hh_world* world, hh_player player, hh_side side);

/* ---- Events --------------------------------------------------------------------------------- */

typedef enum hh_event_kind {
    /* The palm of an empty, tracked hand came within 2 cm times the player's scale of a body or of
     * another player's head. */
    HH_EVENT_TOUCHED = 0,
    HH_EVENT_GRABBED = 1,       /* a hand grips */
    HH_EVENT_RELEASED = 2,      /* the player opened the hand, or `reason` says who did */
    HH_EVENT_REFUSED = 3,       /* a hand closed and grips nothing: `reason` */
    HH_EVENT_SLIPPED = 4,       /* a hand lost its grip: `reason` */
    /* The player's head, or what a hand holds, hits a body or another player's head. */
    HH_EVENT_CONTACT_BEGAN = 5,
    HH_EVENT_CONTACT_ENDED = 6,
    HH_EVENT_LATCH_CLOSED = 7, /* of `joint` */
    HH_EVENT_LATCH_OPENED = 8,
    HH_EVENT_LIMIT_REACHED = 9, /* a joint came to its lower or upper limit */
    /* hh_player_pose.origin was changed so that a recentring moves nothing. HH_REASON_BY_HOST: by
     * hh_player_recenter; HH_REASON_NONE: the samples jumped. `position`: the head. */
    HH_EVENT_RECENTRED = 10,
    HH_EVENT_KIND_32_BITS = 0x7fffffff
} hh_event_kind;

typedef enum hh_reason {
    HH_REASON_NONE = 0,
    HH_REASON_OPENED = 1,          /* the player opened the hand */
    HH_REASON_NO_SURFACE = 2,      /* nothing in reach, or only behind a wall */
    HH_REASON_NOT_ALLOWED = 3,     /* a grab rule or layers refuse the hand */
    HH_REASON_NEEDS_TWO_HANDS = 4, /* the other hand is not there, or left */
    HH_REASON_STRETCHED = 5,       /* farther from its anchor than hand.max_stretch_m */
    HH_REASON_TRACKING_LOST = 6,   /* it opened unseen, or came back too far away */
    HH_REASON_BODY_GONE = 7,       /* the body was removed */
    /* hh_hand_release, hh_hand_grip, hh_hand_hold, hh_body_set_shape or a teleport */
    HH_REASON_BY_HOST = 8,
    HH_REASON_OTHER_HAND = 9,      /* the other of two hands on a body let go */
    HH_REASON_32_BITS = 0x7fffffff
} hh_reason;

/* "grabbed", "no_surface"; null for numbers that this version does not know. Any thread. */
HH_API const char* hh_event_kind_name(hh_event_kind kind);
HH_API const char* hh_reason_name(hh_reason reason);

/* Grows: see base.h. Later versions also have more kinds and reasons: ignore those you do not know.
 */
typedef struct hh_event {
    hh_event_kind kind;
    hh_reason reason;
    hh_player player;  /* null: a joint's event that concerns no hand */
    int32_t side;      /* hh_side; -1: no hand: the head or a joint alone */
    hh_body body;      /* touched, gripped, held or hit; null: a player, or nothing */
    hh_player other;   /* gripped or hit player; null: none */
    hh_body held;      /* contacts: what the hand holds; null: the head */
    hh_joint joint;    /* whose latch or limit it is; null: none */
    hh_vec3 position;  /* in the world: of the wrist, the contact, the joint or the head */
    double impulse_ns; /* of a contact that began: >= 0, for haptics and sound */
} hh_event;

/* The events of the last step, in a fixed order. Valid until the next step, restore, destroy or
 * call of this function. `event_size`: bytes of hh_event as the host knows it; the list's elements
 * lie so far apart. */
HH_API hh_result hh_world_events_sized(const hh_world* world, const hh_event** events,
                                       size_t* count, size_t event_size);
static inline hh_result hh_world_events(const hh_world* world, const hh_event** events,
                                        size_t* count) {
    return hh_world_events_sized(world, events, count, sizeof(hh_event));
}

#ifdef __cplusplus
}
#endif

#endif
