// A pixel's ray against both triangles of a cell, as the tracer tests. No loops: lavapipe counts helpers' too.
#define READS_RASTER_VERTICES
#include "vulkan/shaders/extensions.glsl"
#include "vulkan/shaders/rays.glsl"
#include "vulkan/shaders/raster.glsl"
#include "formulas/pixel_order.h"

layout(location = 0) flat in uvec2 item_and_cell;
layout(scalar, set = 0, binding = kBindRasterNearest) buffer RasterNearest { uint64_t raster_nearest[]; };

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy) + uvec2(0u, push.first_row);
    uint index = find_pixel_number(pixel.x, pixel.y, push.width, push.height) - push.first_pixel;
    if (index >= push.count) return; // of another batch; indices before the first wrap around
    RasterCell cell = make_cell(item_and_cell.x, item_and_cell.y);
    CellCorners corners = load_cell(cell);
    RayData world = rays[index];
    ObjectRay ray = enter_object(world, instances[cell.item.instance]);
    float limit = nearest_distance(raster_nearest[index]);
    vec3 a = shear_vertex(ray, corners.p00);
    vec3 c = shear_vertex(ray, corners.p11);
    float lower = intersect_sheared(ray, a, shear_vertex(ray, corners.p10), c, world.t_min, limit).t;
    uint rank = 2u * item_and_cell.y;
    if (lower != kInfinity) atomicMin(raster_nearest[index], make_nearest(lower, rank));
    float upper = intersect_sheared(ray, a, c, shear_vertex(ray, corners.p01), world.t_min, limit).t;
    if (upper != kInfinity) atomicMin(raster_nearest[index], make_nearest(upper, rank + 1u));
}
