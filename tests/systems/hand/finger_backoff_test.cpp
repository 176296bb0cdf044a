#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "systems/hand/shared/finger_chain.hpp"

namespace handhold::finger_retry_test {
namespace {

// However long it is in vain, every place of the round has its turn and the round comes to an end.
TEST(FingerRetry, RoundsGoOnForEver) {
    for (const std::uint32_t most : {1U, 3U, 6U}) {
        FingerRetry retry;
        for (int round = 0; round < 2000; ++round) {
            std::set<std::uint32_t> places;
            for (std::uint32_t i = 0; i < most; ++i) {
                age(retry, 0.03, 0.011);
                ASSERT_TRUE(may_retry(retry)) << round;
                places.insert(retry.tries % most);
                note_try(retry, true, false, most);
            }
            ASSERT_EQ(places.size(), most) << round;
            ASSERT_EQ(retry.since_m, 0.0) << round;  // all was tried: a hand at rest is done
        }
    }
}

// A fast hand tries less than a slow one: when it stops, all is still to be tried.
TEST(FingerRetry, TriesOfAFastHandAreNotAllThereIsToTry) {
    FingerRetry retry;
    age(retry, 0.01, 0.011);
    note_try(retry, true, true);
    EXPECT_EQ(retry.since_m, 0.01);
    EXPECT_TRUE(retry.was_fast);
    note_try(retry, true, false);
    EXPECT_EQ(retry.since_m, 0.0);
    EXPECT_FALSE(retry.was_fast);
}

// Samples that come at half the frames' rate let a fast hand stand in every second frame.
TEST(IsSlow, AHandIsAfterAMoment) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const FingerTuning tuning;
    FingerPose pose;
    for (int frame = 0; frame < 90; ++frame) {
        note_speed(frame % 2 == 0 ? 0.2 * k_dt_s : 0.0, k_dt_s, tuning, pose);
        ASSERT_FALSE(is_slow(pose)) << frame;
    }
    for (int frame = 0; frame < 10; ++frame) {
        note_speed(0.9 * tuning.slow_mps * k_dt_s, k_dt_s, tuning, pose);
    }
    EXPECT_TRUE(is_slow(pose));
    for (int frame = 0; frame < 900; ++frame) {
        note_speed(0.0, k_dt_s, tuning, pose);
    }
    EXPECT_LE(pose.slow_s, 1.0);
    note_speed(1.1 * tuning.slow_mps * k_dt_s, k_dt_s, tuning, pose);
    EXPECT_FALSE(is_slow(pose));

    FingerTuning none = tuning;
    none.slow_mps = 0.0;
    FingerPose cold;
    note_speed(0.0, std::numeric_limits<double>::infinity(), none, cold);
    EXPECT_TRUE(is_slow(cold));
}

// What a standing finger sees from one pose and not from the next it looks for once, or it would
// swing between the two for ever; when the hand moves it looks again.
TEST(FingerOutlook, AStandingFingerLooksNoMoreForWhatIsGone) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const auto look = [](bool is_ahead, FingerOutlook& outlook) {
        ChainFit fit;
        fit.fallback = ChainFallback::relaxed;
        fit.has_looked_ahead = true;
        fit.is_ahead = is_ahead;
        note_outlook(fit, outlook);
    };
    for (const bool was_ahead : {false, true}) {
        FingerOutlook outlook;
        look(was_ahead, outlook);
        look(false, outlook);
        for (int frame = 0; frame < 45; ++frame) {
            age(outlook, 0.0, k_dt_s);
        }
        EXPECT_EQ(is_ahead(outlook, true).has_value(), was_ahead);
        for (int frame = 0; frame < 4; ++frame) {
            age(outlook, 1e-3, k_dt_s);
        }
        EXPECT_FALSE(is_ahead(outlook, true).has_value());
    }
}

TEST(FingerRetry, WaitsLongerWhileItIsInVain) {
    FingerRetry retry;
    double last_m = 0.0;
    for (int i = 0; i < 3; ++i) {
        note_try(retry, true, false, 6);
        EXPECT_GT(retry.wait_m, last_m);
        last_m = retry.wait_m;
    }
    for (int i = 0; i < 3000; ++i) {
        note_try(retry, true, false, 6);
        EXPECT_EQ(retry.wait_m, last_m);
    }
    note_try(retry, false, false, 6);
    EXPECT_LT(retry.wait_m, last_m);
}

}  // namespace
}  // namespace handhold::finger_retry_test
