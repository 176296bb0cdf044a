// Samples stamped ahead of their steps, and by other clocks.
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_samples_test {
namespace {

using test::HostScene;
using test::k_palm_ahead;
using test::Random;

std::uint64_t count_of(const hh::World& world, const std::string& name) {
    std::vector<std::uint64_t> counts(300);
    std::size_t count = 0;
    EXPECT_EQ(hh_world_fallbacks(world.get(), counts.data(), counts.size(), &count), HH_OK);
    for (std::size_t i = 0; i < count; ++i) {
        if (name == hh_fallback_name(i)) {
            return counts[i];
        }
    }
    ADD_FAILURE() << "no counter " << name;
    return 0;
}

// A session beside a wall: hands sway, the right one opens and closes.
hh::Sample sample_at(double t_s) {
    hh::Sample made = hh::sample();
    made.time_s = t_s;
    made.head.position = {0.02 * std::sin(5.0 * t_s), 1.6, 0.03 * std::cos(3.0 * t_s)};
    made.hands[0] = hh::pose_at({-0.25, 1.3 + 0.1 * std::sin(4.0 * t_s), -0.3}, k_palm_ahead);
    made.hands[1] = hh::pose_at({0.2 + 0.1 * std::sin(6.0 * t_s), 1.4, -0.43}, k_palm_ahead);
    made.grab[1] = std::fmod(t_s, 0.6) > 0.3;
    return made;
}

bool are_same(const hh_player_pose& a, const hh_player_pose& b) {
    const auto same = [](const hh_pose& p, const hh_pose& q) {
        return p.position == q.position && p.rotation == q.rotation;
    };
    bool result = same(a.origin, b.origin) && same(a.head, b.head);
    for (std::size_t side = 0; side < 2; ++side) {
        result = result && same(a.hands[side].tracked, b.hands[side].tracked) &&
                 same(a.hands[side].shown, b.hands[side].shown) &&
                 a.hands[side].grip == b.hands[side].grip;
    }
    return result;
}

// Sums over all sessions.
struct Counts {
    std::size_t steps = 0;
    std::size_t ahead = 0;    // samples waiting after a step that the other host does not have yet
    std::size_t gripped = 0;  // steps in which the right hand grips
};

// Devices of 40 to 120 Hz with jitter, stamped up to 0.5 s ahead, at any frame rate: each sample
// counts at its time, as if the host had given it only then. Saved and restored on the way. The
// other host gets only one sample after each step's end, which interpolation needs.
void compare_hosts(Counts& counts) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const double device_hz = random.between(40.0, 120.0);
    const double dt_s = 1.0 / random.between(30.0, 144.0);
    const double lead_s = random.between(0.0, 0.5) * (1.0 - 1e-6);
    const bool gives_empty_steps = *rc::gen::arbitrary<bool>();
    HostScene ahead;
    HostScene then;
    RC_ASSERT(ahead.world.has(ahead.add_wall()));
    RC_ASSERT(then.world.has(then.add_wall()));
    std::vector<hh::Sample> all;
    for (double t_s = 0.3 / device_hz; t_s < 4.0;) {
        all.push_back(sample_at(t_s));
        t_s += random.between(0.6, 1.4) / device_hz;
    }
    std::size_t next_ahead = 0;
    std::size_t next_then = 0;
    const int steps = static_cast<int>(2.0 / dt_s);
    for (int step = 0; step < steps; ++step) {
        const double end_s = ahead.world.time_s() + dt_s;
        const auto give = [&](HostScene& scene, std::size_t& next, auto&& is_given) {
            const std::size_t first = next;
            while (next < all.size() && is_given(next)) {
                ++next;
            }
            hh_player_input input = hh_default_player_input();
            input.player = scene.player;
            input.samples = all.data() + first;
            input.sample_count = next - first;
            const bool is_silent = next == first && gives_empty_steps;
            RC_ASSERT(hh_world_step(scene.world.get(), dt_s, &input, is_silent ? 0 : 1) == HH_OK);
        };
        // Both know the step's samples and the one after; at most 64 wait.
        const auto is_known = [&](std::size_t i) { return i == 0 || all[i - 1].time_s <= end_s; };
        give(ahead, next_ahead, [&](std::size_t i) {
            constexpr std::size_t k_most_waiting = 64;
            const bool has_room = i < k_most_waiting || all[i - k_most_waiting].time_s <= end_s;
            return is_known(i) || (has_room && all[i].time_s <= end_s + lead_s);
        });
        give(then, next_then, is_known);
        hh_player_pose a;
        hh_player_pose b;
        RC_ASSERT(hh_world_player_poses(ahead.world.get(), &ahead.player, 1, &a) == HH_OK);
        RC_ASSERT(hh_world_player_poses(then.world.get(), &then.player, 1, &b) == HH_OK);
        RC_ASSERT(are_same(a, b));
        ++counts.steps;
        counts.ahead += next_ahead - next_then;
        counts.gripped += a.hands[HH_RIGHT].grip != HH_GRIP_NONE ? 1 : 0;
        if (step == steps / 2) {
            std::vector<std::byte> saved;
            RC_ASSERT(static_cast<bool>(ahead.world.save(saved)));
            RC_ASSERT(hh_world_restore(ahead.world.get(), saved.data(), saved.size()) == HH_OK);
        }
    }
    RC_ASSERT(count_of(ahead.world, "sample_too_far_ahead") == 0U);
}

TEST(HostSamples, SamplesGivenAheadCountAtTheirTime) {
    Counts counts;
    EXPECT_TRUE(rc::check([&counts] { compare_hosts(counts); }));
    // On average 0.25 s of 80 Hz wait; the right hand is closed for 0.9 s of 2.
    EXPECT_GT(counts.ahead, 10 * counts.steps);
    EXPECT_GT(10 * counts.gripped, 3 * counts.steps);
}

// A later prediction replaces those of its time and later.
TEST(HostSamples, NewerPredictionsReplaceKeptOnes) {
    HostScene scene;
    std::vector<hh::Sample> first = {sample_at(0.05), sample_at(0.10), sample_at(0.15)};
    ASSERT_TRUE(scene.world.step(0.01, hh::input(scene.player, {first.data(), first.size()})));
    hh::Sample better = sample_at(0.10);
    better.head.position.x = 0.04;
    ASSERT_TRUE(scene.world.step(0.09, hh::input(scene.player, {&better, 1})));
    hh_player_pose pose;
    ASSERT_EQ(hh_world_player_poses(scene.world.get(), &scene.player, 1, &pose), HH_OK);
    EXPECT_NEAR(pose.head.position.x, 0.04, 1e-12);
    EXPECT_EQ(count_of(scene.world, "sample_out_of_order"), 0U);
}

// During a pause devices move on: samples that waited for their step say nothing about the time
// after it.
TEST(HostSamples, APauseDropsKeptSamples) {
    HostScene scene;
    std::vector<hh::Sample> ahead;
    for (int i = 1; i <= 20; ++i) {
        ahead.push_back(sample_at(0.01 * i));
    }
    ASSERT_TRUE(scene.world.step(0.01, hh::input(scene.player, {ahead.data(), ahead.size()})));
    hh::Sample paused = sample_at(0.0);
    paused.head.position = {0.5, 1.6, 0.0};
    const hh_player_input input = hh::input(scene.player, {&paused, 1});
    ASSERT_EQ(hh_world_step_pose_only(scene.world.get(), 0.01, &input, 1), HH_OK);
    ASSERT_EQ(hh_world_step(scene.world.get(), 0.01, nullptr, 0), HH_OK);
    hh_player_pose pose;
    ASSERT_EQ(hh_world_player_poses(scene.world.get(), &scene.player, 1, &pose), HH_OK);
    EXPECT_DOUBLE_EQ(pose.head.position.x, 0.5);
}

TEST(HostSamples, SnapshotsGrowOnlyByTheSamplesThatWait) {
    const auto bytes_with = [](int waiting) {
        HostScene scene;
        std::vector<hh::Sample> given = {sample_at(0.01)};
        for (int i = 1; i <= waiting; ++i) {
            given.push_back(sample_at(0.01 + 0.005 * i));
        }
        EXPECT_TRUE(scene.world.step(0.01, hh::input(scene.player, {given.data(), given.size()})));
        std::vector<std::byte> saved;
        EXPECT_TRUE(scene.world.save(saved));
        EXPECT_EQ(hh_world_restore(scene.world.get(), saved.data(), saved.size()), HH_OK);
        std::vector<std::byte> again;
        EXPECT_TRUE(scene.world.save(again));
        EXPECT_EQ(saved, again);
        return saved.size();
    };
    const std::size_t none = bytes_with(0);
    const std::size_t one = bytes_with(1);
    const std::size_t two = bytes_with(2);
    const std::size_t sample_bytes = two - one;
    EXPECT_LT(one - none - sample_bytes, 16U);  // the owner and the count
    EXPECT_LT(sample_bytes, 400U);
    EXPECT_EQ(bytes_with(64), one + 63 * sample_bytes);
}

TEST(HostSamples, MoreThan64SamplesOrHalfASecondAheadAreDroppedAndCounted) {
    HostScene scene;
    std::vector<hh::Sample> many;
    for (int i = 0; i < 70; ++i) {
        many.push_back(sample_at(0.02 + 0.005 * i));
    }
    ASSERT_TRUE(scene.world.step(0.01, hh::input(scene.player, {many.data(), many.size()})));
    EXPECT_EQ(count_of(scene.world, "sample_too_far_ahead"), 6U);
    HostScene other;
    const std::vector<hh::Sample> two = {sample_at(0.51), sample_at(0.5101)};
    ASSERT_TRUE(other.world.step(0.01, hh::input(other.player, {two.data(), two.size()})));
    EXPECT_EQ(count_of(other.world, "sample_too_far_ahead"), 1U);
}

// The devices' clock goes on while the world's stands still.
TEST(HostSamples, PausesFollowSamplesWhateverTheirTime) {
    HostScene scene;
    const hh::Sample before = sample_at(0.01);
    ASSERT_TRUE(scene.world.step(0.01, hh::input(scene.player, {&before, 1})));
    for (int i = 2; i <= 200; ++i) {
        const hh::Sample sample = sample_at(0.01 * i);
        const hh_player_input input = hh::input(scene.player, {&sample, 1});
        ASSERT_TRUE(scene.world.step_pose_only(0.01, {&input, 1}));
        hh_player_pose pose;
        ASSERT_EQ(hh_world_player_poses(scene.world.get(), &scene.player, 1, &pose), HH_OK);
        ASSERT_NEAR(pose.head.position.x, sample.head.position.x, 1e-12) << i;
    }
    EXPECT_EQ(count_of(scene.world, "sample_too_far_ahead"), 0U);
}

// The lines of the log while it lives.
class HeardLog {
  public:
    HeardLog() {
        said_.clear();
        hh_host_hooks hooks = hh_default_host_hooks();
        hooks.log = [](void* /*context*/, hh_log_level /*level*/, const char* text) {
            said_.emplace_back(text);
        };
        EXPECT_EQ(hh_set_host_hooks(&hooks), HH_OK);
    }
    ~HeardLog() {
        const hh_host_hooks hooks = hh_default_host_hooks();
        EXPECT_EQ(hh_set_host_hooks(&hooks), HH_OK);
    }
    HeardLog(const HeardLog&) = delete;
    HeardLog& operator=(const HeardLog&) = delete;
    std::vector<std::string> take() { return std::exchange(said_, {}); }

  private:
    static inline std::vector<std::string> said_;
};

// Samples of a clock that is off by any amount above half a second: the counter and, once, the log.
TEST(HostSamples, OtherClocksAreNamedOnceInTheLogAndCounted) {
    HeardLog log;
    Random random(3);
    for (int i = 0; i < 20; ++i) {
        const double sign = i % 2 == 0 ? 1.0 : -1.0;
        const double off_s = sign * std::exp(random.between(-0.4, 21.0));
        HostScene scene;
        for (int step = 1; step <= 30; ++step) {
            const hh::Sample sample = [&] {
                hh::Sample made = sample_at(step * test::k_step_s);
                made.time_s += off_s;
                return made;
            }();
            ASSERT_TRUE(scene.world.step(test::k_step_s, hh::input(scene.player, {&sample, 1})));
            EXPECT_EQ(count_of(scene.world, sign > 0.0 ? "sample_too_far_ahead" : "sample_too_old"),
                      1U)
                << off_s;
        }
        const std::vector<std::string> said = log.take();
        ASSERT_EQ(said.size(), 1U) << off_s;
        EXPECT_NE(said[0].find("clock"), std::string::npos) << said[0];
    }
}

// Tracked devices whose pose has no rotation or no finite place: counted, and named once in the
// log.
TEST(HostSamples, InvalidPosesAreNamedOnceInTheLogAndCounted) {
    constexpr std::array k_names = {"the left hand", "the right hand", "the head"};
    constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
    HeardLog log;
    for (std::size_t device = 0; device < k_names.size(); ++device) {
        for (const bool is_tracked : {true, false}) {
            HostScene scene;
            for (int step = 1; step <= 30; ++step) {
                hh::Sample sample = sample_at(step * test::k_step_s);
                hh_pose& pose = device < 2 ? sample.hands[device] : sample.head;
                (device < 2 ? sample.hand_tracked[device] : sample.head_tracked) =
                    is_tracked ? 1 : 0;
                pose.rotation = {step % 2 == 0 ? 0.0 : k_nan, 0.0, 0.0, 0.0};
                ASSERT_TRUE(
                    scene.world.step(test::k_step_s, hh::input(scene.player, {&sample, 1})));
                EXPECT_EQ(count_of(scene.world, "sample_not_finite"), 1U);
            }
            const std::vector<std::string> said = log.take();
            ASSERT_EQ(said.size(), is_tracked ? 1U : 0U);
            EXPECT_TRUE(!is_tracked || said[0].starts_with(k_names[device])) << said[0];
        }
    }
}

}  // namespace
}  // namespace handhold::host_samples_test
