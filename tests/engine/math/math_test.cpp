#include "engine/math/math.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/core/hash.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "tests/random.hpp"

namespace handhold::math_test {
namespace {

constexpr double k_above_pi = k_pi * (1.0 + 1e-15);  // pi plus the rounding of a vector's length
constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

rc::Gen<double> number_between(double low, double high) {
    return rc::gen::map(rc::gen::inRange<std::int64_t>(0, 1'000'000'001), [=](std::int64_t i) {
        return low + (high - low) * (static_cast<double>(i) * 1e-9);
    });
}

Vec3 any_vector(double size) {
    const double x = *number_between(-size, size);
    const double y = *number_between(-size, size);
    const double z = *number_between(-size, size);
    return {x, y, z};
}

Vec3 any_direction() {
    const Vec3 v = any_vector(1.0);
    RC_PRE(v.norm() > 1e-3);
    return v.normalized();
}

Quat any_rotation() { return rotation_about(any_direction(), *number_between(-k_pi, k_pi)); }

Pose any_pose() {
    const Vec3 position = any_vector(10.0);
    return {position, any_rotation()};
}

double angle_between(const Quat& a, const Quat& b) {
    return rotation_to_vector(a.conjugate() * b).norm();
}

RC_GTEST_PROP(Rotation, VectorRoundTripsBelowHalfTurn, ()) {
    const Vec3 vector = any_direction() * *number_between(0.0, k_pi - 1e-6);
    const Vec3 back = rotation_to_vector(rotation_from_vector(vector));
    RC_ASSERT((back - vector).norm() < 1e-9);
    RC_ASSERT(back.norm() <= k_above_pi);
}

RC_GTEST_PROP(Rotation, SmallVectorsRoundTripToRelativePrecision, ()) {
    const double size = std::pow(10.0, *number_between(-150.0, -3.0));
    const Vec3 vector = any_direction() * size;
    const Vec3 back = rotation_to_vector(rotation_from_vector(vector));
    RC_ASSERT((back - vector).norm() < 4e-15 * size);
}

RC_GTEST_PROP(Rotation, VectorNearHalfTurnRoundTripsUpToFullTurn, ()) {
    const Vec3 axis = any_direction();
    const double over = std::pow(10.0, *number_between(-17.0, -1.0));
    for (const double angle : {k_pi - over, k_pi + over}) {
        const Quat rotation = rotation_from_vector(axis * angle);
        const Vec3 back = rotation_to_vector(rotation);
        RC_ASSERT(back.norm() <= k_above_pi);
        const double off =
            std::min((back - axis * angle).norm(), (back - axis * (angle - 2.0 * k_pi)).norm());
        RC_ASSERT(off < 1e-14);
    }
}

RC_GTEST_PROP(Rotation, QuaternionRoundTripsUpToSign, ()) {
    const Quat rotation = any_rotation();
    const Quat back = rotation_from_vector(rotation_to_vector(rotation));
    const double off = std::min((back.coeffs() - rotation.coeffs()).norm(),
                                (back.coeffs() + rotation.coeffs()).norm());
    RC_ASSERT(off < 2e-15);
}

TEST(Rotation, ZeroVectorIsIdentity) {
    EXPECT_EQ(rotation_from_vector(Vec3::Zero()).coeffs(), Quat::Identity().coeffs());
    EXPECT_EQ(rotation_to_vector(Quat::Identity()), Vec3::Zero());
    EXPECT_EQ(rotation_to_vector(Quat(-1.0, 0.0, 0.0, 0.0)), Vec3::Zero());
}

TEST(Rotation, QuarterTurnAboutYMapsForwardToLeft) {
    const Vec3 turned = rotation_about(Vec3::UnitY(), 0.5 * k_pi) * -Vec3::UnitZ();
    EXPECT_LT((turned + Vec3::UnitX()).norm(), 1e-15);
}

RC_GTEST_PROP(Rotation, AboutAxisMatchesRodriguesFormula, ()) {
    const Vec3 axis = any_direction();
    const Vec3 v = any_vector(1.0);
    const double angle = *number_between(-10.0, 10.0);
    const Vec3 expected = v * std::cos(angle) + axis.cross(v) * std::sin(angle) +
                          axis * (axis.dot(v) * (1.0 - std::cos(angle)));
    RC_ASSERT((rotation_about(axis, angle) * v - expected).norm() < 5e-15);
}

RC_GTEST_PROP(RotationBetween, MapsFromToToByAngleBetweenThem, ()) {
    const Vec3 from = any_direction();
    const Vec3 to = any_direction();
    const Quat rotation = rotation_between(from, to);
    RC_ASSERT((rotation * from - to).norm() < 4e-15);
    RC_ASSERT(std::abs(rotation.norm() - 1.0) < 4e-16);
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    RC_ASSERT(std::abs(rotation_to_vector(rotation).norm() - angle) < 4e-15);
}

RC_GTEST_PROP(RotationBetween, AccurateForNearlyOppositeDirections, ()) {
    const Vec3 from = any_direction();
    const double off = std::pow(10.0, *number_between(-20.0, -1.0));
    const Vec3 to = (any_direction() * off - from).normalized();
    RC_ASSERT((rotation_between(from, to) * from - to).norm() < 2e-14);
}

TEST(RotationBetween, OppositeDirectionsGiveHalfTurn) {
    const std::vector<Vec3> directions = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(),
                                          Vec3(1, 1, 1).normalized(), Vec3(-3, 0, 4).normalized()};
    for (const Vec3& from : directions) {
        const Quat rotation = rotation_between(from, -from);
        EXPECT_LT((rotation * from + from).norm(), 1e-15);
        EXPECT_NEAR(rotation_to_vector(rotation).norm(), k_pi, 1e-15);
    }
}

TEST(RotationBetween, EqualDirectionsGiveIdentity) {
    const Vec3 direction = Vec3(1.0, -2.0, 0.5).normalized();
    EXPECT_LT(rotation_to_vector(rotation_between(direction, direction)).norm(), 1e-15);
}

RC_GTEST_PROP(LookRotation, LooksForwardWithUpInVerticalPlane, ()) {
    const Vec3 forward = any_direction();
    const Vec3 up = any_direction();
    const Quat turn = look_rotation(2.0 * forward, 3.0 * up);
    const double apart = forward.cross(up).norm();
    RC_PRE(apart > 1e-5);
    // The more parallel the two are, the less accurate the roll is.
    RC_ASSERT((turn * -Vec3::UnitZ() - forward).norm() < 1e-14 / apart);
    RC_ASSERT(std::abs((turn * Vec3::UnitX()).dot(up)) < 1e-14 / apart);
    RC_ASSERT((turn * Vec3::UnitY()).dot(up) > 0.0);
}

TEST(LookRotation, ValidIfUpIsParallelToForward) {
    for (const double up : {1.0, -1.0}) {
        const Quat turn = look_rotation(Vec3::UnitY(), Vec3(0.0, up, 0.0));
        EXPECT_NEAR(turn.norm(), 1.0, 1e-15);
        EXPECT_NEAR((turn * -Vec3::UnitZ() - Vec3::UnitY()).norm(), 0.0, 1e-15);
    }
}

RC_GTEST_PROP(TransformNormal, StaysPerpendicularAndOutward, ()) {
    const Vec3 a = any_direction();
    const Vec3 b = any_direction();
    RC_PRE(a.cross(b).norm() > 1e-2);
    Mat3 linear = rotation_about(any_direction(), 1.0).toRotationMatrix();
    linear.col(0) *= *number_between(-3.0, 3.0);
    linear.col(1) *= *number_between(0.1, 3.0);
    const Vec3 normal = transform_normal(linear, a.cross(b));
    RC_ASSERT(std::abs(normal.dot(linear * a)) < 1e-12);
    RC_ASSERT(std::abs(normal.dot(linear * b)) < 1e-12);
    const double side = linear.determinant() < 0.0 ? -1.0 : 1.0;
    RC_ASSERT((normal - side * (linear * a).cross(linear * b)).norm() < 1e-12);
}

RC_GTEST_PROP(PoseAlgebra, ProductAppliesRightFactorFirst, ()) {
    const Pose a = any_pose();
    const Pose b = any_pose();
    const Vec3 point = any_vector(10.0);
    RC_ASSERT(
        (transform_point(a * b, point) - transform_point(a, transform_point(b, point))).norm() <
        1e-13);
}

RC_GTEST_PROP(PoseAlgebra, InverseUndoesPose, ()) {
    const Pose a = any_pose();
    const Vec3 point = any_vector(10.0);
    RC_ASSERT((inverse_transform_point(a, transform_point(a, point)) - point).norm() < 1e-13);
    RC_ASSERT((transform_point(inverse(a), transform_point(a, point)) - point).norm() < 1e-13);
    const Pose identity = a * inverse(a);
    RC_ASSERT(identity.position.norm() < 1e-13);
    RC_ASSERT(rotation_to_vector(identity.rotation).norm() < 1e-14);
}

RC_GTEST_PROP(PoseAlgebra, CrossMatrixEqualsCrossProduct, ()) {
    const Vec3 v = any_vector(5.0);
    const Vec3 u = any_vector(5.0);
    RC_ASSERT((cross_matrix(v) * u - v.cross(u)).norm() < 1e-14);
}

TEST(PoseAlgebra, ValidPosesAreFiniteWithUnitRotation) {
    EXPECT_TRUE(is_valid(Pose{}));
    EXPECT_TRUE(is_valid({Vec3::Zero(), Quat(1.0005, 0.0, 0.0, 0.0)}));
    EXPECT_FALSE(is_valid({Vec3::Zero(), Quat(1.002, 0.0, 0.0, 0.0)}));
    EXPECT_FALSE(is_valid({Vec3::Zero(), Quat(0.0, 0.0, 0.0, 0.0)}));
    EXPECT_FALSE(is_valid({Vec3::Zero(), Quat(k_nan, 0.0, 0.0, 0.0)}));
    EXPECT_FALSE(is_valid({Vec3(0.0, k_infinity, 0.0), Quat::Identity()}));
    EXPECT_FALSE(is_valid({Vec3(k_nan, 0.0, 0.0), Quat::Identity()}));
    EXPECT_TRUE(is_finite(Vec3::Zero()));
    EXPECT_FALSE(is_finite(Vec3(0.0, 0.0, k_nan)));
}

RC_GTEST_PROP(Interpolate, EndsEqualPoses, ()) {
    const Pose a = any_pose();
    const Pose b = any_pose();
    const Pose first = interpolate(a, b, 0.0);
    const Pose last = interpolate(a, b, 1.0);
    RC_ASSERT(first.position == a.position);
    RC_ASSERT((last.position - b.position).norm() < 1e-14);
    RC_ASSERT(angle_between(first.rotation, a.rotation) < 2e-15);
    RC_ASSERT(angle_between(last.rotation, b.rotation) < 4e-15);
}

RC_GTEST_PROP(Interpolate, RotatesAtConstantSpeedAlongShorterArc, ()) {
    const Pose a = any_pose();
    const Pose b = any_pose();
    const double t = *number_between(0.0, 1.0);
    const double whole = angle_between(a.rotation, b.rotation);
    const Pose between = interpolate(a, b, t);
    RC_ASSERT(whole <= k_above_pi);
    RC_ASSERT(std::abs(angle_between(a.rotation, between.rotation) - t * whole) < 1e-14);
    RC_ASSERT(std::abs(angle_between(between.rotation, b.rotation) - (1.0 - t) * whole) < 1e-14);
    RC_ASSERT((between.position - ((1.0 - t) * a.position + t * b.position)).norm() < 1e-14);
}

TEST(Interpolate, NegatedQuaternionIsSamePose) {
    const Pose a;
    const Quat turn = rotation_about(Vec3::UnitY(), 0.4);
    const Pose b = {Vec3(2.0, 0.0, 0.0), Quat(-turn.w(), -turn.x(), -turn.y(), -turn.z())};
    const Pose half = interpolate(a, b, 0.5);
    EXPECT_EQ(half.position, Vec3(1.0, 0.0, 0.0));
    EXPECT_LT(angle_between(half.rotation, rotation_about(Vec3::UnitY(), 0.2)), 1e-15);
}

TEST(SmoothStep, RisesFromZeroToOneWithFlatEnds) {
    EXPECT_EQ(smooth_step(1.0, 2.0, 4.0), 0.0);
    EXPECT_EQ(smooth_step(2.0, 2.0, 4.0), 0.0);
    EXPECT_EQ(smooth_step(2.5, 2.0, 4.0), 0.15625);  // 3/16 - 2/64
    EXPECT_EQ(smooth_step(3.0, 2.0, 4.0), 0.5);
    EXPECT_EQ(smooth_step(4.0, 2.0, 4.0), 1.0);
    EXPECT_EQ(smooth_step(k_infinity, 2.0, 4.0), 1.0);
    EXPECT_NEAR(smooth_step(2.0 + 1e-6, 2.0, 4.0), 0.75e-12, 1e-17);  // 3 t^2
}

void add_to_hash(HashStream& hash, const Quat& rotation) {
    for (const double value : {rotation.w(), rotation.x(), rotation.y(), rotation.z()}) {
        hash.add(value);
    }
}

void add_to_hash(HashStream& hash, const Vec3& vector) {
    for (const double value : {vector.x(), vector.y(), vector.z()}) {
        hash.add(value);
    }
}

// Golden value: only checks that all compilers and optimisation levels give the same bits, not that
// they are right. Changing a formula changes it and every state hash.
TEST(MathGolden, BitsAreEqualOnAllCompilers) {
    constexpr std::uint64_t k_golden = 0x5c869c7a130c071dULL;
    HashStream hash;
    for (int i = -4000; i <= 4000; ++i) {
        const double x = 0.0625 * i + 1e-3 * (i % 7);
        double sine = 0.0;
        double cosine = 0.0;
        sin_cos(x, sine, cosine);
        hash.add(sine);
        hash.add(cosine);
        hash.add(arc_tangent2(sine - 0.3, 0.01 * x));
        const Vec3 vector(sine, 0.03 * x, cosine * sine);
        const Vec3 axis = vector.normalized();
        const Quat rotation = rotation_from_vector(vector);
        add_to_hash(hash, rotation);
        add_to_hash(hash, rotation_to_vector(rotation));
        add_to_hash(hash, rotation_about(axis, x));
        add_to_hash(hash, rotation_between(axis, rotation * axis));
        add_to_hash(hash, rotation_between(axis, rotation * -Vec3::UnitX()));
        const Pose a = {vector, rotation};
        const Pose b = a * inverse({axis, rotation_about(axis, 0.1 * x)});
        const Pose between = interpolate(a, b, 0.3);
        add_to_hash(hash, between.position);
        add_to_hash(hash, between.rotation);
        hash.add(smooth_step(x, -1.0, 2.0));
    }
    EXPECT_EQ(hash.value(), k_golden) << std::hex << "0x" << hash.value();
}

TEST(ShareOfLine, PointsAtShareOfAngle) {
    for (double angle = 0.0; std::cos(angle) > 0.95; angle += 0.003) {
        for (double share = 0.0; share <= 1.0; share += 0.01) {
            const double on_line = share_of_line(share, std::cos(angle));
            const double x = 1.0 + on_line * (std::cos(angle) - 1.0);
            const double y = on_line * std::sin(angle);
            ASSERT_NEAR(std::atan2(y, x), share * angle, 1e-4) << angle << ' ' << share;
        }
    }
}

TEST(AnyPerpendicular, IsUnitAndPerpendicular) {
    test::Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 axis = i < 3 ? Vec3(Vec3::Unit(i)) : random.direction();
        const Vec3 square = any_perpendicular(axis);
        ASSERT_NEAR(square.norm(), 1.0, 1e-12);
        ASSERT_NEAR(square.dot(axis), 0.0, 1e-12);
    }
}

}  // namespace
}  // namespace handhold::math_test
