#include "surface/surface.h"

#include <algorithm>
#include <utility>

namespace relief {

Surface::EdgeLine Surface::edge_line(uint32_t patch, int edge) const {
    uint32_t first = quads[patch].vertex[edge], second = quads[patch].vertex[(edge + 1) & 3];
    if (is_seam(patch, edge)) {
        const uint32_t patch_edge = 4 * patch + uint32_t(edge);
        const auto found =
            std::lower_bound(overrides.begin(), overrides.end(), patch_edge,
                             [](const EdgeOverride& entry, uint32_t key) { return entry.patch_edge < key; });
        first = found->first;
        second = found->second;
    }
    // The vertices decide where both ends are one point, so that both sides still agree.
    const bool is_reversed = std::pair(dominant(second), second) < std::pair(dominant(first), first);
    return is_reversed ? EdgeLine{second, first, true} : EdgeLine{first, second, false};
}

size_t Surface::geometry_bytes() const {
    return positions.size() * sizeof(Vec3f) + uvs.size() * sizeof(Vec2f) +
           frames.size() * sizeof(PackedFrame) + derivatives.size() * sizeof(derivatives[0]) +
           dominants.size() * sizeof(uint32_t) + vertex_tiles.size() + quads.size() * sizeof(Quad) +
           mips.size() * sizeof(uint32_t) + controls.size() * sizeof(InnerControls) +
           overrides.size() * sizeof(EdgeOverride) + override_bits.size() * sizeof(uint64_t);
}

} // namespace relief
