// OBJ text to polygons, quads and n-gons of any size kept.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// `name` is for messages. Throws bad_input with the line for a missing or malformed number, the index of a
/// position that is out of range, and a damaged tag. Uvs and normals that are out of range and lines that OBJ
/// does not have are left out, and added to `warnings`. Faces of fewer than 3 corners, groups and materials
/// are left out without one; normals are dropped unless all corners have one. A backslash joins a line to the
/// next. Creases come from OpenSubdiv's tags ("t crease 2/1/0 4 5 2.5"): `crease` (pairs of positions) and
/// `corner` (single ones), counted from 0, with one sharpness for all or one each; negative ones count as 0.
Mesh parse_obj(std::string_view text, const std::string& name, std::vector<std::string>* warnings = nullptr);

/// Creases as lines of tags, which read back as they were.
std::string format_obj_creases(const std::vector<Crease>& creases);

} // namespace relief
