#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/solver/newton/newton.hpp"
#include "tests/engine/solver/scene.hpp"

namespace handhold::solver_velocity_test {
namespace {

using test::Random;
using test::SolverScene;

struct Momentum {
    Vec3 linear = Vec3::Zero();
    Vec3 angular = Vec3::Zero();  // about the world's origin
    double scale = 0.0;           // sum of magnitudes: scale of the tolerance
};

Momentum momentum_of(const SolverScene& scene) {
    Momentum sum;
    for (const SolverBody& body : scene.graph.bodies) {
        const Vec3 linear = body.mass_kg * body.velocity_mps;
        const Quat& rotation = body.pose_ws.rotation;
        const Vec3 spin_bs = rotation.conjugate() * body.spin_radps;
        sum.linear += linear;
        sum.angular += body.pose_ws.position.cross(linear) +
                       rotation * Vec3(body.inertia_kgm2.cwiseProduct(spin_bs));
        sum.scale += linear.norm() * (1.0 + body.pose_ws.position.norm());
    }
    return sum;
}

void set_random_motion(SolverScene& scene, Random& random) {
    for (SolverBody& body : scene.graph.bodies) {
        if (body.role != BodyRole::fixed) {
            body.velocity_mps = random.vector(5.0);
        }
        if (body.role == BodyRole::free) {
            body.spin_radps = random.vector(5.0);
        }
    }
}

// A tree of satisfied points and welds with random motion. Any velocities of the rows are
// compatible.
SolverScene random_tree(std::uint32_t count, Random& random) {
    SolverScene scene;
    for (std::uint32_t i = 0; i < count; ++i) {
        scene.graph.bodies.push_back(test::random_free_body(i + 1, random));
    }
    for (std::uint32_t i = 1; i < count; ++i) {
        const auto other = static_cast<std::uint32_t>(random.engine()() % i);
        const RowKind kind =
            random.between(0.0, 1.0) < 0.5 ? RowKind::drive_point : RowKind::drive_weld;
        RowBlock block = test::random_block(kind, i, other, random);
        test::meet(scene.graph.bodies, block);
        scene.graph.blocks.push_back(block);
    }
    sort_blocks(scene.graph);
    set_random_motion(scene, random);
    return scene;
}

double velocity_of_row(const SolverScene& scene, const Row& row) {
    const SolverBody& a = scene.graph.bodies[row.a];
    const SolverBody& b = scene.graph.bodies[row.b];
    return row.linear_a.dot(a.velocity_mps - b.velocity_mps) + row.angular_a.dot(a.spin_radps) +
           row.angular_b.dot(b.spin_radps);
}

RC_GTEST_PROP(SolveVelocities, RowVelocitiesOfAnyTreeVanishTo1e9, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene = random_tree(2 + static_cast<std::uint32_t>(random.engine()() % 6), random);
    scene.solve_velocities();
    for (const Row& row : scene.rows()) {
        RC_ASSERT(std::abs(velocity_of_row(scene, row)) < 1e-9);
    }
}

RC_GTEST_PROP(SolveVelocities, FreeIslandsKeepLinearAndAngularMomentum, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene = random_tree(2 + static_cast<std::uint32_t>(random.engine()() % 6), random);
    const Momentum before = momentum_of(scene);
    scene.solve_velocities();
    const Momentum after = momentum_of(scene);
    RC_ASSERT((after.linear - before.linear).norm() < 1e-12 * before.scale);
    RC_ASSERT((after.angular - before.angular).norm() < 1e-12 * before.scale);
}

RC_GTEST_PROP(SolveVelocities, ReportedImpulsesEqualTheMomentumChange, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene = random_tree(4, random);
    std::vector<Vec3> gained;
    for (const SolverBody& body : scene.graph.bodies) {
        gained.push_back(-body.mass_kg * body.velocity_mps);
    }
    scene.solve_velocities();
    std::vector<Vec3> given(scene.graph.bodies.size(), Vec3::Zero());
    for (const RowBlock& block : scene.graph.blocks) {
        given[block.a] += block.impulse_ws_ns;
        given[block.b] -= block.impulse_ws_ns;
    }
    for (std::size_t i = 0; i < given.size(); ++i) {
        gained[i] += scene.body(i).mass_kg * scene.body(i).velocity_mps;
        RC_ASSERT((gained[i] - given[i]).norm() < 1e-10);
    }
}

TEST(SolveVelocities, TranslatingBodyMovesOppositeToItsDriveOnAFixedBody) {
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1), test::translating_body(2, 80.0)};
    scene.graph.blocks = {test::row_block(RowKind::drive_point, 1, 0)};
    scene.block(0).drive_velocity_ws_mps = Vec3(0.5, -1.0, 0.25);
    scene.solve_velocities();
    EXPECT_LT((scene.body(1).velocity_mps + Vec3(0.5, -1.0, 0.25)).norm(), 1e-9);
    EXPECT_LT((scene.block(0).impulse_ws_ns + 80.0 * Vec3(0.5, -1.0, 0.25)).norm(), 1e-7);
}

