#pragma once

// Functions of four.hpp's numbers exist twice where their speed matters: for any processor, and for
// AVX2, with equal bits: no fused operations.
namespace handhold {

enum class Vectors : unsigned char { portable, avx2 };

#ifdef __x86_64__
#define HH_AVX2 [[gnu::target("avx2")]]

// What this processor has.
inline Vectors fastest_vectors() {
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
    return has_avx2 ? Vectors::avx2 : Vectors::portable;
}
#else
inline Vectors fastest_vectors() { return Vectors::portable; }
#endif

}  // namespace handhold
