#include "common/mesh_options.h"

#include <array>
#include <functional>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>

#include "common/mesh_reader.h"
#include "common/values.h"

namespace relief::cli {

float parse_weld(const std::string& text) { return float(parse_number("--weld", text, 0, 1e18)); }

UpAxis parse_up_axis(const std::string& text) {
    constexpr std::array<std::pair<std::string_view, UpAxis>, 3> kAxes = {
        {{"x", UpAxis::x}, {"y", UpAxis::y}, {"z", UpAxis::z}}};
    return parse_word("--up", text, kAxes);
}

void add_mesh_options(CLI::App& verb, const std::string& group, MeshSceneOptions& options,
                      std::vector<std::string>& given) {
    const auto add = [&](const char* name, const char* value, const char* help,
                         const std::function<void(const std::string&)>& set) {
        verb.add_option_function<std::string>(
                name,
                [&given, name, set](const std::string& text) {
                    given.push_back(name);
                    set(text);
                },
                help)
            ->type_name(value)
            ->group(group);
    };
    const auto add_flag = [&](const char* name, const char* help, bool& flag, bool value) {
        verb.add_flag_callback(
                name,
                [&given, name, &flag, value] {
                    given.push_back(name);
                    flag = value;
                },
                help)
            ->group(group);
    };
    options.reader = make_mesh_reader();
    add("--vdm", "MAP", "displacement map; may hold <UDIM>, and name a layer: FILE.exr:LAYER",
        [&options](const std::string& text) { options.displacement_map = text; });
    add("--subdivision", "NAME", "catmark: the limit surface of the mesh; bilinear, none (default)",
        [&options](const std::string& text) {
            constexpr std::array<std::pair<std::string_view, bool>, 3> kSchemes = {
                {{"catmark", true}, {"bilinear", true}, {"none", true}}};
            parse_word("--subdivision", text, kSchemes);
            options.subdivision = text;
        });
    add("--subdivision-level", "auto|N",
        "patches per quad: 2^N x 2^N, or few and near enough (default: auto)",
        [&options](const std::string& text) { options.subdivision_level = parse_subdivision_level(text); });
    add("--weld", "EPS", "distance at which open edges are joined (default: rounding errors; 0: never)",
        [&options](const std::string& text) { options.weld = parse_weld(text); });
    add("--up", "AXIS", "axis of the mesh that points up, and becomes y: x, y (default), z",
        [&options](const std::string& text) { options.up = parse_up_axis(text); });
    add("--filter", "NAME", "of the map: cubic or bspline up close, mip from afar, none (default)",
        [&options](const std::string& text) { options.map.filter = text; });
    add_flag("--dequantize", "smooth the steps of 8 and 16-bit maps; filter cubic or bspline",
             options.map.dequantize, true);
    add_flag("--autobump", "shade the map's detail that is finer than the cells", options.map.autobump, true);
    add_flag("--no-dilate", "leave texels between uv islands as the map has them", options.map.dilate, false);
}

namespace {

using GivenOption = std::pair<bool, const char*>;

void refuse_without_map(const MeshSceneOptions& options, const std::vector<GivenOption>& given) {
    if (!options.displacement_map.empty()) return;
    for (const auto& [is_given, name] : given)
        if (is_given)
            throw Error(ErrorKind::usage,
                        {fmt::format("{} says nothing without a map", name), "", "--vdm MAP"});
}

} // namespace

void check_mesh_options(const MeshSceneOptions& options) {
    if (options.subdivision_level && !options.subdivision)
        throw Error(ErrorKind::usage, {"--subdivision-level needs a subdivision scheme",
                                       "--subdivision-level", "--subdivision catmark"});
    const MapOptions& map = options.map;
    refuse_without_map(options, {{map.filter.has_value(), "--filter"},
                                 {map.dequantize, "--dequantize"},
                                 {map.autobump, "--autobump"},
                                 {!map.dilate, "--no-dilate"}});
}

void check_map_options(const MeshSceneOptions& options) {
    const MapOptions& map = options.map;
    refuse_without_map(options, {{!map.preset.empty(), "--preset"},
                                 {map.type.has_value(), "--type"},
                                 {map.space.has_value(), "--space"},
                                 {map.axes.has_value(), "--axes"},
                                 {map.frame.has_value(), "--frame"},
                                 {map.lengths.has_value(), "--lengths"},
                                 {map.encoding.has_value(), "--encoding"},
                                 {map.wrap.has_value(), "--wrap"},
                                 {map.midlevel.has_value(), "--midlevel"},
                                 {map.scale.has_value(), "--vdm-scale"},
                                 {map.flip_v, "--flip-v"}});
}

} // namespace relief::cli
