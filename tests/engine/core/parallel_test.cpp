#include "engine/core/parallel.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/check.hpp"
#include "engine/core/hash.hpp"
#include "tests/engine/allocation_count.hpp"

namespace handhold::parallel_test {
namespace {

// Sets the count for one test.
class ThreadCount {
  public:
    explicit ThreadCount(int count) : before_(thread_count()) { set_thread_count(count); }
    ~ThreadCount() { set_thread_count(before_); }
    ThreadCount(const ThreadCount&) = delete;
    ThreadCount& operator=(const ThreadCount&) = delete;

  private:
    int before_;
};

TEST(ParallelThreaded, TwoWorkersReallyRun) {
    using Clock = std::chrono::steady_clock;
    const ThreadCount threads(2);
    std::atomic<int> present = 0;
    std::atomic<int> met = 0;
    // Each task waits for the other: one thread alone could never let them meet.
    auto wait_for_other = [&](std::size_t) {
        ++present;
        const Clock::time_point give_up = Clock::now() + std::chrono::seconds(20);
        while (present < 2 && Clock::now() < give_up) {
            std::this_thread::yield();
        }
        met += present == 2 ? 1 : 0;
    };
    parallel_for(2, wait_for_other);
    EXPECT_EQ(met, 2);
}

TEST(ParallelThreaded, EveryIndexRunsExactlyOnce) {
    for (const int count : {1, 2, 3, 16}) {
        const ThreadCount threads(count);
        for (const std::size_t size : {0U, 1U, 2U, 3U, 1000U, 50000U}) {
            std::vector<int> runs(size, 0);
            auto run = [&](std::size_t i) { ++runs[i]; };
            parallel_for(size, run);
            EXPECT_EQ(runs, std::vector<int>(size, 1)) << count << " threads";
        }
    }
}

TEST(ParallelThreaded, WritesAreSeenByTheCaller) {
    const ThreadCount threads(4);
    std::vector<std::uint64_t> values(2000);
    for (std::uint64_t round = 0; round < 100; ++round) {
        auto mix = [&](std::size_t i) { values[i] = mix64(values[i] + round); };
        parallel_for(values.size(), mix);
    }
    for (const std::uint64_t value : values) {
        std::uint64_t expected = 0;
        for (std::uint64_t round = 0; round < 100; ++round) {
            expected = mix64(expected + round);
        }
        ASSERT_EQ(value, expected);
    }
}

TEST(ParallelThreaded, NestedCallsRunOnTheirOwnThreadInOrder) {
    const ThreadCount threads(4);
    constexpr std::size_t k_outer = 64;
    std::vector<std::vector<std::size_t>> order(k_outer);
    std::atomic<int> strangers = 0;
    auto outer = [&](std::size_t i) {
        const std::thread::id own = std::this_thread::get_id();
        auto inner = [&](std::size_t j) {
            strangers += std::this_thread::get_id() == own ? 0 : 1;
            order[i].push_back(j);
        };
        parallel_for(3, inner);
    };
    parallel_for(k_outer, outer);
    EXPECT_EQ(strangers, 0);
    EXPECT_EQ(order, std::vector<std::vector<std::size_t>>(k_outer, {0, 1, 2}));
}

TEST(ParallelThreaded, CallsOfTwoHostThreadsDoNotDisturbEachOther) {
    const ThreadCount threads(2);
    const auto count_up = [](std::vector<int>& runs) {
        auto run = [&](std::size_t i) { ++runs[i]; };
        for (int round = 0; round < 50; ++round) {
            parallel_for(runs.size(), run);
        }
    };
    std::vector<int> here(500, 0);
    std::vector<int> there(500, 0);
    std::thread host([&] { count_up(there); });
    count_up(here);
    host.join();
    EXPECT_EQ(here, std::vector<int>(500, 50));
    EXPECT_EQ(there, std::vector<int>(500, 50));
}

TEST(Parallel, OneThreadIsSerialInOrderOnTheCallersThread) {
    const ThreadCount threads(1);
    const std::thread::id caller = std::this_thread::get_id();
    std::vector<std::size_t> order;
    auto run = [&](std::size_t i) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        order.push_back(i);
    };
    parallel_for(5, run);
    EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(Parallel, SerialPathAllocatesNothing) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "a sanitizer's own operator new does not count";
    }
    const ThreadCount threads(1);
    std::size_t sum = 0;
    auto add = [&](std::size_t i) { sum += i; };
    const std::size_t before = allocation_count();
    parallel_for(1000, add);
    EXPECT_EQ(allocation_count(), before);
    EXPECT_EQ(sum, 499500U);
}

TEST(ParallelThreaded, OneIndexStaysOnTheCallersThread) {
    const ThreadCount threads(4);
    std::thread::id runner;
    auto run = [&](std::size_t) { runner = std::this_thread::get_id(); };
    parallel_for(1, run);
    EXPECT_EQ(runner, std::this_thread::get_id());
}

TEST(Parallel, CountBelowOneIsRefusedAndChangesNothing) {
    const int before = thread_count();
    EXPECT_THROW(set_thread_count(0), PreconditionError);
    EXPECT_THROW(set_thread_count(-3), PreconditionError);
    EXPECT_EQ(thread_count(), before);
}

TEST(ParallelThreaded, CountMayChangeBetweenCalls) {
    for (const int count : {4, 1, 2, 16, 1, 3}) {
        const ThreadCount threads(count);
        EXPECT_EQ(thread_count(), count);
        std::atomic<std::size_t> sum = 0;
        auto add = [&](std::size_t i) { sum += i; };
        parallel_for(101, add);
        EXPECT_EQ(sum, 5050U);
    }
}

}  // namespace
}  // namespace handhold::parallel_test
