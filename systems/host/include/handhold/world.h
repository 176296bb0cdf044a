#ifndef HANDHOLD_WORLD_H
#define HANDHOLD_WORLD_H

#include <handhold/base.h>

/* Worlds: stepping, snapshots, tuning and statistics. */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hh_world_def {
    uint32_t struct_size;
    /* Fingers and palms close on what they grip. Default true. Without it no shape needs a grip
     * mesh, hands are shown as tracked, and meshes are added faster: for servers. */
    uint8_t fits_hands;
    /* HH_EVENT_TOUCHED is reported: one query a step for each empty hand. Default true. */
    uint8_t reports_touches;
    hh_vec3 gravity_mps2;           /* of dynamic bodies; default 0. Each axis within 1e4 */
    hh_vec3 reference_velocity_mps; /* of the scene: what counts as rest. Each axis within 1e6 */
} hh_world_def;

HH_API hh_result hh_default_world_def_sized(hh_world_def* filled, size_t size);
static inline hh_world_def hh_default_world_def(void) {
    hh_world_def filled;
    hh_default_world_def_sized(&filled, sizeof(filled));
    return filled;
}
/* Makes an empty world. A null `def`: the default. Any thread, at any time. Cost: 0.1 ms. */
HH_API hh_result hh_world_create(const hh_world_def* def, hh_world** world);
/* Destroys a world and everything in it. Null, inside the world's own surface query, or in a match:
 * nothing happens. */
HH_API void hh_world_destroy(hh_world* world);

/* One reading of the headset and both controllers. A pose at exactly (0, 0, 0) counts as not
 * tracked, since runtimes report devices that sleep so. */
typedef struct hh_tracking_sample {
    uint32_t struct_size;
    /* On the world's clock: hh_world_time plus the step for a sample at the step's end. A sample
     * that is not later than the one before is ignored and counted as sample_out_of_order. More
     * than 0.5 s after the step's end, it is dropped and counted as sample_too_far_ahead, unless
     * hh_player_input.repeats_samples; more than 0.5 s before the step's start, it is counted as
     * sample_too_old. If all samples of a player in a step are so far off, the log is told, once
     * per world, that they are on another clock. hh_world_step_pose_only takes any times. */
    double time_s;
    hh_pose head;     /* between the eyes, in play space: the frame that the tracking is given in */
    hh_pose hands[2]; /* controllers, by hh_side; see hh_player_set_hand_in_controller */
    uint8_t head_tracked;    /* false: `head` is ignored */
    uint8_t hand_tracked[2]; /* false: the pose is ignored, `grab` counts */
    uint8_t grab[2];         /* a button that closes the hand is down */
    double squeeze[2]; /* how far it is pressed, [0, 1]: bends fingers until `grab` closes them */
    /* How far the index finger's trigger is pressed, [0, 1]: bends the index finger of an empty
     * hand, and the fingers of authored grips that follow the trigger. */
    double trigger[2];
    /* True if the runtime only guesses the head's position: OpenXR's POSITION_VALID without
     * POSITION_TRACKED, WebXR's emulatedPosition, a low confidence. Default false; true overrides
     * head_tracked. The head follows the guess, but while a hand grips what the player can
     * pull on, only its rotation does. */
    uint8_t head_inferred;
    /* The same for the hands; true overrides hand_tracked. An inferred hand does not begin to grip,
     * and never moves a player who grips: it stays where it was last measured. Opening `grab` lets
     * go, without a throw. The shown empty hand follows the guess. When the hand is measured again,
     * its displacement since does not count as travel. */
    uint8_t hand_inferred[2];
    /* Bend of the fingers of an empty hand; known curls override squeeze and trigger. Default
     * unknown. Measured by gloves, or made from joints by hh_finger_curls_of. */
    hh_finger_curls curls[2];
} hh_tracking_sample;

/* Everything tracked, hands open, at time 0. The poses are for you to fill: at the origin they
 * count as not tracked. Any thread. */
HH_API hh_result hh_default_tracking_sample_sized(hh_tracking_sample* filled, size_t size);
static inline hh_tracking_sample hh_default_tracking_sample(void) {
    hh_tracking_sample filled;
    hh_default_tracking_sample_sized(&filled, sizeof(filled));
    return filled;
}

/* What a player asks for in one step. All zero: nothing. Grows with hh_player_input, of which it is
 * the last field. In the fields of later versions, too, 0 will ask for nothing. */
typedef struct hh_commands {
    double smooth_turn; /* [-1, 1], positive turns left */
    int32_t snap_turns; /* turns to the left begun in this step; negative: to the right */
    double brake;       /* [0, 1] */
    hh_vec3 thrust;     /* play space, each in [-1, 1]; needs locomotion.thruster_mps2 above 0 */
    uint8_t calibrate;  /* held while the player holds a T-pose: measures the body */
} hh_commands;

