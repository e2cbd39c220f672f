// OBJ text to polygons, quads and n-gons of any size kept.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// `name` is for messages. Throws bad_input with its line for a position, uv or normal that lacks a number or
/// has something that is none ("nan", "1,5"), an index out of range, uv on some corners only and a damaged
/// tag. Faces of fewer than 3 corners, groups and materials are left out; normals are dropped unless all
/// corners have one. A line that ends with a backslash goes on in the next. Creases come from the tags that
/// OpenSubdiv adds to the format ("t crease 2/1/0 4 5 2.5"): `crease` (pairs of positions) and `corner`
/// (single ones), indices counted from 0, with one sharpness for all or one for each; negative ones count as
/// 0. Other tags are left out.
Mesh parse_obj(std::string_view text, const std::string& name);

/// Creases as lines of tags, which read back as they were.
std::string format_obj_creases(const std::vector<Crease>& creases);

} // namespace relief
