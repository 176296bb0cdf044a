#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/solver/triad_system.hpp"
#include "solver_scene.hpp"

namespace handhold {
namespace {

using test::Random;
using test::SolverScene;

constexpr double k_same_m = 1e-7;  // or radians; a step is 1 cm
constexpr double k_touch_m = std::numeric_limits<double>::infinity();

std::uint32_t random_index(std::uint32_t count, Random& random) {
    return static_cast<std::uint32_t>(random.engine()() % count);
}

// A tree of balls, welds and hands on a fixed body, some of its bodies tied twice.
SolverScene random_tree(Random& random) {
    SolverScene scene;
    const std::uint32_t count = 3 + random_index(12, random);
    scene.graph.bodies = {test::fixed_body(1, test::random_pose(random))};
    for (std::uint32_t i = 1; i < count; ++i) {
        scene.graph.bodies.push_back(test::random_free_body(i + 1, random));
    }
    scene.graph.bodies.push_back(test::player_body(count + 1, 80.0, test::random_pose(random)));
    const auto tie = [&](RowKind kind, std::uint32_t a, std::uint32_t b) {
        RowBlock block = test::random_block(kind, a, b, random);
        block.key = scene.graph.blocks.size();
        test::meet(scene.graph.bodies, block);
        scene.graph.blocks.push_back(block);
    };
    tie(RowKind::ball, 0, 1);
    for (std::uint32_t i = 2; i < count; ++i) {
        const RowKind kind = random_index(4, random) == 0 ? RowKind::fixed : RowKind::ball;
        tie(kind, i - 1 - random_index(2, random), i);
    }
    if (random_index(2, random) == 0 && count > 4) {
        tie(RowKind::ball, 1, count - 1);
    }
    tie(random_index(2, random) == 0 ? RowKind::hand_point : RowKind::hand_weld, count, count - 1);
    sort_blocks(scene.graph);
    build_islands(scene.graph);
    return scene;
}

bool loads(SolverScene& scene, double touch_m = k_touch_m) {
    build_islands(scene.graph);
    TriadSystem system;
    return system.load(scene.view(scene.graph.islands.front()), touch_m);
}

// One that is served.
SolverScene random_island(Random& random) {
    for (;;) {
        SolverScene scene = random_tree(random);
        if (loads(scene)) {
            return scene;
        }
    }
}

void disturb(SolverScene& scene, double size, Random& random) {
    for (SolverBody& body : scene.graph.bodies) {
        if (body.role == BodyRole::free) {
            body.pose_ws.position += random.vector(0.1 * size);
            body.pose_ws.rotation =
                (rotation_from_vector(random.vector(size)) * body.pose_ws.rotation).normalized();
        }
        if (body.role != BodyRole::fixed) {
            body.velocity_mps = random.vector(1.0);
            body.spin_radps = random.vector(body.role == BodyRole::free ? 5.0 : 0.0);
        }
    }
}

// The same equations, but one joint could stop somewhere that it never gets to: TriadSystem does
// not serve it.
SolverScene solved_by_rows(const SolverScene& scene) {
    SolverScene rows;
    rows.graph = scene.graph;
    for (RowBlock& block : rows.graph.blocks) {
        if (block.kind == RowKind::ball) {
            block.joint.limited = true;
            block.joint.upper = 10.0;
            break;
        }
    }
    return rows;
}

SolverScene hanging_ball() {
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1), test::ball(2, 1.0, 0.1)};
    scene.graph.blocks = {test::row_block(RowKind::ball, 0, 1)};
    return scene;
}

// --- The same answers as row by row
// ---------------------------------------------------------------

