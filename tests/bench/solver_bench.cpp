// One island through a whole step: predict, solve positions, solve velocities. The graph is built
// once; building it is not measured.
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/solver/model/islands.hpp"
#include "engine/solver/newton/newton.hpp"
#include "engine/solver/newton/velocities.hpp"

namespace handhold::solver_bench {
namespace {

constexpr double k_dt_s = 1.0 / 90.0;
constexpr double k_link_m = 0.1;

SolverBody link(std::uint64_t id, double mass_kg, const Vec3& position) {
    const Vec3 squares = Vec3(0.05, 0.02, 0.02).cwiseAbs2();
    SolverBody body;
    body.id = id;
    body.role = BodyRole::free;
    body.pose_ws.position = position;
    body.mass_kg = mass_kg;
    body.inertia_kgm2 = (mass_kg / 3.0) * (Vec3::Constant(squares.sum()) - squares);
    body.inverse_mass = 1.0 / mass_kg;
    body.inverse_inertia_bs = body.inertia_kgm2.cwiseInverse();
    return body;
}

RowBlock joint(RowKind kind, std::uint32_t a, std::uint32_t b, double point_a_m, double point_b_m) {
    RowBlock block;
    block.kind = kind;
    block.a = a;
    block.b = b;
    block.point_a_bs = Vec3(point_a_m, 0.0, 0.0);
    block.point_b_bs = Vec3(point_b_m, 0.0, 0.0);
    return block;
}

struct Step {
    ConstraintGraph graph;
    SolveScratch scratch;
    double t_s = 0.0;
    int iterations = 0;
    double residual_m = 0.0;

    void take() {
        for (SolverBody& body : graph.bodies) {
            if (body.role == BodyRole::free) {
                body.pose_ws.position += k_dt_s * body.velocity_mps;
                body.pose_ws.rotation =
                    (rotation_from_vector(k_dt_s * body.spin_radps) * body.pose_ws.rotation)
                        .normalized();
            }
        }
        for (const Island& island : graph.islands) {
            const IslandView view{BlockFilter::all, graph.bodies, graph.blocks,
                                  graph.bodies_of(island), graph.blocks_of(island)};
            NewtonSettings settings;
            settings.tolerance_m = 1e-7;  // the game's tolerance
            const NewtonResult result = solve_positions(view, settings, scratch);
            iterations += result.iterations;
            residual_m = std::max(residual_m, result.residual_m);
            solve_island_velocities(view, {}, scratch);
        }
        t_s += k_dt_s;
    }
};

// One end on the world, the other on a hand that swings by 30 cm at up to 1.5 m/s.
Step chain(std::uint32_t links) {
    Step step;
    std::vector<SolverBody>& bodies = step.graph.bodies;
    for (std::uint32_t i = 0; i < links; ++i) {
        // Zigzag: half as long as the stretched chain.
        bodies.push_back(link(i + 1, 1.0, Vec3(0.0, 0.0, 0.0)));
        const double angle = i % 2 == 0 ? 1.0 : -1.0;
        SolverBody& body = bodies.back();
        body.pose_ws.rotation = rotation_about(Vec3::UnitZ(), angle);
        const Vec3 half = body.pose_ws.rotation * Vec3(0.5 * k_link_m, 0.0, 0.0);
        const Vec3 end =
            i == 0 ? Vec3(Vec3::Zero())
                   : transform_point(bodies[i - 1].pose_ws, Vec3(0.5 * k_link_m, 0.0, 0.0));
        body.pose_ws.position = end + half;
    }
    SolverBody fixed;
    fixed.id = links + 1;
    bodies.push_back(fixed);
    SolverBody hand;
    hand.id = links + 2;
    hand.pose_ws.position =
        transform_point(bodies[links - 1].pose_ws, Vec3(0.5 * k_link_m, 0.0, 0.0));
    bodies.push_back(hand);
    step.graph.blocks.push_back(joint(RowKind::ball, 0, links, -0.5 * k_link_m, 0.0));
    for (std::uint32_t i = 1; i < links; ++i) {
        step.graph.blocks.push_back(
            joint(RowKind::ball, i - 1, i, 0.5 * k_link_m, -0.5 * k_link_m));
    }
    step.graph.blocks.push_back(
        joint(RowKind::drive_point, links - 1, links + 1, 0.5 * k_link_m, 0.0));
    sort_blocks(step.graph);
    build_islands(step.graph);
    return step;
}

// Bodies around a central one, each on a ball joint at its rim.
Step hub(std::uint32_t spokes) {
    Step step;
    step.graph.bodies.push_back(link(1, 20.0, Vec3::Zero()));
    step.graph.bodies[0].inertia_kgm2.setConstant(2.0);
    step.graph.bodies[0].inverse_inertia_bs.setConstant(0.5);
    for (std::uint32_t i = 0; i < spokes; ++i) {
        const double angle = 6.283 * i / spokes;
        const Quat rotation = rotation_about(Vec3::UnitZ(), angle);
        step.graph.bodies.push_back(link(i + 2, 1.0, rotation * Vec3(0.35, 0.0, 0.0)));
        step.graph.bodies.back().pose_ws.rotation = rotation;
        RowBlock block = joint(RowKind::ball, 0, i + 1, 0.0, -0.05);
        block.point_a_bs = rotation * Vec3(0.3, 0.0, 0.0);
        step.graph.blocks.push_back(block);
    }
    SolverBody hand;
    hand.id = spokes + 2;
    step.graph.bodies.push_back(hand);
    step.graph.blocks.push_back(joint(RowKind::drive_point, 0, spokes + 1, 0.0, 0.0));
    sort_blocks(step.graph);
    build_islands(step.graph);
    return step;
}

void run(benchmark::State& state, Step step) {
    SolverBody& hand = step.graph.bodies.back();
    const Vec3 start = hand.pose_ws.position;
    for (auto _ : state) {
        const double phase = 5.0 * step.t_s;
        double sine = 0.0;
        double cosine = 0.0;
        sin_cos(std::fmod(phase, 6.283185307179586), sine, cosine);
        hand.pose_ws.position = start + Vec3(0.15 * sine, 0.3 * (1.0 - cosine), 0.0);
        hand.velocity_mps = Vec3(0.75 * cosine, 1.5 * sine, 0.0);
        step.take();
    }
    const auto frames = static_cast<double>(state.iterations());
    state.counters["newton_iterations"] = static_cast<double>(step.iterations) / frames;
    state.counters["residual_nm"] = 1e9 * step.residual_m;
}

void run_chain(benchmark::State& state) {
    run(state, chain(static_cast<std::uint32_t>(state.range(0))));
}
void run_hub(benchmark::State& state) {
    run(state, hub(static_cast<std::uint32_t>(state.range(0))));
}

BENCHMARK(run_chain)
    ->Name("solver/chain")
    ->RangeMultiplier(4)
    ->Range(8, 2048)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(run_hub)->Name("solver/hub")->Arg(16)->Arg(64)->Arg(256)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace handhold::solver_bench
