// Instruction sets that a source is compiled for; include before Highway's foreach_target. With RELIEF_TARGET
// that one alone, else every target of the compiler, and none close to another.
#pragma once

#define HWY_COMPILE_ALL_ATTAINABLE
#ifdef RELIEF_TARGET
// The target without SIMD is Highway's fallback and must stay.
#define HWY_DISABLED_TARGETS (~(RELIEF_TARGET | HWY_EMU128))
#else
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#endif