// Closed form of a throw: v_com = v_drive + w x (com - drive).
RC_GTEST_PROP(SolveVelocities, WeldedBodyFollowsTheDriveRigidly, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene;
    scene.graph.bodies = {test::translating_body(1, 80.0, test::random_pose(random)),
                          test::random_free_body(2, random)};
    scene.body(0).inverse_mass = 0.0;
    scene.body(0).velocity_mps = random.vector(2.0);
    RowBlock block = test::random_block(RowKind::drive_weld, 0, 1, random);
    test::meet(scene.graph.bodies, block);
    block.drive_velocity_ws_mps = random.vector(3.0);
    block.drive_spin_ws_radps = random.vector(8.0);
    scene.graph.blocks = {block};
    scene.solve_velocities();
    const Vec3 drive_mps = scene.body(0).velocity_mps + block.drive_velocity_ws_mps;
    const Vec3 com_from_drive = -(scene.body(1).pose_ws.rotation * block.point_b_bs);
    const Vec3 expected = drive_mps + block.drive_spin_ws_radps.cross(com_from_drive);
    RC_ASSERT((scene.body(1).spin_radps - block.drive_spin_ws_radps).norm() < 1e-8);
    RC_ASSERT((scene.body(1).velocity_mps - expected).norm() < 1e-8);
}

// Two touching balls, one at x < 0, the other at x > 0.
SolverScene touching_balls(double left_kg, double right_kg, double restitution) {
    SolverScene scene;
    scene.graph.bodies = {test::ball(1, left_kg, 0.1, {Vec3(-0.1, 0.0, 0.0), Quat::Identity()}),
                          test::ball(2, right_kg, 0.1, {Vec3(0.1, 0.0, 0.0), Quat::Identity()})};
    RowBlock block =
        test::row_block(RowKind::contact, 0, 1, Vec3(0.1, 0.0, 0.0), Vec3(-0.1, 0.0, 0.0));
    block.normal_b_bs = -Vec3::UnitX();
    block.restitution = restitution;
    scene.graph.blocks = {block};
    return scene;
}

// Newton's law of impact: v' = (m1 v1 + m2 v2 -+ e m (v1 - v2)) / (m1 + m2).
RC_GTEST_PROP(SolveVelocities, HeadOnImpactFollowsNewtonsLaw, (std::uint64_t seed)) {
    Random random(seed);
    const double left_kg = random.between(0.1, 50.0);
    const double right_kg = random.between(0.1, 50.0);
    const double e = random.between(0.0, 1.0);
    SolverScene scene = touching_balls(left_kg, right_kg, e);
    const double left = random.between(1.0, 5.0);
    const double right = random.between(-5.0, 0.5);
    scene.body(0).velocity_mps = Vec3(left, 0.7, 0.0);
    scene.body(1).velocity_mps = Vec3(right, 0.0, -0.3);
    scene.solve_velocities();
    const double common = (left_kg * left + right_kg * right) / (left_kg + right_kg);
    const double left_after = common - e * (left - right) * right_kg / (left_kg + right_kg);
    const double right_after = common + e * (left - right) * left_kg / (left_kg + right_kg);
    RC_ASSERT((scene.body(0).velocity_mps - Vec3(left_after, 0.7, 0.0)).norm() < 1e-9);
    RC_ASSERT((scene.body(1).velocity_mps - Vec3(right_after, 0.0, -0.3)).norm() < 1e-9);
}

TEST(SolveVelocities, SlowImpactsDoNotBounce) {
    const VelocitySettings settings;
    SolverScene scene = touching_balls(1.0, 1.0, 1.0);
    scene.body(0).velocity_mps.x() = 0.99 * settings.restitution_speed_mps;
    scene.solve_velocities();
    EXPECT_NEAR(scene.body(0).velocity_mps.x(), 0.495 * settings.restitution_speed_mps, 1e-9);
    EXPECT_NEAR(scene.body(1).velocity_mps.x(), 0.495 * settings.restitution_speed_mps, 1e-9);
}

TEST(SolveVelocities, SeparatingOrDistantBodiesAreUnaffected) {
    SolverScene parting = touching_balls(1.0, 2.0, 0.5);
    parting.body(0).velocity_mps.x() = -1.0;
    parting.solve_velocities();
    EXPECT_EQ(parting.body(0).velocity_mps.x(), -1.0);
    EXPECT_EQ(parting.block(0).impulse_ws_ns, Vec3(Vec3::Zero()));

    SolverScene apart = touching_balls(1.0, 2.0, 0.5);
    apart.body(0).pose_ws.position.x() -= 2.0 * VelocitySettings{}.touch_m;
    apart.body(0).velocity_mps.x() = 1.0;
    apart.solve_velocities();
    EXPECT_EQ(apart.body(0).velocity_mps.x(), 1.0);
}

