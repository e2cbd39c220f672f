// What OBJ's reader would take for 0 without a word.
#pragma once

#include <string>
#include <string_view>

namespace relief {

/// Throws bad_input with file and line for a position, uv or normal of an OBJ file that lacks a number or has
/// something that is none ("nan", "1,5").
void check_obj_numbers(std::string_view text, const std::string& name);

} // namespace relief
