#include "io/displacement_reader.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "relief/error.h"
#include "relief/suggest.h"

namespace relief {

namespace {

template <class Value> using NameTable = std::span<const std::pair<std::string_view, Value>>;

constexpr std::array<std::pair<std::string_view, DisplacementType>, 2> kTypes = {
    {{"vector", DisplacementType::vector}, {"height", DisplacementType::height}}};
constexpr std::array<std::pair<std::string_view, DisplacementSpace>, 3> kSpaces = {
    {{"tangent", DisplacementSpace::tangent},
     {"object", DisplacementSpace::object},
     {"world", DisplacementSpace::world}}};
constexpr std::array<std::pair<std::string_view, WrapMode>, 4> kWraps = {{{"clamp", WrapMode::clamp},
                                                                          {"repeat", WrapMode::repeat},
                                                                          {"mirror", WrapMode::mirror},
                                                                          {"black", WrapMode::black}}};
/// Programs and the tangent order that they write.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kPresets = {
    {{"blender-brush", "t,b,n"},
     {"genvdm", "t,b,n"},
     {"3dcoat", "t,b,n"},
     {"mudbox", "t,n,b"},
     {"maya", "t,n,b"},
     {"cycles", "t,n,b"},
     {"arnold", "t,n,b"},
     {"moonray", "t,n,b"}}};

template <class Value> Value find_name(NameTable<Value> table, std::string_view text, const char* what) {
    std::vector<std::string_view> names;
    for (const auto& [name, value] : table) {
        if (name == text) return value;
        names.push_back(name);
    }
    throw Error(ErrorKind::bad_input,
                {fmt::format("unknown {} '{}'", what, text), "", suggest_word(text, names)});
}

template <class Value> std::string_view find_value(NameTable<Value> table, Value wanted) {
    for (const auto& [name, value] : table)
        if (value == wanted) return name;
    return {};
}

[[noreturn]] void fail_axes(std::string_view text) {
    throw Error(ErrorKind::bad_input, {fmt::format("'{}' is no order of axes", text), "",
                                       "write t,b,n or x,y,z in the order of the channels, each once, "
                                       "with a minus where one points backwards: t,-n,b"});
}

std::string_view trim(std::string_view text) {
    const size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
    return begin == std::string_view::npos ? std::string_view() : text.substr(begin, end - begin + 1);
}

DisplacementType decide_type(const DisplacementRequest& request, const Displacement& map,
                             AssetCache& assets) {
    const uint32_t channels = map.tiles.front().texture->channel_count;
    if (request.type) {
        const DisplacementType type = parse_displacement_type(*request.type);
        if (type == DisplacementType::vector && channels < 3)
            assets.warnings().push_back(fmt::format("displacement '{}': a map of {} channel(s) is used as a "
                                                    "vector map; was \"type\": \"height\" meant?",
                                                    request.name, channels));
        if (type == DisplacementType::height && channels >= 3)
            assets.warnings().push_back(
                fmt::format("displacement '{}': a height map with {} channels; only the first is used",
                            request.name, channels));
        return type;
    }
    if (channels >= 3) return DisplacementType::vector;
    assets.warnings().push_back(fmt::format(
        "displacement '{}': a map of {} channel(s) is taken as a height map", request.name, channels));
    return DisplacementType::height;
}

void decide_axes(const DisplacementRequest& request, Displacement& map) {
    std::optional<AxisText> axes;
    if (request.axes) axes = parse_axes(*request.axes);
    if (request.space)
        map.space = parse_displacement_space(*request.space);
    else if (axes && !axes->is_tangent)
        map.space = DisplacementSpace::object;
    const bool is_tangent = map.space == DisplacementSpace::tangent;
    if (axes && axes->is_tangent != is_tangent)
        throw Error(ErrorKind::bad_input,
                    {fmt::format("axes '{}' do not fit {} space", *request.axes, get_name(map.space)), "",
                     "use t, b, n in tangent space and x, y, z in object or world space"});
    if (!request.preset.empty()) {
        const std::string_view order =
            find_name(NameTable<std::string_view>(kPresets), request.preset, "preset");
        if (!axes && is_tangent) axes = parse_axes(order);
    }
    if (axes) map.axes = axes->axes;
}

void decide_midlevel(const DisplacementRequest& request, Displacement& map, AssetCache& assets) {
    bool is_integer = false, is_eight_bit = false;
    for (const MapTile& tile : map.tiles) {
        const SampleType type = tile.texture->source_type;
        is_integer |= type != SampleType::float16 && type != SampleType::float32;
        is_eight_bit |= type == SampleType::uint8;
    }
    if (is_eight_bit)
        assets.warnings().push_back(
            fmt::format("displacement '{}': 8-bit map, one step is {:.3g} scene units: stairs will show; "
                        "export half or float EXR",
                        request.name, std::max({map.scale.x, map.scale.y, map.scale.z}) / 255));
    if (request.midlevel) {
        map.midlevel = *request.midlevel;
    } else if (is_integer) {
        map.midlevel = {0.5f, 0.5f, 0.5f};
        assets.warnings().push_back(
            fmt::format("displacement '{}': integer map without a midlevel: 0.5 is assumed", request.name));
    }
}

} // namespace

std::span<const std::string_view> get_preset_names() {
    static constexpr auto kNames = [] {
        std::array<std::string_view, kPresets.size()> names;
        for (size_t i = 0; i < names.size(); ++i) names[i] = kPresets[i].first;
        return names;
    }();
    return kNames;
}

DisplacementType parse_displacement_type(std::string_view text) {
    return find_name(NameTable<DisplacementType>(kTypes), text, "type");
}
DisplacementSpace parse_displacement_space(std::string_view text) {
    return find_name(NameTable<DisplacementSpace>(kSpaces), text, "space");
}
WrapMode parse_wrap_mode(std::string_view text) {
    return find_name(NameTable<WrapMode>(kWraps), text, "wrap");
}
std::string_view get_name(DisplacementType type) {
    return find_value(NameTable<DisplacementType>(kTypes), type);
}
std::string_view get_name(DisplacementSpace space) {
    return find_value(NameTable<DisplacementSpace>(kSpaces), space);
}
std::string_view get_name(WrapMode wrap) { return find_value(NameTable<WrapMode>(kWraps), wrap); }

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

Displacement make_displacement(const DisplacementRequest& request, AssetCache& assets) {
    Displacement map;
    map.name = request.name;
    decide_axes(request, map);
    if (request.wrap) map.wrap = parse_wrap_mode(*request.wrap);
    map.scale = request.scale.value_or(Vec3f{1, 1, 1});
    map.flip_v = request.flip_v;
    map.dilate = request.dilate;
    map.is_udim = has_udim_token(request.file);
    map.tiles = assets.load_displacement(request.file);
    map.type = decide_type(request, map, assets);
    decide_midlevel(request, map, assets);
    return map;
}

} // namespace relief
