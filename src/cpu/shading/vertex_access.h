// Puts a material into the lanes that vertices are brought to the kernels in.
#pragma once

#include <cstddef>

#include "cpu/shading/point_material.h"
#include "cpu/shading/shading_kernels.h"

namespace relief::cpu {

/// A lane that costs nothing beside those with layers or of glass, and none beyond the batch.
inline void set_plain(size_t lane, VertexLanes& lanes) { lanes.metallic[lane] = 0, lanes.ior[lane] = 1; }

/// Lane 0 first: it clears the masks.
inline void set_material(const PointMaterial& m, size_t lane, VertexLanes& lanes) {
    set_lane(m.base_color, lane, lanes.base_color);
    lanes.roughness[lane] = m.roughness, lanes.metallic[lane] = m.metallic, lanes.ior[lane] = m.ior;
    if (lane == 0) lanes.has_layers = lanes.has_glass = 0;
    if (m.glass != kNoIndex) {
        lanes.has_glass |= 1u << lane;
        lanes.glass[lane] = m.glass_numbers;
        set_plain(lane, lanes);
    } else if (m.layers != kNoIndex) {
        lanes.has_layers |= 1u << lane;
        lanes.layers[lane] = m.layers;
        lanes.layered_metallic[lane] = m.metallic;
        set_plain(lane, lanes);
    }
}

} // namespace relief::cpu
