// One player grips another's arm, trunk or leg, through whole frames. Expected values are closed
// forms: conservation of momentum, and the speed at which a grip may follow its part.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "components/world_edit.hpp"
#include "engine/core/parallel.hpp"
#include "systems/locomotion/shared/body_parts.hpp"
#include "systems/snapshot.hpp"
#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_body_grip_test {
namespace {

using test::Random;

constexpr double k_step_s = 1.0 / 90.0;
constexpr double k_reach_from_s = 1.0;  // the bodies hang still by then
constexpr double k_grab_s = 2.0;
constexpr std::size_t k_holder = 0;
constexpr std::size_t k_held = 1;
constexpr std::size_t k_left = index_of(HandSide::left);
constexpr std::size_t k_right = index_of(HandSide::right);
const Vec3 k_held_head(0.0, 1.6, 0.0);

// A hand whose palm's centre is at `palm` and looks along `palm_way`.
Pose hand_with_palm(const Vec3& palm, const Vec3& palm_way, const HandTuning& tuning) {
    const Quat rotation = Quat::FromTwoVectors(-Vec3::UnitY(), palm_way);
    return {palm - rotation * tuning.palm_center_m, rotation};
}

// The holder's right hand moves to a part of the other's body and closes on it.
struct Pair {
    ShapeLibrary shapes;
    World world;
    Tuning tuning;
    StageStats stats;
    std::array<DeviceScript, 2> scripts;
    std::array<PlayerEntities, 2> players;
    std::array<PlayerCommands, 2> commands;
    std::unique_ptr<FrameCaches> caches;
    double release_s = 1e9;
    Pose touch;  // the holder's right hand, in his play space, when it closes
    std::function<Vec3(double)> way = [](double) { return Vec3(Vec3::Zero()); };

    explicit Pair(double holder_kg = 80.0, double held_kg = 80.0) {
        tuning.locomotion.drift_drag_per_s = 0.0;
        for (std::size_t i = 0; i < players.size(); ++i) {
            PlayerDescription description;
            description.name = i == k_holder ? "holder" : "held";
            description.body.mass_kg = i == k_holder ? holder_kg : held_kg;
            description.head_shape = shapes.add_sphere(tuning.head.radius_m);
            players[i] = add_player(world, description);
            for (const Entity hand : players[i].hands) {
                world.controller_to_hand.add(hand, {});
            }
        }
        scripts[k_held].head = [](double) { return Pose{k_held_head, Quat::Identity()}; };
        scripts[k_holder].head = [](double) {
            return Pose{Vec3(0.0, 1.6, 3.0), Quat::Identity()};  // far off until it is placed
        };
        scripts[k_holder].grabs[k_right] = [this](double t) {
            return t > k_grab_s && t < release_s;
        };
        drop_caches();
    }
    Pair(const Pair&) = delete;
    Pair& operator=(const Pair&) = delete;

    void drop_caches() { caches = std::make_unique<FrameCaches>(shapes); }

    const RenderPose& shown(std::size_t i) const { return world.render_pose.at(players[i].player); }
    PartCapsule capsule(BodyPart part) const {
        return part_capsule(shown(k_held), world.body_measures.at(players[k_held].player), part);
    }

    // Lets the bodies come to rest, and plans the holder's reach for a point on the part: a share
    // of its length, in a direction across it.
    void plan(BodyPart part, double along, const Vec3& direction) {
        run(k_reach_from_s);
        const PartCapsule target = capsule(part);
        const Vec3 axis = (target.frame_ws.rotation * target.end_bs).normalized();
        Vec3 out = direction - axis * axis.dot(direction);
        out.normalize();
        const Vec3 on_axis = transform_point(target.frame_ws, along * target.end_bs);
        if (out.dot(on_axis - k_held_head) < 0.0) {
            out = -out;  // away from the other's head
        }
        touch = hand_with_palm(on_axis + (target.radius_m + 0.004) * out, -out, tuning.hand);
        const Vec3 head = on_axis + 0.8 * out + Vec3(0.0, 0.15, 0.0);
        const Vec3 far = touch.position + 0.2 * out;
        const Vec3 start_head = scripts[k_holder].head(0.0).position;
        scripts[k_holder].head = [=](double t) {
            const double share = ease(t, k_reach_from_s, 1.5);
            return Pose{start_head + share * (head - start_head), Quat::Identity()};
        };
        const Vec3 start_hand = scripts[k_holder].hands[k_right](0.0).position;
        scripts[k_holder].hands[k_right] = [=, this](double t) {
            const double first = ease(t, k_reach_from_s, 1.5);
            const double second = ease(t, 1.5, 1.9);
            return Pose{
                start_hand + first * (far - start_hand) + second * (touch.position - far) + way(t),
                touch.rotation};
        };
        tuning.tracking.max_hand_speed_mps = 100.0;
    }

