#include "viewer/conventions.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "relief/io.h"

namespace relief::viewer {

namespace {

bool holds_integers(const Displacement& map) {
    return std::ranges::any_of(map.tiles, [](const MapTile& tile) {
        const SampleType type = tile.texture->source_type;
        return type != SampleType::float16 && type != SampleType::float32;
    });
}

/// Axes and midlevel of a program's maps; all else is no part of it.
Displacement get_preset(const std::string& preset, const Displacement& map) {
    constexpr const char* kSpaces[] = {"tangent", "object", "world"};
    MapOptions options;
    options.preset = preset;
    options.space = kSpaces[size_t(map.space)];
    Displacement meaning = make_map_meaning(options);
    if (meaning.midlevel == Vec3f{} && holds_integers(map)) meaning.midlevel = {0.5f, 0.5f, 0.5f};
    return meaning;
}

} // namespace

void apply_preset(const std::string& preset, Displacement& map) {
    const Displacement meaning = get_preset(preset, map);
    map.axes = meaning.axes;
    map.midlevel = meaning.midlevel;
    map.has_midlevel = true;
}

std::string find_preset(const Displacement& map, const std::string& chosen) {
    const auto has_values = [&](const std::string& preset) {
        const Displacement meaning = get_preset(preset, map);
        return meaning.axes == map.axes && meaning.midlevel == map.midlevel;
    };
    if (!chosen.empty() && has_values(chosen)) return chosen;
    const auto found = std::ranges::find_if(kPresets, has_values);
    return found == std::end(kPresets) ? std::string() : *found;
}

Displacement choose_convention(const std::string& preset, const Displacement& map) {
    MapOptions options;
    options.preset = preset;
    Displacement to = make_map_meaning(options);
    to.flip_v = map.flip_v;
    return to;
}

void set_axis(AxisMap& axes, size_t channel, uint8_t axis, int8_t sign) {
    for (size_t other = 0; other < 3; ++other)
        if (other != channel && axes.axis[other] == axis) std::swap(axes.axis[other], axes.axis[channel]);
    axes.sign[channel] = sign;
}

} // namespace relief::viewer
