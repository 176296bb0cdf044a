#include "systems/host/host_call.hpp"

#include <algorithm>
#include <array>

#include "engine/core/parallel.hpp"
#include "systems/host/host_growth.hpp"
#include "systems/host/host_hooks.hpp"

namespace handhold {
namespace {

constexpr std::size_t k_error_bytes = 512;
thread_local std::array<char, k_error_bytes> t_last_error{};

void check_thread_count(std::uint32_t count) {
    constexpr std::uint32_t k_max_threads = 256;
    require(count >= 1 && count <= k_max_threads, HH_ERROR_VALUE,
            "thread_count must lie in [1, 256]");
}

hh_host_hooks& hooks() {
    static hh_host_hooks set = hh_default_host_hooks();
    return set;
}

}  // namespace

std::atomic<int>& world_count() {
    static std::atomic<int> count{0};
    return count;
}

void log_note(const char* text) noexcept {
    const hh_host_hooks& set = hooks();
    if (set.log != nullptr) {
        set.log(set.context, HH_LOG_NOTE, text);
    }
}

hh_result report_failure(hh_result result, const char* text) noexcept {
    const std::size_t length = std::min(std::strlen(text), k_error_bytes - 1);
    std::memcpy(t_last_error.data(), text, length);
    t_last_error[length] = '\0';
    const hh_host_hooks& set = hooks();
    if (set.log != nullptr) {
        set.log(set.context, HH_LOG_ERROR, t_last_error.data());
    }
    if (result == HH_ERROR_INTERNAL && set.assert_failed != nullptr) {
        set.assert_failed(set.context, t_last_error.data());
    }
    return result;
}

void fail_size(std::string_view name, bool is_filled, std::size_t size, std::size_t first_size,
               std::size_t own_size) {
    std::string text(name);
    text += " of " + std::to_string(size) + " bytes: this library knows ";
    if (first_size < own_size) {
        text += std::to_string(first_size) + " to ";
    }
    text += std::to_string(own_size) + " bytes";
    if (is_filled) {  // all names begin with hh_
        text +=
            "; fill it by hh_default_" + std::string(name.substr(3)) + ", which sets struct_size";
    }
    throw HostError{HH_ERROR_VERSION, text};
}

}  // namespace handhold

using namespace handhold;

const char* hh_result_text(hh_result result) {
    switch (result) {
        case HH_OK:
            return "HH_OK";
        case HH_ERROR_NULL:
            return "HH_ERROR_NULL";
        case HH_ERROR_VERSION:
            return "HH_ERROR_VERSION";
        case HH_ERROR_HANDLE:
            return "HH_ERROR_HANDLE";
        case HH_ERROR_VALUE:
            return "HH_ERROR_VALUE";
        case HH_ERROR_NAME:
            return "HH_ERROR_NAME";
        case HH_ERROR_STATE:
            return "HH_ERROR_STATE";
        case HH_ERROR_CAPACITY:
            return "HH_ERROR_CAPACITY";
        case HH_ERROR_DATA:
            return "HH_ERROR_DATA";
        case HH_ERROR_MEMORY:
            return "HH_ERROR_MEMORY";
        case HH_ERROR_INTERNAL:
            return "HH_ERROR_INTERNAL";
        case HH_RESULT_32_BITS:
            break;
    }
    return "not a result";
}

const char* hh_last_error(void) { return t_last_error.data(); }

void hh_version(uint32_t* major, uint32_t* minor, uint32_t* patch) {
    const auto write = [](uint32_t* to, uint32_t value) {
        if (to != nullptr) {
            *to = value;
        }
    };
    write(major, HANDHOLD_VERSION_MAJOR);
    write(minor, HANDHOLD_VERSION_MINOR);
    write(patch, HANDHOLD_VERSION_PATCH);
}

hh_pose hh_identity_pose(void) { return to_c(Pose{}); }

void hh_sin_cos(double angle_rad, double* sine, double* cosine) {
    double s = 0.0;
    double c = 1.0;
    call([&] { sin_cos(angle_rad, s, c); });
    if (sine != nullptr) {
        *sine = s;
    }
    if (cosine != nullptr) {
        *cosine = c;
    }
}

double hh_atan2(double y, double x) {
    double angle_rad = 0.0;
    call([&] { angle_rad = arc_tangent2(y, x); });
    return angle_rad;
}

hh_result hh_default_host_hooks_sized(hh_host_hooks* filled, size_t size) {
    hh_host_hooks set{};
    set.thread_count = 1;
    return write_default(filled, size, set);
}

hh_result hh_set_host_hooks(const hh_host_hooks* wanted) {
    return call([&] {
        const hh_host_hooks defaults = hh_default_host_hooks();
        const hh_host_hooks set = wanted != nullptr ? read_def(wanted, defaults) : defaults;
        check_thread_count(set.thread_count);
        require(world_count() == 0, HH_ERROR_STATE, "hooks are set before the first world");
        set_thread_count(set.parallel_for != nullptr ? 1 : static_cast<int>(set.thread_count));
        set_parallel_backend(set.parallel_for, set.context);
        hooks() = set;
    });
}

hh_result hh_set_thread_count(uint32_t count) {
    return call([&] {
        check_thread_count(count);
        require(hooks().parallel_for == nullptr, HH_ERROR_STATE,
                "the host lends its own threads by parallel_for");
        set_thread_count(static_cast<int>(count));
    });
}

uint32_t hh_thread_count(void) { return static_cast<uint32_t>(thread_count()); }
