#include "scene/displacement_conventions.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "relief/error.h"
#include "scene/words.h"

namespace relief {

namespace {

constexpr std::array<MapPreset, 10> kPresets = {{{"blender-brush", "t,b,n", {}},
                                                 {"genvdm", "t,b,n", {}},
                                                 {"3dcoat", "t,b,n", {}},
                                                 {"vray-tangent", "t,b,n", 0.5f},
                                                 {"mudbox", "t,n,b", {}},
                                                 {"maya", "t,n,b", {}},
                                                 {"cycles", "t,n,b", {}},
                                                 {"arnold", "t,n,b", {}},
                                                 {"moonray", "t,n,b", {}},
                                                 {"daz16", "t,n,b", 0.5f}}};

[[noreturn]] void fail_axes(std::string_view text) {
    throw Error(ErrorKind::bad_input, {fmt::format("'{}' is no order of axes", text), "",
                                       "write t,b,n or x,y,z in the order of the channels, each once, "
                                       "with a minus where one points backwards: t,-n,b"});
}

std::string_view trim(std::string_view text) {
    const size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
    return begin == std::string_view::npos ? std::string_view() : text.substr(begin, end - begin + 1);
}

} // namespace

std::span<const std::string_view> get_preset_names() {
    static constexpr auto kNames = [] {
        std::array<std::string_view, kPresets.size()> names;
        for (size_t i = 0; i < names.size(); ++i) names[i] = kPresets[i].name;
        return names;
    }();
    return kNames;
}

const MapPreset& find_preset(std::string_view name) {
    for (const MapPreset& preset : kPresets)
        if (preset.name == name) return preset;
    if (name == "zbrush" || name.starts_with("zbrush:"))
        throw Error(
            ErrorKind::bad_input,
            {fmt::format("preset '{}' does not say where the channels point", name), "",
             "ZBrush writes any of 48 orders by its codes FlipAndSwitch and TangentFlipAndSwitch, which are "
             "nowhere listed: give the axes, which 'relief inspect MAP' reads off the map"});
    throw Error(ErrorKind::bad_input,
                {fmt::format("unknown preset '{}'", name), "", suggest_word(name, get_preset_names())});
}

MapFilter parse_texture_filter(std::string_view text) {
    const auto filter = parse_word<MapFilter>(text);
    if (filter == MapFilter::mip)
        throw Error(ErrorKind::bad_input,
                    {"filter mip is for displacement maps", "", "none, cubic or bspline"});
    return filter;
}

void check_dequantize(const Displacement& map) {
    if (!map.dequantize) return;
    const std::string where = fmt::format("displacement '{}'", map.name);
    if (!is_smooth(map.filter))
        throw Error(ErrorKind::bad_input,
                    {"dequantize needs a smooth filter: between texels a bilinear one keeps "
                     "the stairs",
                     where, "filter = cubic"});
    for (const MapTile& tile : map.tiles)
        if (tile.texture && tile.texture->source_type != SampleType::uint8 &&
            tile.texture->source_type != SampleType::uint16)
            throw Error(ErrorKind::bad_input,
                        {fmt::format("dequantize is for maps of 8 or 16-bit integers, which {} is not",
                                     tile.texture->file),
                         where, "leave it out: floats have no steps"});
}

AxisText parse_axes(std::string_view text) {
    AxisText result;
    std::string_view letters;
    std::string_view rest = text;
    uint32_t used = 0;
    for (size_t c = 0; c < 3; ++c) {
        const size_t comma = rest.find(',');
        if ((comma == std::string_view::npos) != (c == 2)) fail_axes(text);
        std::string_view part = trim(rest.substr(0, comma));
        if (c < 2) rest.remove_prefix(comma + 1);
        result.axes.sign[c] = part.starts_with('-') ? -1 : 1;
        if (part.starts_with('-') || part.starts_with('+')) part.remove_prefix(1);
        if (part.size() != 1) fail_axes(text);
        if (letters.empty())
            letters = std::string_view("tbn").find(part) != std::string_view::npos ? "tbn" : "xyz";
        const size_t axis = letters.find(part);
        if (axis == std::string_view::npos) fail_axes(text);
        result.axes.axis[c] = uint8_t(axis);
        used |= 1u << axis;
    }
    if (used != 7) fail_axes(text);
    result.is_tangent = letters == "tbn";
    return result;
}

std::string format_axes(const AxisMap& axes, DisplacementSpace space) {
    const char* letters = space == DisplacementSpace::tangent ? "tbn" : "xyz";
    std::string text;
    for (size_t c = 0; c < 3; ++c) {
        if (c > 0) text += ',';
        if (axes.sign[c] < 0) text += '-';
        text += letters[axes.axis[c]];
    }
    return text;
}

void refuse_reach(const std::string& displacement, const std::string& file, double reach) {
    throw Error(ErrorKind::bad_input,
                {fmt::format("map '{}' displaces by {:g}", file, reach),
                 fmt::format("displacement '{}'", displacement), "lower the scale or repair the map"});
}

} // namespace relief
