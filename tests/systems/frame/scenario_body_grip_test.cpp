// One player grips another's arm, trunk or leg, through whole frames. Expected values are closed
// forms: conservation of momentum, and the speed at which a grip may follow its part.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "components/world_edit.hpp"
#include "engine/core/parallel.hpp"
#include "systems/snapshot/snapshot.hpp"
#include "tests/systems/frame/held_pair.hpp"

namespace handhold::scenario_body_grip_test {
namespace {

constexpr std::uint64_t k_draws = 3 * k_gripped_parts;

Vec3 wave(double t) {
    return 0.15 * ease(t, k_grab_s + 0.2, k_grab_s + 0.7) *
           Vec3(std::sin(4.0 * t), std::sin(5.0 * t), std::cos(3.0 * t));
}

// Both arms of the held player move, up to 2.5 m/s.
void swing_arms(Pair& pair) {
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        pair.scripts[k_held].hands[side] = [still = pair.scripts[k_held].hands[side]](double t) {
            Pose hand = still(t);
            hand.position += 0.3 * ease(t, k_grab_s + 0.2, k_grab_s + 0.5) *
                             Vec3(std::sin(6.0 * t), std::sin(7.0 * t), std::sin(8.0 * t));
            return hand;
        };
    }
}

TEST(BodyGrip, BeginsAndEndsWithoutMovingAnybody) {
    std::set<BodyPart> gripped;
    std::size_t grips = 0;
    for (std::uint64_t seed = 0; seed < k_draws; ++seed) {
        const auto pair = prepare(draw(seed));
        pair->release_s = k_grab_s + 0.3;
        bool held = false;
        pair->run_until(k_grab_s + 0.6, [&] {
            held = held || pair->holds_body();
            if (pair->holds_body()) {
                gripped.insert(pair->hold()->part);
            }
            for (const std::size_t i : {k_holder, k_held}) {
                ASSERT_LE(pair->origin(i).norm(), 1e-3) << seed;  // legs still swing by this much
                ASSERT_LE(pair->velocity(i).norm(), 1e-2) << seed;
            }
            ASSERT_LE(pair->grab().error_m, 1e-6) << seed;
        });
        grips += held ? 1U : 0U;
        EXPECT_EQ(pair->grab().kind, GripKind::none) << seed;
    }
    EXPECT_GE(grips, k_draws * 9 / 10);
    EXPECT_GE(gripped.size(), k_gripped_parts - 1);  // a hand may lie on the forearm's end
}

TEST(BodyGrip, SharesMomentumByTheMasses) {
    std::size_t grips = 0;
    for (std::uint64_t seed = 0; seed < k_draws; ++seed) {
        const auto pair = prepare(draw(seed));
        pair->way = wave;
        swing_arms(*pair);
        const Vec3 before(3.0, -2.0, 1.0);
        pair->run_until(k_grab_s);
        pair->velocity(k_held) = before / pair->mass_kg(k_held);
        const Vec3 center = pair->center();
        double apart_m = 0.0;
        bool held = false;
        pair->run(2.0, [&] {
            held = held || pair->holds_body();
            ASSERT_LE((pair->momentum() - before).norm(), 1e-7) << seed;
            const double since_s = pair->t_s() - k_grab_s;
            const Vec3 drifted =
                center + (since_s / (pair->mass_kg(0) + pair->mass_kg(1))) * before;
            ASSERT_LE((pair->center() - drifted).norm(), 1e-5) << seed;
            apart_m = std::max(apart_m, (pair->origin(0) - pair->origin(1)).norm());
        });
        EXPECT_GT(apart_m, 0.02) << seed;
        grips += held ? 1U : 0U;
    }
    EXPECT_GE(grips, k_draws * 9 / 10);
}

// Hands of the held player jump to random places, which no arm can follow smoothly. The grip moves
// the players by no more than its own speed, shared by the masses, and his hands are shown where
// they are tracked.
TEST(BodyGrip, ChangeOfTheShownBodyMovesNobodyFasterThanTheGripFollows) {
    std::size_t moved = 0;
    for (std::uint64_t seed = 0; seed < k_draws; ++seed) {
        const auto pair = prepare(draw(seed));
        Random random(seed + 1000);
        std::array<std::array<Vec3, 8>, 2> places;
        for (auto& of_hand : places) {
            for (Vec3& place : of_hand) {
                place = k_held_head + random.vector(0.5) - Vec3(0.0, 0.2, 0.0);
            }
        }
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            pair->scripts[k_held].hands[side] = [still = pair->scripts[k_held].hands[side],
                                                 of_hand = places[side]](double t) {
                const double since_s = t - k_grab_s - 0.1;
                const auto place = static_cast<std::size_t>(std::max(0.0, since_s / 0.2));
                return since_s < 0.0 ? still(t) : Pose{of_hand[place % 8], Quat::Identity()};
            };
        }
        std::array<Vec3, 2> before = {pair->origin(0), pair->origin(1)};
        bool is_moved = false;
        pair->run_until(k_grab_s + 1.5, [&] {
            for (const std::size_t i : {k_holder, k_held}) {
                const double moved_m = (pair->origin(i) - before[i]).norm();
                const double most_m = pair->share(i) * pair->tuning.hand.part_speed_mps * k_step_s;
                ASSERT_LE(moved_m, most_m + 1e-6) << seed << ' ' << pair->t_s();
                before[i] = pair->origin(i);
            }
            const Pose& origin_ws =
                pair->world.player_origin.at(pair->players[k_held].player).pose_ws;
            for (std::size_t side = 0; side < k_hand_count; ++side) {
                const Entity hand = pair->players[k_held].hands[side];
                const Pose tracked_ws = origin_ws * pair->world.hand_tracking.at(hand).pose_ps;
                const Pose& shown_ws = pair->shown(k_held).arms.arms[side].hand_ws;
                ASSERT_LE((shown_ws.position - tracked_ws.position).norm(), 1e-12) << seed;
                ASSERT_LE(shown_ws.rotation.angularDistance(tracked_ws.rotation), 1e-7) << seed;
            }
            is_moved = is_moved || (pair->holds_body() && pair->origin(k_holder).norm() > 0.01);
        });
        moved += is_moved ? 1U : 0U;
    }
    EXPECT_GE(moved, k_draws / 3);  // arms that are held carry the holder along
}

