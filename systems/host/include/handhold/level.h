#ifndef HANDHOLD_LEVEL_H
#define HANDHOLD_LEVEL_H

#include <handhold/base.h>

/* The level: shapes, bodies and joints. All may come and go between steps. */

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Shapes. Sizes in [1e-3, 1e4] m. A shape may be used by any number of bodies. ------------ */

/* In a world with fits_hands, a new shape gets a surface for hands on the calling thread; a shape equal to
 * one that is there costs microseconds. Costs are of one core at 2.1 GHz. Large round shapes cost more
 * than a frame: add them while loading. Box: 0.02 ms. */
HH_API hh_result hh_shape_add_box(hh_world* world, hh_vec3 half_extents_m, hh_shape* shape);
/* Cost with fits_hands: 2 ms at 0.1 m, growing with the radius to 18 ms at 1 m; none above 64 m. */
HH_API hh_result hh_shape_add_sphere(hh_world* world, double radius_m, hh_shape* shape);
/* Along Y; half_height_m without the caps. Cost: as a sphere. */
HH_API hh_result hh_shape_add_capsule(hh_world* world, double radius_m, double half_height_m,
                                      hh_shape* shape);
/* Along Y. Cost with fits_hands: 0.4 ms at 0.1 m. */
HH_API hh_result hh_shape_add_cylinder(hh_world* world, double radius_m, double half_height_m,
                                       hh_shape* shape);
/* Convex hull of points that are not coplanar. Cost with fits_hands: 1.6 ms for 64 points. */
HH_API hh_result hh_shape_add_hull(hh_world* world, const hh_vec3* points, size_t count,
                                   hh_shape* shape);

/* A part of a compound: any shape but a mesh or a compound. */
typedef struct hh_compound_part {
    hh_shape shape;
    hh_pose pose;   /* in the compound's frame */
    double mass_kg; /* give it for all parts, or 0 for all: the mass is then spread by volume */
} hh_compound_part;
/* 1 to 64 parts that move as one. It keeps copies: the parts may be removed. Cost with fits_hands: as
 * if all its parts were new shapes. */
HH_API hh_result hh_shape_add_compound(hh_world* world, const hh_compound_part* parts, size_t count,
                                       hh_shape* shape);

/* Triangles, prepared for collision and hands. Used by any number of worlds; immutable. */
typedef struct hh_mesh hh_mesh;
typedef struct hh_mesh_def {
    uint32_t struct_size;
    const float* positions; /* x, y, z of each vertex, metres */
    size_t vertex_count;
    size_t vertex_stride; /* bytes from one vertex to the next; 0: 12 */
    const uint32_t* indices;
    size_t index_count; /* a multiple of 3, at most 3 * 2^21 */
    uint8_t fits_hands;    /* default true; false: hands on it are shown as tracked */
} hh_mesh_def;
HH_API hh_result hh_default_mesh_def_sized(hh_mesh_def* filled, size_t size);
static inline hh_mesh_def hh_default_mesh_def(void) {
    hh_mesh_def filled;
    hh_default_mesh_def_sized(&filled, sizeof(filled));
    return filled;
}
/* Copies and prepares a mesh. Any thread, beside steps of any world: the place for the work of
 * streaming. Cost: up to 40 microseconds a triangle with fits_hands, 1 without. */
HH_API hh_result hh_mesh_create(const hh_mesh_def* def, hh_mesh** mesh);
/* Destroys the handle; shapes keep what they need of the mesh. Null: nothing happens. Any thread. */
HH_API void hh_mesh_destroy(hh_mesh* mesh);
/* A shape of a prepared mesh, for static and kinematic bodies. The size of each factor is in
 * [1e-3, 1e3], others get HH_ERROR_VALUE; negative ones mirror the mesh, whose triangles keep their
 * outer side. Cost: microseconds for scale 1; another scale prepares the hands' surface again, about
 * 40 microseconds a triangle with fits_hands. */
HH_API hh_result hh_shape_add_mesh(hh_world* world, const hh_mesh* mesh, hh_vec3 scale,
                                   hh_shape* shape);

/* HH_ERROR_STATE while a body or a player has the shape. */
HH_API hh_result hh_shape_remove(hh_world* world, hh_shape shape);
HH_API uint8_t hh_shape_is_valid(const hh_world* world, hh_shape shape);
/* Number of shapes. */
HH_API hh_result hh_world_shape_count(const hh_world* world, size_t* count);

