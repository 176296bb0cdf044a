// Random constraint networks: trees, loops, repeated joints, mass ratios up to 1000. The same 500
// seeds in every run: about one network in some thousands ends in a local minimum (a hinge inverted
// by contradicting drives), which is a known limitation.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/engine/solver/scene.hpp"

namespace handhold::solver_net_test {
namespace {

using test::Random;
using test::SolverScene;

std::uint32_t random_index(std::uint32_t count, Random& random) {
    return static_cast<std::uint32_t>(random.engine()() % count);
}

// Body 0 is `first`; every other body is a box of 30 g to 30 kg attached to an earlier one. Half of
// the networks use joints of any kind, some of them repeated, so that rows are redundant. The other
// half use balls with loops: a loop of hinges closes in one pose only, and Newton converges slowly
// where that pose is a double root. All joints are satisfied.
SolverScene make_net(const SolverBody& first, Random& random) {
    SolverScene scene;
    const std::uint32_t count = 3 + random_index(30, random);
    scene.graph.bodies = {first};
    for (std::uint32_t i = 1; i < count; ++i) {
        SolverBody body = test::random_free_body(i + 1, random);
        const double factor = 0.03 * std::pow(1000.0, random.between(0.0, 1.0)) / body.mass_kg;
        body.mass_kg *= factor;
        body.inertia_kgm2 *= factor;
        body.inverse_mass /= factor;
        body.inverse_inertia_bs /= factor;
        scene.graph.bodies.push_back(body);
    }
    const bool has_loops = random_index(2, random) == 0;
    const auto any_kind = [&] {
        const RowKind kinds[] = {RowKind::ball, RowKind::hinge, RowKind::slider, RowKind::fixed};
        return has_loops ? RowKind::ball : kinds[random_index(4, random)];
    };
    const auto tie = [&](RowKind kind, std::uint32_t a, std::uint32_t b) {
        RowBlock block = test::random_block(kind, a, b, random);
        block.key = scene.graph.blocks.size();
        test::meet(scene.graph.bodies, block);
        scene.graph.blocks.push_back(block);
    };
    for (std::uint32_t i = 1; i < count; ++i) {
        tie(any_kind(), random_index(i, random), i);
        if (random_index(4, random) != 0) {
            continue;
        }
        if (has_loops) {
            tie(RowKind::ball, random_index(i, random), i);
        } else {
            RowBlock again = scene.graph.blocks.back();
            again.key = scene.graph.blocks.size();
            scene.graph.blocks.push_back(again);
        }
    }
    sort_blocks(scene.graph);
    return scene;
}

void disturb(SolverScene& scene, Random& random) {
    for (SolverBody& body : scene.graph.bodies) {
        if (body.role == BodyRole::free) {
            body.pose_ws.position += random.vector(0.01);
            body.pose_ws.rotation =
                (rotation_from_vector(random.vector(0.03)) * body.pose_ws.rotation).normalized();
        }
    }
}

double worst_joint_m(const SolverScene& scene) {
    double worst = 0.0;
    for (const RowBlock& block : scene.graph.blocks) {
        if (is_joint(block)) {
            worst = std::max(worst, block_error_m(scene.graph.bodies, block));
        }
    }
    return worst;
}

constexpr std::uint64_t k_nets = 500;

// Disturbed by as much as fast motion in one frame. About one in a thousand is almost stretched out
// and converges slowly: it takes another frame or two.
TEST(ConstraintNetworks, ConvergeAfterADisturbance) {
    for (std::uint64_t seed = 1; seed <= k_nets; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SolverScene scene = make_net(test::fixed_body(1, test::random_pose(random)), random);
        disturb(scene, random);
        for (int frame = 0; frame < 4; ++frame) {
            scene.solve_positions();
        }
        EXPECT_LE(worst_joint_m(scene), 1e-6);
    }
}

// As in the contradiction phase: after drives have stretched the network, it is solved again
// without them. About one in a thousand, left almost stretched out, may still be micrometres off.
TEST(ConstraintNetworks, JointsConvergeAfterContradictingDrivesAreRemoved) {
    for (std::uint64_t seed = 1; seed <= k_nets; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SolverScene scene = make_net(test::fixed_body(1, test::random_pose(random)), random);
        const auto count = static_cast<std::uint32_t>(scene.graph.bodies.size());
        scene.graph.bodies.push_back(test::translating_body(count + 1, 80.0));
        scene.body(count).inverse_mass = 0.0;
        for (std::uint64_t drive = 0; drive < 2; ++drive) {
            const std::uint32_t driven = 1 + random_index(count - 1, random);
            RowBlock block =
                test::row_block(RowKind::drive_point, driven, count, random.vector(0.2));
            block.point_b_bs =
                transform_point(scene.body(driven).pose_ws, block.point_a_bs) + random.vector(0.2);
            block.key = drive;
            scene.graph.blocks.push_back(block);
        }
        sort_blocks(scene.graph);
        scene.solve_positions();
        scene.solve_positions(test::tight_settings(), BlockFilter::without_drives);
        EXPECT_LE(worst_joint_m(scene), 2e-5);
        for (const SolverBody& body : scene.graph.bodies) {
            ASSERT_TRUE(body.pose_ws.position.allFinite());
            EXPECT_LT(body.pose_ws.position.norm(), 100.0);
        }
    }
}

struct Momentum {
    Vec3 linear = Vec3::Zero();
    Vec3 angular = Vec3::Zero();
    double size = 0.0;  // sum of magnitudes: scale of the tolerance
};
Momentum momentum_of(const SolverScene& scene) {
    Momentum sum;
    for (const SolverBody& body : scene.graph.bodies) {
        const Vec3 linear = body.mass_kg * body.velocity_mps;
        const Mat3 axes = body.pose_ws.rotation.toRotationMatrix();
        const Vec3 spin =
            axes * (body.inertia_kgm2.cwiseProduct(axes.transpose() * body.spin_radps));
        const Vec3 angular = body.pose_ws.position.cross(linear) + spin;
        sum.linear += linear;
        sum.angular += angular;
        sum.size += linear.norm() + angular.norm();
    }
    return sum;
}

TEST(ConstraintNetworks, FreeNetworksKeepMomentumAndSatisfyTheirJoints) {
    for (std::uint64_t seed = 1; seed <= k_nets; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SolverScene scene = make_net(test::random_free_body(1, random), random);
        for (SolverBody& body : scene.graph.bodies) {
            body.velocity_mps = random.vector(2.0);
            body.spin_radps = random.vector(5.0);
        }
        const Momentum before = momentum_of(scene);
        scene.solve_velocities();
        const Momentum after = momentum_of(scene);
        EXPECT_LT((after.linear - before.linear).norm(), 1e-9 * before.size);
        EXPECT_LT((after.angular - before.angular).norm(), 1e-9 * before.size);
        for (const Row& row : scene.rows()) {
            const SolverBody& a = scene.body(row.a);
            const SolverBody& b = scene.body(row.b);
            const double speed = row.linear_a.dot(a.velocity_mps - b.velocity_mps) +
                                 row.angular_a.dot(a.spin_radps) + row.angular_b.dot(b.spin_radps);
            // 1e-9 in nearly all networks; nearly redundant rows leave up to 1e-5.
            EXPECT_LT(std::abs(speed), 2e-4);
        }
    }
}

}  // namespace
}  // namespace handhold::solver_net_test
