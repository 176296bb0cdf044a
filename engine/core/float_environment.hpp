#pragma once

#include <cstdint>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace handhold {

// While alive, this thread computes in the environment that the library is written for: no
// exception traps, rounding to nearest, denormals kept (but see FlushDenormals). Afterwards the
// thread has the environment of before, to the bit, sticky flags included. Cost: a few nanoseconds.
//
// Traps would end programs in places that mean what they compute: slab tests divide by a
// direction's zero and compare with infinity, lanes of four that stand for nothing hold infinite
// sentinels or integers. Their results are never used, or are used as infinity.
//
// Only the control register of scalar and vector instructions is set: MXCSR on x86, FPCR and FPSR
// on 64-bit Arm. The library contains no x87 instructions. WebAssembly has a single environment.
class FloatEnvironment {
  public:
    FloatEnvironment() : before_(read()) {
        if (before_.control != k_own_control) {
            write({k_own_control, before_.flags});
        }
    }
    ~FloatEnvironment() {
        const State now = read();
        if (now.control != before_.control || now.flags != before_.flags) {
            write(before_);
        }
    }
    FloatEnvironment(const FloatEnvironment&) = delete;
    FloatEnvironment& operator=(const FloatEnvironment&) = delete;
    FloatEnvironment(FloatEnvironment&&) = delete;
    FloatEnvironment& operator=(FloatEnvironment&&) = delete;

  private:
    struct State {
        std::uint64_t control = 0;
        std::uint64_t flags = 0;
    };
#if defined(__SSE2__)
    static constexpr std::uint64_t k_flag_bits = 0x3f;
    static constexpr std::uint64_t k_own_control = 0x1f80;  // all exceptions masked
    static State read() {
        const std::uint64_t all = _mm_getcsr();
        return {all & ~k_flag_bits, all & k_flag_bits};
    }
    // A compiler barrier: the compiler moves no memory access across it.
    static void write(const State& state) {
        __asm__ volatile("" ::: "memory");
        _mm_setcsr(static_cast<unsigned>(state.control | state.flags));
        __asm__ volatile("" ::: "memory");
    }
#elif defined(__aarch64__)
    static constexpr std::uint64_t k_own_control = 0;
    static State read() {
        State state;
        __asm__ volatile("mrs %0, fpcr" : "=r"(state.control)::"memory");
        __asm__ volatile("mrs %0, fpsr" : "=r"(state.flags)::"memory");
        return state;
    }
    static void write(const State& state) {
        __asm__ volatile("msr fpcr, %0" ::"r"(state.control) : "memory");
        __asm__ volatile("msr fpsr, %0" ::"r"(state.flags) : "memory");
    }
#else
    static constexpr std::uint64_t k_own_control = 0;
    static State read() { return {}; }
    static void write(const State& /*state*/) {}
#endif
    const State before_;
};

}  // namespace handhold
