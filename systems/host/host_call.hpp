#pragma once

#include <cmath>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <type_traits>
#include <utility>

#include <handhold/base.h>

#include "components/world.hpp"
#include "engine/core/check.hpp"
#include "engine/core/float_environment.hpp"
#include "engine/math/math.hpp"

// Shared by all functions of the C interface: checks, conversions, and call(), which turns
// exceptions into results. No exception leaves a function that runs in call().
namespace handhold {

// Ends a call with a result other than HH_OK.
struct HostError {
    hh_result result;
    std::string text;
};

// Throws HostError if the condition is false. `text` is a function, for texts that name a value of
// the call: they are made only on failure.
template <typename MakeText>
requires std::is_invocable_r_v<std::string, MakeText>
void require(bool condition, hh_result result, const MakeText& text) {
    if (!condition) [[unlikely]] {
        throw HostError{result, text()};
    }
}
inline void require(bool condition, hh_result result, const char* text) {
    if (!condition) [[unlikely]] {
        throw HostError{result, text};
    }
}

// Refuses a count before its array is read: no element may be there twice.
inline void require_at_most(std::size_t count, std::size_t most, const char* elements,
                            const char* owners) {
    require(count <= most, HH_ERROR_VALUE, [&] {
        return std::to_string(count) + " " + elements + " are more than the world's " + owners +
               " (" + std::to_string(most) + ")";
    });
}

// Passes a note to the host's log, if the host has one.
void log_note(const char* text) noexcept;
// Stores the text for hh_last_error and logs it; HH_ERROR_INTERNAL also calls the assert hook.
hh_result report_failure(hh_result result, const char* text) noexcept;

// Not inlined, so that the compiler computes nothing of it outside of the FloatEnvironment.
template <typename Work>
[[gnu::noinline]] void run_call(Work& work) {
    work();
}

// Runs `work` in the library's floating-point environment and returns HH_OK, or the result for what
// it throws. `precondition`: the result for a PreconditionError.
template <typename Work>
hh_result call(Work&& work, hh_result precondition = HH_ERROR_VALUE) noexcept {
    const FloatEnvironment environment;
    try {
        run_call(work);
        return HH_OK;
    } catch (const HostError& error) {
        return report_failure(error.result, error.text.c_str());
    } catch (const PreconditionError& error) {
        return report_failure(precondition, error.what());
    } catch (const std::bad_alloc&) {
        return report_failure(HH_ERROR_MEMORY, "no memory left");
    } catch (const std::exception& error) {
        return report_failure(HH_ERROR_INTERNAL, error.what());
    } catch (...) {
        return report_failure(HH_ERROR_INTERNAL, "an unknown exception");
    }
}

inline Vec3 from_c(const hh_vec3& v) { return {v.x, v.y, v.z}; }
inline hh_vec3 to_c(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline hh_pose to_c(const Pose& pose) {
    const Quat& q = pose.rotation;
    return {to_c(pose.position), {q.x(), q.y(), q.z(), q.w()}};
}
// Converts any numbers.
inline Pose unchecked_pose(const hh_pose& pose) {
    const hh_quat& q = pose.rotation;
    return {from_c(pose.position), Quat(q.w, q.x, q.y, q.z)};
}
// These three convert numbers that may be used, and throw HH_ERROR_VALUE for others, NaN included.
inline Vec3 checked(const hh_vec3& v, double limit, const char* text) {
    Vec3 read = from_c(v);
    for (const double axis : read) {
        require(std::abs(axis) <= limit, HH_ERROR_VALUE, text);  // false for NaN
    }
    return read;
}
inline double checked(double number, double low, double high, const char* text) {
    require(number >= low && number <= high, HH_ERROR_VALUE, text);
    return number;
}
inline Pose checked(const hh_pose& pose) {
    Pose read = unchecked_pose(pose);
    checked(pose.position, world_limits::k_max_coordinate_m, "a position beyond 1e9 m, or NaN");
    require(is_valid(read), HH_ERROR_VALUE,
            "a rotation is not a unit quaternion (hh_identity_pose has one)");
    // A quaternion of unit length is not normalised again: a pose that is read and written back
    // stays equal to the bit.
    constexpr double k_rounding = 1e-12;
    if (std::abs(read.rotation.squaredNorm() - 1.0) > k_rounding) {
        read.rotation.normalize();
    }
    return read;
}

// Copies a list into a host's buffer. `count` gets its length in any case. A null buffer of
// capacity 0 asks for the length only.
template <typename T, typename Get>
void write_list(std::size_t size, T* buffer, std::size_t capacity, std::size_t* count,
                const Get& get) {
    require(count != nullptr, HH_ERROR_NULL, "the count is null");
    *count = size;
    if (buffer == nullptr && capacity == 0) {
        return;
    }
    require(buffer != nullptr, HH_ERROR_NULL, "the buffer is null");
    require(size <= capacity, HH_ERROR_CAPACITY, [&] {
        return "the buffer is too small: it needs " + std::to_string(size) + " elements, it has " +
               std::to_string(capacity);
    });
    for (std::size_t i = 0; i < size; ++i) {
        buffer[i] = get(i);
    }
}

template <typename Id>
Entity entity_of(Id id) {
    return {id.index, id.generation};
}
template <typename Id>
Id id_of(Entity entity) {
    return {entity.slot, entity.generation};
}

}  // namespace handhold
