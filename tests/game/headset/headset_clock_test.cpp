// Display times as frames of the simulation.
#include "game/headset/headset_clock.hpp"

#include <cstdint>

#include <gtest/gtest.h>

namespace handhold::headset_clock_test {
namespace {

constexpr std::int64_t k_period_ns = 11'111'111;
constexpr std::int64_t k_begin_ns = 5'000'000'000'000;

TEST(HeadsetClock, EveryRefreshHasOneFrameForHours) {
    HeadsetClock clock;
    EXPECT_EQ(clock.advance(k_begin_ns, k_period_ns), 0);
    EXPECT_EQ(clock.hz(), 90.0);
    // Runtimes count whole nanoseconds. At 90 Hz this drifts by one part in 1e8, which is less than
    // half a frame a day. Now and then a frame comes twice or not at all.
    std::int64_t frames = 0;
    constexpr std::int64_t k_refreshes = 90LL * 3600;
    for (std::int64_t i = 1; i <= k_refreshes; ++i) {
        frames += clock.advance(k_begin_ns + i * k_period_ns, k_period_ns);
    }
    EXPECT_EQ(frames, k_refreshes);
}

TEST(HeadsetClock, RatesOfDisplaysAreWhole) {
    for (const auto& [period_ns, hz] : {std::pair<std::int64_t, double>{13'888'889, 72.0},
                                        {16'666'667, 60.0},
                                        {8'333'333, 120.0},
                                        {6'944'444, 144.0},
                                        {12'500'000, 80.0}}) {
        HeadsetClock clock;
        clock.advance(k_begin_ns, period_ns);
        EXPECT_EQ(clock.hz(), hz);
    }
}

TEST(HeadsetClock, MissedRefreshesAreCaughtUpWithAtTheirOwnTimes) {
    HeadsetClock clock;
    clock.advance(k_begin_ns, k_period_ns);
    EXPECT_EQ(clock.advance(k_begin_ns + 4 * k_period_ns, k_period_ns), 4);
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(static_cast<double>(clock.frame_ns(i) - k_begin_ns),
                    static_cast<double>((4 - i) * k_period_ns), 10.0);
    }
    EXPECT_EQ(clock.advance(k_begin_ns + 4 * k_period_ns, k_period_ns), 0);  // seen already
    EXPECT_EQ(clock.advance(k_begin_ns + 5 * k_period_ns + 2'000'000, k_period_ns), 1);  // jitter
    EXPECT_EQ(clock.advance(k_begin_ns + 6 * k_period_ns - 2'000'000, k_period_ns), 1);
}

TEST(HeadsetClock, TimeGoesSlowerWhereThereIsTooMuchToCatchUpWith) {
    HeadsetClock clock;
    clock.advance(k_begin_ns, k_period_ns);
    EXPECT_EQ(clock.advance(k_begin_ns + 900 * k_period_ns, k_period_ns),
              HeadsetClock::k_max_frames);
    // What was left out is not asked for again, and poses are asked for as of now.
    EXPECT_NEAR(static_cast<double>(clock.frame_ns(0) - k_begin_ns),
                static_cast<double>(900 * k_period_ns), 2e4);
    EXPECT_EQ(clock.advance(k_begin_ns + 901 * k_period_ns, k_period_ns), 1);
}

TEST(HeadsetClock, NoTimePassesDuringAPauseAndTheRateStays) {
    HeadsetClock clock;
    clock.advance(k_begin_ns, k_period_ns);
    clock.advance(k_begin_ns + 3 * k_period_ns, k_period_ns);
    clock.pause();
    constexpr std::int64_t k_other_ns = 77;  // the clock of another runtime
    EXPECT_EQ(clock.advance(k_other_ns, 2 * k_period_ns), 0);
    EXPECT_EQ(clock.hz(), 90.0);
    EXPECT_EQ(clock.advance(k_other_ns + k_period_ns, k_period_ns), 1);
    EXPECT_NEAR(static_cast<double>(clock.frame_ns(0)),
                static_cast<double>(k_other_ns + k_period_ns), 10.0);
}

}  // namespace
}  // namespace handhold::headset_clock_test