// An arm that moves slower than hand.part_speed_mps takes the gripping hand along. The hand lags by
// the arm's travel in one frame.
TEST(BodyGrip, HandStaysOnAnArmThatMoves) {
    Draw of_arm = draw(1);
    of_arm.part = BodyPart::left_forearm;
    const auto pair = prepare(of_arm);
    pair->scripts[k_held].hands[k_left] = [still = pair->scripts[k_held].hands[k_left]](double t) {
        Pose hand = still(t);
        hand.position += 0.2 * ease(t, 2.5, 3.5) * Vec3(0.5, 1.0, -0.5);
        return hand;
    };
    pair->run_until(2.4);
    ASSERT_TRUE(pair->holds_body());
    const auto on_part = [&] {
        const Pose& hand_ws = pair->shown(k_holder).hands[k_right].tracked_ws;
        return inverse_transform_point(pair->capsule(pair->hold()->part).frame_ws,
                                       hand_ws.position);
    };
    const Vec3 at_first = on_part();
    double moved_m = 0.0;
    pair->run_until(4.0, [&] {
        ASSERT_TRUE(pair->holds_body());
        ASSERT_LE((on_part() - at_first).norm(), 0.6 * k_step_s);  // m; the arm's speed is below
        moved_m = std::max(moved_m, pair->origin(k_holder).norm());
    });
    EXPECT_LE((on_part() - at_first).norm(), 1e-3);
    EXPECT_GT(moved_m, 0.03);
}

// A leg swings by its momentum while a hand pulls at it. The swing does not feed on itself.
TEST(BodyGrip, PullAtALegDiesAway) {
    for (const BodyPart part : {BodyPart::left_thigh, BodyPart::left_shin, BodyPart::right_shin,
                                BodyPart::lower_spine, BodyPart::upper_spine}) {
        for (const double rate : {2.0, 5.0, 10.0, 20.0}) {
            Draw of_leg = draw(7);
            of_leg.part = part;
            const auto pair = prepare(of_leg);
            constexpr double k_stop_s = 4.0;
            pair->way = [=](double t) {
                const double share = ease(t, 2.2, 2.6) * (1.0 - ease(t, k_stop_s - 0.4, k_stop_s));
                return Vec3(share * 0.6 / rate * Vec3(std::sin(rate * t), 0.0, std::cos(rate * t)));
            };
            double fastest_mps = 0.0;
            pair->run_until(k_stop_s, [&] {
                fastest_mps = std::max(fastest_mps,
                                       (pair->velocity(k_held) - pair->velocity(k_holder)).norm());
                ASSERT_LE(pair->grab().error_m, 1e-6);
            });
            EXPECT_TRUE(pair->holds_body());
            EXPECT_LE(fastest_mps, 0.6 + pair->tuning.hand.part_speed_mps);
            pair->run(3.0);
            EXPECT_LE((pair->velocity(k_held) - pair->velocity(k_holder)).norm(), 0.05)
                << static_cast<int>(part) << ' ' << rate;
        }
    }
}

