#ifndef HANDHOLD_YOUR_PHYSICS_H
#define HANDHOLD_YOUR_PHYSICS_H

#include <handhold/base.h>
#include <handhold/level.h>
#include <handhold/players.h>
#include <handhold/world.h>

/* For hosts with physics of their own: docs/guide/your_own_physics.md.
 *
 * The world gets no shapes. The host registers the bodies that hands may grip (hh_body_add with a
 * null shape), answers queries about surfaces (hh_world_set_surface_query), and tells where bodies
 * are (hh_world_place_bodies). Then, in each frame, one of:
 *   hh_world_step_hands             the host moves players and decides what hands hold
 *   hh_world_begin_step, _end_step  hands pull players; the host's solver moves everything
 *   hh_world_step                   hands pull players; bodies that they hold are moved here
 * Cost: linear in the number of registered bodies, about 0.2 microseconds each. */

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Surfaces ------------------------------------------------------------------------------- */

/* What a query found. Ignored, and counted as surface_answer_invalid: a body that is not in the
 * world, numbers that are not finite, a point beyond 1e9 m, a normal of length zero. */
typedef struct hh_surface_hit {
    hh_body body;
    hh_vec3 point;     /* on the surface, in the world */
    hh_vec3 normal;    /* out of the solid or towards the query; need not have length 1 */
    double distance_m; /* see each query */
} hh_surface_hit;

/* Queries against the host's surfaces. Each returns true if it found something, and then fills
 * `hit`. `skip`: bodies that count as not there. Called only inside hh_world_step, _step_hands,
 * _begin_step, _end_step, _step_pose_only and hh_hand_find_grip of this world, by the thread that
 * made that call. A query may read the world; calls that change it return HH_ERROR_STATE. Per
 * player and frame: about 3 queries, up to 50 when a hand closes behind walls or among bodies. */
typedef struct hh_surface_query {
    uint32_t struct_size;
    void* context; /* passed to each of the functions */
    /* First surface that the segment hits, from outside or inside. distance_m is not read. */
    uint8_t (*cast_ray)(void* context, hh_vec3 from, hh_vec3 to, const hh_body* skip,
                     size_t skip_count, hh_surface_hit* hit);
    /* First impact of a sphere moving along a segment; distance_m: how far its centre has moved.
     * For the distance grab (pull.reach_m above 0), and to keep trunk and legs out of surfaces:
     * about one query per player and frame. Null: neither. */
    uint8_t (*cast_sphere)(void* context, double radius_m, hh_vec3 from, hh_vec3 to,
                        const hh_body* skip, size_t skip_count, hh_surface_hit* hit);
    /* Nearest surface point within max_distance_m; distance_m: 0 inside a solid. */
    uint8_t (*closest_point)(void* context, hh_vec3 point, double max_distance_m, const hh_body* skip,
                          size_t skip_count, hh_surface_hit* hit);
    /* Nearest surface point of one body, at any distance; distance_m: 0 inside a solid. */
    uint8_t (*closest_point_on)(void* context, hh_body body, hh_vec3 point, hh_surface_hit* hit);
} hh_surface_query;
/* All functions null: nothing is found. */
HH_API hh_result hh_default_surface_query_sized(hh_surface_query* filled, size_t size);
static inline hh_surface_query hh_default_surface_query(void) {
    hh_surface_query filled;
    hh_default_surface_query_sized(&filled, sizeof(filled));
    return filled;
}
/* From now on hands, trunks and legs ask the host, not the world's shapes. Null: back to the shapes.
 * HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. */
HH_API hh_result hh_world_set_surface_query(hh_world* world, const hh_surface_query* query);
/* The triangles that palm and fingers close on, in the body's frame; null: none. Not needed for
 * gripping. The body must have no shape. HH_ERROR_STATE if it has, or if the mesh or the world was
 * made without fits_hands. */
