// One part of a glTF mesh: its vertices, and its faces as polygons.
#pragma once

#include <cstdint>
#include <vector>

#include "io/gltf_file.h"

namespace relief {

struct GltfPrimitive {
    // Values of the vertices one after another; empty where the part has none of the kind.
    std::vector<float> positions, normals; ///< 3 a vertex
    std::vector<float> uvs;                ///< 2 a vertex, v upwards
    std::vector<float> tangents;           ///< 4 a vertex
    std::vector<uint32_t> face_sizes, corners;
    size_t uv_set_count = 0; ///< TEXCOORD_0 and so on that the part has
};

/// Points and lines have no faces. Throws bad_input.
GltfPrimitive read_gltf_primitive(GltfFile& file, const JsonNode& primitive, int uv_set);

} // namespace relief
