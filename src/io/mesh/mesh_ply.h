// PLY to polygons, quads and n-gons kept: text, and binary of either byte order.
#pragma once

#include <string>
#include <string_view>

#include "relief/scene.h"

namespace relief {

/// Vertices x y z, normals nx ny nz and uvs s t, u v, texture_u texture_v or texture_s texture_t; faces
/// vertex_indices or vertex_index, with a list texcoord that wins over uvs of vertices. Any types and orders;
/// other data and faces of fewer than 3 corners are left out. Equal positions are welded. `name` is for
/// messages. Throws bad_input with line or byte and element.
Mesh parse_ply(std::string_view bytes, const std::string& name);

} // namespace relief
