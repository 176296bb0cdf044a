#include "engine/core/profile.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <ctime>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/text_file.hpp"

namespace handhold {
namespace {

std::atomic<StageClock> g_stage_clock{StageClock::wall};
std::atomic<std::int64_t> g_read_ns{0};  // cost of thread_cpu_now_ns
thread_local std::int64_t t_reads = 0;   // number of reads of the stage clock

// The mean cost of a read in the fastest of some batches.
std::int64_t measure_read_ns() {
    constexpr std::int64_t k_reads = 200;
    std::int64_t least_ns = 0;
    for (int batch = 0; batch < 20; ++batch) {
        const std::int64_t begin_ns = thread_cpu_now_ns();
        std::int64_t end_ns = begin_ns;
        for (std::int64_t read = 0; read < k_reads; ++read) {
            end_ns = thread_cpu_now_ns();
        }
        least_ns = batch == 0 ? end_ns - begin_ns : std::min(least_ns, end_ns - begin_ns);
    }
    return least_ns / k_reads;
}

struct ZoneRecord {
    const char* name;
    std::int64_t begin_ns;
    std::int64_t end_ns;
};

// Zones of one thread. The mutex is locked for every zone, but it is contended only while a trace
// is started or written.
struct ThreadZones {
    std::mutex mutex;
    int tid = 0;
    std::vector<ZoneRecord> zones;
    std::uint64_t dropped = 0;
    std::size_t max_zones = 0;  // limit of the current trace
    std::int64_t trace_begin_ns = 0;
};

struct Trace {
    std::atomic<bool> is_on = false;
    std::mutex mutex;  // guards the members below
    std::vector<std::shared_ptr<ThreadZones>> threads;
    std::int64_t begin_ns = 0;
    std::size_t max_zones = 0;
    int next_tid = 1;
};

Trace& trace() {
    // Never destroyed: a thread may close its last zone after main has returned.
    static Trace& instance = *new Trace;
    return instance;
}

// Reserves memory for all zones, so that recording never reallocates. Untouched pages cost nothing.
void begin_trace(ThreadZones& thread, std::size_t max_zones, std::int64_t trace_begin_ns) {
    thread.zones.clear();
    thread.zones.reserve(max_zones);
    thread.dropped = 0;
    thread.max_zones = max_zones;
    thread.trace_begin_ns = trace_begin_ns;
}

// The calling thread's zones. The trace owns them too, so that they outlive the thread.
ThreadZones& thread_zones() {
    thread_local const std::shared_ptr<ThreadZones> t_zones = [] {
        auto zones = std::make_shared<ThreadZones>();
        Trace& all = trace();
        const std::lock_guard lock(all.mutex);
        zones->tid = all.next_tid++;
        begin_trace(*zones, all.max_zones, all.begin_ns);
        all.threads.push_back(zones);
        return zones;
    }();
    return *t_zones;
}

void record_zone(const ZoneRecord& zone) {
    ThreadZones& own = thread_zones();
    const std::lock_guard lock(own.mutex);
    if (zone.begin_ns < own.trace_begin_ns) {
        return;  // began in an earlier trace
    }
    if (own.zones.size() < own.max_zones) {
        own.zones.push_back(zone);
    } else {
        ++own.dropped;
    }
}

std::string escape_json(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            escaped += '\\';
        }
        escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return escaped;
}

void append_microseconds(std::string& json, std::int64_t duration_ns) {
    char text[32];
    std::snprintf(text, sizeof text, "%" PRId64 ".%03" PRId64, duration_ns / 1000,
                  duration_ns % 1000);
    json += text;
}

// Sorts parents before their children: if zones begin at the same time, viewers nest them in file
// order.
std::vector<ZoneRecord> sorted_by_begin(std::vector<ZoneRecord> zones) {
    std::stable_sort(zones.begin(), zones.end(), [](const ZoneRecord& a, const ZoneRecord& b) {
        return a.begin_ns != b.begin_ns ? a.begin_ns < b.begin_ns : a.end_ns > b.end_ns;
    });
    return zones;
}

void append_zone(std::string& json, const ZoneRecord& zone, int tid, std::int64_t trace_begin_ns) {
    json += "{\"name\":\"" + escape_json(zone.name) + "\",\"ph\":\"X\",\"pid\":1,\"tid\":";
    json += std::to_string(tid);
    json += ",\"ts\":";
    append_microseconds(json, zone.begin_ns - trace_begin_ns);
    json += ",\"dur\":";
    append_microseconds(json, zone.end_ns - zone.begin_ns);
    json += '}';
}

// Chrome's trace event format: complete events ("X"), times in microseconds since the trace began.
std::string trace_json() {
    Trace& all = trace();
    const std::lock_guard lock(all.mutex);
    std::uint64_t dropped = 0;
    const char* separator = "\n";
    std::string json = "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[";
    for (const auto& thread : all.threads) {
        const std::lock_guard thread_lock(thread->mutex);
        dropped += thread->dropped;
        for (const ZoneRecord& zone : sorted_by_begin(thread->zones)) {
            json += separator;
            append_zone(json, zone, thread->tid, all.begin_ns);
            separator = ",\n";
        }
    }
    return json + "\n],\"otherData\":{\"dropped_zones\":" + std::to_string(dropped) + "}}\n";
}

}  // namespace

std::int64_t now_ns() {
    const auto since_epoch = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count();
}

std::int64_t thread_cpu_now_ns() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void set_stage_clock(StageClock clock) {
    g_read_ns.store(clock == StageClock::thread_cpu ? measure_read_ns() : 0);
    g_stage_clock.store(clock, std::memory_order_relaxed);
}

std::int64_t stage_now_ns() {
    if (g_stage_clock.load(std::memory_order_relaxed) == StageClock::wall) {
        return now_ns();
    }
    return thread_cpu_now_ns() - ++t_reads * g_read_ns.load(std::memory_order_relaxed);
}

void start_trace(std::size_t max_zones) {
    Trace& all = trace();
    const std::lock_guard lock(all.mutex);
    all.is_on = false;
    // Removes the zones of threads that have ended.
    std::erase_if(all.threads, [](const auto& thread) { return thread.use_count() == 1; });
    all.max_zones = max_zones;
    all.begin_ns = now_ns();
    for (const auto& thread : all.threads) {
        const std::lock_guard thread_lock(thread->mutex);
        begin_trace(*thread, max_zones, all.begin_ns);
    }
    all.is_on = true;
}

void stop_trace() { trace().is_on = false; }
bool is_tracing() { return trace().is_on.load(std::memory_order_relaxed); }

std::optional<FileError> write_trace(const std::string& path) {
    return write_file_atomically(path, trace_json());
}

Zone::Zone(const char* name) : name_(name), begin_ns_(is_tracing() ? now_ns() : -1) {}

Zone::~Zone() {
    if (begin_ns_ >= 0 && is_tracing()) {
        record_zone({name_, begin_ns_, now_ns()});
    }
}

}  // namespace handhold
