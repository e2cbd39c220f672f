// Clears the hits of camera rays before rasterisation.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/rays.glsl"
#include "vulkan/shaders/raster.glsl"

layout(scalar, set = 0, binding = kBindRasterNearest) writeonly buffer RasterNearest { uint64_t raster_nearest[]; };

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    hits[index] = HitData(kInfinity, kNone, kNone, 0.0, 0.0, 0u, 0u);
    raster_nearest[index] = make_nearest(rays[index].t_max, 0xffffffffu);
}