RC_GTEST_PROP(Triads, MoveBodiesAsRowsOneByOneDo, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene = random_island(random);
    disturb(scene, 0.01, random);
    SolverScene rows = solved_by_rows(scene);
    RC_ASSERT(!loads(rows));
    NewtonSettings step;
    step.max_iterations = 1;
    scene.solve_positions(step);
    rows.solve_positions(step);
    for (std::size_t i = 0; i < scene.graph.bodies.size(); ++i) {
        const Pose& one = scene.body(i).pose_ws;
        const Pose& other = rows.body(i).pose_ws;
        RC_ASSERT((one.position - other.position).norm() < k_same_m);
        RC_ASSERT(rotation_to_vector(one.rotation * other.rotation.conjugate()).norm() < k_same_m);
    }
}

RC_GTEST_PROP(Triads, GiveVelocitiesAndImpulsesAsRowsOneByOneDo, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene = random_island(random);
    disturb(scene, 0.0, random);
    for (RowBlock& block : scene.graph.blocks) {
        if (is_hand(block)) {
            block.drive_velocity_ws_mps = random.vector(1.0);
            block.drive_spin_ws_radps = random.vector(1.0);
        }
    }
    SolverScene rows = solved_by_rows(scene);
    scene.solve_velocities();
    rows.solve_velocities();
    for (std::size_t i = 0; i < scene.graph.bodies.size(); ++i) {
        RC_ASSERT((scene.body(i).velocity_mps - rows.body(i).velocity_mps).norm() < 1e-5);
        RC_ASSERT((scene.body(i).spin_radps - rows.body(i).spin_radps).norm() < 1e-5);
    }
    // Who of two that tie the same bodies takes how much is a matter of softness: of some 10 N s.
    for (std::size_t i = 0; i < scene.graph.blocks.size(); ++i) {
        RC_ASSERT((scene.block(i).impulse_ws_ns - rows.block(i).impulse_ws_ns).norm() < 0.01);
        RC_ASSERT((scene.block(i).couple_ws_nms - rows.block(i).couple_ws_nms).norm() < 0.01);
    }
}

// --- The same bits on every processor
// -------------------------------------------------------------

void solve_a_step(TriadSystem& system, const IslandView& island) {
    ASSERT_TRUE(system.load(island, k_touch_m));
    for (int step = 0; step < 2; ++step) {
        system.evaluate(island);
        if (step > 0) {
            system.gather_stiffness();
        }
        system.factorise({}, 1.0);
        system.solve();
        system.apply_moves(0.9);
    }
    system.store_poses(island);
    system.evaluate_velocities(island);
    system.solve();
    system.apply_impulses(island);
    system.store_velocities(island);
}

TEST(Triads, HaveTheSameBitsWithAndWithoutAvx2) {
    if (&triad_kernels() == &portable_triad_kernels()) {
        GTEST_SKIP() << "this processor has no AVX2";
    }
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SolverScene fast = random_island(random);
        disturb(fast, 0.05, random);
        SolverScene portable;
        portable.graph = fast.graph;
        TriadSystem fast_system(triad_kernels());
        TriadSystem portable_system(portable_triad_kernels());
        solve_a_step(fast_system, fast.view(fast.graph.islands.front()));
        solve_a_step(portable_system, portable.view(portable.graph.islands.front()));
        for (std::size_t i = 0; i < fast.graph.bodies.size(); ++i) {
            EXPECT_EQ(fast.body(i).pose_ws.position, portable.body(i).pose_ws.position);
            EXPECT_EQ(fast.body(i).pose_ws.rotation.coeffs(),
                      portable.body(i).pose_ws.rotation.coeffs());
            EXPECT_EQ(fast.body(i).velocity_mps, portable.body(i).velocity_mps);
            EXPECT_EQ(fast.body(i).spin_radps, portable.body(i).spin_radps);
        }
        for (std::size_t i = 0; i < fast.graph.blocks.size(); ++i) {
            EXPECT_EQ(fast.block(i).impulse_ws_ns, portable.block(i).impulse_ws_ns);
            EXPECT_EQ(fast.block(i).couple_ws_nms, portable.block(i).couple_ws_nms);
        }
    }
}

// --- What is served
// ---------------------------------------------------------------------------------

