// Names of settings in messages of the library, which are not parts of other names or of files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace relief::cli {

/// Where `name` stands in `text` by itself, from `at` on; npos: nowhere.
size_t find_whole_name(std::string_view text, std::string_view name, size_t at = 0);

/// `text` with "displacement.axes" and the other keys of displacements as "axes", for those who see the keys
/// of one displacement.
std::string name_map_keys(std::string text);

} // namespace relief::cli
