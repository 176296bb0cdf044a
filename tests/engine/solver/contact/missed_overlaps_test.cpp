// Overlaps that a sweep does not report, because it reports only the first touch of a pair.
#include "engine/solver/contact/missed_overlaps.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/random.hpp"

namespace handhold::missed_overlaps_test {
namespace {

using test::Random;

constexpr double k_sweep_m = 0.005;

// A cube before a fork: one collider of two plates, whose near faces are at z = 0.2. The cube moves
// along z and ends `depth_m` deep in the right plate. All of it is in the frame `frame_ws`.
struct CubeAtFork {
    ShapeLibrary shapes;
    CollisionWorld collision{shapes};
    std::vector<ColliderProxy> proxies;
    ConstraintGraph graph;
    MissedOverlaps missed;

    CubeAtFork(double depth_m, double moved_m, const Pose& frame_ws) {
        const Vec3 half(0.05, 0.3, 0.2);
        const std::vector<CompoundChild> plates = {
            {shapes.add_box(half), {Vec3(-0.3, 0.0, 0.0), Quat::Identity()}},
            {shapes.add_box(half), {Vec3(0.3, 0.0, 0.0), Quat::Identity()}}};
        const Pose fork = frame_ws;
        const Pose to = frame_ws * Pose{Vec3(0.3, 0.0, 0.3 - depth_m), Quat::Identity()};
        const Pose from =
            frame_ws * Pose{Vec3(0.3, 0.0, 0.3 - depth_m + moved_m), Quat::Identity()};
        proxies = {{1, shapes.add_box({0.1, 0.1, 0.1}), from, to, true},
                   {2, shapes.add_compound(plates), fork, fork, false}};
        collision.update_shapes();
        graph.bodies.resize(2);
        graph.bodies[0].role = BodyRole::free;
    }
    void add_contact() {
        RowBlock block;
        block.kind = RowKind::contact;
        block.a = 0;
        block.b = 1;
        graph.blocks.assign(3, block);
    }
    void find() { find_missed_overlaps(collision, proxies, graph, k_sweep_m, missed); }
};

TEST(MissedOverlaps, AreAsDeepAsTheBodiesEndInAnotherPart) {
    Random random(3611);
    for (int round = 0; round < 50; ++round) {
        const double depth_m = random.between(1e-3, 0.05);
        CubeAtFork scene{depth_m, random.between(0.02, 0.5), random.pose()};
        scene.add_contact();
        scene.find();
        EXPECT_NEAR(scene.missed.of_body[0].depth_m, depth_m, 1e-6);
        EXPECT_EQ(scene.missed.of_body[0].with, 1U);
        EXPECT_EQ(scene.missed.of_body[1].depth_m, 0.0);  // fixed bodies are not restored
        EXPECT_EQ(scene.missed.deep, std::vector<std::uint32_t>{0});
    }
}

TEST(MissedOverlaps, AreLookedForOnlyWhereASweepTouched) {
    CubeAtFork slow(0.02, 0.8 * k_sweep_m, {});
    slow.add_contact();
    slow.find();
    EXPECT_TRUE(slow.missed.deep.empty());  // its contacts were found at the end pose
    CubeAtFork untouched(0.02, 0.3, {});
    untouched.find();
    EXPECT_TRUE(untouched.missed.deep.empty());
    CubeAtFork beside(-0.01, 0.3, {});
    beside.add_contact();
    beside.find();
    EXPECT_TRUE(beside.missed.deep.empty());
}

}  // namespace
}  // namespace handhold::missed_overlaps_test
