// SPDX-License-Identifier: Apache-2.0
#pragma once

#if defined(__x86_64__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#elif !defined(__aarch64__)
#error "name the register that controls float arithmetic on this processor"
#endif

/// The register of the processor that controls how the calling thread computes with floats: mxcsr on x86-64, fpcr on
/// aarch64. Only float_environment.cpp and tests use it.
namespace base::float_register {

#if defined(__x86_64__)
inline constexpr unsigned kRounding = _MM_ROUND_MASK;
inline constexpr unsigned kRoundsUp = _MM_ROUND_UP;
inline constexpr unsigned kRoundsDown = _MM_ROUND_DOWN;
inline constexpr unsigned kRoundsTowardZero = _MM_ROUND_TOWARD_ZERO;
inline constexpr unsigned kFlushesResults = _MM_FLUSH_ZERO_MASK;
inline constexpr unsigned kFlushesOperands = _MM_DENORMALS_ZERO_MASK;
inline constexpr unsigned kOneTrap = _MM_MASK_INVALID;
inline constexpr unsigned kTraps = _MM_MASK_MASK;    // a bit of 0 traps an exception
inline constexpr unsigned kDefault = _MM_MASK_MASK;  // all exceptions masked, everything else 0
inline constexpr unsigned kPast = _MM_EXCEPT_MASK;   // exceptions of the past, which do not change a result

[[nodiscard]] inline unsigned get() { return _mm_getcsr(); }
inline void set(unsigned value) { _mm_setcsr(value); }
#else
inline constexpr unsigned kRounding = 3U << 22U;
inline constexpr unsigned kRoundsUp = 1U << 22U;
inline constexpr unsigned kRoundsDown = 2U << 22U;
inline constexpr unsigned kRoundsTowardZero = 3U << 22U;
inline constexpr unsigned kFlushesResults = 1U << 24U;  // operands too
inline constexpr unsigned kFlushesOperands = 1U << 0U;  // only processors with FEAT_AFP have this bit
inline constexpr unsigned kOneTrap = 1U << 8U;
inline constexpr unsigned kTraps = 0x9f00;  // a bit of 1 traps an exception; many processors have none of these bits
inline constexpr unsigned kDefault = 0;
inline constexpr unsigned kPast = 0;  // exceptions of the past are in another register, fpsr

[[nodiscard]] inline unsigned get() {
    unsigned long value = 0;
    asm volatile("mrs %0, fpcr" : "=r"(value));
    return static_cast<unsigned>(value);
}
inline void set(unsigned value) {
    const unsigned long wide = value;
    asm volatile("msr fpcr, %0" : : "r"(wide));
}
#endif

}  // namespace base::float_register
