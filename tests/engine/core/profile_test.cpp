#include "engine/core/profile.hpp"

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/engine/allocation_count.hpp"

namespace handhold::profile_test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

// An empty temporary folder, removed with the test.
class TraceFolder {
  public:
    TraceFolder() {
        const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
        path_ = fs::path(testing::TempDir()) / (std::string("handhold_trace_") + test->name());
        fs::remove_all(path_);
        fs::create_directories(path_);
    }
    ~TraceFolder() { fs::remove_all(path_); }
    TraceFolder(const TraceFolder&) = delete;
    TraceFolder& operator=(const TraceFolder&) = delete;
    fs::path path() const { return path_; }

  private:
    fs::path path_;
};

Json written_trace() {
    const TraceFolder folder;
    const fs::path path = folder.path() / "trace.json";
    EXPECT_FALSE(write_trace(path.string()));
    std::ifstream in(path);
    return Json::parse(in);
}

// The events of one name, in file order.
std::vector<Json> events_named(const Json& trace, const std::string& name) {
    std::vector<Json> found;
    for (const Json& event : trace.at("traceEvents")) {
        if (event.at("name") == name) {
            found.push_back(event);
        }
    }
    return found;
}

double begin_us(const Json& event) { return event.at("ts").get<double>(); }
double end_us(const Json& event) { return begin_us(event) + event.at("dur").get<double>(); }

TEST(Profile, TraceIsJsonOfCompleteEvents) {
    start_trace();
    { HH_ZONE("solve_phases"); }
    stop_trace();
    const Json trace = written_trace();
    ASSERT_EQ(trace.at("traceEvents").size(), 1U);
    const Json& event = trace.at("traceEvents").at(0);
    EXPECT_EQ(event.at("name"), "solve_phases");
    EXPECT_EQ(event.at("ph"), "X");
    EXPECT_TRUE(event.at("pid").is_number_integer());
    EXPECT_TRUE(event.at("tid").is_number_integer());
    EXPECT_GE(begin_us(event), 0.0);
    EXPECT_GE(event.at("dur").get<double>(), 0.0);
    EXPECT_EQ(trace.at("otherData").at("dropped_zones"), 0);
}

TEST(Profile, TraceWithoutZonesIsValid) {
    start_trace();
    stop_trace();
    EXPECT_TRUE(written_trace().at("traceEvents").empty());
}

TEST(Profile, NamesAreEscaped) {
    start_trace();
    { HH_ZONE("a \"quoted\\\" \n name"); }
    stop_trace();
    EXPECT_EQ(written_trace().at("traceEvents").at(0).at("name"), "a \"quoted\\\"   name");
}

TEST(Profile, NestedZonesLieInsideParents) {
    start_trace();
    {
        HH_ZONE("outer");
        { HH_ZONE("first"); }
        { HH_ZONE("second"); }
    }
    stop_trace();
    const Json trace = written_trace();
    const Json& events = trace.at("traceEvents");
    ASSERT_EQ(events.size(), 3U);
    EXPECT_EQ(events[0].at("name"), "outer") << "parents stand before their children";
    // The file has nanosecond resolution; sums of such numbers in microseconds round in the last
    // bit.
    constexpr double k_rounding_us = 1e-4;
    for (const int child : {1, 2}) {
        const Json& event = events[static_cast<std::size_t>(child)];
        EXPECT_EQ(event.at("tid"), events[0].at("tid"));
        EXPECT_GE(begin_us(event), begin_us(events[0]));
        EXPECT_LE(end_us(event), end_us(events[0]) + k_rounding_us);
    }
    EXPECT_GE(begin_us(events[2]) + k_rounding_us, end_us(events[1]));
}

TEST(Profile, KeepsOnlyZonesInsideTrace) {
    { HH_ZONE("before"); }
    {
        HH_ZONE("begun before");
        start_trace();
    }
    { HH_ZONE("inside"); }
    {
        HH_ZONE("ended after");
        stop_trace();
    }
    { HH_ZONE("after"); }
    const Json trace = written_trace();
    EXPECT_EQ(trace.at("traceEvents").size(), 1U);
    EXPECT_EQ(events_named(trace, "inside").size(), 1U);
}

TEST(Profile, ZoneThatOutlivesTraceIsNotInNextTrace) {
    start_trace();
    {
        HH_ZONE("of the first");
        stop_trace();
        start_trace();
    }
    stop_trace();
    EXPECT_TRUE(written_trace().at("traceEvents").empty());
}

TEST(Profile, NewTraceDiscardsLastTrace) {
    start_trace();
    { HH_ZONE("old"); }
    stop_trace();
    EXPECT_EQ(written_trace().at("traceEvents").size(), 1U);
    EXPECT_EQ(written_trace().at("traceEvents").size(), 1U) << "writing keeps the zones";
    start_trace();
    stop_trace();
    EXPECT_TRUE(written_trace().at("traceEvents").empty());
}

