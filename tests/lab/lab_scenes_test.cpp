// The claims of each scene about the runtime, at the design's goals where today's solver meets
// them. Expected values are the scenes' closed forms.
#include <algorithm>
#include <cmath>

#include "lab_files.hpp"
#include "tools/lab/lab_scene.hpp"

namespace handhold::lab::lab_scenes_test {
namespace {

using Json = nlohmann::json;

double worst(const Json& json, const char* figure) { return json[figure]["max"].get<double>(); }
double claim(const Json& json, const char* figure) {
    return json["scene_figures"].at(figure).get<double>();
}

class LabScenes : public LabTest {};

TEST_F(LabScenes, JointsHoldWithBothKindsOfHolders) {
    for (const std::string_view name : scene_names()) {
        for (const char* holder : {"player", "kinematic"}) {
            if (std::string(holder) == "kinematic" && make_scene(name, {}).needs_player) {
                continue;
            }
            SolveOptions run_options = options(std::string(name), name == "hub" ? 20 : 90);
            run_options.holder = holder;
            const Json json = solve(run_options);
            SCOPED_TRACE(std::string(name) + " " + holder);
            EXPECT_LE(worst(json, "joint_error_mm"), 1e-3);
            EXPECT_LE(worst(json, "joint_error_deg"), 1e-4);
            EXPECT_EQ(worst(json, "player_error_mm"), 0.0);
        }
    }
}

TEST_F(LabScenes, ChainsOfAnyMassesHoldWithoutMovingPlayers) {
    for (const std::string_view masses : mass_patterns()) {
        for (const int links : {8, 33}) {
            SolveOptions run_options = options("chain", 120);
            run_options.links = links;
            run_options.masses = masses;
            const Json json = solve(run_options);
            SCOPED_TRACE(std::string(masses));
            EXPECT_LE(worst(json, "joint_error_mm"), 1e-3);
            EXPECT_LE(worst(json, "grab_error_mm"), 1e-3);
            EXPECT_EQ(worst(json, "player_error_mm"), 0.0);
        }
    }
}

// A hand that jumps by a metre, and a ring in free space.
TEST_F(LabScenes, JumpingHandsAndRingsHoldWithoutMovingPlayers) {
    for (const std::string_view masses : mass_patterns()) {
        for (const int links : {16, 64, 128}) {
            for (const char* scene : {"teleport", "ring"}) {
                SolveOptions run_options = options(scene, 100);
                run_options.links = links;
                run_options.masses = masses;
                const Json json = solve(run_options);
                SCOPED_TRACE(std::string(scene) + " " + std::string(masses) + " " +
                             std::to_string(links));
                EXPECT_LE(worst(json, "joint_error_mm"), 1e-3);
                EXPECT_LE(worst(json, "grab_error_mm"), 1e-3);
                EXPECT_EQ(worst(json, "player_error_mm"), 0.0);
            }
        }
    }
}

// Every scene and every mass pattern with all four solvers: each runs, or names what it cannot
// express. The runtime's solver satisfies the joints; the baselines move the player of a reachable
// chain.
TEST_F(LabScenes, EverySceneHasBodiesAndFiguresByDefault) {
    for (const std::string_view scene : scene_names()) {
        SCOPED_TRACE(scene);
        EXPECT_FALSE(make_scene(scene, {}).bodies.empty());
        const Json json = solve(options(std::string(scene), 60));
        for (const auto& [name, value] : json["scene_figures"].items()) {
            EXPECT_TRUE(value.is_number()) << name;
        }
    }
}

TEST_F(LabScenes, EverySceneRunsWithEverySolver) {
    const auto run = [&](SolveOptions run_options, const std::string& solver) {
        run_options.solver = solver;
        const Json json = solve(run_options);
        EXPECT_EQ(json["solver"], solver);
        EXPECT_EQ(json["scene"], run_options.scene);
        EXPECT_TRUE(std::isfinite(worst(json, "joint_error_mm")));
        EXPECT_TRUE(solver != "direct" || worst(json, "joint_error_mm") <= 1e-3);
        return json;
    };
    for (const std::string_view scene : scene_names()) {
        SolveOptions run_options = options(std::string(scene), 12);
        run_options.links = 12;
        for (const std::string& solver : solver_names()) {
            SCOPED_TRACE(run_options.scene + " " + solver);
            if (solver == "bullet" && !make_scene(scene, {}).beyond_bullet.empty()) {
                run_options.solver = solver;
                EXPECT_EQ(solve_command(run_options), 1);
            } else {
                run(run_options, solver);
            }
        }
    }
    for (const std::string_view masses : mass_patterns()) {
        SolveOptions run_options = options("chain", 100);
        run_options.masses = masses;
        for (const std::string& solver : solver_names()) {
            SCOPED_TRACE(std::string(masses) + " " + solver);
            const double player_mm = worst(run(run_options, solver), "player_error_mm");
            EXPECT_TRUE(solver == "direct" ? player_mm == 0.0 : player_mm > 1.0) << player_mm;
        }
    }
}

TEST_F(LabScenes, JointedBodiesHoldWhenPulledBeyondTheirRange) {
    for (const char* scene : {"lever", "drawer", "door"}) {
        const Json json = solve(scene, 900);
        SCOPED_TRACE(scene);
        EXPECT_LE(worst(json, "joint_error_mm"), 1e-3);
        EXPECT_LE(worst(json, "joint_error_deg"), 1e-4);
        EXPECT_LE(worst(json, "grab_error_mm"), 1e-3);
        EXPECT_EQ(worst(json, "player_error_mm"), 0.0) << "while they can follow";
    }
    EXPECT_LE(claim(solve("lever", 900), "push_back_error_mm"), 1e-3);
}

TEST_F(LabScenes, WallsPushBackInTheSameFrame) {
    for (const char* scene : {"shove", "shove_mesh", "step", "lean_in"}) {
        const Json json = solve(scene);
        SCOPED_TRACE(scene);
        EXPECT_LE(worst(json, "penetration_mm"), 1e-3);
        EXPECT_LE(claim(json, "push_back_error_mm"), 1e-3);
        EXPECT_EQ(worst(json, "player_error_mm"), 0.0) << "before the wall";
    }
}

// Figures of larger heaps: docs/reference/lab.md.
TEST_F(LabScenes, HeapsOverlapByLessThanAMillimetreAndKeepTheHandExact) {
    for (const int crates : {8, 27}) {
        SolveOptions run_options = options("heap", 120);
        run_options.links = crates;
        const Json json = solve(run_options);
        SCOPED_TRACE(crates);
        EXPECT_LE(claim(json, "overlap_mm"), 1.0);
        EXPECT_LE(worst(json, "penetration_mm"), 1.0);
        EXPECT_LE(worst(json, "grab_error_mm"), 1e-3);
    }
}

TEST_F(LabScenes, OpposingHandsShareTheErrorEqually) {
    EXPECT_LE(claim(solve("contradict"), "share_error_mm"), 1e-3);
    EXPECT_LE(claim(solve("two_players"), "push_back_error_mm"), 1e-3);
}

// A hand that releases may move the head by 0.01 mm in that frame. Expected: the closed form.
TEST_F(LabScenes, ClimbersHeadsFollowTheirHands) {
    const Json json = solve("climb", 900);
    EXPECT_LE(claim(json, "head_path_one_hand_mm"), 1e-3);
    EXPECT_LE(claim(json, "head_path_two_hands_mm"), 1e-3);
    EXPECT_LE(claim(json, "head_jump_mm"), 0.01);
}

TEST_F(LabScenes, FirstHandOnAFreeBarHasNoError) {
    const Json json = solve("two_hands");
    EXPECT_LE(claim(json, "first_hand_error_mm"), 1e-3);
    EXPECT_LE(claim(json, "second_hand_beside_line_mm"), 1e-3);
    EXPECT_LE(worst(json, "grab_error_mm"), 2.0 + 1e-3)
        << "the second hand slides by the change of distance";
}

TEST_F(LabScenes, JamErrorIsSharedByBothWallsWithoutJitter) {
    const Json json = solve("jam");
    EXPECT_NEAR(claim(json, "jam_gap_left_mm"), 10.0, 1.0);
    EXPECT_NEAR(claim(json, "jam_gap_right_mm"), 10.0, 1.0);
    EXPECT_LE(claim(json, "still_mps"), 1e-6);
}

// A tenth of the solver's tolerance: the remaining hand error is corrected once more.
TEST_F(LabScenes, HandsOnShipsLagLessThanTheSolversTolerance) {
    for (const char* scene : {"ship_kinematic", "ship_dynamic"}) {
        EXPECT_LE(claim(solve(scene, 900), "ship_lag_mm"), 1e-5) << scene;
    }
}

TEST_F(LabScenes, MomentumIsConservedInClosedScenes) {
    for (const char* scene : {"throw", "push_off", "ship_dynamic"}) {
        EXPECT_LE(solve(scene)["momentum_residual"].get<double>(), 1e-9) << scene;
    }
    const Json pushed = solve("push_off");
    EXPECT_LE(claim(pushed, "push_off_crate_error_mps"), 1e-9);
    EXPECT_LE(claim(pushed, "push_off_player_error_mps"), 1e-9);
    const Json thrown = solve("throw");
    EXPECT_LE(claim(thrown, "throw_speed_error_mps"), 1e-6);
    EXPECT_LE(claim(thrown, "throw_spin_error_radps"), 1e-6);
}

TEST_F(LabScenes, BouncesAndSlidesFollowTheirClosedForms) {
    EXPECT_LE(claim(solve("bounce"), "restitution_error"), 1e-9);
    const Json slid = solve("slide");
    EXPECT_LE(claim(slid, "sliding_error_mm"), claim(slid, "sliding_step_mm"));
}

// Within the tolerance of a sweep, a tenth of 5 mm, at slow speeds.
TEST_F(LabScenes, ImpactsOfBallsFollowNewtonsLaw) {
    const Json json = solve("impact", 60);
    EXPECT_LE(claim(json, "impact_velocity_error"), 0.06);
    EXPECT_LE(json["momentum_residual"].get<double>(), 1e-9);
}

TEST_F(LabScenes, DebrisKeepsMomentumGainsNoEnergyAndDoesNotOverlap) {
    SolveOptions run_options = options("debris", 270);
    run_options.links = 64;
    const Json json = solve(run_options);
    EXPECT_LE(claim(json, "energy_gain"), 1e-6);
    EXPECT_LE(claim(json, "overlap_mm"), 1.0);
    EXPECT_LE(json["momentum_residual"].get<double>(), 1e-9);
}

TEST_F(LabScenes, OverlappingBoxesComeApartWithoutSpeed) {
    SolveOptions run_options = options("overlap", 200);
    run_options.links = 40;
    const Json json = solve(run_options);
    EXPECT_LE(claim(json, "speed_mps"), 1e-6);
    EXPECT_LE(claim(json, "overlap_left_mm"), 1.0);
}

// A player leaves a shove no faster than their own hand pushed them.
TEST_F(LabScenes, PlayersLeaveAShoveAtTheSpeedOfTheirHand) {
    for (const char* scene : {"shove", "shove_mesh"}) {
        const Json json = solve(scene, 270);
        EXPECT_LE(claim(json, "drift_mps"), claim(json, "drift_expected_mps") + 1e-6) << scene;
        EXPECT_GE(claim(json, "drift_mps"), 0.95 * claim(json, "drift_expected_mps")) << scene;
    }
}

TEST_F(LabScenes, BaselineSolversLeaveLargerErrors) {
    SolveOptions run_options = options("chain", 120);
    run_options.holder = "kinematic";
    const double direct_mm = worst(solve(run_options), "joint_error_mm");
    for (const char* solver : {"plain", "sweep", "bullet"}) {
        run_options.solver = solver;
        EXPECT_GT(worst(solve(run_options), "joint_error_mm"), 100.0 * direct_mm) << solver;
    }
}

TEST_F(LabScenes, ResidualFallsWithEachIteration) {
    SolveOptions run_options = options("chain", 40);
    run_options.residual_frame = 30;
    for (const char* solver : {"direct", "plain"}) {
        run_options.solver = solver;
        const Json json = solve(run_options);
        const auto curve = json["residual_per_iteration"].get<std::vector<double>>();
        ASSERT_GE(curve.size(), 3U);
        EXPECT_LT(curve.back(), 0.1 * curve.front()) << solver;
        EXPECT_TRUE(std::is_sorted(curve.rbegin(), curve.rend())) << solver;
    }
    run_options.solver = "bullet";
    EXPECT_EQ(solve(run_options)["residual_per_iteration"].size(), 50U);
}

}  // namespace
}  // namespace handhold::lab::lab_scenes_test