/* ---- Bodies --------------------------------------------------------------------------------- */

typedef enum hh_body_kind {
    HH_STATIC = 0,    /* never moves, except by hh_body_teleport */
    HH_KINEMATIC = 1, /* moved by hh_body_move_kinematic; pushes others and carries hands */
    HH_DYNAMIC = 2,   /* moved by its velocity, contacts, joints and hands */
    HH_BODY_KIND_32_BITS = 0x7fffffff
} hh_body_kind;

/* A body's pose is that of its shape's own frame, as the host made it: the library finds centre of
 * mass and principal axes by itself. Velocities are those of the centre of mass, in the world. */
typedef struct hh_body_def {
    uint32_t struct_size;
    const char* name; /* unique in the world, identifies the body in hashes; null: by its id */
    hh_body_kind kind;
    hh_shape shape; /* null: touches nothing */
    hh_pose pose;
    hh_vec3 velocity_mps;         /* each within 1e6 */
    hh_vec3 angular_velocity_radps; /* each within 1e4 */
    double mass_kg;        /* dynamic: [1e-12, 1e15], default 1 */
    /* About the principal axes; 0: computed from the shape. A dynamic body without a shape needs
     * one: HH_ERROR_VALUE. */
    hh_vec3 inertia_kgm2;
    double restitution;    /* [0, 1] */
    double friction;       /* [0, 1e6], default 0.4 */
    double gravity_scale;  /* default 1; within 1000 */
    uint32_t layers, mask; /* two bodies touch if each one's layers meet the other's mask */
    uint8_t grab_left, grab_right; /* which hands may grip it; default both */
    uint8_t grab_two_hands;        /* only both hands of one player at once */
    int32_t grab_priority; /* of bodies in reach, hands take one of highest priority; default 0 */
    uint64_t user_data;    /* the host's; not part of the state */
} hh_body_def;
HH_API hh_result hh_default_body_def_sized(hh_body_def* filled, size_t size);
static inline hh_body_def hh_default_body_def(void) {
    hh_body_def filled;
    hh_default_body_def_sized(&filled, sizeof(filled));
    return filled;
}
/* Adds a body. Cost: constant, whatever else is in the world. */
HH_API hh_result hh_body_add(hh_world* world, const hh_body_def* def, hh_body* body);
/* Removes a body with its joints. Hands that grip it are empty at once; the event follows in the
 * next step. */
HH_API hh_result hh_body_remove(hh_world* world, hh_body body);
HH_API uint8_t hh_body_is_valid(const hh_world* world, hh_body body);
HH_API hh_result hh_body_find(const hh_world* world, const char* name, hh_body* body);
/* Valid until a body is added or removed. Empty if the name came only with a snapshot. */
HH_API hh_result hh_body_name(const hh_world* world, hh_body body, const char** name);
/* Ids of all bodies; `count` gets their number. HH_ERROR_CAPACITY if it is more than `capacity`.
 * A null buffer of capacity 0: the number only. */
HH_API hh_result hh_world_bodies(const hh_world* world, hh_body* bodies, size_t capacity,
                                 size_t* count);

HH_API hh_result hh_body_pose(const hh_world* world, hh_body body, hh_pose* pose);
/* Poses of many bodies in one call; HH_ERROR_HANDLE, and nothing written, if one is stale. */
HH_API hh_result hh_world_body_poses(const hh_world* world, const hh_body* bodies, size_t count,
                                     hh_pose* poses);
/* Null outputs are skipped. */
HH_API hh_result hh_body_velocity(const hh_world* world, hh_body body, hh_vec3* velocity_mps,
                                  hh_vec3* angular_velocity_radps);
/* Within 1e6 m/s and 1e4 rad/s. HH_ERROR_STATE for a body that is not dynamic. */
HH_API hh_result hh_body_set_velocity(hh_world* world, hh_body body, hh_vec3 velocity_mps,
                                      hh_vec3 angular_velocity_radps);
/* Changes the velocity by an impulse in N s at a point in the world. HH_ERROR_STATE for a body that
 * is not dynamic, HH_ERROR_VALUE if the velocity would leave the limits of hh_body_set_velocity. */
HH_API hh_result hh_body_apply_impulse(hh_world* world, hh_body body, hh_vec3 impulse_ns,
                                       hh_vec3 point);
/* Moves a body at once, without collisions on the path. It keeps its velocity; hands that grip it
 * let go. */
