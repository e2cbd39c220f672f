// The kernels that shade for one instruction set, RELIEF_TARGET: each has a source of its own
// (cmake/Kernels.cmake), so that processors compile them side by side, and a build may leave some out.
#include "math/lane_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu/shading/shading_kernels-inl.h"
#include <hwy/foreach_target.h>

#if HWY_TARGET == RELIEF_TARGET

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

#endif
