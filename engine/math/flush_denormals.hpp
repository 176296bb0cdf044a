#pragma once

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace handhold {

// While it lives, this thread takes numbers below 2.2e-308 for 0. What pulls at one end of a long
// rope fades by a constant factor a link, down to such numbers, and each sum of them costs a
// hundred cycles. No other thread is touched; on other processors nothing is.
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
    // Nothing in memory is read or written across it.
    static void set(unsigned state) {
        __asm__ volatile("" ::: "memory");
        _mm_setcsr(state);
        __asm__ volatile("" ::: "memory");
    }
    unsigned before_;
#endif
};

}  // namespace handhold
