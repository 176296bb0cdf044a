// Simulated columns do not depend on the shown stages: any mixture of steps with and without them,
// with rollbacks, equals the straight run bit for bit.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "systems/snapshot/simulated_state.hpp"
#include "systems/snapshot/snapshot.hpp"
#include "tests/systems/frame/crowd.hpp"
#include "tests/systems/frame/held_pair.hpp"

namespace handhold::simulated_steps_test {
namespace {

using scenario_body_grip_test::draw;
using scenario_body_grip_test::k_grab_s;
using scenario_body_grip_test::prepare;
using test::Crowd;
using test::Random;

// What happened in a run that proves something.
struct Counts {
    int rollbacks = 0;
    int steps_again = 0;  // ticks that were stepped again
    int hidden = 0;       // steps without shown stages
    int shown = 0;
    int wrong = 0;     // steps with wrong input, which were rolled back
    int on_parts = 0;  // ticks in which a hand held another player's arm, trunk or leg
    int on_bodies = 0;
    int on_walls = 0;
};

void count_grips(const World& world, Counts& counts) {
    counts.on_parts += static_cast<int>(world.body_hold.size());
    for (const Grab& grab : world.grab.elements()) {
        counts.on_bodies += grab.kind == GripKind::held ? 1 : 0;
        counts.on_walls += grab.kind == GripKind::surface ? 1 : 0;
    }
}

// Overwrites every shown column, as if nothing had ever been shown.
void forget_shown(World& world) {
    visit_column_members([&](const char*, auto member) {
        using Component = typename std::remove_cvref_t<decltype(world.*member)>::Element;
        if constexpr (k_is_shown<Component>) {
            for (Component& element : (world.*member).elements()) {
                element = {};
            }
        }
    });
}

// Plays `ticks` ticks of a scene in a random mixture. hashes: hash_simulated after each tick of the
// straight run, and the start.
template <typename Scene>
void play_mixed(Scene& scene, const std::vector<std::uint64_t>& hashes, std::uint64_t seed,
                Counts& counts) {
    constexpr std::size_t k_window = 24;
    Random random(seed);
    std::array<SimulatedState, k_window> states;
    std::size_t tick = 0;
    std::size_t farthest = 0;
    const std::size_t ticks = hashes.size() - 1;
    const auto chance = [&](double share) { return random.between(0.0, 1.0) < share; };
    while (tick < ticks) {
        states[tick % k_window].keep(scene.world);
        if (chance(0.1)) {  // a wrong guess
            scene.are_silent = true;
            for (int i = 0; i < 5; ++i) {
                scene.kind_of_step = chance(0.5) ? &step_frame : &step_simulated;
                scene.step();
                ++counts.wrong;
            }
            scene.are_silent = false;
            states[tick % k_window].restore(scene.world);
            ASSERT_EQ(hash_simulated(scene.world), hashes[tick]) << seed << ' ' << tick;
        }
        if (chance(0.05)) {
            scene.drop_caches();
        }
        if (chance(0.05)) {
            forget_shown(scene.world);
        }
        const bool is_shown = chance(0.4);
        scene.kind_of_step = is_shown ? &step_frame : &step_simulated;
        scene.step();
        (is_shown ? counts.shown : counts.hidden) += 1;
        ++tick;
        ASSERT_EQ(hash_simulated(scene.world), hashes[tick]) << seed << ' ' << tick;
        if (tick > farthest) {
            farthest = tick;
            count_grips(scene.world, counts);
        } else {
            ++counts.steps_again;
        }
        const std::size_t kept = std::min(tick, k_window - 1);
        if (kept > 1 && tick == farthest && chance(0.1)) {
            const auto depth =
                static_cast<std::size_t>(random.between(1.0, static_cast<double>(kept)));
            tick -= depth;
            states[tick % k_window].restore(scene.world);
            ++counts.rollbacks;
            ASSERT_EQ(scene.world.clock.frame, states[tick % k_window].clock().frame);
            ASSERT_EQ(hash_simulated(scene.world), hashes[tick]) << seed << ' ' << tick;
        }
    }
}

// Plays the scene straight and in several mixtures. `make` makes it at its first tick.
template <typename Make>
Counts play_scene(const Make& make, int ticks, std::uint64_t first_seed) {
    Counts counts;
    const auto straight = make();
    std::vector<std::uint64_t> hashes = {hash_simulated(straight->world)};
    for (int i = 0; i < ticks; ++i) {
        straight->step();
        hashes.push_back(hash_simulated(straight->world));
    }
    for (std::uint64_t seed = first_seed; seed < first_seed + 2; ++seed) {
        const auto mixed = make();
        play_mixed(*mixed, hashes, seed, counts);
        const std::vector<std::string> differences =
            diff_worlds(straight->world, mixed->world, {.simulated_only = true});
        EXPECT_TRUE(differences.empty()) << differences.front();
        // The whole worlds do differ: steps were left out.
        EXPECT_FALSE(diff_worlds(straight->world, mixed->world).empty());
    }
    return counts;
}

TEST(SimulatedSteps, MixedRunsOfACrowdEqualTheStraightRun) {
    const Counts counts = play_scene([] { return std::make_unique<Crowd>(); }, Crowd::k_frames, 1);
    EXPECT_GT(counts.rollbacks, 30);
    EXPECT_GT(counts.steps_again, 200);
    EXPECT_GT(counts.hidden, 300);
    EXPECT_GT(counts.shown, 200);
    EXPECT_GT(counts.wrong, 100);
    EXPECT_GT(counts.on_walls, 300);
    EXPECT_GT(counts.on_bodies, 300);
}

TEST(SimulatedSteps, MixedRunsWithHandsOnOtherPlayersEqualTheStraightRun) {
    Counts all;
    std::array<int, k_gripped_parts> held_parts{};
    for (std::uint64_t seed = 0; seed < k_gripped_parts; ++seed) {
        const auto make = [&] {
            auto pair = prepare(draw(seed));
            pair->way = [](double t) {
                return Vec3(0.15 * ease(t, k_grab_s + 0.2, k_grab_s + 0.7) *
                            Vec3(std::sin(4.0 * t), std::sin(5.0 * t), std::cos(3.0 * t)));
            };
            for (std::size_t side = 0; side < k_hand_count; ++side) {
                auto& hand = pair->scripts[scenario_body_grip_test::k_held].hands[side];
                hand = [still = hand](double t) {
                    Pose pose = still(t);
                    pose.position += 0.2 * ease(t, k_grab_s + 0.2, k_grab_s + 0.5) *
                                     Vec3(std::sin(6.0 * t), std::sin(7.0 * t), std::sin(8.0 * t));
                    return pose;
                };
            }
            pair->run_until(k_grab_s - 0.1);
            return pair;
        };
        const Counts counts = play_scene(make, 90, 10 * seed);
        all.rollbacks += counts.rollbacks;
        all.hidden += counts.hidden;
        all.on_parts += counts.on_parts;
        held_parts[seed] += counts.on_parts;
    }
    EXPECT_GT(all.rollbacks, 100);
    EXPECT_GT(all.hidden, 1000);
    EXPECT_GT(all.on_parts, 1200);
    EXPECT_GE(std::ranges::count_if(held_parts, [](int held) { return held > 60; }),
              static_cast<std::ptrdiff_t>(k_gripped_parts) - 2);
}

// Bodies, joints and players that came or went since are undone too.
TEST(SimulatedState, UndoesEntitiesThatCameAndWent) {
    Crowd crowd;
    crowd.run(30);
    SimulatedState state;
    state.keep(crowd.world);
    const Crowd expected = [&] {
        Crowd straight;
        straight.run(90);
        return straight;
    }();
    ASSERT_TRUE(destroy(crowd.world, find_by_name(crowd.world, "pebble3")));
    ASSERT_TRUE(destroy(crowd.world, find_by_name(crowd.world, "crawler")));
    PlayerDescription description;
    description.name = "stranger";
    const PlayerEntities stranger = add_player(crowd.world, description);
    crowd.run(3);
    state.restore(crowd.world);
    EXPECT_FALSE(crowd.world.player.contains(stranger.player));
    EXPECT_TRUE(is_null(find_by_name(crowd.world, "stranger")));
    EXPECT_FALSE(is_null(find_by_name(crowd.world, "pebble3")));
    EXPECT_FALSE(is_null(find_by_name(crowd.world, "crawler")));
    visit_columns(crowd.world, [&](const char* name, const auto& column) {
        for (const Entity owner : column.owners()) {
            EXPECT_TRUE(crowd.world.entities.is_alive(owner)) << name;
        }
    });
    EXPECT_EQ(crowd.world.render_pose.size(), crowd.world.player.size());
    EXPECT_EQ(crowd.world.finger_pose.size(), crowd.world.hand_owner.size());
    crowd.run(60);
    const auto differences = diff_worlds(expected.world, crowd.world, {.simulated_only = true});
    EXPECT_TRUE(differences.empty()) << differences.front();
}

// hash_simulated depends on the elements of every simulated column that the crowd has, and on no
// shown one. frame_hash_test covers single fields.
TEST(HashSimulated, DependsOnSimulatedColumnsAlone) {
    Crowd crowd;
    crowd.run(60);
    const std::uint64_t before = hash_simulated(crowd.world);
    const std::uint64_t whole = hash_state(crowd.world);
    forget_shown(crowd.world);
    EXPECT_EQ(hash_simulated(crowd.world), before);
    EXPECT_NE(hash_state(crowd.world), whole);
    int simulated = 0;
    visit_simulated_members([&](const char* name, auto member) {
        auto& column = crowd.world.*member;
        if (column.empty()) {
            return;
        }
        ++simulated;
        const auto kept = column;
        const Entity first = column.owners().front();
        if (std::string_view(name) != "persistent_id") {  // every hash needs the id
            column.remove(first);
            EXPECT_NE(hash_simulated(crowd.world), before) << name;
        }
        column = kept;
        EXPECT_EQ(hash_simulated(crowd.world), before) << name;
    });
    EXPECT_GT(simulated, 20);
}

}  // namespace
}  // namespace handhold::simulated_steps_test
