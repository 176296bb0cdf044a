// Hands of two players on one bar, through whole frames. Expected values are closed forms of the
// hands' motion.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/frame/column_scene.hpp"
#include "tests/systems/frame/two_players.hpp"

namespace handhold::scenario_two_players_test {
namespace {

constexpr double k_step_s = test::TwoPlayers::k_step_s;
constexpr int k_samples = 20;      // samples per frame: buttons may close and open within one
constexpr double k_jump_m = 1e-5;  // of a head, in the frame of a button edge: 0.01 mm
constexpr double k_bar_kg = 5.0;

// A bar under the right palms of two players, 40 cm to either side of its middle.
struct SharedBar : test::TwoPlayers {
    Entity bar;
    double jump_m = 0.0;  // of either head in the last frame
    // Samples per frame; 1: only at its end.
    int samples_a_frame = 20;

    explicit SharedBar(std::array<double, 2> masses_kg = {80.0, 80.0}) {
        const ShapeId shape = shapes.add_box(Vec3(0.6, 0.02, 0.02));
        const RigidBody body{BodyKind::free, k_bar_kg, solid_inertia(shapes.at(shape), k_bar_kg),
                             0.0};
        bar = add_body(world, {"bar", body, {Vec3(0.0, 1.175, 0.0), Quat::Identity()}, {}, shape});
        add_players({"first", "second"}, masses_kg);
        for (std::size_t i = 0; i < players.size(); ++i) {
            move_hand(i, [](double) { return Pose{}; });
            hold(i, 0.1, 1e9);
            scripts[i].head = [i](double) {
                return Pose{Vec3(i == 0 ? -0.6 : 0.6, 1.8, 0.5), Quat::Identity()};
            };
        }
        drop_caches();
    }
    // Moves the hand relative to its rest pose.
    void move_hand(std::size_t i, const std::function<Pose(double)>& motion) {
        const Vec3 palm(i == 0 ? -0.4 : 0.4, 1.2, 0.0);
        const Vec3 rest = palm - tuning.hand.palm_center_m;
        scripts[i].hands[index_of(HandSide::right)] = [=](double t) {
            const Pose moved = motion(t);
            return Pose{rest + moved.position, moved.rotation};
        };
    }
    void hold(std::size_t i, double from_s, double until_s) {
        scripts[i].grabs[index_of(HandSide::right)] = [=](double t) {
            return t > from_s && t < until_s;
        };
    }
    void run(
        double seconds, const std::function<void()>& after_frame = [] {}) {
        for (int i = 0; i < static_cast<int>(std::lround(seconds / k_step_s)); ++i) {
            const double end_s = world.clock.t_s + k_step_s;
            std::array<std::vector<TrackingSample>, 2> samples;
            std::vector<PlayerInput> inputs;
            for (std::size_t p = 0; p < players.size(); ++p) {
                for (int k = 0; k <= samples_a_frame; ++k) {
                    const double t_s = end_s - k_step_s * (samples_a_frame - k) / samples_a_frame;
                    samples[p].push_back(sample_of(scripts[p], t_s));
                }
                inputs.push_back({players[p].player, samples[p], {}});
            }
            const Vec3 before[] = {origin(0), origin(1)};
            step_frame(world, *caches, tuning, {k_step_s, inputs}, stats);
            jump_m = std::max((origin(0) - before[0]).norm(), (origin(1) - before[1]).norm());
            after_frame();
        }
    }
    const Grab& grab(std::size_t i) const {
        return world.grab.at(players[i].hands[index_of(HandSide::right)]);
    }
    bool holds(std::size_t i) const { return grab(i).kind == GripKind::held; }
};

// The common motion of the hands and the bar: varying at up to 0.5 m/s and 5 m/s^2, and uniform.
Pose lively(double t) {
    const double w = ease(t, 0.15, 0.4);
    return {w * Vec3(0.1 * std::sin(4 * t), 0.08 * std::cos(3 * t), 0.1 * std::sin(5 * t)),
            rotation_from_vector(w * Vec3(0.1 * std::sin(3 * t), 0.2 * std::sin(2 * t), 0.05))};
}
Pose even(double t) {
    return {Vec3(0.3 * t, -0.1 * t, 0.2 * t), rotation_about(Vec3(0.6, 0.0, 0.8), 0.1 * t)};
}
struct Carry {
    Pose (*motion)(double);
    int samples_a_frame;
};
constexpr Carry k_carries[] = {{lively, 1}, {even, 20}, {lively, 20}};

void carry(const Carry& how, SharedBar& shared) {
    shared.samples_a_frame = how.samples_a_frame;
    for (DeviceScript& script : shared.scripts) {
        const auto rest = script.hands[index_of(HandSide::right)];
        script.hands[index_of(HandSide::right)] = [=](double t) { return how.motion(t) * rest(t); };
    }
}
// Whichever player joins or leaves, and however the hand is rotated: the hands' targets can be met
// without moving either player.
TEST(TwoPlayers, JoiningAndLeavingMovesNeitherHead) {
    for (const Carry& how : k_carries) {
        for (const std::size_t first : {0U, 1U}) {
            SharedBar shared({80.0, 60.0});
            shared.move_hand(1 - first, [](double) {
                return Pose{Vec3::Zero(), rotation_about(Vec3::UnitY(), 0.5)};
            });
            shared.hold(first, 0.1, 0.8047);
            shared.hold(1 - first, 0.3047, 1e9);
            carry(how, shared);
            int both = 0;
            shared.run(1.0, [&] {
                both += shared.holds(0) && shared.holds(1) ? 1 : 0;
                ASSERT_LE(shared.jump_m, k_jump_m) << shared.t_s();
                ASSERT_LE(shared.velocity(0).norm() + shared.velocity(1).norm(), 1e-3);
            });
            EXPECT_GT(both, 40);
            EXPECT_FALSE(shared.holds(first));
            EXPECT_TRUE(shared.holds(1 - first));
        }
    }
}

// From one player to the other: with both hands on it, in one frame, and in one frame with the
// first hand opening before the second closes.
TEST(TwoPlayers, PassingMovesNeitherHeadAndTheBarStaysInTheHands) {
    for (const Carry& how : k_carries) {
        for (const double late_s : {0.03, 0.002, -0.002}) {
            SharedBar shared({80.0, 60.0});
            const double pass_s = 0.5 + 4.0 / 900.0;
            shared.hold(0, 0.1, pass_s + late_s);
            shared.hold(1, pass_s, 1e9);
            carry(how, shared);
            shared.run(0.4);
            const auto bar_in_hands = [&] {
                const Pose hands_ws =
                    Pose{shared.origin(1), Quat::Identity()} * how.motion(shared.t_s());
                return Pose(inverse(hands_ws) * shared.world.body_pose.at(shared.bar).pose_ws);
            };
            const Pose held = bar_in_hands();
            double slipped = 0.0;
            shared.run(0.6, [&] {
                ASSERT_LE(shared.jump_m, k_jump_m) << shared.t_s() << " " << late_s;
                slipped = std::max(slipped, test::distance(held, bar_in_hands()));
            });
            EXPECT_LE(slipped, 1e-5) << late_s << " " << how.samples_a_frame;
            EXPECT_FALSE(shared.holds(0));
            EXPECT_TRUE(shared.holds(1));
        }
    }
}

// They pull at each other with rising speed while the second releases: they separate at their
// hands' velocities, up to one frame's change.
TEST(TwoPlayers, ReleasingAPulledBarKeepsBothVelocities) {
    const Vec3 motion(0.3, 0.1, 0.0);
    const double leaves_s = 0.4547;
    const auto share = [](double t) { return ease(t, 0.3, 0.9); };
    for (const int samples : {1, 20}) {
        SharedBar shared({80.0, 60.0});
        shared.samples_a_frame = samples;
        shared.move_hand(1, [&](double t) { return Pose{share(t) * motion, Quat::Identity()}; });
        shared.hold(1, 0.1, leaves_s);
        shared.run(0.5);
        const Vec3 parting_mps = shared.velocity(0) - shared.velocity(1);
        const double gained = (share(leaves_s) - 2.0 * share(leaves_s - k_step_s) +
                               share(leaves_s - 2.0 * k_step_s)) /
                              k_step_s;
        const double speed = (share(leaves_s + 1e-4) - share(leaves_s - 1e-4)) / 2e-4;
        EXPECT_LE((parting_mps - speed * motion).norm(), gained * motion.norm()) << samples;
    }
}

// The hands move 20 cm apart, along or across the bar: the players move by as much, shared by their
// masses, and the bar follows the first player's hand, which rests.
TEST(TwoPlayers, PullingMovesThemByTheirMasses) {
    for (const Vec3& motion : {Vec3(0.2, 0.0, 0.0), Vec3(0.0, 0.2, 0.0)}) {
        SharedBar shared({80.0, 60.0});
        shared.move_hand(1, [=](double t) {
            return Pose{ease(t, 0.3, 0.8) * motion, Quat::Identity()};
        });
        shared.run(1.0, [&] {
            const Vec3 momentum = 80.0 * shared.velocity(0) + 60.0 * shared.velocity(1) +
                                  k_bar_kg * shared.world.body_velocity.at(shared.bar).linear_mps;
            ASSERT_LE(momentum.norm(), 1e-9) << shared.t_s();
            ASSERT_LE(shared.grab(0).error_m, 1e-6);
            ASSERT_LE(shared.grab(1).error_m, 1e-6);
        });
        const double sum_kg = 80.0 + 60.0 + k_bar_kg;
        EXPECT_LE((shared.origin(0) - 60.0 / sum_kg * motion).norm(), 2e-4);
        EXPECT_LE((shared.origin(1) + (80.0 + k_bar_kg) / sum_kg * motion).norm(), 2e-4);
        EXPECT_LE(shared.velocity(0).norm() + shared.velocity(1).norm(), 1e-6);
    }
}

}  // namespace
}  // namespace handhold::scenario_two_players_test
