// Creases in OBJ text: the lines of tags that OpenSubdiv adds to the format ("t crease 2/1/0 4 5 2.5").
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// Tags `crease` (pairs of positions) and `corner` (single ones), indices counted from 0, with one sharpness
/// for all or one for each; negative ones count as 0. Other tags are left out. `name` is for messages.
/// Throws bad_input with the line: counts that the line does not hold, an index out of range.
std::vector<Crease> parse_obj_creases(std::string_view text, size_t position_count, const std::string& name);

/// The same as lines, which read back as they were.
std::string format_obj_creases(const std::vector<Crease>& creases);

} // namespace relief
