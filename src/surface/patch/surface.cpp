#include "surface/patch/surface.h"

#include <utility>

namespace relief {

Surface::EdgeLine Surface::edge_line(uint32_t patch, int edge) const {
    const Quad quad = quads[patch];
    uint32_t first = quad.vertex[size_t(edge)], second = quad.vertex[size_t(edge + 1) & 3];
    if (is_seam(patch, edge)) {
        const std::array<uint32_t, 2> ends = overrides.ends(4 * patch + uint32_t(edge));
        first = ends[0], second = ends[1];
    }
    // The vertices decide where both ends are one point, so that both sides still agree.
    const bool is_reversed = std::pair(dominant(second), second) < std::pair(dominant(first), first);
    return is_reversed ? EdgeLine{second, first, true} : EdgeLine{first, second, false};
}

size_t Surface::geometry_bytes() const {
    size_t further_bytes = 0;
    for (const PatchUvs& set : further_uvs) further_bytes += set.corners.size() * sizeof(set.corners[0]);
    return further_bytes + positions.size() * sizeof(Vec3f) + copies.byte_count() +
           uvs.size() * sizeof(Vec2f) + frames.size() * sizeof(PackedFrame) +
           derivatives.size() * sizeof(derivatives[0]) + corner_tangents.size() * sizeof(corner_tangents[0]) +
           vertex_tiles.size() * sizeof(TileIndex) + quads.byte_count() + mips.size() * sizeof(uint32_t) +
           controls.size() * sizeof(InnerControls) + base_heights.size() * sizeof(float) +
           overrides.byte_count();
}

} // namespace relief
