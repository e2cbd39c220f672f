// OBJ text to polygons, quads and n-gons of any size kept.
#pragma once

#include <string>
#include <string_view>

#include "relief/scene.h"

namespace relief {

/// `name` is for messages. Throws bad_input with line and face: index out of range, uv on some corners only.
/// Faces of fewer than 3 corners, groups and materials are left out; normals are dropped unless all corners
/// have one. Creases come from OpenSubdiv's tags (io/mesh/obj_tags.h).
Mesh parse_obj(std::string_view text, const std::string& name);

} // namespace relief
