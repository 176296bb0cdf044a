// Conversions between engines (handhold/convert.h). Known poses are those of the engines' own
// documentation; Unreal's quaternions are also compared with the formula of its OpenXR plugin, (-z,
// x, y, -w).
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/convert.hpp>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "engine/math/math.hpp"

namespace handhold {
namespace {

constexpr hh::EngineSpace k_unity{HH_ENGINE_UNITY};
constexpr hh::EngineSpace k_unreal{HH_ENGINE_UNREAL};
constexpr hh::EngineSpace k_godot{HH_ENGINE_GODOT};
constexpr hh::EngineSpace k_engines[] = {k_unity, k_unreal, k_godot};
const double k_half = std::sqrt(0.5);

Vec3 vec(const hh_vec3& v) { return {v.x, v.y, v.z}; }
hh_vec3 c_vec(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Quat quat(const hh_quat& q) { return Quat(q.w, q.x, q.y, q.z); }
hh_quat c_quat(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }

void expect_near(const Vec3& a, const Vec3& b) { EXPECT_LT((a - b).norm(), 1e-12) << a << b; }

Vec3 any_vector() {
    const auto number = [] { return *rc::gen::inRange(-1000, 1001) / 100.0; };
    return {number(), number(), number()};
}
Quat any_rotation() {
    const auto number = [] { return *rc::gen::inRange(-100, 101) / 100.0; };
    const Quat made(1.01 + number(), number(), number(), number());
    return made.normalized();
}

TEST(EngineAxes, UnityLooksAlongZ) {
    expect_near(vec(k_unity.vector_from({1.0, 2.0, 3.0})), {1.0, 2.0, -3.0});
    // Quaternion.Euler(0, 90, 0) turns a view from ahead to the right.
    const Quat right = quat(k_unity.rotation_from({0.0, k_half, 0.0, k_half}));
    expect_near(right * Vec3(0.0, 0.0, -1.0), {1.0, 0.0, 0.0});
    // Quaternion.Euler(90, 0, 0) turns a view from ahead down.
    const Quat down = quat(k_unity.rotation_from({k_half, 0.0, 0.0, k_half}));
    expect_near(down * Vec3(0.0, 0.0, -1.0), {0.0, -1.0, 0.0});
}

TEST(EngineAxes, UnrealLooksAlongXInCentimetres) {
    // 100 cm ahead, 200 cm to the right, 300 cm up.
    expect_near(vec(k_unreal.vector_from({100.0, 200.0, 300.0})), {2.0, 3.0, -1.0});
    expect_near(vec(k_unreal.direction_from({1.0, 0.0, 0.0})), {0.0, 0.0, -1.0});
    // A yaw of 90 degrees turns a view from ahead to the right.
    const Quat right = quat(k_unreal.rotation_from({0.0, 0.0, k_half, k_half}));
    expect_near(right * Vec3(0.0, 0.0, -1.0), {1.0, 0.0, 0.0});
    EXPECT_EQ(k_unreal.metres_per_unit(), 0.01);
    expect_near(vec(k_unreal.scale_from({1.0, 2.0, 3.0})), {2.0, 3.0, 1.0});
}

TEST(EngineAxes, GodotsAreOurs) {
    expect_near(vec(k_godot.vector_from({1.0, 2.0, 3.0})), {1.0, 2.0, 3.0});
    expect_near(vec(k_godot.angular_from({1.0, 2.0, 3.0})), {1.0, 2.0, 3.0});
}

TEST(EngineAxes, FrontFacesPointOutwards) {
    // Triangles that each engine shows to somebody who stands at our +Z side of them. Unity:
    // the manual's page of Mesh; Unreal: UKismetProceduralMeshLibrary::GenerateBoxMesh; Godot:
    // the class reference of ArrayMesh.
    std::vector<float> unity{0, 0, 0, 0, 1, 0, 1, 0, 0};       // clockwise for a view along +Z
    std::vector<float> unreal{0, 0, 0, 0, 100, 0, 0, 0, 100};  // counter-clockwise along +X
    std::vector<float> godot{0, 0, 0, 0, 1, 0, 1, 0, 0};       // clockwise for a view along -Z
    std::vector<float>* const meshes[] = {&unity, &unreal, &godot};
    for (std::size_t i = 0; i < 3; ++i) {
        std::vector<std::uint32_t> indices{0, 1, 2};
        std::vector<float>& xyz = *meshes[i];
        ASSERT_EQ(k_engines[i].mesh_from(xyz, indices), HH_OK);
        const auto corner = [&](std::size_t n) {
            const Eigen::Vector3f read = Eigen::Map<Eigen::Vector3f>(&xyz[3 * indices[n]]);
            return Vec3(read.cast<double>());
        };
        expect_near((corner(1) - corner(0)).cross(corner(2) - corner(0)), {0.0, 0.0, 1.0});
    }
}

TEST(EngineAxes, WrongMeshesAreRefusedUnchanged) {
    float xyz[] = {1.0F, 2.0F, 3.0F};
    std::uint32_t indices[] = {0, 0};
    EXPECT_EQ(hh_convert_mesh_from(HH_ENGINE_UNITY, xyz, 3, indices, 2), HH_ERROR_VALUE);
    EXPECT_EQ(hh_convert_mesh_from(HH_ENGINE_UNITY, xyz, 2, indices, 0), HH_ERROR_VALUE);
    EXPECT_EQ(hh_convert_mesh_from(HH_ENGINE_UNITY, nullptr, 3, indices, 0), HH_ERROR_NULL);
    EXPECT_EQ(xyz[2], 3.0F);
}

RC_GTEST_PROP(EngineAxes, UnrealsQuaternionsAreThoseOfItsOpenXrPlugin, ()) {
    const hh_quat ours = c_quat(any_rotation());
    const Quat made = quat(k_unreal.rotation_to(ours));
    const Quat plugin(-ours.w, -ours.z, ours.x, ours.y);
    RC_ASSERT(std::abs(std::abs(made.dot(plugin)) - 1.0) < 1e-12);
}

RC_GTEST_PROP(EngineAxes, RoundTripsReturnWhatWasGiven, ()) {
    const hh::EngineSpace engine = k_engines[*rc::gen::inRange(0, 3)];
    const Vec3 v = any_vector();
    const Quat q = any_rotation();
    RC_ASSERT((vec(engine.vector_to(engine.vector_from(c_vec(v)))) - v).norm() < 1e-12);
    RC_ASSERT(vec(engine.direction_to(engine.direction_from(c_vec(v)))) == v);
    RC_ASSERT(vec(engine.angular_to(engine.angular_from(c_vec(v)))) == v);
    RC_ASSERT(vec(engine.scale_to(engine.scale_from(c_vec(v)))) == v);
    const hh_pose pose = engine.pose_to(engine.pose_from({c_vec(v), c_quat(q)}));
    RC_ASSERT((vec(pose.position) - v).norm() < 1e-12);
    RC_ASSERT(quat(pose.rotation).coeffs() == q.coeffs());
}

RC_GTEST_PROP(EngineAxes, RotatingAndConvertingCommute, ()) {
    const hh::EngineSpace engine = k_engines[*rc::gen::inRange(0, 3)];
    const Vec3 v = any_vector();
    const Quat q = any_rotation();
    const Vec3 converted_last = vec(engine.vector_from(c_vec(q * v)));
    const Vec3 converted_first =
        quat(engine.rotation_from(c_quat(q))) * vec(engine.vector_from(c_vec(v)));
    RC_ASSERT((converted_last - converted_first).norm() < 1e-12);
}

RC_GTEST_PROP(EngineAxes, VelocityOfARotatingPointCommutes, ()) {
    // omega x r, with the cross product that every engine computes from components.
    const hh::EngineSpace engine = k_engines[*rc::gen::inRange(0, 3)];
    const Vec3 omega = any_vector();
    const Vec3 r = any_vector();
    const Vec3 converted_last = vec(engine.vector_from(c_vec(omega.cross(r))));
    const Vec3 converted_first =
        vec(engine.angular_from(c_vec(omega))).cross(vec(engine.vector_from(c_vec(r))));
    RC_ASSERT((converted_last - converted_first).norm() < 1e-10);
}

}  // namespace
}  // namespace handhold