    std::uint64_t step() {
        const double end_s = world.clock.t_s + k_step_s;
        std::array<std::array<TrackingSample, 2>, 2> samples;
        std::vector<PlayerInput> inputs;
        for (std::size_t p = 0; p < players.size(); ++p) {
            samples[p] = {sample_of(scripts[p], world.clock.t_s), sample_of(scripts[p], end_s)};
            inputs.push_back({players[p].player, samples[p], commands[p]});
        }
        step_frame(world, *caches, tuning, {k_step_s, inputs}, stats);
        return hash_state(world);
    }
    void run(
        double seconds, const std::function<void()>& after_frame = [] {}) {
        for (int i = 0; i < static_cast<int>(std::lround(seconds / k_step_s)); ++i) {
            step();
            after_frame();
        }
    }
    void run_until(
        double end_s, const std::function<void()>& after_frame = [] {}) {
        run(end_s - t_s(), after_frame);
    }

    double t_s() const { return world.clock.t_s; }
    const Grab& grab() const { return world.grab.at(players[k_holder].hands[k_right]); }
    const BodyHold* hold() const { return world.body_hold.find(players[k_holder].hands[k_right]); }
    bool holds_body() const { return grab().kind == GripKind::player && hold() != nullptr; }
    Vec3 origin(std::size_t i) const {
        return world.player_origin.at(players[i].player).pose_ws.position;
    }
    Vec3& velocity(std::size_t i) { return world.player_velocity.at(players[i].player).linear_mps; }
    double mass_kg(std::size_t i) const { return world.player.at(players[i].player).mass_kg; }
    double share(std::size_t i) const { return mass_kg(1 - i) / (mass_kg(0) + mass_kg(1)); }
    Vec3 momentum() { return mass_kg(0) * velocity(0) + mass_kg(1) * velocity(1); }
    Vec3 center() const {
        return (mass_kg(0) * origin(0) + mass_kg(1) * origin(1)) / (mass_kg(0) + mass_kg(1));
    }
};

// A held player whose hands are at a random place in front of him, and a part to grip.
struct Draw {
    std::array<double, 2> mass_kg{};
    std::array<Vec3, 2> hands;
    BodyPart part = BodyPart::left_forearm;
    double along = 0.5;
    Vec3 direction;
};
Draw draw(std::uint64_t seed) {
    Random random(seed);
    Draw out;
    out.mass_kg = {random.between(40.0, 140.0), random.between(40.0, 140.0)};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const double across = side == k_left ? -1.0 : 1.0;
        out.hands[side] = k_held_head + Vec3(across * random.between(0.15, 0.5),
                                             random.between(-0.6, 0.0), -random.between(0.2, 0.5));
    }
    out.part = static_cast<BodyPart>(seed % k_gripped_parts);
    out.along = random.between(0.3, 0.7);
    out.direction = random.direction();
    return out;
}
std::unique_ptr<Pair> prepare(const Draw& draw) {
    auto pair = std::make_unique<Pair>(draw.mass_kg[k_holder], draw.mass_kg[k_held]);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        pair->scripts[k_held].hands[side] = [at = draw.hands[side]](double) {
            return Pose{at, Quat::Identity()};
        };
    }
    pair->plan(draw.part, draw.along, draw.direction);
    return pair;
}

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
    for (std::uint64_t seed = 0; seed < k_draws; ++seed) {
        const auto pair = prepare(draw(seed));
        pair->way = wave;
        swing_arms(*pair);
        const Vec3 before(3.0, -2.0, 1.0);
        pair->run_until(k_grab_s);
        pair->velocity(k_held) = before / pair->mass_kg(k_held);
        const Vec3 center = pair->center();
        double apart_m = 0.0;
        pair->run(2.0, [&] {
            ASSERT_LE((pair->momentum() - before).norm(), 1e-7) << seed;
            const double since_s = pair->t_s() - k_grab_s;
            const Vec3 drifted =
                center + (since_s / (pair->mass_kg(0) + pair->mass_kg(1))) * before;
            ASSERT_LE((pair->center() - drifted).norm(), 1e-5) << seed;
            apart_m = std::max(apart_m, (pair->origin(0) - pair->origin(1)).norm());
        });
        EXPECT_GT(apart_m, 0.02) << seed;
    }
}

// Hands of the held player jump to random places, which no arm can follow smoothly. The grip moves
// the players by no more than its own speed, shared by the masses, and his hands are shown where
// they are tracked.
TEST(BodyGrip, ChangeOfTheShownBodyMovesNobodyFasterThanTheGripFollows) {
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
        });
    }
}

// An arm that moves slower than the grip follows takes the holder's hand along: the hand is a
// frame's travel behind.
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
