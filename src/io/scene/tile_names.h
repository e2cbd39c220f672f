// Tiles of a map by their file names: 1001 + u + 10 v (Mari), u1_v1 (Mudbox), u0_v0 (ZBrush).
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace relief {

/// Throws Error{bad_input} where a name with a star is no file: tiles and frames are named otherwise.
void refuse_wildcard(const std::filesystem::path& file);

/// True for a name with a tile token: <UDIM> or <udim> for 1001 ..., <UVTILE> for u1_v1 ..., <uvtile> for
/// u0_v0 ...
bool has_tile_token(const std::string& file);

/// The files that a name with a token stands for, numbered as UDIM does (1001 + u + 10 v), by rising number.
/// Throws bad_input when there is none, more than a map may have, or two of one number.
std::vector<std::pair<int, std::filesystem::path>> find_tiles(const std::filesystem::path& pattern);

/// Those of `names` that a pattern stands for, numbered alike, by rising number. None, where there are none;
/// the rest as find_tiles.
std::vector<std::pair<int, std::string>> choose_tiles(const std::string& pattern,
                                                      const std::vector<std::string>& names);

/// The name of tile `udim` for a name with a token.
std::filesystem::path make_tile_name(const std::filesystem::path& pattern, int udim);

} // namespace relief
