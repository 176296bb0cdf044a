#include "systems/physics/book_momentum.hpp"

#include <gtest/gtest.h>

#include "tests/engine/solver/scene.hpp"

namespace handhold::book_momentum_test {
namespace {

using test::Random;

// Two players, of which the second counts as heavier than they are, two objects and a wall, with
// random rows and impulses.
struct Impulses {
    ConstraintGraph graph;

    explicit Impulses(Random& random) {
        graph.bodies = {test::translating_body(1, 70.0, test::random_pose(random)),
                        test::translating_body(2, 60.0, test::random_pose(random)),
                        test::random_free_body(3, random), test::random_free_body(4, random),
                        test::fixed_body(5, test::random_pose(random))};
        graph.bodies[1].inverse_mass *= random.between(0.0, 1.0);
        for (int i = 0; i < 30; ++i) {
            const auto a = static_cast<std::uint32_t>(random.between(0.0, 5.0));
            const auto b = static_cast<std::uint32_t>(random.between(0.0, 5.0));
            const RowKind kinds[] = {RowKind::drive_point, RowKind::contact, RowKind::hinge};
            if (a != b) {
                RowBlock& block =
                    graph.blocks.emplace_back(test::random_block(kinds[i % 3], a, b, random));
                test::meet(graph.bodies, block);
                block.impulse_ws_ns = random.vector(5.0);
                block.angular_impulse_ws_nms = random.vector(1.0);
            }
        }
    }
};

TEST(BookMomentum, ReceiversSumToZero) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Random random(seed);
        const Impulses scene(random);
        MomentumLedger ledger;
        book_momentum(scene.graph, ledger);
        Vec3 linear = Vec3::Zero();
        Vec3 angular = Vec3::Zero();
        for (std::size_t i = 0; i < MomentumLedger::receiver_count; ++i) {
            linear += ledger.linear_kgmps[i];
            angular += ledger.angular_kgm2ps[i];
        }
        EXPECT_LT(linear.norm(), 1e-12);
        EXPECT_LT(angular.norm(), 1e-12);
        EXPECT_GT(ledger.linear_kgmps[MomentumLedger::virtual_player].norm(), 0.0);
    }
}

// A player of mass M with inverse mass s / M gets velocity s / M times the impulse, and so momentum
// s times the impulse.
TEST(BookMomentum, PlayersGetTheMomentumOfTheirVelocityChange) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Random random(seed);
        const Impulses scene(random);
        MomentumLedger ledger;
        book_momentum(scene.graph, ledger);
        Vec3 expected = Vec3::Zero();
        for (const RowBlock& block : scene.graph.blocks) {
            for (const auto& [body, sign] : {std::pair{block.a, 1.0}, std::pair{block.b, -1.0}}) {
                const SolverBody& player = scene.graph.bodies[body];
                if (player.role == BodyRole::translating) {
                    const Vec3 change_mps = player.inverse_mass * sign * block.impulse_ws_ns;
                    expected += player.mass_kg * change_mps;
                }
            }
        }
        EXPECT_LT((ledger.linear_kgmps[MomentumLedger::players] - expected).norm(), 1e-12);
    }
}

}  // namespace
}  // namespace handhold::book_momentum_test