HH_API hh_result hh_body_teleport(hh_world* world, hh_body body, hh_pose pose);
/* A kinematic body reaches the pose at the end of the next step and then rests. Call it before every
 * step in which it moves, or less often: a host that ticks slower than it draws may tell each tick's
 * pose once. The body's velocity, with which hands leave it and bodies are thrown, is the displacement
 * since the pose before over the time since then; over tracking.release_window_s if the poses come at
 * varying times. It is 0 once a pose is due that does not come or is the same. The first pose after a
 * rest counts as half a second's motion, since nothing says when it began. */
HH_API hh_result hh_body_move_kinematic(hh_world* world, hh_body body, hh_pose pose);
HH_API hh_result hh_body_set_gravity_scale(hh_world* world, hh_body body, double scale);
HH_API hh_result hh_body_set_layers(hh_world* world, hh_body body, uint32_t layers, uint32_t mask);
HH_API hh_result hh_body_set_grab_rule(hh_world* world, hh_body body, uint8_t left, uint8_t right,
                                       uint8_t two_hands, int32_t priority);
HH_API hh_result hh_body_get_kind(const hh_world* world, hh_body body, hh_body_kind* kind);
/* 0 for a body that is not dynamic: nothing that acts on it moves it. */
HH_API hh_result hh_body_mass(const hh_world* world, hh_body body, double* mass_kg);
/* Mass in [1e-12, 1e15] kg and inertia as hh_body_def's, else HH_ERROR_VALUE; 0 inertia: of the solid
 * shape. Dynamic bodies only: HH_ERROR_STATE. Hands keep their grips: beyond phases.heavy_body_kg the
 * body moves its player from the next step on, below it comes along. */
HH_API hh_result hh_body_set_mass(hh_world* world, hh_body body, double mass_kg,
                                  hh_vec3 inertia_kgm2);
/* Friction in [0, 1e6], restitution in [0, 1]. Null outputs are skipped. */
HH_API hh_result hh_body_material(const hh_world* world, hh_body body, double* friction,
                                  double* restitution);
HH_API hh_result hh_body_set_material(hh_world* world, hh_body body, double friction,
                                      double restitution);
/* A body becomes static, kinematic or dynamic where it is. Hands keep their grips without a jump: a
 * body that becomes dynamic comes along, others move the player. A body that becomes static or
 * kinematic stops; one that becomes dynamic keeps its velocity. Joints stay. Mass and inertia: of a
 * body that becomes dynamic, as hh_body_set_mass; of others ignored. A mesh cannot become dynamic:
 * HH_ERROR_VALUE. HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. */
HH_API hh_result hh_body_set_kind(hh_world* world, hh_body body, hh_body_kind kind, double mass_kg,
                                  hh_vec3 inertia_kgm2);
/* Null for a body without a shape. */
HH_API hh_result hh_body_shape(const hh_world* world, hh_body body, hh_shape* shape);
/* The body touches with another shape from now on, or with none (null id). A dynamic body needs a
 * solid shape: HH_ERROR_VALUE for none or a mesh. The body's pose, joints and grips
 * stay as they are in the frame in which the host made the shapes, whatever their centres of mass; a
 * dynamic body's inertia becomes that of the solid shape with the same mass. Hands let go in the next
 * step (HH_EVENT_RELEASED, HH_REASON_BY_HOST) if the body has no shape any more, or if their palm is
 * farther from the new surface than a closing hand reaches: hand.ray_length_m minus hand.ray_back_m,
 * or hand.reach_m if that is larger.
 * HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. Cost: microseconds; with a mesh
 * that a hand grips, linear in its triangles, 0.1 ms for 5,000. */
HH_API hh_result hh_body_set_shape(hh_world* world, hh_body body, hh_shape shape);
HH_API hh_result hh_body_set_user_data(hh_world* world, hh_body body, uint64_t user_data);
HH_API hh_result hh_body_user_data(const hh_world* world, hh_body body, uint64_t* user_data);

/* Adds a level from the bytes of a glTF file (.glb, or .gltf with its data inside): a static body
 * with a mesh for each node that has triangles, where the file has them, moved by `pose`. Its name is
 * the node's, with a number if the world has that name. `bodies` may be null; `count` gets their
 * number. HH_ERROR_CAPACITY and HH_ERROR_DATA, which says what the file lacks: nothing is added.
 * Cost: that of hh_mesh_create for every triangle. */
