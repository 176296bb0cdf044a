#pragma once

// Checks, and numbers of every kind, for hosts that misuse the C interface.
#include <cstdint>
#include <cstdio>
#include <limits>

#include <handhold/handhold.h>

namespace misuse {

inline int g_failures = 0;
inline int g_calls = 0;

inline void expect(bool is_right, const char* what, int line) {
    ++g_calls;
    if (!is_right) {
        std::printf("line %d: %s\n", line, what);
        ++g_failures;
    }
}
#define HH_REFUSED(call) misuse::expect((call) != HH_OK, #call, __LINE__)
#define HH_GIVES(result, call) misuse::expect((call) == (result), #call, __LINE__)

inline constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double k_inf = std::numeric_limits<double>::infinity();
inline const hh_pose k_origin = hh_identity_pose();

struct Rng {
    std::uint64_t state = 1;
    std::uint64_t next() {
        state ^= state << 13U;
        state ^= state >> 7U;
        state ^= state << 17U;
        return state;
    }
    double number() {  // of any kind
        switch (next() % 9) {
            case 0:
                return k_nan;
            case 1:
                return k_inf;
            case 2:
                return -k_inf;
            case 3:
                return 1e300;
            case 4:
                return -1e300;
            case 5:
                return 0.0;
            case 6:
                return 5e-324;
            case 7:
                return -1.0;
            default:
                return static_cast<double>(next() % 2000) / 1000.0;
        }
    }
    hh_vec3 vector() { return {number(), number(), number()}; }
    hh_pose pose() { return {vector(), {number(), number(), number(), number()}}; }
};

}  // namespace misuse
