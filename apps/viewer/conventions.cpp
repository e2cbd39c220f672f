#include "viewer/conventions.h"

#include <algorithm>
#include <string_view>
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

} // namespace

void apply_preset(const std::string& preset, Displacement& map) {
    constexpr const char* kSpaces[] = {"tangent", "object", "world"};
    MapOptions options;
    options.preset = preset;
    options.space = kSpaces[size_t(map.space)];
    const Displacement meaning = make_map_meaning(options);
    map.axes = meaning.axes;
    map.midlevel = meaning.midlevel;
    map.has_midlevel = true;
    if (meaning.midlevel == Vec3f{} && holds_integers(map)) map.midlevel = {0.5f, 0.5f, 0.5f};
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

std::string name_panels(std::string warning) {
    constexpr std::string_view kStart = "displacement.";
    for (size_t at = 0; (at = warning.find(kStart, at)) != std::string::npos;)
        warning.erase(at, kStart.size());
    return warning;
}

} // namespace relief::viewer
