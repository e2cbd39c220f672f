#include "common/map_options.h"

#include <functional>

#include <CLI/CLI.hpp>

#include "common/values.h"

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
    if (parts.size() == 2)
        refuse_value(option, text, "a number, or three separated by commas",
                     fmt::format("a point in place of the comma: {}.{}", parts[0], parts[1]));
    if (parts.size() != 1) refuse_value(option, text, "a number, or three separated by commas");
    const float all = parse(parts[0]);
    return {all, all, all};
}

namespace {

/// Adds options with one prefix.
class MapOptionAdder {
  public:
    MapOptionAdder(CLI::App& verb, const MapOptionPlace& place) : verb_(verb), place_(place) {}

    void add(const std::string& name, const char* value, const char* help,
             const std::function<void(const std::string&)>& set) {
        verb_
            .add_option_function<std::string>(
                name,
                [given = place_.given, spoken = name.substr(0, name.find(',')),
                 set](const std::string& text) {
                    if (given) given->push_back(spoken);
                    set(text);
                },
                help)
            ->type_name(value)
            ->group(place_.group);
    }
    void add_text(const std::string& name, const char* value, const char* help,
                  std::optional<std::string>& text) {
        add(name, value, help, [&text](const std::string& given) { text = given; });
    }
    void add_factors(const std::string& name, const char* help, std::optional<Vec3f>& factors) {
        add(name, "F|F,F,F", help,
            [&factors, name](const std::string& text) { factors = parse_factors(name, text); });
    }
    void add_flag(const std::string& name, const char* help, bool& flag) {
        verb_
            .add_flag_callback(
                name,
                [given = place_.given, name, &flag] {
                    flag = true;
                    if (given) given->push_back(name);
                },
                help)
            ->group(place_.group);
    }

  private:
    CLI::App& verb_;
    const MapOptionPlace& place_;
};

} // namespace

void add_map_options(CLI::App& verb, MapOptions& options, const MapOptionPlace& place) {
    MapOptionAdder adder(verb, place);
    const bool is_target = !place.prefix.empty();
    const std::string start = "--" + place.prefix;
    adder.add(place.preset, "NAME", "the program: blender-brush, mudbox, ...",
              [&options](const std::string& text) { options.preset = to_lower_case(text); });
    adder.add_text(start + "type", "NAME", "vector or height", options.type);
    adder.add_text(start + "space", "NAME", "tangent, object or world", options.space);
    adder.add_text(start + "axes", "LIST", "where R, G, B point: t,b,n or x,-z,y ...", options.axes);
    adder.add_text(start + "frame", "NAME", "of tangent space: mikk (default), dpdu or file", options.frame);
    adder.add_text(start + "lengths", "NAME", "of its axes: absolute (default) or relative", options.lengths);
    adder.add_text(start + "encoding", "NAME", "float, or signed: 0..1 means -1..1", options.encoding);
    adder.add_factors(start + "midlevel", "value that means no displacement", options.midlevel);
    adder.add_factors(is_target ? "--to-scale" : "--vdm-scale", "factor on the displacement", options.scale);
    if (!is_target)
        adder.add_text("--wrap", "NAME", "clamp (default), repeat, mirror or black", options.wrap);
    adder.add_flag(start + "flip-v", "row 0 of the map is v = 0", options.flip_v);
}

void check_map_words(const MapOptions& options) {
    try {
        make_map_meaning(options);
    } catch (const Error& error) {
        throw Error(ErrorKind::usage, {error.message(), error.where(), error.hint()});
    }
}

} // namespace relief::cli
