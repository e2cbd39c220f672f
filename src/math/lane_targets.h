// Which instruction sets a source is compiled for: to be included before Highway's foreach_target.
// RELIEF_TARGET: that one alone. Else every target that the compiler can reach, the one without SIMD
// included; those left out are close to a neighbour.
#pragma once

#define HWY_COMPILE_ALL_ATTAINABLE
#ifdef RELIEF_TARGET
// The one without SIMD is what Highway falls back on, and has to stay.
#define HWY_DISABLED_TARGETS (~(RELIEF_TARGET | HWY_EMU128))
#else
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#endif
