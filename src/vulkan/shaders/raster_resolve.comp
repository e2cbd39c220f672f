// Commits a camera ray's hit in a wave of items if it is nearer than earlier ones; same bits as traced.
#define READS_RASTER_VERTICES
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/rays.glsl"
#include "vulkan/shaders/raster.glsl"

layout(scalar, set = 0, binding = kBindRasterNearest) buffer RasterNearest { uint64_t raster_nearest[]; };

vec2 find_place(const RasterCell cell, const RayData world, const uint is_upper) {
    CellCorners corners = load_cell(cell);
    ObjectRay ray = enter_object(world, instances[cell.item.instance]);
    vec3 a = shear_vertex(ray, corners.p00);
    vec3 b = shear_vertex(ray, is_upper != 0u ? corners.p11 : corners.p10);
    vec3 c = shear_vertex(ray, is_upper != 0u ? corners.p01 : corners.p11);
    TriangleHit found = intersect_sheared(ray, a, b, c, -kInfinity, kInfinity);
    return place_in_cell(vec2(found.weight_b, found.weight_c), is_upper);
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint64_t packed_hit = raster_nearest[index];
    uint rank = uint(packed_hit);
    if (rank == 0xffffffffu) return;
    uint is_upper = rank & 1u;
    RasterCell cell = make_cell(find_item(rank >> 1u), rank >> 1u);
    uint cell_rank = make_cell_rank(cell.column, cell.item.first_row + cell.row, is_upper);
    HitData found = HitData(nearest_distance(packed_hit), cell.item.instance, cell.item.patch_index, 0.0, 0.0, cell_rank,
                            cell.item.levels);
    if (is_better(found, hits[index])) {
        vec2 within = find_place(cell, rays[index], is_upper);
        vec2 uv = place_on_patch(cell_rank, packed_patch_level(cell.item.levels), within);
        found.u = uv.x;
        found.v = uv.y;
        hits[index] = found;
    }
    raster_nearest[index] = make_nearest(found.t, 0xffffffffu);
}
