// Which instruction sets kernels are compiled for: to be included before Highway's foreach_target. Every
// target that the compiler can reach, the one without SIMD included; those left out are close to a neighbour.
#pragma once

#define HWY_COMPILE_ALL_ATTAINABLE
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