HH_API hh_result hh_body_set_surface(hh_world* world, hh_body body, const hh_mesh* mesh);

/* ---- Bodies and players of the host --------------------------------------------------------- */

typedef struct hh_body_motion {
    hh_body body;
    hh_pose pose; /* of the shape's own frame; without a shape: centre of mass and principal axes */
    hh_vec3 velocity_mps;
    hh_vec3 angular_velocity_radps;
} hh_body_motion;
/* Where bodies are now, after the host's own step. Unlike a teleport it ends no grip. A kinematic
 * body rests there until hh_body_move_kinematic says where it will be at the end of the next step.
 * Places all or, on an error, none. HH_ERROR_VALUE for a body that is there twice. */
HH_API hh_result hh_world_place_bodies(hh_world* world, const hh_body_motion* motions,
                                       size_t count);
/* Where a player's hh_player_pose.origin is now, and its velocity, by the host's locomotion. Unlike a
 * teleport it ends no grip. */
HH_API hh_result hh_player_place(hh_world* world, hh_player player, hh_pose origin,
                                 hh_vec3 velocity_mps);

/* ---- The host moves players and decides what hands hold ------------------------------------- */

/* The hand holds `body` from now on; a null id: nothing. `anchor`: the wrist in the body's frame;
 * null: where both are now, HH_ERROR_STATE for a hand that was never tracked. For hosts that use
 * hh_world_step_hands only: the other steps keep the hold and let the hand pull the player. */
HH_API hh_result hh_hand_hold(hh_world* world, hh_player player, hh_side side, hh_body body,
                              const hh_pose* anchor);
/* What the hand would grip if it closed where it is, by the rules of hands that pull players:
 * reach, sight, grab rules, authored grips. A null body: nothing, or another player. distance_m:
 * from the palm. In every kind of world. HH_ERROR_STATE for a hand that was never tracked. */
HH_API hh_result hh_hand_find_grip(hh_world* world, hh_player player, hh_side side,
                                   hh_surface_hit* hit);
/* One frame: reads tracking and shows hands and bodies where the host put them. It moves neither
 * players nor bodies, and buttons do nothing: place bodies by hh_world_place_bodies. A move ordered
 * by hh_body_move_kinematic waits for the next step of another kind. Cost: that of
 * hh_world_step without physics. */
HH_API hh_result hh_world_step_hands(hh_world* world, double dt_s, const hh_player_input* inputs,
                                     size_t input_count);

/* ---- Hands pull players through the host's solver ------------------------------------------- */

/* What a hand asks of the host's solver. The player is a body of the host's: a point mass at the
 * play space's origin that cannot turn: at hh_player_pose.origin until a recentring, which does not move
 * it. At the end of the step, with origin and body solved:
 *   POINT      origin + target.position = body * anchor.position
 *   WELD       the same, and the body's rotation is body_rotation
 *   DIRECTION  the body's rotation is body_rotation: the second of two hands on one body */
typedef enum hh_hand_rows {
    HH_ROWS_POINT = 0,
    HH_ROWS_WELD = 1,
    HH_ROWS_DIRECTION = 2,
    HH_HAND_ROWS_32_BITS = 0x7fffffff
} hh_hand_rows;
typedef struct hh_hand_constraint {
    hh_player player;
    hh_side side;
    hh_body body;
    hh_hand_rows rows;
    hh_pose anchor; /* the wrist in the body's frame */
    hh_pose target; /* the wrist at the end of the step: from the origin, with the world's axes */
    /* The target's velocity relative to the origin: the throwing velocity while a hand lets go,
     * else the mean over the step. */
    hh_vec3 velocity_mps;
    hh_vec3 angular_velocity_radps;
    hh_quat body_rotation;               /* in the world, at the end of the step; not for POINT */
    hh_vec3 body_angular_velocity_radps; /* reaches body_rotation; not for POINT */
    /* The anchor in the world at the end of the step, if the body keeps its velocity. Exact for
     * static and kinematic bodies: a joint may attach the player to this point of the world. */
    hh_pose anchor_end;
    double compliance_m_per_n; /* of the rows; 0: rigid, as in the runtime's own solver */
    double max_force_n; /* enough to stop what the hand drives from its highest speed in one step */
    uint8_t is_releasing;  /* the hand lets go in this step */
} hh_hand_constraint;

