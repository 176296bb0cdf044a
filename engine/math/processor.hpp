#pragma once

// Speed-critical functions on Double4 are compiled twice: portably and for AVX2. Both versions give
// equal bits, because neither uses fused multiply-add.
namespace handhold {

enum class Vectors : unsigned char { portable, avx2 };

// Not on Windows: GCC aligns no stack to 32 bytes there (its bug 54412), and AVX code crashes.
#if defined(__x86_64__) && !defined(_WIN32)
#define HH_AVX2 [[gnu::target("avx2")]]

// The fastest variant this processor supports.
inline Vectors fastest_vectors() {
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
    return has_avx2 ? Vectors::avx2 : Vectors::portable;
}
#else
inline Vectors fastest_vectors() { return Vectors::portable; }
#endif

}  // namespace handhold
