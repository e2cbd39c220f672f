// Vertices of a wave of items: displaced vertices at the levels of camera rays, or polygon corners.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/sample_evaluation.glsl"
#include "vulkan/shaders/raster.glsl"

layout(scalar, set = 0, binding = kBindRasterVertices) writeonly buffer Vertices { vec3 raster_vertices[]; };

RasterItem find_item_of_vertex(const uint vertex) {
    uint low = 0u;
    uint high = push.item_count - 1u;
    while (low < high) {
        uint middle = (low + high + 1u) / 2u;
        if (items[middle].first_vertex <= vertex)
            low = middle;
        else
            high = middle - 1u;
    }
    return items[low];
}

/// The upper triangle of a polygon with three corners is degenerate: no ray hits it.
vec3 load_polygon_corner(const SurfaceData s, const uint patch_index, const uint i, const uint j) {
    return load_position(s, load_quad(s, patch_index)[j == 0u ? i : 3u - i]);
}

void main() {
    uint vertex = invocation_index();
    if (vertex >= push.vertex_count) return;
    RasterItem item = find_item_of_vertex(vertex);
    SurfaceData s = surfaces[instances[item.instance].surface];
    uint stride = count_columns(item) + 1u;
    uint place = vertex - item.first_vertex;
    uint i = place % stride;
    uint j = item.first_row + place / stride;
    vec3 p;
    if (s.map == kNone)
        p = load_polygon_corner(s, item.patch_index, i, j);
    else
        p = find_sample(s, item.patch_index, item.levels, i, j);
    raster_vertices[vertex] = p;
}