HH_API hh_result hh_world_add_gltf_level(hh_world* world, const void* gltf, size_t size,
                                         hh_pose pose, hh_body* bodies, size_t capacity,
                                         size_t* count);

/* ---- Joints --------------------------------------------------------------------------------- */

/* Each kind has a coordinate, on which limits, friction, detents and latches act. */
typedef enum hh_joint_kind {
    HH_BALL = 0,    /* points coincide; coordinate: angle between the axes, rad; limits: a cone */
    HH_HINGE = 1,   /* turns about the axis; coordinate: angle, rad */
    HH_SLIDER = 2,  /* moves along the axis; coordinate: displacement, m */
    HH_FIXED = 3,   /* no coordinate */
    HH_DISTANCE = 4, /* coordinate: distance of two points, m; lower 0: a rope; equal limits: a rod */
    HH_JOINT_KIND_32_BITS = 0x7fffffff
} hh_joint_kind;

typedef struct hh_joint_def {
    uint32_t struct_size;
    const char* name; /* unique in the world; null: by its id */
    hh_joint_kind kind;
    hh_body body_a; /* null: the world */
    hh_body body_b;
    hh_pose frame; /* in the world, with the bodies where they are now: x is the joint's axis */
    /* HH_DISTANCE: the point on body_b, in the world; the point on body_a is frame's. */
    hh_vec3 point_b;
    uint8_t collides; /* the two bodies touch each other; default false */
    uint8_t limited;  /* lower and upper apply; distance joints are always limited */
    double lower, upper;
    double friction;         /* N, or N m about a hinge or any axis of a ball; >= 0 */
    double detent_spacing;   /* a rest position at each multiple; 0: none */
    double detent_strength;  /* force towards the nearest rest position, N or N m */
    double latch_at;         /* the latch locks the coordinate at this */
    double latch_range;      /* the latch closes within this distance; 0: no latch */
    double latch_strength;   /* the latch opens above this force, N or N m; 0: never by force */
    hh_joint latch_handle;   /* a joint that opens it; null: none */
    double latch_handle_at;  /* open while |handle's coordinate| is at least this */
} hh_joint_def;
HH_API hh_result hh_default_joint_def_sized(hh_joint_def* filled, size_t size);
static inline hh_joint_def hh_default_joint_def(void) {
    hh_joint_def filled;
    hh_default_joint_def_sized(&filled, sizeof(filled));
    return filled;
}
HH_API hh_result hh_joint_add(hh_world* world, const hh_joint_def* def, hh_joint* joint);
HH_API hh_result hh_joint_remove(hh_world* world, hh_joint joint);
HH_API uint8_t hh_joint_is_valid(const hh_world* world, hh_joint joint);
/* Ids of the joints of a body; `count` gets their number. HH_ERROR_CAPACITY if it is more than
 * `capacity`. A null buffer of capacity 0: the number only. */
HH_API hh_result hh_body_joints(const hh_world* world, hh_body body, hh_joint* joints,
                                size_t capacity, size_t* count);
typedef enum hh_motor_kind {
    HH_MOTOR_NONE = 0,
    HH_MOTOR_SPEED = 1,    /* towards a speed of the coordinate */
    HH_MOTOR_POSITION = 2, /* towards a coordinate */
    HH_MOTOR_KIND_32_BITS = 0x7fffffff
} hh_motor_kind;
typedef struct hh_motor_def {
    uint32_t struct_size;
    hh_motor_kind kind; /* default HH_MOTOR_NONE */
    double speed;       /* HH_MOTOR_SPEED: rad/s or m/s, within 1e9 */
    double position;    /* HH_MOTOR_POSITION: rad or m, within 1e9; a hinge counts full turns */
    /* HH_MOTOR_POSITION: the joint moves so fast that it would be there after this; a step at least,
     * 1e9 at most, s; default 0.1 */
    double time_s;
    double strength; /* largest force, N or N m, [0, 1e15]; default 0 */
} hh_motor_def;
HH_API hh_result hh_default_motor_def_sized(hh_motor_def* filled, size_t size);
static inline hh_motor_def hh_default_motor_def(void) {
    hh_motor_def filled;
    hh_default_motor_def_sized(&filled, sizeof(filled));
    return filled;
}
/* Drives a hinge or slider from the next step on, with a limited force, as friction acts; replaces
 * its detents. A position's target moves a stiff drive: a load below the strength does not deflect
 * it. Part of the state. HH_ERROR_VALUE for other kinds of joints. Cost: that of a joint with
 * friction. */
