#ifndef HANDHOLD_CONVERT_H
#define HANDHOLD_CONVERT_H

#include <handhold/base.h>

/* Axes and units of other engines: docs/guide/in_your_engine.md.
 *
 * Functions _from take numbers of the engine and return Handhold's, functions _to the reverse. They
 * compute with any numbers and do not check them; an unknown engine counts as Godot. They cost
 * nanoseconds. Any thread. */

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hh_engine {
    HH_ENGINE_UNITY = 0,  /* left-handed, +X right, +Y up, +Z ahead, metres */
    HH_ENGINE_UNREAL = 1, /* left-handed, +X ahead, +Y right, +Z up, centimetres */
    HH_ENGINE_GODOT = 2,  /* as Handhold: right-handed, +X right, +Y up, -Z ahead, metres */
    HH_ENGINE_32_BITS = 0x7fffffff
} hh_engine;

/* Metres in one of the engine's units of length: 0.01 for Unreal, else 1. For radii and distances. */
HH_API double hh_convert_metres_per_unit(hh_engine engine);

/* Whatever scales with length: positions, velocities, accelerations, impulses, forces. */
HH_API hh_vec3 hh_convert_vector_from(hh_engine engine, hh_vec3 vector);
HH_API hh_vec3 hh_convert_vector_to(hh_engine engine, hh_vec3 vector);
/* Directions without a length: normals, axes. */
HH_API hh_vec3 hh_convert_direction_from(hh_engine engine, hh_vec3 direction);
HH_API hh_vec3 hh_convert_direction_to(hh_engine engine, hh_vec3 direction);
/* Angular velocities in rad/s, and other vectors along an axis of rotation. Left-handed engines
 * count angles the other way, so the sign changes too. */
HH_API hh_vec3 hh_convert_angular_from(hh_engine engine, hh_vec3 angular_radps);
HH_API hh_vec3 hh_convert_angular_to(hh_engine engine, hh_vec3 angular_radps);
HH_API hh_quat hh_convert_rotation_from(hh_engine engine, hh_quat rotation);
HH_API hh_quat hh_convert_rotation_to(hh_engine engine, hh_quat rotation);
HH_API hh_pose hh_convert_pose_from(hh_engine engine, hh_pose pose);
HH_API hh_pose hh_convert_pose_to(hh_engine engine, hh_pose pose);
/* Scale factors of an object along its own axes, and half extents in metres: axes change places,
 * signs do not. */
HH_API hh_vec3 hh_convert_scale_from(hh_engine engine, hh_vec3 scale);
HH_API hh_vec3 hh_convert_scale_to(hh_engine engine, hh_vec3 scale);

/* Converts a mesh in place: x, y, z of its vertices. Reverses its triangles if the engine's front
 * faces are clockwise (Unity, Godot), so that they are counter-clockwise from outside.
 * A mirrored object, of which the product of the scales is negative, needs nothing else: give its
 * scale, from hh_convert_scale_from, to hh_shape_add_mesh, which takes negative factors.
 * HH_ERROR_VALUE, and no change, for counts that are no multiples of 3. */
HH_API hh_result hh_convert_mesh_from(hh_engine engine, float* coordinates, size_t coordinate_count,
                                      uint32_t* indices, size_t index_count);

#ifdef __cplusplus
}
#endif

#endif
