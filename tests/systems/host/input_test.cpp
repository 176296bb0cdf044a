// Samples of the C interface: their stamps, and those that are given again.
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/ecs.hpp>
#include <handhold/handhold.hpp>
#include <handhold/math.hpp>
#include <rapidcheck/gtest.h>

#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_input_test {
namespace {

using namespace test;

TEST(HostSamples, StampsMayDifferFromTheClockByRounding) {
    HostScene scene;
    scene.add_wall();
    for (int frame = 1; frame <= 60; ++frame) {
        hh::Sample sample = scene.sample();
        sample.time_s = frame / 90.0;
        sample.grab[HH_RIGHT] = frame >= 54;
        ASSERT_TRUE(scene.world.step(k_step_s, hh::input(scene.player, {&sample, 1})));
        EXPECT_EQ(scene.world.hand(scene.player, HH_RIGHT)->is_closed, frame >= 54) << frame;
    }
}

// A host gives each sample once, always a little after the step's end, as headsets predict.
TEST(HostInput, SamplesOfAfterTheStepAreNotLost) {
    HostScene scene;
    for (int i = 0; i < 60; ++i) {
        hh::Sample now = scene.sample();
        now.time_s += 0.003;
        ASSERT_TRUE(scene.world.step(k_step_s, hh::input(scene.player, {&now, 1})));
    }
    EXPECT_TRUE(scene.hand(HH_RIGHT).is_tracked);
}

// Returns the samples of a stream that a host passes to one step: those up to its end, and the next
// one.
struct Stream {
    std::vector<hh::Sample> samples;
    std::size_t next = 0;

    std::span<const hh::Sample> once(double end_s) {
        const std::size_t first = next;
        while (next < samples.size() && (next == 0 || samples[next - 1].time_s <= end_s)) {
            ++next;
        }
        return std::span(samples).subspan(first, next - first);
    }
    std::span<const hh::Sample> window(double end_s) {
        const std::size_t first = next;
        while (next < samples.size() && samples[next].time_s <= end_s) {
            ++next;
        }
        const std::size_t last = std::min(next + 1, samples.size());
        return std::span(samples).subspan(first, last - first);
    }
};

// The same poses, whether the world keeps the sample after a step's end or is given it again; in
// the second case the state is that of step_frame with these windows.
RC_GTEST_PROP(HostSamples, MayBeGivenAgain, ()) {
    HostScene keeps;
    HostScene repeats;
    HostScene columns;
    for (HostScene* scene : {&keeps, &repeats, &columns}) {
        scene->add_wall();
    }
    Stream once;
    // Never within a microsecond of a step's end, where a kept sample would count as at the end.
    double t_s = 0.37e-3;
    for (int i = 0; i < 60; ++i) {
        t_s += 1e-3 * (*rc::gen::inRange(2, 25));
        hh::Sample sample = keeps.sample();
        sample.time_s = t_s;
        sample.hands[HH_RIGHT].position.x += 1e-3 * (*rc::gen::inRange(-3, 4));
        sample.grab[HH_RIGHT] = i > 10;
        once.samples.push_back(sample);
    }
    Stream again = once;
    Stream raw = once;
    for (int i = 0; i < 40; ++i) {
        const double end_s = keeps.world.time_s() + k_step_s;
        const hh_player_input first = hh::input(keeps.player, once.once(end_s));
        RC_ASSERT(static_cast<bool>(keeps.world.step(k_step_s, first)));
        hh_player_input second = hh::input(repeats.player, again.window(end_s));
        second.repeats_samples = true;
        RC_ASSERT(static_cast<bool>(repeats.world.step(k_step_s, second)));

        std::vector<TrackingSample> samples;
        for (const hh::Sample& sample : raw.window(end_s)) {
            TrackingSample& made = samples.emplace_back();
            made.t_s = sample.time_s;
            made.head_ps = from_host(sample.head);
            for (std::size_t side = 0; side < 2; ++side) {
                made.controllers[side].controller_ps = from_host(sample.hands[side]);
                made.controllers[side].grab = sample.grab[side] != 0;
            }
        }
        const HostColumns c = columns_of(columns.world.get());
        const PlayerInput input{entity_of(columns.player), samples, {}};
        StageStats stats;
        step_frame(c.world, c.caches, c.tuning, {k_step_s, {&input, 1}}, stats);

        const hh_player_pose a = *keeps.world.pose(keeps.player);
        const hh_player_pose b = *repeats.world.pose(repeats.player);
        RC_ASSERT(a.origin.position == b.origin.position);
        RC_ASSERT(a.hands[1].tracked.position == b.hands[1].tracked.position);
        RC_ASSERT(a.hands[1].grip == b.hands[1].grip);
        RC_ASSERT(repeats.world.hash() == columns.world.hash());
    }
}

// Rounding in a host may put a sample 1 ns after the step's end. Kept samples are rounded to the
// end; repeated ones are not.
TEST(HostSamples, AreTakenToTheBitIfTheyAreGivenAgain) {
    for (const bool repeats : {false, true}) {
        HostScene scene;
        std::array<hh::Sample, 2> samples = {scene.sample(), scene.sample()};
        samples[0].time_s = 0.0;
        samples[1].time_s += 1e-9;
        samples[1].grab[HH_RIGHT] = true;
        hh_player_input input = hh::input(scene.player, samples);
        input.repeats_samples = repeats;
        ASSERT_TRUE(scene.world.step(k_step_s, input));
        EXPECT_EQ(scene.hand(HH_RIGHT).is_closed, !repeats);
    }
}

}  // namespace
}  // namespace handhold::host_input_test
