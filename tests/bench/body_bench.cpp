// Cost of the bodies that follow players' heads and hands.
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>

#include <benchmark/benchmark.h>

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/player.hpp"
#include "components/spine.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"
#include "systems/body/estimate_arms.hpp"
#include "systems/body/pose_arms.hpp"
#include "systems/body/propagate_spine.hpp"

namespace handhold::body_bench {
namespace {

constexpr double k_dt_s = 1.0 / 90.0;

// Players who sway and turn with individual phases, both hands circling beside them.
struct Bodies {
    Column<PlayerOrigin> origin;
    Column<PlayerVelocity> velocity;
    Column<ReferenceVelocity> reference;
    Column<HeadTracking> head;
    Column<BodyMeasures> measures;
    Column<HandOwner> owner;
    Column<PalmPose> palm;
    Column<PersistentId> no_ids;
    Column<Grab> no_grips;
    Column<BodyHold> no_holds;
    Column<ArmMemory> arm_memory;
    Column<ArmEstimate> estimate;
    Column<ArmPose> arms;
    Column<SpineMemory> spine_memory;
    Column<SpinePose> spine;
    double t_s = 0.0;

    explicit Bodies(std::size_t count) {
        // In add_player's order: a player, then both hands.
        for (std::uint32_t i = 0; i < count; ++i) {
            const Entity player{3 * i, 1};
            origin.add(player);
            velocity.add(player);
            reference.add(player);
            head.add(player);
            measures.add(player);
            arm_memory.add(player);
            estimate.add(player);
            arms.add(player);
            spine_memory.add(player);
            spine.add(player);
            for (const HandSide side : {HandSide::left, HandSide::right}) {
                const Entity hand{3 * i + 1 + static_cast<std::uint32_t>(index_of(side)), 1};
                owner.add(hand, {player, side});
                palm.add(hand);
            }
        }
    }
    void move() {
        t_s += k_dt_s;
        for (std::size_t i = 0; i < head.size(); ++i) {
            const double t = t_s + 0.37 * static_cast<double>(i);
            head.elements()[i].pose_ps = {Vec3(0.05 * std::sin(t), 1.6, 0.0),
                                          rotation_about(Vec3::UnitY(), 0.6 * std::sin(0.7 * t))};
            for (std::size_t side = 0; side < k_hand_count; ++side) {
                const double out = side == 0 ? -1.0 : 1.0;
                palm.elements()[k_hand_count * i + side].pose_ws = {
                    Vec3(0.3 * out + 0.2 * std::sin(2.0 * t), 1.3 + 0.3 * std::sin(1.3 * t),
                         -0.25 + 0.2 * std::cos(2.0 * t)),
                    rotation_about(Vec3::UnitX(), 0.5 * std::sin(t))};
            }
            velocity.elements()[i].linear_mps = Vec3(std::sin(t), 0.0, 2.0 * std::cos(0.9 * t));
        }
    }
    void run_estimate() {
        estimate_arms({.dt_s = k_dt_s,
                       .origin = origin,
                       .head = head,
                       .measures = measures,
                       .owner = owner,
                       .palm = palm,
                       .memory = arm_memory,
                       .estimate = estimate},
                      {});
    }
    void run_pose() {
        pose_arms({.origin = origin,
                   .measures = measures,
                   .owner = owner,
                   .palm = palm,
                   .estimate = estimate,
                   .arms = arms});
    }
    void run_spine() {
        propagate_spine({.dt_s = k_dt_s,
                         .t_s = t_s,
                         .surfaces = {},
                         .persistent_id = no_ids,
                         .origin = origin,
                         .velocity = velocity,
                         .reference = reference,
                         .head = head,
                         .measures = measures,
                         .estimate = estimate,
                         .owner = owner,
                         .grab = no_grips,
                         .body_hold = no_holds,
                         .memory = spine_memory,
                         .pose = spine},
                        {});
    }
};

double thread_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Thread CPU time per frame and player, without moving the players. With one player, the clock's
// own 0.3 us would matter: see body/one_*.
template <typename Run>
void players(benchmark::State& state, Run run) {
    const std::size_t count = 100;
    Bodies bodies(count);
    const auto all = [&] {
        bodies.move();
        bodies.run_estimate();
        bodies.run_pose();
        bodies.run_spine();
    };
    for (int i = 0; i < 90; ++i) {
        all();
    }
    for (auto _ : state) {
        bodies.move();
        const double begin_s = thread_s();
        run(bodies);
        state.SetIterationTime((thread_s() - begin_s) / static_cast<double>(count));
    }
    benchmark::DoNotOptimize(bodies.spine.elements().data());
}

BENCHMARK_CAPTURE(players, estimate, [](Bodies& b) { b.run_estimate(); })
    ->Name("body/estimate_arms")
    ->UseManualTime()
    ->MinTime(0.004);
BENCHMARK_CAPTURE(players, pose, [](Bodies& b) { b.run_pose(); })
    ->Name("body/pose_arms")
    ->UseManualTime()
    ->MinTime(0.004);
BENCHMARK_CAPTURE(players, spine, [](Bodies& b) { b.run_spine(); })
    ->Name("body/propagate_spine")
    ->UseManualTime()
    ->MinTime(0.004);
BENCHMARK_CAPTURE(players, whole,
                  [](Bodies& b) {
                      b.run_estimate();
                      b.run_pose();
                      b.run_spine();
                  })
    ->Name("body/whole")
    ->UseManualTime()
    ->MinTime(0.004);

// One player, including the cost of moving the player, which one_moving_him measures alone.
template <typename Run>
void one_player(benchmark::State& state, Run run) {
    Bodies body(1);
    for (auto _ : state) {
        body.move();
        run(body);
    }
    benchmark::DoNotOptimize(body.spine.elements().data());
}

BENCHMARK_CAPTURE(one_player, nothing, [](Bodies&) {})->Name("body/one_moving_him");
BENCHMARK_CAPTURE(one_player, whole, [](Bodies& b) {
    b.run_estimate();
    b.run_pose();
    b.run_spine();
})->Name("body/one_moving_him_and_whole");

}  // namespace
}  // namespace handhold::body_bench
