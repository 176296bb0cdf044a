// The bytes that wait for one connection, and what it may send, stay within their limits.
#include "game/net/send_queue.hpp"

#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "game/net/receive_budget.hpp"

namespace handhold::send_queue_test {
namespace {

// Each message begins with its number.
std::vector<std::byte> numbered(std::size_t number, std::size_t size) {
    std::vector<std::byte> message(size);
    for (std::size_t i = 0; i < 4; ++i) {
        message[i] = static_cast<std::byte>((number >> (8 * i)) & 0xffU);
    }
    return message;
}
std::size_t number_of(std::span<const std::byte> message) {
    std::size_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        number |= std::to_integer<std::size_t>(message[i]) << (8 * i);
    }
    return number;
}

// A model: reliable messages all come, in order, until one is refused; newest ones come in order,
// and the last one always.
RC_GTEST_PROP(SendQueue, IsBoundedAndLosesOnlyOldNewestMessages,
              (std::vector<std::uint16_t> what)) {
    SendQueue queue;
    std::vector<std::size_t> reliable;
    std::size_t refused = 0;
    std::size_t last_newest = 0;
    for (std::size_t i = 0; i < what.size(); ++i) {
        const std::uint16_t draw = what[i];
        const std::size_t size = 4 + draw % 9000U;
        if (draw % 3 == 0) {
            if (queue.push(Delivery::reliable, numbered(i + 1, size))) {
                reliable.push_back(i + 1);
            } else {
                ++refused;
            }
        } else {
            const std::uint64_t dropped = queue.dropped();
            RC_ASSERT(queue.push(Delivery::newest, numbered(i + 1, size)));
            // It is dropped itself only where reliable messages leave no space.
            last_newest = queue.dropped() > dropped ? last_newest : i + 1;
        }
        RC_ASSERT(queue.bytes() <= SendQueue::k_most_bytes);
    }
    std::vector<std::size_t> found;
    std::size_t newest = 0;
    std::size_t before = 0;
    while (!queue.is_empty()) {
        const std::size_t number = number_of(queue.front());
        RC_ASSERT(number > before);
        before = number;
        if (std::ranges::find(reliable, number) != reliable.end()) {
            found.push_back(number);
        } else {
            ++newest;
        }
        queue.pop();
    }
    RC_ASSERT(queue.bytes() == 0U);
    RC_ASSERT(found == reliable);
    RC_ASSERT(newest <= SendQueue::k_most_newest);
    RC_TAG(refused > 0);
}

TEST(SendQueue, ReceiverThatReadsNothingGetsTheNewestPackets) {
    SendQueue queue;
    for (std::size_t i = 1; i <= 1000; ++i) {
        ASSERT_TRUE(queue.push(Delivery::newest, numbered(i, 200)));
    }
    EXPECT_EQ(queue.dropped(), 1000 - SendQueue::k_most_newest);
    EXPECT_EQ(queue.bytes(), 200 * SendQueue::k_most_newest);
    EXPECT_EQ(number_of(queue.front()), 1001 - SendQueue::k_most_newest);
}

TEST(ReceiveBudget, LetsUsualPeersThroughAndNoMoreThanItsRate) {
    const LinkBudget limits{.messages_per_s = 200.0, .bytes_per_s = 20e3, .burst_s = 0.5};
    ReceiveBudget usual(limits);
    for (int i = 1; i <= 900; ++i) {
        EXPECT_TRUE(usual.take(1, 120, i / 90.0));
    }
    ReceiveBudget flooded(limits);
    int taken = 0;
    bool is_read = true;
    for (int i = 1; i <= 100000; ++i) {  // 10 s
        const double now_s = i / 10000.0;
        is_read = is_read || flooded.may_read(now_s);
        if (is_read) {
            ++taken;
            is_read = flooded.take(1, 20, now_s);
        }
    }
    EXPECT_GT(taken, 1500);
    EXPECT_LE(taken, 2200);  // 10 s at 200, and the burst
}

}  // namespace
}  // namespace handhold::send_queue_test