HH_API hh_result hh_joint_set_motor(hh_world* world, hh_joint joint, const hh_motor_def* def);
/* New limits of the coordinate, as in hh_joint_def; equal ones lock the joint there. A joint beyond
 * them is moved within. Bodies move at once: hands that held on may slip. */
HH_API hh_result hh_joint_set_limits(hh_world* world, hh_joint joint, uint8_t limited, double lower,
                                     double upper);
/* A new latch, as in hh_joint_def; range 0: none. The handle stays. A closed latch stays closed if
 * it is at the same place. */
HH_API hh_result hh_joint_set_latch(hh_world* world, hh_joint joint, double at, double range,
                                    double strength);
HH_API hh_result hh_joint_set_friction(hh_world* world, hh_joint joint, double friction);
/* State after the last step; null outputs are skipped. A hinge counts full turns. */
HH_API hh_result hh_joint_state(const hh_world* world, hh_joint joint, double* coordinate,
                                double* speed, uint8_t* latched);

/* ---- Contacts ------------------------------------------------------------------------------- */

/* Two surfaces that touched in the last step. Whichever of body and player is not null it is: a
 * player's head, or a body. */
typedef struct hh_contact {
    hh_body body_a, body_b;
    hh_player player_a, player_b;
    hh_vec3 point;     /* on the surface of a, in the world */
    hh_vec3 normal;    /* unit, from b to a */
    double depth_m;    /* how deep they overlap; negative: apart */
    double impulse_ns; /* that the step applied, >= 0 */
} hh_contact;
/* The contacts of the last step, in a fixed order: pairs that have come within 0.1 mm, or between
 * which an impulse acted. Empty after a restore and after hh_world_step_simulated. `count` gets
 * their number; HH_ERROR_CAPACITY if it is more than `capacity`. */
HH_API hh_result hh_world_contacts(const hh_world* world, hh_contact* contacts, size_t capacity,
                                   size_t* count);

/* ---- Queries -------------------------------------------------------------------------------- */

/* Queries test the shapes of all bodies, whatever their layers, and the tracked heads of players,
 * at their present poses. Bodies without a shape, and surfaces of hh_world_set_surface_query, are
 * not found. HH_ERROR_STATE between hh_world_begin_step and hh_world_end_step. Cost: microseconds;
 * the first query after a change of the world also compares every body with its place before. */
typedef struct hh_hit {
    hh_body body;      /* null: a player's head, or nothing was found */
    hh_player player;  /* whose head; null: a body, or nothing was found */
    hh_vec3 point;     /* on the surface, in the world */
    hh_vec3 normal;    /* unit, to the side that the query came from */
    double distance_m; /* see each query */
} hh_hit;
/* First surface that the segment hits, from outside or inside; distance_m: from `from`. `skip`: a
 * player whose head counts as not there; null: none. Coordinates within 1e9 m. */
HH_API hh_result hh_world_cast_ray(hh_world* world, hh_vec3 from, hh_vec3 to, hh_player skip,
                                   hh_hit* hit);
/* First impact of a sphere that moves along the segment. Radius in [1e-6, 1e4] m; distance_m: how far
 * its centre has moved, 0 if it touches something at the start. */
HH_API hh_result hh_world_cast_sphere(hh_world* world, double radius_m, hh_vec3 from, hh_vec3 to,
                                      hh_player skip, hh_hit* hit);
/* Nearest surface point within max_distance_m of the point, [0, 1e4]; distance_m: 0 inside a solid,
 * where the normal points outward. */
HH_API hh_result hh_world_closest_point(hh_world* world, hh_vec3 point, double max_distance_m,
                                        hh_player skip, hh_hit* hit);
/* Everything that a sphere touches: the nearest point of each body and head to its centre, in a
 * fixed order. Inside a solid distance_m is 0 and the normal points outward. `count` gets their
 * number; HH_ERROR_CAPACITY if it is more than `capacity`. Radius in [0, 1e4] m. */
HH_API hh_result hh_world_overlap_sphere(hh_world* world, hh_vec3 center, double radius_m,
                                         hh_player skip, hh_hit* hits, size_t capacity,
                                         size_t* count);

#ifdef __cplusplus
}
#endif

#endif
