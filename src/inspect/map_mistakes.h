// The usual mistakes in displacement maps, each with its remedy. docs/inspect.md lists the codes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/map_convention.h"
#include "analysis/map_statistics.h"
#include "relief/inspect.h"

namespace relief {

/// "column 5, row 3", and the tile where a map has several.
std::string describe_place(const TexelPlace& place, const Displacement& map);

/// Whether the map has tiles, and each of them texels.
bool has_all_textures(const Displacement& map);

/// Whether the midlevel of the map is somebody's word: 0 may be a mere default.
bool knows_midlevel(const Displacement& map, MapMeaning meaning);
/// The midlevel that was said, if any was.
std::optional<Vec3f> find_known_midlevel(const Displacement& map, MapMeaning meaning);

/// What the texels alone show. With MapMeaning::declared midlevel, scale and type of `map` are taken at their
/// word; otherwise the midlevel of the statistics counts.
void find_map_mistakes(const Displacement& map, MapMeaning meaning, const MapStatistics& statistics,
                       std::vector<Finding>& findings);

/// What a map and its mesh show together: length against size, density of texels.
void find_misfits(const Displacement& map, const MapStatistics& statistics, const Mesh& mesh,
                  std::vector<Finding>& findings);

/// The setting that makes axes those of the convention: "write displacement.axes = t,n,b, as presets ...".
std::string advise_axes(const MapConvention& convention, DisplacementSpace space);

/// Where what was declared is not what the values look like.
void note_convention(const Displacement& map, MapMeaning meaning, const MapConvention& convention,
                     std::vector<Finding>& findings);

} // namespace relief