// Turning in place takes the held part away from the hand: both players get there smoothly.
TEST(BodyGrip, SnapTurnOfTheHeldPlayerIsNoJump) {
    Draw of_leg = draw(3);
    of_leg.part = BodyPart::left_shin;
    const auto pair = prepare(of_leg);
    pair->run_until(k_grab_s + 0.2);
    ASSERT_TRUE(pair->holds_body());
    const auto head = [&](std::size_t i) { return pair->shown(i).head_ws.position; };
    std::array<Vec3, 2> before = {head(0), head(1)};
    pair->commands[k_held].snap_turns = 1;
    pair->run(1.0, [&] {
        pair->commands[k_held].snap_turns = 0;
        for (const std::size_t i : {k_holder, k_held}) {
            ASSERT_LE((head(i) - before[i]).norm(),
                      pair->tuning.hand.part_speed_mps * k_step_s + 1e-6);
            before[i] = head(i);
        }
    });
    EXPECT_TRUE(pair->holds_body());
}

TEST(BodyGrip, EndsIfTheOtherPlayerIsDestroyed) {
    const auto pair = prepare(draw(10));
    pair->run_until(k_grab_s + 0.2);
    ASSERT_TRUE(pair->holds_body());
    destroy(pair->world, pair->players[k_held].player);
    std::array<TrackingSample, 1> samples = {sample_of(pair->scripts[k_holder], pair->t_s())};
    const std::array inputs = {PlayerInput{pair->players[k_holder].player, samples, {}}};
    step_frame(pair->world, *pair->caches, pair->tuning, {k_step_s, inputs}, pair->stats);
    EXPECT_EQ(pair->grab().kind, GripKind::none);
    EXPECT_EQ(pair->hold(), nullptr);
}

TEST(BodyGrip, TeleportOfTheHeldPlayerEndsTheGripInPlace) {
    const auto pair = prepare(draw(12));
    pair->run_until(k_grab_s + 0.2);
    ASSERT_TRUE(pair->holds_body());
    const Vec3 before = pair->origin(k_holder);
    teleport_player(pair->world, pair->players[k_held].player,
                    {Vec3(5.0, 0.0, 0.0), Quat::Identity()});
    pair->run(0.2);
    EXPECT_EQ(pair->grab().kind, GripKind::none);
    EXPECT_LE((pair->origin(k_holder) - before).norm(), 1e-3);
}

// Both grip each other's forearm and pull: two targets that agree only as far as the arms do.
TEST(BodyGrip, ClaspedForearmsHold) {
    Draw of_arm = draw(2);
    of_arm.part = BodyPart::right_forearm;
    of_arm.hands[k_right] = k_held_head + Vec3(0.25, -0.35, -0.45);
    const auto pair = prepare(of_arm);
    pair->way = wave;
    pair->scripts[k_held].grabs[k_right] = [](double t) { return t > k_grab_s + 0.05; };
    pair->run_until(k_grab_s + 3.0, [&] {
        ASSERT_LE(pair->momentum().norm(), 1e-6);
        ASSERT_LE(pair->grab().error_m, 0.1);
        for (const std::size_t i : {k_holder, k_held}) {
            ASSERT_LE(pair->velocity(i).norm(), 3.0);
        }
    });
    EXPECT_TRUE(pair->holds_body());
}

std::vector<std::uint64_t> hashes_of(Pair& pair, int frames) {
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < frames; ++i) {
        hashes.push_back(pair.step());
    }
    return hashes;
}

std::unique_ptr<Pair> busy_pair(std::uint64_t seed) {
    auto pair = prepare(draw(seed));
    pair->way = wave;
    swing_arms(*pair);
    return pair;
}

TEST(BodyGrip, RolledBackFramesAreRepeatedBitwise) {
    constexpr int k_frames = 60;
    for (const std::uint64_t seed : {1U, 8U, 23U}) {
        const auto pair = busy_pair(seed);
        const SnapshotAssets assets(pair->shapes);
        pair->run_until(k_grab_s - 0.2);
        std::vector<std::byte> saved;
        for (int i = 0; i < 3; ++i) {
            save_snapshot(pair->world, assets, saved);
            const auto expected = hashes_of(*pair, k_frames);
            const auto error = restore_snapshot(saved, assets, pair->world);
            ASSERT_FALSE(error) << error->message();
            pair->drop_caches();
            EXPECT_EQ(hashes_of(*pair, k_frames), expected) << seed;
        }
        EXPECT_TRUE(pair->holds_body()) << seed;
    }
}

TEST(BodyGripThreaded, OneAndTwoThreadsGiveTheSameFrames) {
    const auto run = [](int threads) {
        set_thread_count(threads);
        const auto pair = busy_pair(8);
        const auto hashes = hashes_of(*pair, 180);
        set_thread_count(1);
        EXPECT_TRUE(pair->holds_body());
        return hashes;
    };
    EXPECT_EQ(run(2), run(1));
}

}  // namespace
}  // namespace handhold::scenario_body_grip_test
