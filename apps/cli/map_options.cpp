#include "map_options.h"

#include <functional>

#include "values.h"

namespace relief::cli {

namespace {

constexpr double kLargestFactor = 1e9;

} // namespace

Vec3f parse_factors(const std::string& option, const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    const auto parse = [&](const std::string& part) {
        return float(parse_number(option, part, -kLargestFactor, kLargestFactor));
    };
    if (parts.size() == 3) return {parse(parts[0]), parse(parts[1]), parse(parts[2])};
    if (parts.size() != 1) refuse_value(option, text, "a number, or three separated by commas");
    const float all = parse(parts[0]);
    return {all, all, all};
}

void add_map_options(CLI::App& verb, MapOptions& options, const MapOptionPlace& place) {
    const auto add = [&](const char* name, const char* value, const char* help,
                         std::function<void(const std::string&)> set) {
        verb.add_option_function<std::string>(
                name,
                [given = place.given, name, set](const std::string& text) {
                    if (given) given->push_back(name);
                    set(text);
                },
                help)
            ->type_name(value)
            ->group(place.group);
    };
    const auto add_text = [&](const char* name, const char* value, const char* help,
                              std::optional<std::string>& text) {
        add(name, value, help, [&text](const std::string& given) { text = given; });
    };
    add("--preset", "NAME", "what wrote the map: blender-brush, mudbox, ...",
        [&options](const std::string& text) { options.preset = text; });
    add_text("--type", "NAME", "vector or height", options.type);
    add_text("--space", "NAME", "tangent, object or world", options.space);
    add_text("--axes", "LIST", "where R, G, B point: t,b,n or x,-z,y ...", options.axes);
    add_text("--encoding", "NAME", "float, or signed: 0..1 means -1..1", options.encoding);
    add("--midlevel", "F|F,F,F", "value that means no displacement",
        [&options](const std::string& text) { options.midlevel = parse_factors("--midlevel", text); });
    add("--vdm-scale", "F|F,F,F", "factor on the displacement",
        [&options](const std::string& text) { options.scale = parse_factors("--vdm-scale", text); });
    add_text("--wrap", "NAME", "clamp (default), repeat, mirror or black", options.wrap);
    verb.add_flag_callback(
            "--flip-v",
            [&options, given = place.given] {
                options.flip_v = true;
                if (given) given->push_back("--flip-v");
            },
            "row 0 of the map is v = 0")
        ->group(place.group);
}

} // namespace relief::cli
