#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/solver/newton/load_stepped_drives.hpp"
#include "engine/solver/newton/newton.hpp"
#include "tests/engine/solver/newton/uneven_chain.hpp"

namespace handhold::solver_load_stepping_test {
namespace {

using test::Random;
using test::SolverScene;

bool is_same(const RowBlock& a, const RowBlock& b) {
    return a.point_a_bs == b.point_a_bs && a.rotation_a_bs.coeffs() == b.rotation_a_bs.coeffs() &&
           a.point_b_bs == b.point_b_bs && a.rotation_b_bs.coeffs() == b.rotation_b_bs.coeffs();
}

RC_GTEST_PROP(LoadSteppedDrives, WithheldShareOfTheErrorIsNotAskedFor, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene;
    scene.graph.bodies = {test::translating_body(1, 80.0, test::random_pose(random)),
                          test::random_free_body(2, random)};
    const bool is_weld = random.between(0.0, 1.0) < 0.5;
    scene.graph.blocks = {
        test::random_block(is_weld ? RowKind::drive_weld : RowKind::drive_point, 0, 1, random)};
    build_islands(scene.graph);
    const IslandView island = scene.view(scene.graph.islands.front());
    const RowBlock taken = scene.block(0);
    const auto point_error_m = [&] {
        return point_error(scene.graph.bodies, scene.block(0)).norm();
    };
    const auto rotation_error_rad = [&] {
        return rotation_error(scene.body(0).pose_ws.rotation, scene.body(1).pose_ws.rotation,
                              scene.block(0))
            .norm();
    };
    const double initial_m = point_error_m();
    const double initial_rad = rotation_error_rad();
    LoadSteppedDrives load_stepped;
    load_stepped.take(island);
    for (const double share : {1.0, 0.75, 0.25}) {
        load_stepped.withhold_load(island, share);
        RC_ASSERT(std::abs(point_error_m() - (1.0 - share) * initial_m) < 1e-12);
        RC_ASSERT(!is_weld || std::abs(rotation_error_rad() - (1.0 - share) * initial_rad) < 1e-9);
    }
    load_stepped.withhold_load(island, 0.0);
    RC_ASSERT(is_same(scene.block(0), taken));
}

// The drive's target is to the side, at `reach` times the chain's length.
SolverScene chain_to(double reach) {
    constexpr std::uint32_t k_links = 16;
    const Vec3 target =
        reach * 2.0 * test::k_half_link_m * k_links * Vec3(1.0, 2.0, 0.0).normalized();
    return test::uneven_chain(k_links, RowKind::ball, target);
}

double worst_error_m(const SolverScene& scene) {
    double worst_m = 0.0;
    for (std::size_t i = 0; i < scene.graph.blocks.size(); ++i) {
        worst_m = std::max(worst_m, scene.error_m(i));
    }
    return worst_m;
}

// With fewer iterations than the full load needs, but enough for one load step.
TEST(SolvePositions, DriveThatRunsOutOfIterationsIsLoadStepped) {
    SolverScene scene = chain_to(0.8);
    build_islands(scene.graph);
    const std::vector<RowBlock> blocks = scene.graph.blocks;
    NewtonSettings settings = test::tight_settings();
    settings.max_iterations = 12;
    const NewtonResult result = scene.solve_positions(settings);
    EXPECT_EQ(result.load_stepping, LoadStepping::converged);
    EXPECT_TRUE(result.converged);
    EXPECT_GT(result.iterations, settings.max_iterations);
    EXPECT_LT(worst_error_m(scene), 2.0 * settings.tolerance_m);
    EXPECT_TRUE(std::equal(blocks.begin(), blocks.end(), scene.graph.blocks.begin(), &is_same));
    SolverScene full_load = chain_to(0.8);
    settings.max_iterations = 200;
    const NewtonResult with_more = full_load.solve_positions(settings);
    EXPECT_EQ(with_more.load_stepping, LoadStepping::none);
    EXPECT_TRUE(with_more.converged);
}

TEST(SolvePositions, FailedLoadSteppingRestoresTheFullLoadResult) {
    SolverScene scene = chain_to(1.5);
    build_islands(scene.graph);
    const std::vector<RowBlock> blocks = scene.graph.blocks;
    NewtonSettings settings = test::tight_settings();
    settings.max_iterations = 8;
    const NewtonResult result = scene.solve_positions(settings);
    EXPECT_EQ(result.load_stepping, LoadStepping::failed);
    EXPECT_FALSE(result.converged);
    EXPECT_GT(result.iterations, settings.max_iterations);
    EXPECT_LE(result.iterations, 5 * settings.max_iterations);
    EXPECT_NEAR(worst_error_m(scene), result.residual_m, 1e-12);
    EXPECT_TRUE(std::equal(blocks.begin(), blocks.end(), scene.graph.blocks.begin(), &is_same));
}

// No number of iterations reaches the target of a drive that overstretches its rope. Load steps
// would cost time in every frame.
TEST(SolvePositions, TautRopeIsNotLoadStepped) {
    for (const double beyond_m : {0.001, 0.02, 0.2}) {
        SolverScene scene = chain_to(1.0 + beyond_m / 1.6);
        build_islands(scene.graph);
        NewtonSettings settings = test::tight_settings();
        settings.max_iterations = 300;
        settings.load_stepping_from_m = std::numeric_limits<double>::infinity();
        scene.solve_positions(settings);  // the state left by earlier frames
        settings = test::tight_settings();
        for (int frame = 1; frame <= 5; ++frame) {
            scene.graph.blocks.back().point_a_bs *= 1.001;
            const NewtonResult result = scene.solve_positions(settings);
            EXPECT_FALSE(result.converged) << beyond_m;
            EXPECT_EQ(result.load_stepping, LoadStepping::none) << beyond_m;
            EXPECT_LE(result.iterations, settings.max_iterations) << beyond_m;
        }
    }
}

}  // namespace
}  // namespace handhold::solver_load_stepping_test
