// The kernels that shade for one instruction set, RELIEF_TARGET: each has a source of its own
// (cmake/Kernels.cmake), so that processors compile them side by side, and a build may leave some out. The
// headers below are thus compiled for one target and need no guards that Highway can toggle.
#include "math/lane_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu/shading/shading_kernels-inl.h"
#include <hwy/foreach_target.h>

#if HWY_TARGET == RELIEF_TARGET

#include <cstring>

#include "cpu/shading/cone_lanes-inl.h"
#include "cpu/shading/environment_lanes-inl.h"
#include "cpu/shading/polygon_points-inl.h"
#include "cpu/shading/reflection-inl.h"
#include "cpu/shading/shading_kernels.h"
#include "cpu/shading/surface_points-inl.h"
#include "cpu/shading/texture_lanes-inl.h"
#include "cpu/traversal/camera_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace {

/// scalar::sobol_pair for each seed and sample.
void sample_2d(const cpu::SampleList& list, uint32_t pair, Vec2f* drawn) {
    for (size_t first = 0; first < list.count; first += 16) {
        const size_t size = HWY_MIN(size_t(16), list.count - first);
        alignas(64) uint32_t seed[16] = {}, sample[16] = {};
        std::memcpy(seed, list.seeds + first, size * sizeof(uint32_t));
        std::memcpy(sample, list.samples + first, size * sizeof(uint32_t));
        const wide::Vec2 u = wide::sobol_pair(wide::Uint::load(seed), wide::Uint::load(sample), pair);
        alignas(64) float x[16], y[16];
        u.x.store(x), u.y.store(y);
        for (size_t lane = 0; lane < size; ++lane) drawn[first + lane] = {x[lane], y[lane]};
    }
}

} // namespace

const cpu::ShadingKernels& shading_kernels(const char* name) {
    static const cpu::ShadingKernels kKernels{name,
                                              make_batch<make_points>,
                                              make_batch<make_polygon_points>,
                                              sample_2d,
                                              wide::reflect,
                                              wide::look_up_environment,
                                              wide::fetch_environment,
                                              wide::draw_directions,
                                              wide::draw_cone,
                                              wide::fetch_texture,
                                              aim_rays};
    return kKernels;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
