// handhold/math.hpp against the library's own mathematics: equal to the bit.
#include "engine/math/math.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <handhold/math.hpp>
#include <rapidcheck/gtest.h>

#include "systems/host/host_columns.hpp"

namespace handhold::host_math_test {
namespace {

double number(double limit) {
    return *rc::gen::map(
        rc::gen::inRange<std::int64_t>(-(1LL << 52), 1LL << 52),
        [limit](std::int64_t i) { return limit * static_cast<double>(i) * 0x1p-52; });
}
Vec3 vector(double limit) {
    const double x = number(limit);
    const double y = number(limit);
    return {x, y, number(limit)};
}
Quat rotation() {
    const Vec3 v = vector(1.0);
    const Quat q(number(1.0), v.x(), v.y(), v.z());
    RC_PRE(q.norm() > 1e-3);
    return q.normalized();
}
Pose pose() {
    const Vec3 position = vector(100.0);
    return {position, rotation()};
}

bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same(const Vec3& a, hh_vec3 b) {
    return same(a.x(), b.x) && same(a.y(), b.y) && same(a.z(), b.z);
}
bool same(const Quat& a, hh_quat b) {
    return same(Vec3(a.vec()), {b.x, b.y, b.z}) && same(a.w(), b.w);
}
bool same(const Pose& a, const hh_pose& b) {
    return same(a.position, b.position) && same(a.rotation, b.rotation);
}

RC_GTEST_PROP(HostMath, VectorsEqualTheLibrarysToTheBit, ()) {
    const Vec3 a = vector(10.0);
    const Vec3 b = vector(0.1);
    const double s = number(3.0);
    const hh_vec3 p = to_host(a);
    const hh_vec3 q = to_host(b);
    RC_ASSERT(same(a + s * b, p + s * q));
    RC_ASSERT(same(a - b, p - q));
    RC_ASSERT(same(-a, -p));
    RC_ASSERT(same(a.dot(b), hh::dot(p, q)));
    RC_ASSERT(same(a.cross(b), hh::cross(p, q)));
    RC_ASSERT(same(a.norm(), hh::length(p)));
    RC_ASSERT(same(a.normalized(), hh::normalized(p)));
}

RC_GTEST_PROP(HostMath, RotationsAndPosesEqualTheLibrarysToTheBit, ()) {
    const Pose a = pose();
    const Pose b = pose();
    const Vec3 v = vector(10.0);
    const double t = std::abs(number(1.0));
    const hh_pose p = to_host(a);
    const hh_pose q = to_host(b);
    RC_ASSERT(same(a.rotation * b.rotation, p.rotation * q.rotation));
    RC_ASSERT(same(a.rotation * v, p.rotation * to_host(v)));
    RC_ASSERT(same(a.rotation.conjugate(), hh::conjugate(p.rotation)));
    RC_ASSERT(same(Quat(2.0 * a.rotation.coeffs()).normalized(),
                   hh::normalized(to_host(Quat(2.0 * a.rotation.coeffs())))));
    RC_ASSERT(same(a * b, p * q));
    RC_ASSERT(same(inverse(a), hh::inverse(p)));
    RC_ASSERT(same(transform_point(a, v), hh::transform_point(p, to_host(v))));
    RC_ASSERT(same(inverse_transform_point(a, v), hh::inverse_transform_point(p, to_host(v))));
    RC_ASSERT(same(interpolate(a, b, t), hh::interpolate(p, q, t)));
}

RC_GTEST_PROP(HostMath, MadeRotationsEqualTheLibrarysToTheBit, ()) {
    const Vec3 v = vector(4.0);
    const Vec3 axis = v.normalized();
    const double angle = number(7.0);
    RC_ASSERT(same(sine(angle), hh::sine(angle)));
    RC_ASSERT(same(rotation_about(axis, angle), hh::rotation_about(to_host(axis), angle)));
    RC_ASSERT(same(rotation_from_vector(v), hh::rotation_from_vector(to_host(v))));
    const Quat q = rotation();
    RC_ASSERT(same(rotation_to_vector(q), hh::rotation_to_vector(to_host(q))));
    const Mat3 axes = q.toRotationMatrix();
    RC_ASSERT(same(
        Quat(axes).normalized(),
        hh::normalized(hh::rotation_from_axes(
            to_host(Vec3(axes.col(0))), to_host(Vec3(axes.col(1))), to_host(Vec3(axes.col(2)))))));
    const Vec3 other = rotation() * axis;
    RC_ASSERT(
        same(rotation_between(axis, other), hh::rotation_between(to_host(axis), to_host(other))));
    RC_ASSERT(same(rotation_between(axis, -axis),
                   hh::rotation_between(to_host(axis), to_host(Vec3(-axis)))));
    const Vec3 up = vector(1.0);
    RC_PRE(up.norm() > 1e-3 && v.norm() > 1e-3);
    RC_ASSERT(same(look_rotation(v, up), hh::look_rotation(to_host(v), to_host(up))));
}

TEST(HostMath, SpecialCases) {
    EXPECT_TRUE(hh::normalized(hh_vec3{}) == hh_vec3{});
    EXPECT_TRUE(same(Quat::Identity(), hh::rotation_from_vector({})));
    EXPECT_TRUE(
        same(look_rotation(Vec3::UnitY(), Vec3::UnitY()), hh::look_rotation(hh::k_y, hh::k_y)));
    hh_pose pose = hh_identity_pose();
    EXPECT_TRUE(hh::is_valid(pose));
    pose.rotation.w = 1.01;
    EXPECT_FALSE(hh::is_valid(pose));
    pose = hh_identity_pose();
    pose.position.y = std::nan("");
    EXPECT_FALSE(hh::is_valid(pose));
}

}  // namespace
}  // namespace handhold::host_math_test
