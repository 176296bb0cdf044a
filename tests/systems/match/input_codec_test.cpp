// Inputs in integers: packing, delta coding, guesses, and from devices to ticks and back.
#include "systems/match/shared/input_codec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "systems/match/shared/predict_input.hpp"
#include "tests/random.hpp"
#include "tests/systems/frame/column_scene.hpp"
#include "tests/systems/frame/scenario.hpp"
#include "tests/systems/match/simulated_network.hpp"

namespace handhold::input_codec_test {
namespace {

using match_test::seed_of;
using test::Random;

TEST(PackedPose, KeepsPositionsToTheTenthOfAMillimetreAndRotationsToTwelveBits) {
    // Three components, each off by half a step: by most where all four are 1/2. The fourth, which
    // keeps the length, is then off by three times as much; an angle is twice the distance.
    const double most_rad = 2.0 * std::sqrt(3.0 + 9.0) * 0.5 / (2047.0 * std::sqrt(2.0));
    Random random(seed_of(1));
    for (int i = 0; i < 2000; ++i) {
        const Pose pose = random.pose(i % 2 == 0 ? 2.0 : 3000.0);
        ASSERT_TRUE(is_packable(pose));
        const PackedPose packed = pack(pose);
        const Pose back = unpack(packed);
        ASSERT_LE((back.position - pose.position).cwiseAbs().maxCoeff(), 0.5001e-4);
        ASSERT_LE(test::angle_between(back.rotation, pose.rotation), 1.01 * most_rad);
        ASSERT_NEAR(back.rotation.norm(), 1.0, 1e-12);
        ASSERT_EQ(pack(Pose{pose.position, Quat(-pose.rotation.coeffs())}), packed);  // same turn
    }
    EXPECT_FALSE(is_packable({Vec3(1e5, 0.0, 0.0), Quat::Identity()}));
    EXPECT_FALSE(is_packable({Vec3(std::nan(""), 0.0, 0.0), Quat::Identity()}));
    EXPECT_FALSE(is_packable({Vec3::Zero(), Quat(0.0, 0.0, 0.0, 0.0)}));
}

MatchInput random_input(Random& random, const MatchInput& before) {
    const auto chance = [&](double share) { return random.between(0.0, 1.0) < share; };
    const auto moved = [&](const PackedPose& from) {
        if (chance(0.05)) {
            return pack(random.pose(3000.0));
        }
        Pose pose = unpack(from);
        pose.position += random.vector(0.02);
        const Vec3 axis = random.direction();
        pose.rotation =
            (pose.rotation * rotation_about(axis, random.between(0.0, 0.1))).normalized();
        return pack(pose);
    };
    const auto byte = [&] { return static_cast<std::uint8_t>(random.between(0.0, 255.99)); };
    MatchInput input = before;
    input.head = moved(before.head);
    input.is_head_tracked = !chance(0.05);
    input.is_head_inferred = chance(0.05);
    for (MatchHand& hand : input.hands) {
        hand.pose = moved(hand.pose);
        hand.is_tracked = !chance(0.1);
        hand.is_inferred = chance(0.05);
        hand.grab = chance(0.1) ? !hand.grab : hand.grab;
        hand.edge_at = chance(0.1) ? std::max<std::uint8_t>(1, byte()) : std::uint8_t{0};
        hand.edge_pose = moved(hand.pose);
        if (chance(0.1)) {
            hand.squeeze = byte();
            hand.trigger = byte();
            hand.curls[2] = byte();
        }
    }
    if (chance(0.1)) {
        input.smooth_turn = static_cast<std::int8_t>(random.between(-127.0, 127.0));
        input.snap_turns = static_cast<std::int8_t>(random.between(-3.0, 3.0));
        input.brake = byte();
        input.thrust[1] = static_cast<std::int8_t>(random.between(-127.0, 127.0));
        input.calibrate = chance(0.5);
        input.buttons = static_cast<std::uint32_t>(random.between(0.0, 4e9));
    }
    return normalised(input);
}

TEST(InputCodec, ReadsWhatItWrites) {
    Random random(seed_of(2));
    std::vector<MatchInput> inputs(3);
    std::array<std::byte, 400> bytes{};
    for (int i = 0; i < 5000; ++i) {
        inputs.push_back(random_input(random, inputs.back()));
        const std::size_t n = inputs.size();
        const InputsBefore before = {&inputs[n - 2], &inputs[n - 3], &inputs[n - 4]};
        BitWriter out(bytes);
        write_input(before, inputs.back(), out);
        ASSERT_FALSE(out.has_failed());
        BitReader in{std::span(bytes).first(out.bytes())};
        const MatchInput read = read_input(before, in);
        ASSERT_FALSE(in.has_failed());
        ASSERT_EQ(read, inputs.back()) << i;
        ASSERT_LT(in.bits_left(), 8U);
        // Too few bytes: the writer fails and leaves what is behind them alone.
        std::array<std::byte, 8> few{};
        few.back() = std::byte{0x5a};
        BitWriter short_out{std::span(few).first(7)};
        write_input(before, inputs.back(), short_out);
        ASSERT_EQ(few.back(), std::byte{0x5a});
    }
}

// Hands that wave as people's do, with the noise of tracking (0.3 mm, 1 mrad).
TEST(InputCodec, WavingHandsTakeFewBytes) {
    Random random(seed_of(3));
    std::vector<MatchInput> inputs(3);
    std::array<std::byte, 400> bytes{};
    std::size_t bits = 0;
    constexpr int k_ticks = 2000;
    for (int i = 0; i < k_ticks; ++i) {
        const double t = i / 90.0;
        const auto noisy = [&](const Vec3& at, double turn) {
            const Vec3 shake = random.vector(0.3e-3);
            const Vec3 axis = random.direction();
            const Quat jitter = rotation_about(axis, random.between(0.0, 1e-3));
            return pack({at + shake, rotation_about(Vec3(0.6, 0.0, 0.8), turn) * jitter});
        };
        MatchInput input;
        input.is_head_tracked = true;
        input.head = noisy(Vec3(0.05 * std::sin(t), 1.6, 0.0), 0.3 * std::sin(0.7 * t));
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            MatchHand& hand = input.hands[side];
            hand.is_tracked = true;
            const double w = t * (side == 0 ? 2.0 : 3.0);
            hand.pose = noisy(Vec3(0.25 * std::sin(w), 1.2 + 0.15 * std::cos(w), -0.4),
                              0.8 * std::sin(1.3 * w));
        }
        inputs.push_back(normalised(input));
        const std::size_t n = inputs.size();
        BitWriter out(bytes);
        write_input({&inputs[n - 2], &inputs[n - 3], &inputs[n - 4]}, inputs.back(), out);
        bits += out.bits();
    }
    const double mean_bytes = static_cast<double>(bits) / 8.0 / k_ticks;
    RecordProperty("mean_bytes", std::to_string(mean_bytes));
    EXPECT_LE(mean_bytes, 12.0);
}

InputHistory history_of(const std::vector<MatchInput>& inputs) {
    InputHistory history;
    history.reset(0);
    for (const MatchInput& input : inputs) {
        history.finish_next(input, InputKind::real);
    }
    return history;
}
MatchInput with_head(const Vec3& at) {
    MatchInput input;
    input.is_head_tracked = true;
    input.head = pack({at, Quat::Identity()});
    return input;
}

TEST(PredictInput, ContinuesStraightMotion) {
    Random random(seed_of(4));
    for (int i = 0; i < 100; ++i) {
        const Vec3 velocity = random.vector(2.0) / 90.0;
        std::vector<MatchInput> inputs;
        for (int k = 0; k < 20; ++k) {
            inputs.push_back(with_head(Vec3(0.0, 1.6, 0.0) + k * velocity));
        }
        const InputTrend trend = trend_of(history_of(inputs));
        const MatchInput next = predict_input(trend, 21);
        const Vec3 expected = Vec3(0.0, 1.6, 0.0) + 20.0 * velocity;
        // The guess slows down a little.
        ASSERT_LE((unpack(next.head).position - expected).norm(), velocity.norm() / 14.0 + 1e-4);
        // It never travels farther than k_lag ticks of the motion.
        const MatchInput far = predict_input(trend, 80);
        ASSERT_LE((unpack(far.head).position - unpack(inputs.back().head).position).norm(),
                  k_lag_ticks * velocity.norm() + 1e-3);
        ASSERT_EQ(predict_input(trend, 20 + k_away_after_ticks + 1), MatchInput{});
    }
}

// One jump of tracking among still poses does not become a velocity.
TEST(PredictInput, JumpsAreNoMotion) {
    Random random(seed_of(5));
    for (int i = 0; i < 200; ++i) {
        std::vector<MatchInput> inputs(15, with_head(Vec3(0.0, 1.6, 0.0)));
        const auto at = static_cast<std::size_t>(random.between(6.0, 15.0));
        const Vec3 jump = random.arm(0.2, 3.0);
        for (std::size_t k = at; k < inputs.size(); ++k) {
            inputs[k] = with_head(Vec3(0.0, 1.6, 0.0) + jump);
        }
        const InputTrend trend = trend_of(history_of(inputs));
        for (const MatchTick tick : {16U, 30U, 60U}) {
            ASSERT_EQ(predict_input(trend, tick).head, inputs.back().head);
        }
    }
}

TEST(PredictInput, HoldsButtonsAndGuessesNoEdges) {
    MatchInput last = with_head(Vec3(0.0, 1.6, 0.0));
    last.hands[1].grab = true;
    last.hands[1].edge_at = 17;
    last.hands[1].squeeze = 200;
    last.snap_turns = 1;
    last.brake = 99;
    last.buttons = 5;
    const MatchInput guess = predict_input(trend_of(history_of({last})), 4);
    EXPECT_TRUE(guess.hands[1].grab);
    EXPECT_EQ(guess.hands[1].edge_at, 0);
    EXPECT_EQ(guess.hands[1].squeeze, 200);
    EXPECT_EQ(guess.snap_turns, 0);
    EXPECT_EQ(guess.brake, 99);
    EXPECT_EQ(guess.buttons, 5U);
    EXPECT_EQ(predict_input(trend_of(InputHistory()), 3), MatchInput{});
}

// Devices of any rate: the poses at the ends of ticks and the times of presses survive.
TEST(TickSampler, KeepsPosesAtTickEndsAndTimesOfPresses) {
    Random random(seed_of(6));
    constexpr double k_tick_s = 1.0 / 90.0;
    int presses = 0;
    for (const double device_hz : {60.0, 72.0, 90.0, 120.0, 500.0}) {
        TickSampler sampler;
        const auto hand_at = [](double t) { return Vec3(0.3 * std::sin(2.0 * t), 1.2, -0.3); };
        const auto pressed_at = [](double t) { return std::fmod(t, 0.37) > 0.2; };
        double next_s = 0.001;
        bool was = false;
        MatchInput before;
        for (int tick = 0; tick < 400; ++tick) {
            const double start_s = tick * k_tick_s;
            const double end_s = start_s + k_tick_s;
            double first_press_s = -1.0;
            bool now = was;
            for (; next_s <= end_s + 1.5 / device_hz; next_s += 1.0 / device_hz) {
                TrackingSample sample;
                sample.t_s = next_s;
                sample.head_ps.position = Vec3(0.0, 1.6, 0.0);
                for (ControllerSample& controller : sample.controllers) {
                    controller = {{hand_at(next_s), Quat::Identity()}, pressed_at(next_s)};
                }
                sampler.add(sample);
            }
            for (double t = 0.001 + std::ceil((start_s - 0.001) * device_hz) / device_hz;
                 t <= end_s; t += 1.0 / device_hz) {
                if (t > start_s && pressed_at(t) != now) {
                    now = pressed_at(t);
                    first_press_s = t;
                }
            }
            const MatchInput input = sampler.take(start_s, end_s, {});
            if (tick > 2) {
                ASSERT_TRUE(input.hands[0].is_tracked);
                const Vec3 error = unpack(input.hands[0].pose).position - hand_at(end_s);
                ASSERT_LE(error.norm(), 1e-3) << device_hz << ' ' << tick;
                ASSERT_EQ(input.hands[0].grab, now);
                const TickSamples samples = unpack_samples(before, input, start_s, end_s);
                if (now != was && first_press_s < end_s - 1e-4) {
                    ++presses;
                    ASSERT_EQ(samples.count, 2U);
                    ASSERT_NEAR(samples.samples[0].t_s, first_press_s, k_tick_s / 256.0);
                    ASSERT_EQ(samples.samples[0].controllers[0].grab, now);
                    ASSERT_LE((samples.samples[0].controllers[0].controller_ps.position -
                               hand_at(first_press_s))
                                  .norm(),
                              1e-3);
                }
                ASSERT_EQ(samples.samples[samples.count - 1].t_s, end_s);
            }
            was = now;
            before = input;
        }
        // Silent devices are held for a while, and then not tracked.
        const double late_s = 400.0 * k_tick_s;
        EXPECT_TRUE(sampler.take(late_s, late_s + k_tick_s, {}).is_head_tracked);
        EXPECT_FALSE(sampler.take(late_s + 1.0, late_s + 1.1, {}).is_head_tracked);
    }
    EXPECT_GT(presses, 60);
}

}  // namespace
}  // namespace handhold::input_codec_test
