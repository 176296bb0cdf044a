// What the body that follows one player's head and hands costs.
#include <array>
#include <cmath>

#include <benchmark/benchmark.h>

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/player.hpp"
#include "components/spine.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"
#include "systems/arm/estimate_arms.hpp"
#include "systems/arm/pose_arms.hpp"
#include "systems/body/propagate_spine.hpp"

namespace handhold::body_bench {
namespace {

constexpr double k_dt_s = 1.0 / 90.0;
constexpr Entity k_player{0, 1};
constexpr std::array<Entity, k_hand_count> k_hands = {Entity{1, 1}, Entity{2, 1}};

// One player who sways and turns, with both hands going round beside him.
struct Body {
    Column<PlayerOrigin> origin;
    Column<PlayerVelocity> velocity;
    Column<ReferenceVelocity> reference;
    Column<HeadTracking> head;
    Column<BodyMeasures> measures;
    Column<HandOwner> owner;
    Column<PalmPose> palm;
    Column<ArmMemory> arm_memory;
    Column<ArmEstimate> estimate;
    Column<ArmPose> arms;
    Column<SpineMemory> spine_memory;
    Column<SpinePose> spine;
    double t_s = 0.0;

    Body() {
        origin.add(k_player);
        velocity.add(k_player);
        reference.add(k_player);
        head.add(k_player);
        measures.add(k_player);
        arm_memory.add(k_player);
        estimate.add(k_player);
        arms.add(k_player);
        spine_memory.add(k_player);
        spine.add(k_player);
        owner.add(k_hands[0], {k_player, HandSide::left});
        owner.add(k_hands[1], {k_player, HandSide::right});
        palm.add(k_hands[0]);
        palm.add(k_hands[1]);
    }
    void move() {
        t_s += k_dt_s;
        head.at(k_player).pose_ps = {Vec3(0.05 * std::sin(t_s), 1.6, 0.0),
                                     rotation_about(Vec3::UnitY(), 0.6 * std::sin(0.7 * t_s))};
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const double out = side == 0 ? -1.0 : 1.0;
            palm.at(k_hands[side]).pose_ws = {
                Vec3(0.3 * out + 0.2 * std::sin(2.0 * t_s), 1.3 + 0.3 * std::sin(1.3 * t_s),
                     -0.25 + 0.2 * std::cos(2.0 * t_s)),
                rotation_about(Vec3::UnitX(), 0.5 * std::sin(t_s))};
        }
        velocity.at(k_player).linear_mps = Vec3(std::sin(t_s), 0.0, 2.0 * std::cos(0.9 * t_s));
    }
    void run_estimate() {
        estimate_arms({k_dt_s, origin, head, measures, owner, palm, arm_memory, estimate}, {});
    }
    void run_pose() { pose_arms({origin, measures, owner, palm, estimate, arms}); }
    void run_spine() {
        propagate_spine(
            {k_dt_s, t_s, origin, velocity, reference, measures, estimate, spine_memory, spine},
            {});
    }
};

// Of each frame only `run` counts; moving the player (some 100 ns) is measured beside it, alone.
template <typename Run>
void frames(benchmark::State& state, Run run) {
    Body body;
    for (int i = 0; i < 90; ++i) {
        body.move();
        body.run_estimate();
        body.run_pose();
        body.run_spine();
    }
    for (auto _ : state) {
        body.move();
        run(body);
    }
    benchmark::DoNotOptimize(body.spine.at(k_player));
}

BENCHMARK_CAPTURE(frames, nothing, [](Body&) {})->Name("body/moving_the_player_alone");
BENCHMARK_CAPTURE(frames, estimate, [](Body& b) { b.run_estimate(); })->Name("body/estimate_arms");
BENCHMARK_CAPTURE(frames, pose, [](Body& b) { b.run_pose(); })->Name("body/pose_arms");
BENCHMARK_CAPTURE(frames, spine, [](Body& b) { b.run_spine(); })->Name("body/propagate_spine");
BENCHMARK_CAPTURE(frames, whole, [](Body& b) {
    b.run_estimate();
    b.run_pose();
    b.run_spine();
})->Name("body/whole");

}  // namespace
}  // namespace handhold::body_bench
