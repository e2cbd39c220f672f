#include "scene/displacement_conventions.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "relief/error.h"

namespace relief {

namespace {

template <class Value> using NameTable = std::span<const std::pair<std::string_view, Value>>;

constexpr std::array<std::pair<std::string_view, DisplacementType>, 2> kTypes = {
    {{"vector", DisplacementType::vector}, {"height", DisplacementType::height}}};
constexpr std::array<std::pair<std::string_view, DisplacementSpace>, 3> kSpaces = {
    {{"tangent", DisplacementSpace::tangent},
     {"object", DisplacementSpace::object},
     {"world", DisplacementSpace::world}}};
constexpr std::array<std::pair<std::string_view, MapFilter>, 2> kFilters = {
    {{"none", MapFilter::none}, {"mip", MapFilter::mip}}};
constexpr std::array<std::pair<std::string_view, WrapMode>, 4> kWraps = {{{"clamp", WrapMode::clamp},
                                                                          {"repeat", WrapMode::repeat},
                                                                          {"mirror", WrapMode::mirror},
                                                                          {"black", WrapMode::black}}};
constexpr std::array<std::pair<std::string_view, MapEncoding>, 2> kEncodings = {
    {{"float", MapEncoding::as_stored}, {"signed", MapEncoding::from_unit}}};
constexpr std::array<std::pair<std::string_view, FrameKind>, 3> kFrames = {
    {{"mikk", FrameKind::mikk}, {"dpdu", FrameKind::dpdu}, {"file", FrameKind::file}}};
constexpr std::array<std::pair<std::string_view, FrameLengths>, 2> kLengths = {
    {{"absolute", FrameLengths::absolute}, {"relative", FrameLengths::relative}}};
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
        throw Error(ErrorKind::bad_input,
                    {fmt::format("preset '{}' does not say where the channels point", name), "",
                     "ZBrush writes any of 48 orders by its codes FlipAndSwitch and TangentFlipAndSwitch, "
                     "which are nowhere listed: give the axes, as an inspection of the map names them"});
    throw Error(ErrorKind::bad_input,
                {fmt::format("unknown preset '{}'", name), "", suggest_word(name, get_preset_names())});
}

DisplacementType parse_displacement_type(std::string_view text) {
    return find_name(NameTable<DisplacementType>(kTypes), text, "type");
}
DisplacementSpace parse_displacement_space(std::string_view text) {
    return find_name(NameTable<DisplacementSpace>(kSpaces), text, "space");
}
MapFilter parse_map_filter(std::string_view text) {
    return find_name(NameTable<MapFilter>(kFilters), text, "filter");
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
MapEncoding parse_encoding(std::string_view text) {
    return find_name(NameTable<MapEncoding>(kEncodings), text, "encoding");
}
std::string_view get_name(MapEncoding encoding) {
    return find_value(NameTable<MapEncoding>(kEncodings), encoding);
}
FrameKind parse_frame_kind(std::string_view text) {
    return find_name(NameTable<FrameKind>(kFrames), text, "frame");
}
std::string_view get_name(FrameKind frame) { return find_value(NameTable<FrameKind>(kFrames), frame); }
FrameLengths parse_frame_lengths(std::string_view text) {
    return find_name(NameTable<FrameLengths>(kLengths), text, "lengths");
}
std::string_view get_name(FrameLengths lengths) {
    return find_value(NameTable<FrameLengths>(kLengths), lengths);
}
std::string_view get_name(MapFilter filter) { return find_value(NameTable<MapFilter>(kFilters), filter); }
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

} // namespace relief
