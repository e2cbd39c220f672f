// load_map and make_map_meaning: a displacement map without a scene file.
#include <iterator>

#include "io/scene/asset_cache.h"
#include "io/scene/displacement_reader.h"
#include "relief/io.h"
#include "scene/displacement_conventions.h"
#include "scene/words.h"

namespace relief {

Displacement load_map(const std::filesystem::path& file, const MapOptions& options,
                      std::vector<std::string>& warnings) {
    AssetCache assets("");
    Displacement map = read_displacement_map({file.stem().string(), file.string(), options}, assets);
    std::move(assets.warnings().begin(), assets.warnings().end(), std::back_inserter(warnings));
    return map;
}

Displacement make_map_meaning(const MapOptions& options) { return make_displacement_values(options); }

MapOptions describe_map_meaning(const Displacement& map) {
    MapOptions options;
    options.type = get_word(map.type), options.space = get_word(map.space);
    options.axes = format_axes(map.axes, map.space);
    if (map.space == DisplacementSpace::tangent)
        options.frame = get_word(map.frame), options.lengths = get_word(map.lengths);
    options.midlevel = map.midlevel, options.scale = map.scale, options.flip_v = map.flip_v;
    return options;
}

} // namespace relief