TEST(Profile, CountsZonesAboveLimitAsDropped) {
    start_trace(3);
    for (int i = 0; i < 10; ++i) {
        HH_ZONE("zone");
    }
    stop_trace();
    const Json trace = written_trace();
    EXPECT_EQ(trace.at("traceEvents").size(), 3U);
    EXPECT_EQ(trace.at("otherData").at("dropped_zones"), 7);
}

TEST(Profile, WritingReplacesFileAtomically) {
    const TraceFolder folder;
    const fs::path path = folder.path() / "trace.json";
    std::ofstream(path) << "an old file";
    start_trace();
    stop_trace();
    ASSERT_FALSE(write_trace(path.string()));
    std::ifstream in(path);
    EXPECT_TRUE(Json::accept(in));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(Profile, ReportsUnwritablePathAndLeavesNoFile) {
    const TraceFolder folder;
    EXPECT_TRUE(write_trace((folder.path() / "absent" / "trace.json").string()));
    fs::create_directories(folder.path() / "occupied" / "inside");
    EXPECT_TRUE(write_trace((folder.path() / "occupied").string()));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(Profile, ZonesDoNotAllocateUntracedOrWarm) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "a sanitizer's own operator new does not count";
    }
    ASSERT_FALSE(is_tracing());
    const auto allocations_of_zones = [] {
        const std::size_t before = allocation_count();
        for (int i = 0; i < 1000; ++i) {
            HH_ZONE("zone");
        }
        return allocation_count() - before;
    };
    EXPECT_EQ(allocations_of_zones(), 0U);
    start_trace();
    { HH_ZONE("the thread's first"); }
    EXPECT_EQ(allocations_of_zones(), 0U);
    stop_trace();
    EXPECT_EQ(written_trace().at("traceEvents").size(), 1001U);
}

TEST(Profile, ClockIsMonotonic) {
    std::int64_t last_ns = now_ns();
    for (int i = 0; i < 1000; ++i) {
        const std::int64_t next_ns = now_ns();
        ASSERT_GE(next_ns, last_ns);
        last_ns = next_ns;
    }
}

TEST(ProfileThreaded, ZonesOfTwoThreadsHaveSeparateTids) {
    start_trace();
    { HH_ZONE("here"); }
    // Zones are kept even if their thread ends before the trace is written.
    std::thread([] { HH_ZONE("there"); }).join();
    stop_trace();
    const Json trace = written_trace();
    const std::vector<Json> here = events_named(trace, "here");
    const std::vector<Json> there = events_named(trace, "there");
    ASSERT_EQ(here.size(), 1U);
    ASSERT_EQ(there.size(), 1U);
    EXPECT_NE(here[0].at("tid"), there[0].at("tid"));
}

TEST(ProfileThreaded, TracesMayStartStopAndBeWrittenWhileThreadsOpenZones) {
    std::atomic<bool> is_done = false;
    const auto open_zones = [&] {
        while (!is_done) {
            HH_ZONE("busy");
        }
    };
    std::thread first(open_zones);
    std::thread second(open_zones);
    for (int i = 0; i < 20; ++i) {
        start_trace(1000);
        std::this_thread::yield();
        const Json trace = written_trace();
        EXPECT_LE(trace.at("traceEvents").size(), 2000U);
        for (const Json& event : trace.at("traceEvents")) {
            EXPECT_GE(begin_us(event), 0.0);
        }
        stop_trace();
    }
    is_done = true;
    first.join();
    second.join();
}

// A frame reads the clock at both ends of each stage: its time must not be that of the reads.
TEST(StageClock, LeavesOutTheCostOfItsReads) {
    constexpr int k_reads = 20000;
    set_stage_clock(StageClock::thread_cpu);
    const std::int64_t begin_cpu_ns = thread_cpu_now_ns();
    const std::int64_t begin_ns = stage_now_ns();
    for (int read = 0; read < k_reads; ++read) {
        stage_now_ns();
    }
    const std::int64_t ns = stage_now_ns() - begin_ns;
    const std::int64_t cpu_ns = thread_cpu_now_ns() - begin_cpu_ns;
    set_stage_clock(StageClock::wall);
    EXPECT_LE(std::abs(ns), cpu_ns * 3 / 4);
}

TEST(StageClock, CountsTheWorkBetweenReads) {
    set_stage_clock(StageClock::thread_cpu);
    const std::int64_t begin_ns = stage_now_ns();
    const std::int64_t begin_cpu_ns = thread_cpu_now_ns();
    std::atomic<int> work = 0;
    while (thread_cpu_now_ns() - begin_cpu_ns < 5'000'000) {
        ++work;
    }
    const std::int64_t ns = stage_now_ns() - begin_ns;
    set_stage_clock(StageClock::wall);
    EXPECT_GE(ns, 4'900'000);
}

}  // namespace
}  // namespace handhold::profile_test
