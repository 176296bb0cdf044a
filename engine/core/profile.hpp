#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "engine/io/result.hpp"

// Zones: named spans of time on one thread, for traces that Perfetto and chrome://tracing read.
// A zone costs a call and a branch at either end while no trace is taken, and two clock calls
// (about 60 ns each) while one is. Any thread may open zones at any time, also while a trace
// starts, stops or is written.
namespace handhold {

// Nanoseconds of a steady clock.
std::int64_t now_ns();

// What the times of stages are measured with: by the clock on the wall unless a tool that measures
// on a busy machine asks for the processor's time of the calling thread (a system call, about 0.3
// us). Set it between frames.
enum class StageClock : std::uint8_t { wall, thread_cpu };
void set_stage_clock(StageClock clock);
std::int64_t stage_now_ns();

// Forgets what was collected and starts collecting the zones of all threads that begin and end from
// here to stop_trace: up to `max_zones` a thread (24 bytes each), later ones are only counted as
// dropped.
void start_trace(std::size_t max_zones = 1U << 20U);
void stop_trace();
bool is_tracing();
// Writes what was collected as Chrome trace JSON: complete events, a tid for each thread, and how
// many zones were dropped in otherData.dropped_zones. Writes and fails as write_file_atomically.
[[nodiscard]] std::optional<FileError> write_trace(const std::string& path);

class Zone {
  public:
    explicit Zone(const char* name);  // a literal: kept by pointer
    ~Zone();
    Zone(const Zone&) = delete;
    Zone& operator=(const Zone&) = delete;

  private:
    const char* name_;
    std::int64_t begin_ns_;  // -1: not tracing
};

}  // namespace handhold

#define HH_ZONE_NAME2(line) hh_zone_##line
#define HH_ZONE_NAME(line) HH_ZONE_NAME2(line)
// A stage's zone, in every build.
#define HH_ZONE(name) const ::handhold::Zone HH_ZONE_NAME(__LINE__)(name)
// A zone inside a stage (an island, a phase): only in profiling builds.
#ifdef HANDHOLD_PROFILE
#define HH_DETAIL_ZONE(name) HH_ZONE(name)
#else
#define HH_DETAIL_ZONE(name) static_cast<void>(0)
#endif
