// From what was said of a displacement map to the map itself: presets, defaults by kind of file, warnings.
#pragma once

#include <string>

#include "io/scene/asset_cache.h"
#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// A map of a scene file or of a command line.
struct DisplacementRequest {
    std::string name, file;
    MapOptions options;
};

/// Settles every value without looking at a file: what depends on its samples is as for floats.
Displacement make_displacement_values(const MapOptions& options);

/// Reads the tiles and settles every value; assumptions become warnings of `assets`. NaN and infinity stay.
Displacement read_displacement_map(const DisplacementRequest& request, AssetCache& assets);

/// The same; throws bad_input with pixel and tile for a NaN or an infinity.
Displacement make_displacement(const DisplacementRequest& request, AssetCache& assets);

} // namespace relief
