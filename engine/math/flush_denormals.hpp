#pragma once

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace handhold {

// While alive, flushes denormal doubles (below 2.2e-308) to 0 on this thread. Each operation on
// such numbers costs about a hundred cycles. They occur in long ropes: a force at one end decays by
// a constant factor per link. Has no effect on other threads, nor on processors without SSE2.
class FlushDenormals {
  public:
#ifdef __SSE2__
    FlushDenormals() : before_(_mm_getcsr()) { set(before_ | k_flush_results | k_flush_inputs); }
    ~FlushDenormals() { set(before_); }
#else
    FlushDenormals() = default;
    ~FlushDenormals() = default;
#endif
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;
    FlushDenormals(FlushDenormals&&) = delete;
    FlushDenormals& operator=(FlushDenormals&&) = delete;

  private:
#ifdef __SSE2__
    static constexpr unsigned k_flush_results = 0x8000;
    static constexpr unsigned k_flush_inputs = 0x0040;
    // A compiler barrier: the compiler moves no memory access across it.
    static void set(unsigned state) {
        __asm__ volatile("" ::: "memory");
        _mm_setcsr(state);
        __asm__ volatile("" ::: "memory");
    }
    unsigned before_;
#endif
};

}  // namespace handhold