/* One player's input of one step. Fill by hh_default_player_input. */
typedef struct hh_player_input {
    uint32_t struct_size;
    hh_player player;
    /* The samples since the last step, sorted by time. Give each once. Up to 64 may be later than
     * this step's end, by at most 0.5 s, as predicted poses are: the poses at the end are then
     * interpolated, and each sample is kept for the step of its time, even if that step has no
     * input. A new sample replaces kept samples of the same time or later. None: the devices are
     * silent, except for kept samples. */
    const hh_tracking_sample* samples;
    size_t sample_count;
    /* True: the host gives a sample that is later than the step's end again in the next step, so
     * the world keeps none, and sample times are exact. False, the default: up to a microsecond
     * after the step's end counts as the end. For hosts that have the whole stream: recordings,
     * rollback. */
    uint8_t repeats_samples;
    hh_commands commands;
} hh_player_input;

HH_API hh_result hh_default_player_input_sized(hh_player_input* filled, size_t size);
static inline hh_player_input hh_default_player_input(void) {
    hh_player_input filled;
    hh_default_player_input_sized(&filled, sizeof(filled));
    return filled;
}

/* Steps the world by dt_s, in [1e-6, 10]; 1/90 is usual. `inputs`: at most one a player, else
 * HH_ERROR_VALUE; players without one are silent. Bad samples are ignored and counted; numbers in
 * commands that are out of range are clamped. Cost: about 0.03 ms for a player who crawls, 0.05 ms
 * for one who grips and lets go all the time, and up to 4 ms in the frame in which a hand closes:
 * docs/guide/cost.md. */
HH_API hh_result hh_world_step(hh_world* world, double dt_s, const hh_player_input* inputs,
                               size_t input_count);
/* hh_world_step without fitted hands, arms, spine and legs: about a quarter of its cost. What hosts
 * draw stays as the last other step left it: hh_player_pose with its hands, joints of hands and
 * bodies, hh_player_push_back.
 * Everything else changes exactly as in hh_world_step, bit for bit: hh_world_simulated_hash is
 * equal whichever steps were shown. For rollback: step again to the present with this, and the last
 * time with hh_world_step. Events carry the tracked hand's position. */
HH_API hh_result hh_world_step_simulated(hh_world* world, double dt_s,
                                         const hh_player_input* inputs, size_t input_count);
/* While the game is paused: heads, hands and bodies of players follow their last sample, whatever
 * its time. The clock, bodies, joints, grips and play spaces stand still. Samples that were waiting
 * for their step are dropped. The next hh_world_step goes on: hands that are still closed grip
 * where they are at that time. */
HH_API hh_result hh_world_step_pose_only(hh_world* world, double dt_s,
                                         const hh_player_input* inputs, size_t input_count);
/* The world's clock, seconds, and the number of steps. Null outputs are skipped. */
HH_API hh_result hh_world_time(const hh_world* world, double* time_s, uint64_t* frame);

/* Acceleration of dynamic bodies; players float. Each axis within 1e4 m/s^2. */
HH_API hh_result hh_world_set_gravity(hh_world* world, hh_vec3 gravity_mps2);
/* Velocity of the scene: drifting players come to rest against it. Each axis within 1e6 m/s. */
HH_API hh_result hh_world_set_reference_velocity(hh_world* world, hh_vec3 velocity_mps);
HH_API hh_result hh_world_gravity(const hh_world* world, hh_vec3* gravity_mps2);
HH_API hh_result hh_world_reference_velocity(const hh_world* world, hh_vec3* velocity_mps);

/* Hash of the whole state. Equal on every machine, compiler and number of threads after equal
 * calls with equal names. Not in it: which shape a body has, because ids depend on the order of
 * loading. Cost: linear in the state, about 0.1 ms for a scene of 100 bodies. */
HH_API hh_result hh_world_hash(const hh_world* world, uint64_t* hash);
/* The same of the simulated state alone, without what hosts draw. Machines that show different
 * frames, or none, compare this. */
HH_API hh_result hh_world_simulated_hash(const hh_world* world, uint64_t* hash);
/* Saves every bit of the state. Writes the number of bytes to `size`. A null `buffer` only asks for
 * it. HH_ERROR_CAPACITY if it is more than `capacity`. Rigs, tuning and user data are not in a
 * snapshot. Shapes are named by their content: a world that restores it needs equal ones, whatever
 * their ids. */
HH_API hh_result hh_world_save(hh_world* world, void* buffer, size_t capacity, size_t* size);
/* Back to a saved state, which then goes on bit for bit. Ids taken before the save are valid again.
 * HH_ERROR_DATA, and no change, for bytes that are damaged or name a shape that this world has not.
 * Tolerates any bytes. */
HH_API hh_result hh_world_restore(hh_world* world, const void* bytes, size_t size);

/* What receives the impulses of constraints, index of hh_momentum's arrays. */
typedef enum hh_momentum_receiver {
    HH_MOMENTUM_BODIES = 0, /* dynamic bodies */
    HH_MOMENTUM_PLAYERS = 1,
    HH_MOMENTUM_DISCARDED = 2, /* impulses of hands on bodies that did not push the player back */
    HH_MOMENTUM_STATICS = 3,   /* static and kinematic bodies */
    HH_MOMENTUM_RECEIVERS = 4
} hh_momentum_receiver;
/* Sums of all impulses of a step, by hh_momentum_receiver. Each array's sum is 0. */
typedef struct hh_momentum {
    hh_vec3 linear_kgmps[4];
    hh_vec3 angular_kgm2ps[4]; /* about the world's origin */
} hh_momentum;

