// What solve_phases passes to the solver, and which results it counts.
#include "systems/physics/solve_phases.hpp"

#include <array>

#include <gtest/gtest.h>

#include "engine/geometry/shape_library.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::solve_phases_test {
namespace {

NewtonSettings g_settings;
NewtonResult g_result;

NewtonResult fake_solver(const IslandView& /*island*/, const NewtonSettings& settings,
                         SolveScratch& /*scratch*/) {
    g_settings = settings;
    return g_result;
}

// A free body joined to a fixed one: one island.
struct Phases {
    ShapeLibrary shapes;
    CollisionWorld collision{shapes};
    FrameGraph frame;
    Tuning tuning;
    StageStats stats;

    Phases() {
        SolverBody loose;
        loose.id = 2;
        loose.role = BodyRole::free;
        loose.mass_kg = 1.0;
        loose.inertia_kgm2 = Vec3::Ones();
        frame.graph.bodies = {SolverBody{}, loose};
        RowBlock joint;
        joint.kind = RowKind::ball;
        joint.a = 0;
        joint.b = 1;
        frame.graph.blocks = {joint};
        frame.phase.resize(2);
        frame.proxies.resize(2);
        build_islands(frame.graph);
        for (SolverBody& body : frame.graph.bodies) {
            body.inverse_mass = body.mass_kg > 0.0 ? 1.0 / body.mass_kg : 0.0;
        }
    }
    void solve() {
        solve_phases_with(&fake_solver, {.collision = collision, .frame = frame}, tuning, stats);
    }
};

TEST(SolvePhases, CountsLoadSteppingByItsResult) {
    const auto counted = [](LoadStepping load_stepping) {
        g_result = {};
        g_result.converged = true;
        g_result.load_stepping = load_stepping;
        Phases phases;
        phases.solve();
        return std::array{test::count_of(phases.stats, Fallback::hands_load_stepped),
                          test::count_of(phases.stats, Fallback::load_stepping_failed)};
    };
    EXPECT_EQ(counted(LoadStepping::none), (std::array<std::uint64_t, 2>{0, 0}));
    EXPECT_EQ(counted(LoadStepping::converged), (std::array<std::uint64_t, 2>{1, 0}));
    EXPECT_EQ(counted(LoadStepping::failed), (std::array<std::uint64_t, 2>{0, 1}));
}

TEST(SolvePhases, SettingsOfTheTuningReachTheSolver) {
    g_result = {};
    g_result.converged = true;
    Phases phases;
    phases.tuning.solver.positions.max_iterations = 7;
    phases.tuning.solver.positions.schedule.min_step_scale = 0.125;
    phases.solve();
    EXPECT_EQ(g_settings.max_iterations, 7);
    EXPECT_EQ(g_settings.schedule.min_step_scale, 0.125);
}

}  // namespace
}  // namespace handhold::solve_phases_test
