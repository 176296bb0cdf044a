#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "engine/core/result.hpp"

// Zones: named time spans on one thread, for traces in Perfetto and chrome://tracing. A zone costs
// a call and a branch at each end, plus two clock reads (about 60 ns each) while tracing. Any
// thread may open zones at any time, even while a trace is started, stopped or written.
namespace handhold {

// Nanoseconds of a steady clock.
std::int64_t now_ns();

// Nanoseconds of CPU time of the calling thread. A system call, slower than now_ns.
std::int64_t thread_cpu_now_ns();

// Clock of stage times. Default: the wall clock. A tool that measures on a busy machine may select
// the calling thread's CPU time; the mean cost of reading it, about 20 us a frame, is left out of
// all times. Set it only between frames.
enum class StageClock : std::uint8_t { wall, thread_cpu };
void set_stage_clock(StageClock clock);
std::int64_t stage_now_ns();

// Discards earlier zones. Records all zones that begin and end before stop_trace, up to `max_zones`
// per thread (24 bytes each). Further zones are only counted as dropped.
void start_trace(std::size_t max_zones = 1U << 20U);
void stop_trace();
bool is_tracing();
// Writes the recorded zones as Chrome trace JSON: complete events, with one tid per thread.
// otherData.dropped_zones is the number of dropped zones. Errors: those of write_file_atomically.
[[nodiscard]] std::optional<FileError> write_trace(const std::string& path);

class Zone {
  public:
    explicit Zone(const char* name);  // string literal: stored by pointer
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
// Zone of a stage, in every build.
#define HH_ZONE(name) const ::handhold::Zone HH_ZONE_NAME(__LINE__)(name)
// Zone inside a stage (an island, a phase), in profiling builds only.
#ifdef HANDHOLD_PROFILE
#define HH_DETAIL_ZONE(name) HH_ZONE(name)
#else
#define HH_DETAIL_ZONE(name) static_cast<void>(0)
#endif
