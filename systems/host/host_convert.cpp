// Axes and units of other engines (handhold/convert.h).
//
// An engine's vector v is M v * metres_per_unit here, with an orthogonal M of which each row picks
// one axis with a sign. Rotations: M R M^T turns about det(M) M a if R turns about a by the same
// angle, so axial vectors and a quaternion's vector part get the factor det(M).
#include <array>
#include <cstddef>
#include <utility>

#include <handhold/convert.h>

#include "systems/host/host_call.hpp"

namespace handhold {
namespace {

struct Axis {
    int index;    // index of the engine's axis that lies along ours
    double sign;  // -1: the engine's axis points the other way
};

struct EngineAxes {
    std::array<Axis, 3> axes;  // rows of M
    double determinant;        // determinant of M; -1 for left-handed engines
    double metres_per_unit;
    double units_per_metre;
    bool is_clockwise;  // front faces are clockwise from outside
};

constexpr EngineAxes k_unity{{{{0, 1.0}, {1, 1.0}, {2, -1.0}}}, -1.0, 1.0, 1.0, true};
constexpr EngineAxes k_unreal{{{{1, 1.0}, {2, 1.0}, {0, -1.0}}}, -1.0, 0.01, 100.0, false};
constexpr EngineAxes k_godot{{{{0, 1.0}, {1, 1.0}, {2, 1.0}}}, 1.0, 1.0, 1.0, true};

const EngineAxes& engine_axes(hh_engine engine) {
    return engine == HH_ENGINE_UNITY ? k_unity : engine == HH_ENGINE_UNREAL ? k_unreal : k_godot;
}

using Numbers = std::array<double, 3>;

// factor * M v
hh_vec3 rotated(const EngineAxes& engine, const hh_vec3& v, double factor) {
    const Numbers given{v.x, v.y, v.z};
    Numbers made{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Axis& axis = engine.axes[i];
        made[i] = factor * axis.sign * given[static_cast<std::size_t>(axis.index)];
    }
    return {made[0], made[1], made[2]};
}

// factor * M^T v
hh_vec3 rotated_back(const EngineAxes& engine, const hh_vec3& v, double factor) {
    const Numbers given{v.x, v.y, v.z};
    Numbers made{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Axis& axis = engine.axes[i];
        made[static_cast<std::size_t>(axis.index)] = factor * axis.sign * given[i];
    }
    return {made[0], made[1], made[2]};
}

}  // namespace
}  // namespace handhold

using handhold::engine_axes;
using handhold::rotated;
using handhold::rotated_back;

double hh_convert_metres_per_unit(hh_engine engine) { return engine_axes(engine).metres_per_unit; }

hh_vec3 hh_convert_vector_from(hh_engine engine, hh_vec3 vector) {
    return rotated(engine_axes(engine), vector, engine_axes(engine).metres_per_unit);
}

hh_vec3 hh_convert_vector_to(hh_engine engine, hh_vec3 vector) {
    return rotated_back(engine_axes(engine), vector, engine_axes(engine).units_per_metre);
}

hh_vec3 hh_convert_direction_from(hh_engine engine, hh_vec3 direction) {
    return rotated(engine_axes(engine), direction, 1.0);
}

hh_vec3 hh_convert_direction_to(hh_engine engine, hh_vec3 direction) {
    return rotated_back(engine_axes(engine), direction, 1.0);
}

hh_vec3 hh_convert_angular_from(hh_engine engine, hh_vec3 angular_radps) {
    return rotated(engine_axes(engine), angular_radps, engine_axes(engine).determinant);
}

hh_vec3 hh_convert_angular_to(hh_engine engine, hh_vec3 angular_radps) {
    return rotated_back(engine_axes(engine), angular_radps, engine_axes(engine).determinant);
}

hh_quat hh_convert_rotation_from(hh_engine engine, hh_quat rotation) {
    const hh_vec3 v = hh_convert_angular_from(engine, {rotation.x, rotation.y, rotation.z});
    return {v.x, v.y, v.z, rotation.w};
}

hh_quat hh_convert_rotation_to(hh_engine engine, hh_quat rotation) {
    const hh_vec3 v = hh_convert_angular_to(engine, {rotation.x, rotation.y, rotation.z});
    return {v.x, v.y, v.z, rotation.w};
}

hh_pose hh_convert_pose_from(hh_engine engine, hh_pose pose) {
    return {hh_convert_vector_from(engine, pose.position),
            hh_convert_rotation_from(engine, pose.rotation)};
}

hh_pose hh_convert_pose_to(hh_engine engine, hh_pose pose) {
    return {hh_convert_vector_to(engine, pose.position),
            hh_convert_rotation_to(engine, pose.rotation)};
}

hh_vec3 hh_convert_scale_from(hh_engine engine, hh_vec3 scale) {
    handhold::EngineAxes unsigned_axes = engine_axes(engine);
    for (handhold::Axis& axis : unsigned_axes.axes) {
        axis.sign = 1.0;
    }
    return rotated(unsigned_axes, scale, 1.0);
}

hh_vec3 hh_convert_scale_to(hh_engine engine, hh_vec3 scale) {
    handhold::EngineAxes unsigned_axes = engine_axes(engine);
    for (handhold::Axis& axis : unsigned_axes.axes) {
        axis.sign = 1.0;
    }
    return rotated_back(unsigned_axes, scale, 1.0);
}

hh_result hh_convert_mesh_from(hh_engine engine, float* coordinates, size_t coordinate_count,
                               uint32_t* indices, size_t index_count) {
    return handhold::call([&] {
        handhold::require(coordinates != nullptr || coordinate_count == 0, HH_ERROR_NULL,
                          "the coordinates are null");
        handhold::require(indices != nullptr || index_count == 0, HH_ERROR_NULL,
                          "the indices are null");
        handhold::require(coordinate_count % 3 == 0 && index_count % 3 == 0, HH_ERROR_VALUE,
                          "the number of coordinates or indices is no multiple of 3");
        for (std::size_t i = 0; i < coordinate_count; i += 3) {
            float* const xyz = coordinates + i;
            const hh_vec3 given{static_cast<double>(xyz[0]), static_cast<double>(xyz[1]),
                                static_cast<double>(xyz[2])};
            const hh_vec3 made = hh_convert_vector_from(engine, given);
            xyz[0] = static_cast<float>(made.x);
            xyz[1] = static_cast<float>(made.y);
            xyz[2] = static_cast<float>(made.z);
        }
        for (std::size_t i = 0; engine_axes(engine).is_clockwise && i < index_count; i += 3) {
            std::swap(indices[i + 1], indices[i + 2]);
        }
    });
}