TEST(Triads, DoNotServeWhatMayLetGoSlideOrStop) {
    SolverScene scene = hanging_ball();
    EXPECT_TRUE(loads(scene));
    scene.block(0).joint.friction_impulse = 1.0;
    EXPECT_FALSE(loads(scene));
    scene.block(0).joint = {};
    scene.block(0).joint.limited = true;
    EXPECT_FALSE(loads(scene));
    for (const RowKind kind : {RowKind::hinge, RowKind::slider, RowKind::distance}) {
        scene.block(0) = test::row_block(kind, 0, 1);
        EXPECT_FALSE(loads(scene));
    }
}

TEST(Triads, LeaveOutContactsThatAreApart) {
    SolverScene scene = hanging_ball();
    RowBlock contact = test::row_block(RowKind::contact, 1, 0, Vec3(0.0, 0.01, 0.0));
    contact.key = 1;
    scene.graph.blocks.push_back(contact);
    sort_blocks(scene.graph);
    EXPECT_TRUE(loads(scene, 0.005));
    EXPECT_FALSE(loads(scene, 0.02));
    EXPECT_FALSE(loads(scene));  // positions may bring it near
}

TEST(Triads, LeaveManyJointsOnOneBodyToHubs) {
    SolverScene scene;
    scene.graph.bodies = {test::ball(1, 5.0, 0.3)};
    for (std::uint32_t i = 1; i <= 5; ++i) {
        scene.graph.bodies.push_back(test::ball(i + 1, 1.0, 0.1));
        scene.graph.blocks.push_back(test::row_block(RowKind::ball, 0, i));
        EXPECT_EQ(loads(scene), i <= k_hub_nodes);
    }
}

// Of many that nothing moves each stands for itself.
TEST(Triads, HoldABodyOnSeveralFixedOnes) {
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1, {Vec3(1.0, 0.0, 0.0), Quat::Identity()}),
                          test::fixed_body(2, {Vec3(0.0, 2.0, 0.0), Quat::Identity()}),
                          test::free_body(3, 2.0, Vec3(0.1, 0.2, 0.3))};
    scene.graph.blocks = {test::row_block(RowKind::ball, 0, 2, Vec3::Zero(), Vec3(1.0, 0.0, 0.0)),
                          test::row_block(RowKind::ball, 1, 2, Vec3::Zero(), Vec3(0.0, 2.0, 0.0))};
    scene.body(2).pose_ws = {Vec3(0.02, -0.01, 0.03), rotation_from_vector(Vec3(0.1, 0.05, 0.2))};
    EXPECT_TRUE(loads(scene));
    EXPECT_TRUE(scene.solve_positions().converged);
    EXPECT_LT(scene.error_m(0), 1e-8);
    EXPECT_LT(scene.error_m(1), 1e-8);
}

// Rows that repeat others get no share, or share what there is: nothing grows out of bounds.
TEST(Triads, ThatRepeatEachOtherStayFinite) {
    SolverScene scene = hanging_ball();
    for (std::uint64_t i = 1; i < 4; ++i) {
        scene.graph.blocks.push_back(scene.graph.blocks.front());
        scene.graph.blocks.back().key = i;
    }
    scene.body(1).pose_ws.position = Vec3(0.03, 0.02, 0.01);
    scene.body(1).velocity_mps = Vec3(1.0, 2.0, 3.0);
    EXPECT_TRUE(loads(scene));
    EXPECT_TRUE(scene.solve_positions().converged);
    scene.solve_velocities();
    EXPECT_LT(scene.error_m(0), 1e-8);
    EXPECT_LT(scene.body(1).velocity_mps.norm(), 1e-8);
    Vec3 impulse = Vec3::Zero();
    for (const RowBlock& block : scene.graph.blocks) {
        impulse += block.impulse_ws_ns;
    }
    EXPECT_LT((impulse - Vec3(1.0, 2.0, 3.0)).norm(), 1e-8);  // on the fixed body: a
}

}  // namespace
}  // namespace handhold
