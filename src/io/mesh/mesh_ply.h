// PLY to polygons, quads and n-gons kept: text, and binary of either byte order.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// Vertices x y z, with normals nx ny nz and uvs s t, u v, texture_u texture_v or texture_s texture_t where
/// they have them; faces vertex_indices or vertex_index, with a list texcoord of two numbers a corner, which
/// wins over uvs of the vertices. Types and orders may be any; other properties and elements are left out, as
/// are faces of fewer than 3 corners. Equal positions are welded.
/// `name` is for messages. Throws bad_input with line or byte and the number of the element.
/// Lists of uvs that do not fit their faces are left out, and added to `warnings`.
Mesh parse_ply(std::string_view bytes, const std::string& name, std::vector<std::string>* warnings = nullptr);

} // namespace relief
