#pragma once

// Axes and units of other engines in C++: handhold/convert.h with one name for each direction.
//
//   constexpr hh::EngineSpace unreal{HH_ENGINE_UNREAL};
//   sample.head = unreal.pose_from({{x_cm, y_cm, z_cm}, {qx, qy, qz, qw}});

#include <cstdint>
#include <span>

#include <handhold/convert.h>

namespace hh {

// Converts from an engine to Handhold (_from) and back (_to).
struct EngineSpace {
    // The other engine.
    hh_engine engine;

    // Metres in one unit of length.
    double metres_per_unit() const { return hh_convert_metres_per_unit(engine); }
    // Positions, velocities, impulses: whatever scales with length.
    hh_vec3 vector_from(hh_vec3 vector) const { return hh_convert_vector_from(engine, vector); }
    // The reverse of vector_from.
    hh_vec3 vector_to(hh_vec3 vector) const { return hh_convert_vector_to(engine, vector); }
    // Normals and axes.
    hh_vec3 direction_from(hh_vec3 v) const { return hh_convert_direction_from(engine, v); }
    // The reverse of direction_from.
    hh_vec3 direction_to(hh_vec3 v) const { return hh_convert_direction_to(engine, v); }
    // Angular velocities in rad/s.
    hh_vec3 angular_from(hh_vec3 v) const { return hh_convert_angular_from(engine, v); }
    // The reverse of angular_from.
    hh_vec3 angular_to(hh_vec3 v) const { return hh_convert_angular_to(engine, v); }
    // Unit quaternions.
    hh_quat rotation_from(hh_quat q) const { return hh_convert_rotation_from(engine, q); }
    // The reverse of rotation_from.
    hh_quat rotation_to(hh_quat q) const { return hh_convert_rotation_to(engine, q); }
    // A position and a rotation.
    hh_pose pose_from(hh_pose pose) const { return hh_convert_pose_from(engine, pose); }
    // The reverse of pose_from.
    hh_pose pose_to(hh_pose pose) const { return hh_convert_pose_to(engine, pose); }
    // Scale factors, and half extents in metres: axes change places, signs do not.
    hh_vec3 scale_from(hh_vec3 scale) const { return hh_convert_scale_from(engine, scale); }
    // The reverse of scale_from.
    hh_vec3 scale_to(hh_vec3 scale) const { return hh_convert_scale_to(engine, scale); }
    // A mesh in place: three floats for each vertex, three indices for each triangle.
    hh_result mesh_from(std::span<float> xyz, std::span<std::uint32_t> indices) const {
        return hh_convert_mesh_from(engine, xyz.data(), xyz.size(), indices.data(), indices.size());
    }
};

}  // namespace hh
