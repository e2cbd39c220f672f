// One part of a glTF mesh: its vertices, and its faces as polygons.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/mesh/gltf_file.h"

namespace relief {

inline constexpr const char* kDamagedHint = "the file is damaged: export it again";

struct GltfPrimitive {
    // Values of the vertices one after another, kept by the file; empty where the part has none of the kind.
    std::span<const float> positions, normals; ///< 3 a vertex
    std::span<const float> uvs;                ///< 2 a vertex, v downwards
    std::span<const float> tangents;           ///< 4 a vertex
    std::vector<uint32_t> face_sizes, corners;
    size_t uv_set_count = 0; ///< TEXCOORD_0 and so on that the part has
};

/// Points and lines have no faces. Throws bad_input.
GltfPrimitive read_gltf_primitive(GltfFile& file, const JsonNode& primitive, int uv_set);

} // namespace relief
