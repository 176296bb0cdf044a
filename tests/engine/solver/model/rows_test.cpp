#include "engine/solver/model/rows.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/engine/solver/scene.hpp"

namespace handhold::solver_rows_test {
namespace {

using test::Random;

constexpr std::array k_all_kinds = {RowKind::drive_point, RowKind::drive_weld,
                                    RowKind::drive_direction, RowKind::contact};

std::vector<SolverBody> two_random_bodies(Random& random) {
    return {test::random_free_body(1, random), test::random_free_body(2, random)};
}

std::vector<Row> rows_of(const std::vector<SolverBody>& bodies, const RowBlock& block) {
    std::vector<Row> rows;
    append_rows(bodies, block, 0, rows);
    return rows;
}

// A displacement of one body of the block.
struct Nudge {
    std::uint32_t body = 0;
    Vec3 move_m = Vec3::Zero();
    Vec3 turn_rad = Vec3::Zero();
};

std::vector<SolverBody> nudged(std::vector<SolverBody> bodies, const Nudge& nudge, double scale) {
    Pose& pose = bodies[nudge.body].pose_ws;
    pose.position += scale * nudge.move_m;
    pose.rotation = (rotation_from_vector(scale * nudge.turn_rad) * pose.rotation).normalized();
    return bodies;
}

// Oracle: change of each residual per unit of the nudge, by central differences. Error below 1e-9
// for poses of a few metres: (1e-5)^2 from the step, 1e-15 / 1e-5 from rounding.
std::vector<double> measured_slopes(const std::vector<SolverBody>& bodies, const RowBlock& block,
                                    const Nudge& nudge) {
    constexpr double k_step = 1e-5;
    const std::vector<Row> ahead = rows_of(nudged(bodies, nudge, k_step), block);
    const std::vector<Row> behind = rows_of(nudged(bodies, nudge, -k_step), block);
    std::vector<double> slopes;
    for (std::size_t i = 0; i < ahead.size(); ++i) {
        slopes.push_back((ahead[i].residual - behind[i].residual) / (2.0 * k_step));
    }
    return slopes;
}

// The same change according to the row's Jacobian.
double claimed_slope(const Row& row, const Nudge& nudge) {
    if (nudge.body == 0) {
        return row.linear_a.dot(nudge.move_m) + row.angular_a.dot(nudge.turn_rad);
    }
    return -row.linear_a.dot(nudge.move_m) + row.angular_b.dot(nudge.turn_rad);
}

double worst_slope_error(const std::vector<SolverBody>& bodies, const RowBlock& block,
                         const Nudge& nudge) {
    const std::vector<Row> rows = rows_of(bodies, block);
    const std::vector<double> slopes = measured_slopes(bodies, block, nudge);
    double worst = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        worst = std::max(worst, std::abs(slopes[i] - claimed_slope(rows[i], nudge)));
    }
    return worst;
}

Nudge random_nudge(Random& random) {
    return {random.between(0.0, 1.0) < 0.5 ? 0U : 1U, random.vector(1.0), random.vector(1.0)};
}

RC_GTEST_PROP(Rows, PointJacobianEqualsFiniteDifferences, (std::uint64_t seed)) {
    Random random(seed);
    const auto bodies = two_random_bodies(random);
    const RowBlock block = test::random_block(RowKind::drive_point, 0, 1, random);
    RC_ASSERT(worst_slope_error(bodies, block, random_nudge(random)) < 1e-8);
}

RC_GTEST_PROP(Rows, ContactJacobianEqualsFiniteDifferencesAtAnySeparation, (std::uint64_t seed)) {
    Random random(seed);
    const auto bodies = two_random_bodies(random);
    const RowBlock block = test::random_block(RowKind::contact, 0, 1, random);
    RC_ASSERT(worst_slope_error(bodies, block, random_nudge(random)) < 1e-8);
}

RC_GTEST_PROP(Rows, WeldJacobianEqualsFiniteDifferencesAtTheSolution, (std::uint64_t seed)) {
    for (const RowKind kind : {RowKind::drive_weld, RowKind::drive_direction}) {
        Random random(seed);
        const auto bodies = two_random_bodies(random);
        RowBlock block = test::random_block(kind, 0, 1, random);
        test::meet(bodies, block);
        RC_ASSERT(worst_slope_error(bodies, block, random_nudge(random)) < 1e-8);
    }
}

// The anchor points may be anywhere; they take part in no row.
RC_GTEST_PROP(Rows, DriveDirectionHasNoLinearPart, (std::uint64_t seed)) {
    Random random(seed);
    const auto bodies = two_random_bodies(random);
    const RowBlock block = test::random_block(RowKind::drive_direction, 0, 1, random);
    for (const Row& row : rows_of(bodies, block)) {
        RC_ASSERT(row.linear_a == Vec3(Vec3::Zero()));
        RC_ASSERT(row.angular_a ==
                  -row.angular_b);  // a pure couple, independent of the anchor points
    }
}

// Away from the solution the slope of the rotation vector is 1 + O(angle); along the error itself
// it is exact at any angle.
RC_GTEST_PROP(Rows, WeldJacobianIsExactAlongItsErrorAtAnyAngle, (std::uint64_t seed)) {
    Random random(seed);
    auto bodies = two_random_bodies(random);
    RowBlock block = test::random_block(RowKind::drive_weld, 0, 1, random);
    test::meet(bodies, block);
    const Vec3 axis = random.direction();
    bodies[0] = nudged(bodies, {0, Vec3::Zero(), axis}, random.between(0.1, 3.0))[0];
    for (const std::uint32_t body : {0U, 1U}) {
        const Nudge nudge{body, Vec3::Zero(), axis};
        const std::vector<Row> rows = rows_of(bodies, block);
        const std::vector<double> slopes = measured_slopes(bodies, block, nudge);
        for (std::size_t i = 3; i < rows.size(); ++i) {
            RC_ASSERT(std::abs(slopes[i] - claimed_slope(rows[i], nudge)) < 1e-8);
        }
    }
}

// The normal is fixed to b, so a common rigid motion leaves the separation unchanged.
RC_GTEST_PROP(Rows, RigidMotionOfBothBodiesKeepsTheSeparation, (std::uint64_t seed)) {
    Random random(seed);
    const auto bodies = two_random_bodies(random);
    const RowBlock block = test::random_block(RowKind::contact, 0, 1, random);
    const Vec3 velocity = random.vector(1.0);
    const Vec3 spin = random.vector(1.0);
    const Row row = rows_of(bodies, block)[0];
    const Vec3 velocity_a = velocity + spin.cross(bodies[0].pose_ws.position);
    const Vec3 velocity_b = velocity + spin.cross(bodies[1].pose_ws.position);
    const double change = row.linear_a.dot(velocity_a - velocity_b) + row.angular_a.dot(spin) +
                          row.angular_b.dot(spin);
    RC_ASSERT(std::abs(change) < 1e-13);
}

TEST(Rows, ContactNormalRotatesWithB) {
    std::vector<SolverBody> bodies = {
        test::ball(1, 1.0, 0.1, {Vec3(-0.3, 0.05, 0.0), Quat::Identity()}), test::fixed_body(2)};
    bodies[1].pose_ws.rotation = rotation_about(Vec3::UnitZ(), 0.5 * 3.14159265358979323846);
    RowBlock block = test::row_block(RowKind::contact, 0, 1);
    block.normal_b_bs = Vec3::UnitY();  // rotated by a quarter turn about z: -x in the world
    const Row row = rows_of(bodies, block)[0];
    EXPECT_LT((row.linear_a - -Vec3::UnitX()).norm(), 1e-15);
    EXPECT_NEAR(row.residual, 0.3, 1e-15);
    // Rotating b further rotates the normal away from a: cos(angle) 0.3 + sin(angle) * -0.05 to
    // first order.
    EXPECT_NEAR(row.angular_b.z(), -0.05, 1e-15);
}

TEST(Rows, PointResidualIsTheOffsetFromBToA) {
    const std::vector<SolverBody> bodies = {
        test::translating_body(1, 80.0, {Vec3(1.0, 2.0, 3.0), Quat::Identity()}),
        test::fixed_body(2, {Vec3(0.5, 0.0, 0.0), Quat::Identity()})};
    const RowBlock block =
        test::row_block(RowKind::drive_point, 0, 1, Vec3(0.0, 0.25, 0.0), Vec3(0.25, 0.0, -1.0));
    const std::vector<Row> rows = rows_of(bodies, block);
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_DOUBLE_EQ(rows[0].residual, 0.25);
    EXPECT_DOUBLE_EQ(rows[1].residual, 2.25);
    EXPECT_DOUBLE_EQ(rows[2].residual, 4.0);
    EXPECT_DOUBLE_EQ(block_error_m(bodies, block), Vec3(0.25, 2.25, 4.0).norm());
}

TEST(Rows, WeldResidualIsTheAngleTimesTheLever) {
    std::vector<SolverBody> bodies = {test::translating_body(1, 80.0), test::ball(2, 1.0, 0.1)};
    bodies[0].pose_ws.rotation = rotation_about(Vec3::UnitY(), 0.5);
    const RowBlock block = test::row_block(RowKind::drive_weld, 0, 1);
    const std::vector<Row> rows = rows_of(bodies, block);
    ASSERT_EQ(rows.size(), 6U);
    EXPECT_NEAR(rows[4].residual, 0.5 * k_angle_lever_m, 1e-15);
    EXPECT_NEAR(rows[3].residual, 0.0, 1e-15);
    EXPECT_NEAR(rows[5].residual, 0.0, 1e-15);
    EXPECT_NEAR(block_error_m(bodies, block), 0.5 * k_angle_lever_m, 1e-15);
}

TEST(Rows, ContactErrorIsThePenetrationDepth) {
    std::vector<SolverBody> bodies = {test::ball(1, 1.0, 0.1), test::fixed_body(2)};
    const RowBlock block = test::row_block(RowKind::contact, 0, 1, Vec3(0.0, -0.1, 0.0));
    bodies[0].pose_ws.position.y() = 0.07;
    EXPECT_NEAR(contact_separation_m(bodies, block), -0.03, 1e-15);
    EXPECT_NEAR(block_error_m(bodies, block), 0.03, 1e-15);
    bodies[0].pose_ws.position.y() = 0.15;
    EXPECT_NEAR(contact_separation_m(bodies, block), 0.05, 1e-15);
    EXPECT_EQ(block_error_m(bodies, block), 0.0);
}

RC_GTEST_PROP(Rows, BlockErrorsEqualTheNormsOfTheResiduals, (std::uint64_t seed)) {
    Random random(seed);
    const auto bodies = two_random_bodies(random);
    for (const RowKind kind : k_all_kinds) {
        const RowBlock block = test::random_block(kind, 0, 1, random);
        const std::vector<Row> rows = rows_of(bodies, block);
        if (kind == RowKind::contact) {
            RC_ASSERT(std::abs(contact_separation_m(bodies, block) - rows[0].residual) < 1e-14);
            continue;
        }
        if (kind == RowKind::drive_direction) {
            const Vec3 turned(rows[0].residual, rows[1].residual, rows[2].residual);
            RC_ASSERT(std::abs(block_error_m(bodies, block) - turned.norm()) < 1e-14);
            continue;
        }
        const double point = Vec3(rows[0].residual, rows[1].residual, rows[2].residual).norm();
        const double angle = kind == RowKind::drive_weld
                                 ? Vec3(rows[3].residual, rows[4].residual, rows[5].residual).norm()
                                 : 0.0;
        RC_ASSERT(std::abs(block_error_m(bodies, block) - std::max(point, angle)) < 1e-14);
    }
}

TEST(Rows, OnlyContactsAreUnilateral) {
    Random random(1);
    const auto bodies = two_random_bodies(random);
    for (const RowKind kind : k_all_kinds) {
        std::vector<Row> rows;
        append_rows(bodies, test::random_block(kind, 1, 0, random), 7, rows);
        const std::size_t expected = kind == RowKind::contact      ? 1
                                     : kind == RowKind::drive_weld ? 6
                                                                   : 3;
        EXPECT_EQ(rows.size(), expected);
        for (const Row& row : rows) {
            EXPECT_EQ(row.unilateral, kind == RowKind::contact);
            EXPECT_EQ(row.group, kind == RowKind::contact ? RowGroup::contact : RowGroup::drive);
            EXPECT_EQ(row.block, 7U);
            EXPECT_EQ(row.a, 1U);
            EXPECT_EQ(row.b, 0U);
        }
    }
}

RC_GTEST_PROP(Rows, WorldInverseInertiaInvertsTheRotatedInertia, (std::uint64_t seed)) {
    Random random(seed);
    const SolverBody body = test::random_free_body(1, random);
    const Mat3 axes = body.pose_ws.rotation.toRotationMatrix();
    const Mat3 inertia = axes * body.inertia_kgm2.asDiagonal() * axes.transpose();
    RC_ASSERT((inverse_inertia_ws(body) * inertia - Mat3::Identity()).norm() < 1e-12);
}

}  // namespace
}  // namespace handhold::solver_rows_test
