// Compiles the kernels of shading once for each instruction set (Highway's foreach_target), apart from those
// that trace: both take long.

#include "math/lane_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu/shading/shading_kernels.cpp"
#include <hwy/foreach_target.h>

#include "cpu/shading/environment_lanes-inl.h"
#include "cpu/shading/polygon_points-inl.h"
#include "cpu/shading/random_pairs-inl.h"
#include "cpu/shading/reflection-inl.h"
#include "cpu/shading/shading_kernels.h"
#include "cpu/shading/surface_points-inl.h"
#include "cpu/traversal/camera_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

const cpu::ShadingKernels& shading_kernels(const char* name) {
    static const cpu::ShadingKernels kKernels{
        name,          make_point_batch,          make_polygon_batch,      draw_pairs,
        wide::reflect, wide::look_up_environment, wide::fetch_environment, wide::draw_directions,
        aim_rays};
    return kKernels;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <cstring>

namespace relief::cpu {

const ShadingKernels& find_shading_kernels(const char* name) {
    const ShadingKernels* const all[] = {
#if HWY_TARGETS & HWY_AVX3
        &N_AVX3::shading_kernels("avx512"),
#endif
#if HWY_TARGETS & HWY_AVX2
        &N_AVX2::shading_kernels("avx2"),
#endif
#if HWY_TARGETS & HWY_SSE4
        &N_SSE4::shading_kernels("sse4"),
#endif
#if HWY_TARGETS & HWY_NEON
        &N_NEON::shading_kernels("neon"),
#endif
#if HWY_TARGETS & HWY_EMU128
        &N_EMU128::shading_kernels("scalar"),
#endif
    };
    const ShadingKernels* found = all[0];
    for (const ShadingKernels* kernels : all)
        if (std::strcmp(kernels->name, name) == 0) found = kernels;
    return *found;
}

} // namespace relief::cpu

#endif
