#include <set>

#include <gtest/gtest.h>

#include "components/finger_chain.hpp"

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
                note_try(retry, true, most);
            }
            ASSERT_EQ(places.size(), most) << round;
            ASSERT_EQ(retry.since_m, 0.0) << round;  // all was tried: a hand at rest is done
        }
    }
}

TEST(FingerRetry, WaitsLongerWhileItIsInVain) {
    FingerRetry retry;
    double last_m = 0.0;
    for (int i = 0; i < 3; ++i) {
        note_try(retry, true, 6);
        EXPECT_GT(retry.wait_m, last_m);
        last_m = retry.wait_m;
    }
    for (int i = 0; i < 3000; ++i) {
        note_try(retry, true, 6);
        EXPECT_EQ(retry.wait_m, last_m);
    }
    note_try(retry, false, 6);
    EXPECT_LT(retry.wait_m, last_m);
}

}  // namespace
}  // namespace handhold::finger_retry_test