/* Numbers of the last step. */
typedef struct hh_world_stats {
    uint32_t struct_size;
    uint64_t bodies, joints, players, shapes; /* now */
    uint64_t contacts;
    uint64_t islands;           /* groups of bodies that constraints connect */
    uint64_t newton_iterations; /* of all solves */
    double hand_error_m;        /* largest distance of a gripping hand from its anchor */
    double overlap_m;           /* worst contact overlap at the end */
    double joint_error_m;       /* largest position error of a joint */
    double step_us;             /* sum of all stages */
    double joint_error_rad;     /* largest error of a joint's direction, or angle beyond a limit */
    uint64_t islands_pushed;    /* islands in which something pushed a player back */
    uint64_t contact_rounds;    /* searches for contacts inside the solve */
    uint64_t hands_closed;      /* hands that closed */
    uint64_t hands_gripped;     /* grips that began */
    hh_momentum momentum;
    /* The two of `overlap_m`; null: a player's head, or no overlap. */
    hh_body deepest_a, deepest_b;
} hh_world_stats;
HH_API hh_result hh_default_world_stats_sized(hh_world_stats* filled, size_t size);
static inline hh_world_stats hh_default_world_stats(void) {
    hh_world_stats filled;
    hh_default_world_stats_sized(&filled, sizeof(filled));
    return filled;
}
HH_API hh_result hh_world_get_stats(const hh_world* world, hh_world_stats* stats);
/* Stages and fallbacks by index; null beyond the last. A fallback is counted whenever the runtime
 * does the next best instead of what was asked. Any thread. */
HH_API const char* hh_stage_name(size_t stage);
HH_API const char* hh_fallback_name(size_t fallback);
/* Time of each stage, microseconds, and how often each fallback occurred, in the last step. `count`
 * gets the number of entries; HH_ERROR_CAPACITY if it is more than `capacity`. */
HH_API hh_result hh_world_stage_times(const hh_world* world, double* us, size_t capacity,
                                      size_t* count);
HH_API hh_result hh_world_fallbacks(const hh_world* world, uint64_t* times, size_t capacity,
                                    size_t* count);

/* A tunable number, or a vector of three. Texts live as long as the process. */
typedef struct hh_tuning_info {
    uint32_t struct_size;
    const char* name; /* "hand.reach_m" */
    const char* unit; /* "m", "" */
    const char* what;
    double low, high; /* of each component */
    size_t count;     /* 1 or 3 */
    uint8_t scales;   /* true: each player has the number times hh_player_def.scale */
} hh_tuning_info;
HH_API hh_result hh_default_tuning_info_sized(hh_tuning_info* filled, size_t size);
static inline hh_tuning_info hh_default_tuning_info(void) {
    hh_tuning_info filled;
    hh_default_tuning_info_sized(&filled, sizeof(filled));
    return filled;
}
/* The number with this index; HH_ERROR_VALUE beyond the last. Any thread. */
HH_API hh_result hh_tuning_describe(size_t index, hh_tuning_info* info);
/* Reads and changes one number by name, between steps. `count` must be the number's.
 * HH_ERROR_NAME for an unknown name, HH_ERROR_VALUE out of range. */
HH_API hh_result hh_world_get_tuning(const hh_world* world, const char* name, double* values,
                                     size_t count);
HH_API hh_result hh_world_set_tuning(hh_world* world, const char* name, const double* values,
                                     size_t count);
/* All numbers of the tuning, to compare, keep and restore: in the order of hh_tuning_describe, a
 * vector as three. `count` as for hh_world_fallbacks. Set takes exactly all of them; on an error
 * none changes. */
HH_API hh_result hh_world_tuning_numbers(const hh_world* world, double* values, size_t capacity,
                                         size_t* count);
HH_API hh_result hh_world_set_tuning_numbers(hh_world* world, const double* values, size_t count);
/* All numbers from JSON, {"hand": {"reach_m": 0.12}}; those that it lacks get their defaults.
 * HH_ERROR_DATA, with the place, for unknown names and wrong numbers. */
HH_API hh_result hh_world_load_tuning(hh_world* world, const char* json, size_t size);
/* The additive body clips of all players, from JSON in the format of docs/reference/body_clips.md:
 * idling, pushing off, looking round, raising the arms. They rotate spine, legs and clavicles,
 * never hands. They replace the clips before. Null: none, which is the default. HH_ERROR_DATA, with
 * the place and no change, for anything else. Clips are not in a snapshot: load the same ones
 * before you restore. */
HH_API hh_result hh_world_load_body_clips(hh_world* world, const char* json, size_t size);

#ifdef __cplusplus
}
#endif

#endif
