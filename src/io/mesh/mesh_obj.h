// OBJ text to polygons, quads and n-gons of any size kept.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// `name` is for messages. Throws bad_input with the line for bad numbers, indices out of range, uv on some
/// corners only and damaged tags. Left out: groups, materials, faces of fewer than 3 corners, and normals
/// unless all corners have one. Creases are OpenSubdiv's tags ("t crease 2/1/0 4 5 2.5", `crease` or
/// `corner`), counted from 0, with one sharpness or one each; negative ones count as 0.
Mesh parse_obj(std::string_view text, const std::string& name);

/// Creases as lines of tags, which read back as they were.
std::string format_obj_creases(const std::vector<Crease>& creases);

} // namespace relief