TEST(SolveVelocities, PenetrationDepthNeverBecomesVelocity) {
    SolverScene scene = touching_balls(1.0, 2.0, 1.0);
    scene.body(0).pose_ws.position.x() += 0.1;
    scene.solve_velocities();
    EXPECT_EQ(scene.body(0).velocity_mps.x(), 0.0);
    EXPECT_EQ(scene.body(1).velocity_mps.x(), 0.0);
}

double energy_of(const SolverBody& body) {
    const Vec3 spin_bs = body.pose_ws.rotation.conjugate() * body.spin_radps;
    return 0.5 * body.mass_kg * body.velocity_mps.squaredNorm() +
           0.5 * spin_bs.dot(body.inertia_kgm2.cwiseProduct(spin_bs));
}

// Two contacts with friction of up to 2 at random points of one body, some of which wedge. Energy
// may grow by what limit_energy leaves, 1e-10 of the energy of the change, and by rounding: the
// work of an impulse is a sum of six products, computed once for the limit and once for the
// velocities, each with an error of up to 4 eps of the sum of their sizes. Impulses are large if
// contacts wedge.
RC_GTEST_PROP(SolveVelocities, ContactsNeverAddEnergy, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1), test::random_free_body(2, random)};
    scene.body(1).velocity_mps = random.vector(10.0);
    scene.body(1).spin_radps = random.vector(20.0);
    constexpr std::uint64_t k_contacts = 2;
    for (std::uint64_t i = 0; i < k_contacts; ++i) {
        RowBlock block = test::random_block(RowKind::contact, 1, 0, random);
        test::meet(scene.graph.bodies, block);
        block.key = i;
        block.friction = random.between(0.0, 2.0);
        block.restitution = random.between(0.0, 1.0);
        scene.graph.blocks.push_back(block);
    }
    sort_blocks(scene.graph);
    const SolverBody before = scene.body(1);
    scene.solve_velocities();
    SolverBody change = scene.body(1);
    change.velocity_mps -= before.velocity_mps;
    change.spin_radps -= before.spin_radps;
    double work = 0.0;  // J, all impulses in the directions of their points' velocities
    for (const RowBlock& block : scene.graph.blocks) {
        work += block.impulse_ws_ns.norm() *
                (before.velocity_mps.norm() + before.spin_radps.norm() * block.point_a_bs.norm());
    }
    constexpr double k_left = 1e-10;
    constexpr double k_rounding = 8.0 * std::numeric_limits<double>::epsilon();
    RC_ASSERT(energy_of(scene.body(1)) <=
              energy_of(before) + k_left * energy_of(change) + k_rounding * work);
}

// A driven box is pressed against a wall and dragged along it. When the drive reverses, the wall's
// friction still brakes the box, although the drive does work against the previous motion.
TEST(SolveVelocities, FrictionBrakesADrivenBodyWhenTheDriveReverses) {
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1), test::ball(2, 1.0, 0.1),
                          test::translating_body(3, 80.0)};
    scene.body(1).velocity_mps = Vec3(0.3, 0.0, 0.0);
    RowBlock contact = test::row_block(RowKind::contact, 1, 0);
    contact.friction = 0.4;
    RowBlock drive = test::row_block(RowKind::drive_point, 2, 1);
    drive.drive_velocity_ws_mps = Vec3(-0.2, -0.02, 0.0);
    scene.graph.blocks = {contact, drive};
    sort_blocks(scene.graph);
    build_islands(scene.graph);
    const Island& island = scene.graph.islands.front();
    const VelocityResult result = solve_island_velocities(scene.view(island), {}, scene.scratch);
    EXPECT_FALSE(result.unconverged);
    const auto wall = std::ranges::find_if(scene.graph.blocks, is_contact);
    ASSERT_GT(wall->impulse_ws_ns.y(), 0.0);
    EXPECT_NEAR(wall->impulse_ws_ns.x(), 0.4 * wall->impulse_ws_ns.y(), 1e-3);
}

RC_GTEST_PROP(SolveVelocities, ContactsNeitherApproachNorPullAfterwards, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1)};
    const auto count = 2 + static_cast<std::uint32_t>(random.engine()() % 4);
    for (std::uint32_t i = 0; i < count; ++i) {
        scene.graph.bodies.push_back(test::random_free_body(i + 2, random));
    }
    for (std::uint32_t i = 1; i <= count; ++i) {
        const auto other = static_cast<std::uint32_t>(random.engine()() % i);
        RowBlock block = test::random_block(RowKind::contact, i, other, random);
        test::meet(scene.graph.bodies, block);
        block.restitution = random.between(0.0, 0.9);
        scene.graph.blocks.push_back(block);
    }
    sort_blocks(scene.graph);
    set_random_motion(scene, random);
    scene.solve_velocities();
    const std::vector<Row> rows = scene.rows();
    for (const Row& row : rows) {
        RC_ASSERT(velocity_of_row(scene, row) > -1e-8);
        RC_ASSERT(row.linear_a.dot(scene.block(row.block).impulse_ws_ns) > -1e-9);
    }
}

}  // namespace
}  // namespace handhold::solver_velocity_test