/* A player's body in the host's solver. */
typedef struct hh_player_motion {
    hh_player player;
    hh_vec3 origin;       /* at the start of the step */
    hh_vec3 velocity_mps; /* at the start of the step, with thrusters and drag applied */
    /* For this step. The player's own while a hand grips something static, kinematic or at least
     * phases.heavy_body_kg. Else 1000 times the heaviest held body, so that light bodies do not
     * shake the player; for bodies from phases.kappa_light_kg to phases.kappa_heavy_kg it falls to
     * the player's own. If a held body meets something that does not give way, such as a crate at a
     * wall, solve the step again with hh_player_def.mass_kg: the player then moves back by what the
     * body could not move. Without that, hand and wall press against each other without a bound. */
    double mass_kg;
    hh_pose head;         /* of the head's centre: from the origin, with the world's axes */
    double head_radius_m; /* the host may let this sphere collide, on the player's body */
} hh_player_motion;

typedef struct hh_solved_player {
    hh_player player;
    hh_vec3 origin;       /* at the end of the step */
    hh_vec3 velocity_mps; /* at the end of the step */
} hh_solved_player;

/* A velocity that the host gives its body. */
typedef struct hh_velocity_change {
    hh_body body;
    hh_vec3 velocity_mps;
    hh_vec3 angular_velocity_radps;
} hh_velocity_change;

/* First half of a step: tracking, grips and constraints. Bodies must be placed where they are.
 * Until hh_world_end_step, HH_ERROR_STATE for adding or removing bodies, joints and players, for
 * teleporting, saving and other steps; hh_world_restore forgets the begun step. */
HH_API hh_result hh_world_begin_step(hh_world* world, double dt_s, const hh_player_input* inputs,
                                     size_t input_count);
/* Constraints of the begun step: at most one per hand, in the order in which hands were added.
 * Valid until hh_world_end_step. */
HH_API hh_result hh_world_hand_constraints(const hh_world* world,
                                           const hh_hand_constraint** constraints, size_t* count);
/* One entry per player, in the order of hh_world_players. Valid until hh_world_end_step. */
HH_API hh_result hh_world_player_motions(const hh_world* world, const hh_player_motion** motions,
                                         size_t* count);
/* Second half, after the host's solver. `players`: the solved play spaces; one left out moves as
 * predicted, HH_ERROR_VALUE for one that is there twice. Bodies that the host has not placed since
 * hh_world_begin_step rest where they were. Releases grips, limits velocities and shows hands and
 * bodies. On an error the step stays begun. */
HH_API hh_result hh_world_end_step(hh_world* world, const hh_solved_player* players, size_t count);
/* Velocities that the host must give its bodies: after hh_world_begin_step those of bodies that the
 * distance grab pulls, after hh_world_end_step those of thrown and limited bodies. Players':
 * hh_player_velocity. Valid until the next step. */
HH_API hh_result hh_world_velocity_changes(const hh_world* world,
                                           const hh_velocity_change** changes, size_t* count);

/* ---- Bodies that hands hold are moved here -------------------------------------------------- */

/* After hh_world_step: dynamic bodies that hands hold, and those that joints connect to them. The
 * host makes its own kinematic, takes pose and velocity from here, and places all others before the
 * next step. They touch nothing of the host's, but push what its solver pushes. */
HH_API hh_result hh_world_held_bodies(const hh_world* world, hh_body* bodies, size_t capacity,
                                      size_t* count);

#ifdef __cplusplus
}
#endif

#endif
