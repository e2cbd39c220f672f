#include "io/scene/displacement_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/scene/tile_names.h"
#include "math/vec.h"
#include "relief/error.h"
#include "scene/displacement_conventions.h"
#include "scene/words.h"

namespace relief {

namespace {

DisplacementType decide_type(const DisplacementRequest& request, const Displacement& map,
                             AssetCache& assets) {
    const uint32_t channels = map.tiles.front().texture->channel_count;
    const char* const few = channels == 1 ? "one channel" : "two channels";
    if (request.options.type) {
        if (map.type == DisplacementType::vector && channels < 3)
            assets.warnings().push_back(fmt::format("displacement '{}': a map of {} is used as a "
                                                    "vector map; was \"type\": \"height\" meant?",
                                                    request.name, few));
        if (map.type == DisplacementType::height && channels >= 3)
            assets.warnings().push_back(
                fmt::format("displacement '{}': a height map with {} channels; only the first is used",
                            request.name, channels));
        return map.type;
    }
    if (channels >= 3) return DisplacementType::vector;
    assets.warnings().push_back(fmt::format("displacement '{}': a map of {} is taken as a height "
                                            "map; displacement.type = height says so",
                                            request.name, few));
    return DisplacementType::height;
}

void decide_axes(const MapOptions& options, const MapPreset* preset, Displacement& map) {
    std::optional<AxisText> axes;
    if (options.axes) axes = parse_axes(*options.axes);
    if (options.space)
        map.space = parse_word<DisplacementSpace>(*options.space);
    else if (axes && !axes->is_tangent)
        map.space = DisplacementSpace::object;
    const bool is_tangent = map.space == DisplacementSpace::tangent;
    if (axes && axes->is_tangent != is_tangent)
        throw Error(ErrorKind::bad_input,
                    {fmt::format("axes '{}' do not fit {} space", *options.axes, get_word(map.space)), "",
                     "use t, b, n in tangent space and x, y, z in object or world space"});
    if (!axes && preset && is_tangent) axes = parse_axes(preset->axes);
    if (axes) map.axes = axes->axes;
}

/// 0..1 that mean -1..1 are values around half the midlevel, twice as far apart.
void apply_encoding(const MapOptions& options, Displacement& map) {
    if (!options.encoding || parse_word<MapEncoding>(*options.encoding) == MapEncoding::as_stored) return;
    map.midlevel = (map.midlevel + Vec3f{1, 1, 1}) * 0.5f;
    map.scale = map.scale * 2.0f;
}

bool says_zero(const MapOptions& options, const Displacement& map) {
    return options.midlevel || map.midlevel != Vec3f{};
}

/// What the kind of file decides.
void complete_midlevel(const DisplacementRequest& request, Displacement& map, AssetCache& assets) {
    bool is_integer = false, is_eight_bit = false;
    for (const MapTile& tile : map.tiles) {
        const SampleType type = tile.texture->source_type;
        is_integer |= type != SampleType::float16 && type != SampleType::float32;
        is_eight_bit |= type == SampleType::uint8;
    }
    if (is_eight_bit && !map.dequantize)
        assets.warnings().push_back(fmt::format(
            "displacement '{}': 8-bit map, one step is {:.3g} scene units: stairs will show; "
            "export half or float EXR, or smooth them by displacement.filter = cubic with dequantize",
            request.name,
            std::max({std::fabs(map.scale.x), std::fabs(map.scale.y), std::fabs(map.scale.z)}) / 255));
    if (!is_integer || says_zero(request.options, map)) return;
    map.midlevel = {0.5f, 0.5f, 0.5f};
    assets.warnings().push_back(
        fmt::format("displacement '{}': integer map without a midlevel: 0.5 is assumed; "
                    "displacement.midlevel = 0.5 says so",
                    request.name));
}

} // namespace

Displacement make_displacement_values(const MapOptions& options) {
    Displacement map;
    const MapPreset* preset = options.preset.empty() ? nullptr : &find_preset(options.preset);
    if (options.type) map.type = parse_word<DisplacementType>(*options.type);
    decide_axes(options, preset, map);
    if (options.frame) map.frame = parse_word<FrameKind>(*options.frame);
    if (options.lengths) map.lengths = parse_word<FrameLengths>(*options.lengths);
    if (options.wrap) map.wrap = parse_word<WrapMode>(*options.wrap);
    map.scale = options.scale.value_or(Vec3f{1, 1, 1});
    map.flip_v = options.flip_v;
    map.dilate = options.dilate;
    if (options.filter) map.filter = parse_word<MapFilter>(*options.filter);
    map.dequantize = options.dequantize;
    map.autobump = options.autobump;
    map.has_midlevel = options.midlevel.has_value();
    if (options.midlevel)
        map.midlevel = *options.midlevel;
    else if (preset && preset->midlevel && !options.encoding)
        map.midlevel = {*preset->midlevel, *preset->midlevel, *preset->midlevel};
    apply_encoding(options, map);
    map.assumed = {.space = !options.space && !options.axes && !preset,
                   .axes = !options.axes && !preset,
                   .midlevel = !options.midlevel && !options.encoding && !(preset && preset->midlevel),
                   .wrap = !options.wrap};
    return map;
}

Displacement read_displacement_map(const DisplacementRequest& request, AssetCache& assets) {
    Displacement map = make_displacement_values(request.options);
    map.name = request.name;
    map.is_udim = has_tile_token(request.file);
    map.tiles = assets.load_displacement(request.file);
    map.type = decide_type(request, map, assets);
    complete_midlevel(request, map, assets);
    check_dequantize(map);
    return map;
}

Displacement make_displacement(const DisplacementRequest& request, AssetCache& assets) {
    Displacement map = read_displacement_map(request, assets);
    assets.require_finite(map.tiles, map.is_udim);
    return map;
}

} // namespace relief
