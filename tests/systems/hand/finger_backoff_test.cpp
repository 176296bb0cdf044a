#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "systems/hand/shared/finger_chain.hpp"

namespace handhold::finger_backoff_test {
namespace {

// However often refits fail, each round tries every option once and then ends.
TEST(FingerBackoff, TriesEveryOptionOncePerRound) {
    for (const std::uint32_t option_count : {1U, 3U, 6U}) {
        FingerBackoff backoff;
        for (int round = 0; round < 2000; ++round) {
            std::set<std::uint32_t> options;
            for (std::uint32_t i = 0; i < option_count; ++i) {
                advance(backoff, 0.03, 0.011);
                ASSERT_TRUE(is_retry_due(backoff)) << round;
                options.insert(backoff.failures % option_count);
                record_attempt(backoff, true, false, option_count);
            }
            ASSERT_EQ(options.size(), option_count) << round;
            ASSERT_EQ(backoff.travel_since_m, 0.0)
                << round;  // every option failed: a hand at rest is done
        }
    }
}

// A fast hand's refits have fewer options than a slow hand's, so a slow hand refits again.
TEST(FingerBackoff, FastHandsAttemptsDoNotCompleteARound) {
    FingerBackoff backoff;
    advance(backoff, 0.01, 0.011);
    record_attempt(backoff, true, true);
    EXPECT_EQ(backoff.travel_since_m, 0.01);
    EXPECT_TRUE(backoff.was_fast_hand);
    record_attempt(backoff, true, false);
    EXPECT_EQ(backoff.travel_since_m, 0.0);
    EXPECT_FALSE(backoff.was_fast_hand);
}

// A fast hand sampled at half the frame rate stands still in every second frame.
TEST(IsSlow, OnlyAfterATenthOfASecond) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const FingerTuning tuning;
    FingerPose pose;
    for (int frame = 0; frame < 90; ++frame) {
        update_slow_time(frame % 2 == 0 ? 0.2 * k_dt_s : 0.0, k_dt_s, tuning, pose);
        ASSERT_FALSE(is_slow(pose)) << frame;
    }
    for (int frame = 0; frame < 10; ++frame) {
        update_slow_time(0.9 * tuning.slow_speed_mps * k_dt_s, k_dt_s, tuning, pose);
    }
    EXPECT_TRUE(is_slow(pose));
    for (int frame = 0; frame < 900; ++frame) {
        update_slow_time(0.0, k_dt_s, tuning, pose);
    }
    EXPECT_LE(pose.slow_s, 1.0);
    update_slow_time(1.1 * tuning.slow_speed_mps * k_dt_s, k_dt_s, tuning, pose);
    EXPECT_FALSE(is_slow(pose));

    FingerTuning none = tuning;
    none.slow_speed_mps = 0.0;
    FingerPose cold;
    update_slow_time(0.0, std::numeric_limits<double>::infinity(), none, cold);
    EXPECT_TRUE(is_slow(cold));
}

// A finger at rest may see a surface from one pose and not from the next. It must not oscillate
// between the two, so it waits until the hand moves.
TEST(FingerLookahead, FingerAtRestDoesNotQueryAgainAfterLosingSurface) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const auto store_query = [](bool has_surface_ahead, FingerLookahead& lookahead) {
        ChainFit fit;
        fit.fallback = ChainFallback::rest_pose;
        fit.has_look_ahead = true;
        fit.has_surface_ahead = has_surface_ahead;
        update_lookahead(fit, lookahead);
    };
    for (const bool was_ahead : {false, true}) {
        FingerLookahead lookahead;
        store_query(was_ahead, lookahead);
        store_query(false, lookahead);
        for (int frame = 0; frame < 45; ++frame) {
            advance(lookahead, 0.0, k_dt_s);
        }
        EXPECT_EQ(has_surface_ahead(lookahead, true).has_value(), was_ahead);
        for (int frame = 0; frame < 4; ++frame) {
            advance(lookahead, 1e-3, k_dt_s);
        }
        EXPECT_FALSE(has_surface_ahead(lookahead, true).has_value());
    }
}

TEST(FingerBackoff, GrowsWithFailuresUpToALimit) {
    FingerBackoff backoff;
    double last_m = 0.0;
    for (int i = 0; i < 3; ++i) {
        record_attempt(backoff, true, false, 6);
        EXPECT_GT(backoff.retry_in_m, last_m);
        last_m = backoff.retry_in_m;
    }
    for (int i = 0; i < 3000; ++i) {
        record_attempt(backoff, true, false, 6);
        EXPECT_EQ(backoff.retry_in_m, last_m);
    }
    record_attempt(backoff, false, false, 6);
    EXPECT_LT(backoff.retry_in_m, last_m);
}

}  // namespace
}  // namespace handhold::finger_backoff_test
