#include "aim_options.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/values.h"
#include "relief/io.h"
#include "relief/shot.h"

namespace relief::cli {

namespace {

const char* const kAimGroup = "Camera, light and display";
constexpr float kLargest = 1e18f;

template <class Parse>
void add(CLI::App& verb, const std::string& name, const char* value, const char* help, Parse parse) {
    verb.add_option_function<std::string>(name, parse, help)->type_name(value)->group(kAimGroup);
}

Vec3f parse_point(const std::string& option, const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() != 3) refuse_value(option, text, "x,y,z");
    std::array<float, 3> values;
    for (size_t k = 0; k < 3; ++k) values[k] = float(parse_number(option, parts[k], -kLargest, kLargest));
    return {values[0], values[1], values[2]};
}

SunDirection parse_sun(const std::string& text) {
    constexpr std::string_view kSun = "sun:";
    const std::vector<std::string> parts =
        text.starts_with(kSun) ? split(text.substr(kSun.size()), ',') : std::vector<std::string>();
    if (parts.size() != 2)
        refuse_value(
            "--light", text, "sun:AZIMUTH,ELEVATION in degrees",
            "seen from +z a sun at the left, 30 degrees high, is sun:-60,30; at the right sun:60,30");
    return {float(parse_number("--light", parts[0], -360, 360)),
            float(parse_number("--light", parts[1], -90, 90))};
}

std::string parse_background(const std::string& text) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kNames = {
        {{"transparent", "transparent"},
         {"black", "#000000"},
         {"white", "#ffffff"},
         {"gray", "#808080"},
         {"grey", "#808080"}}};
    for (const auto& [name, value] : kNames)
        if (text == name) return std::string(value);
    const auto is_digit = [](unsigned char c) { return std::isxdigit(c) != 0; };
    if (text.size() != 7 || text[0] != '#' || !std::all_of(text.begin() + 1, text.end(), is_digit))
        refuse_value("--background", text, "transparent, black, white, gray or '#rrggbb'");
    return text;
}

/// A flag without a value is "true".
Ground parse_ground(const std::string& text) {
    if (text == "true") return Ground::plane;
    if (text != "shadow") refuse_value("--ground", text, "--ground, or --ground=shadow");
    return Ground::shadow;
}

float decode_srgb(float x) { return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f); }

Vec3f decode_color(const std::string& text) {
    const unsigned long rgb = std::stoul(text.substr(1), nullptr, 16);
    const auto channel = [&](int shift) { return decode_srgb(float(rgb >> shift & 255) / 255); };
    return {channel(16), channel(8), channel(0)};
}

bool is_png(const std::filesystem::path& file) { return get_lower_extension(file) == ".png"; }

void add_camera_options(CLI::App& verb, AimArguments& a) {
    AimOptions& scene = a.scene;
    add(verb, "--from", "x,y,z", "position of the camera",
        [&scene](const std::string& text) { scene.from = parse_point("--from", text); });
    add(verb, "--to", "x,y,z", "what it looks at; default with --from: the middle of the scene",
        [&scene](const std::string& text) { scene.to = parse_point("--to", text); });
    add(verb, "--fov", "D", "its vertical angle, degrees; what is framed stays as large, see --zoom",
        [&scene](const std::string& text) {
            scene.fov_degrees = float(parse_number("--fov", text, 0.001, 179.999));
        });
    add(verb, "--zoom", "F", "all F times as large, from the same place",
        [&scene](const std::string& text) { scene.zoom = float(parse_number("--zoom", text, 0.01, 100)); });
    add(verb, "--view", "NAME", "all objects from front, back, left, right, top or three-quarter",
        [&scene](const std::string& text) {
            constexpr std::array<std::pair<std::string_view, View>, 6> kViews = {
                {{"front", View::front},
                 {"back", View::back},
                 {"left", View::left},
                 {"right", View::right},
                 {"top", View::top},
                 {"three-quarter", View::three_quarter}}};
            scene.view = parse_word("--view", text, kViews);
        });
    verb.add_flag("--frame-all", scene.frame_all, "all objects from where the camera looks")
        ->group(kAimGroup);
    add(verb, "--turntable", "N", "N pictures of a turn of the camera: FILE.0001.png ...",
        [&a](const std::string& text) {
            if (text.starts_with("-"))
                refuse_value("--turntable", text, "a number of pictures", "a turn of 36: --turntable 36");
            a.turntable = int(parse_integer("--turntable", text, 1, 100000));
            a.scene.is_turntable = true;
        });
}

void add_light_options(CLI::App& verb, AimArguments& a) {
    AimOptions& scene = a.scene;
    add(verb, "--env-rotate", "D", "turns the environment about +y, degrees",
        [&scene](const std::string& text) {
            scene.rotate_degrees = float(parse_number("--env-rotate", text, -360, 360));
        });
    add(verb, "--env-strength", "F",
        "factor on the environment's radiance, in place of that of the scene or the automatic one",
        [&scene](const std::string& text) {
            scene.strength = float(parse_number("--env-strength", text, 0, 1e9));
        });
    add(verb, "--light", "sun:AZ,EL",
        "a sun in place of the scene's; the environment stays. Azimuth from +z to +x, elevation, degrees",
        [&scene](const std::string& text) { scene.suns.push_back(parse_sun(text)); });
    verb.add_flag("--ground", a.ground,
                  "a floor under the lowest point, without a horizon under a mesh alone; --ground=shadow: "
                  "only its shadow")
        ->group(kAimGroup)
        ->each([&scene](const std::string& text) { scene.ground = parse_ground(text); });
}

void add_output_options(CLI::App& verb, AimArguments& a) {
    add(verb, "--background", "COLOR", "behind the objects: '#rrggbb', black, white, gray, transparent",
        [&a](const std::string& text) { a.background = parse_background(text); });
    add(verb, "--save-scene", "FILE", "write the scene as it is rendered, to go on editing: FILE.json",
        [&a](const std::string& text) { a.saved_scene = text; });
}

} // namespace

void add_display_options(CLI::App& verb, DisplayArguments& a) {
    add(verb, "--exposure", "EV", "of PNG: stops brighter, or auto", [&a](const std::string& text) {
        if (text != "auto") parse_number("--exposure", text, -32, 32);
        a.exposure = text.substr(text[0] == '+' ? 1 : 0);
    });
    add(verb, "--tonemap", "NAME", "of PNG: agx (default), aces, filmic, standard (clipped), raw (linear)",
        [&a](const std::string& text) {
            constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kNames = {
                {{"agx", "agx"},
                 {"aces", "aces"},
                 {"filmic", "filmic"},
                 {"standard", "standard"},
                 {"raw", "raw"}}};
            a.tone_map = parse_word("--tonemap", text, kNames);
        });
    add(verb, "--png-bits", "N", "of a value in a PNG: 8 (default) or 16", [&a](const std::string& text) {
        constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kNames = {
            {{"8", "8"}, {"16", "16"}}};
        a.png_bits = parse_word("--png-bits", text, kNames);
    });
    add(verb, "--color-space", "NAME", "of EXR: linear (default: Rec.709), acescg, aces2065-1",
        [&a](const std::string& text) {
            constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kNames = {
                {{"linear", "linear"}, {"acescg", "acescg"}, {"aces2065-1", "aces2065-1"}}};
            a.color_space = parse_word("--color-space", text, kNames);
        });
}

void add_aim_options(CLI::App& verb, AimArguments& arguments) {
    add_camera_options(verb, arguments);
    add_light_options(verb, arguments);
    add_display_options(verb, arguments.display);
    add_output_options(verb, arguments);
}

void check_display(const DisplayArguments& display, const std::filesystem::path& output) {
    if (get_lower_extension(output) == ".hdr" &&
        !(display.exposure.empty() && display.tone_map.empty() && display.png_bits.empty()))
        throw Error(ErrorKind::usage, {"radiance is written as it is, without a display", output.string(),
                                       "--exposure, --tonemap and --png-bits go with .png and .exr"});
    if (get_lower_extension(output) != ".exr" && !display.color_space.empty())
        throw Error(ErrorKind::usage,
                    {"only .exr files tell their colour space", output.string(), "-o FILE.exr"});
    if (!display.tone_map.empty()) check_tone_map(display.tone_map);
}

void apply_background(const AimArguments& arguments, const std::filesystem::path& output,
                      ImageSettings& image) {
    if (arguments.background == "transparent" && get_lower_extension(output) == ".hdr")
        throw Error(ErrorKind::usage, {"this format has no alpha", output.string(), "-o FILE.exr or .png"});
    if (arguments.background.empty()) return;
    // A PNG is laid over its colour after the tone curve, so that the colour is the one that was named.
    const bool is_over = arguments.background == "transparent" || is_png(output);
    image.background = is_over ? Vec3f{} : decode_color(arguments.background);
}

void add_display_entries(const DisplayArguments& display, Image& image) {
    if (!display.exposure.empty()) image.metadata["relief:exposure"] = display.exposure;
    if (!display.tone_map.empty()) image.metadata["relief:display"] = display.tone_map;
    if (!display.png_bits.empty()) image.metadata["relief:png_bits"] = display.png_bits;
    if (!display.color_space.empty()) image.metadata["relief:color_space"] = display.color_space;
}

std::vector<std::string> list_picture_options(const AimArguments& arguments) {
    std::vector<std::string> words;
    const auto add = [&](const char* option, const std::string& value) {
        const char* quote = value.find('#') == std::string::npos ? "" : "'"; // a comment of the shell
        if (!value.empty()) words.push_back(fmt::format("{} {}{}{}", option, quote, value, quote));
    };
    add("--background", arguments.background);
    add("--exposure", arguments.display.exposure);
    add("--tonemap", arguments.display.tone_map);
    add("--png-bits", arguments.display.png_bits);
    add("--color-space", arguments.display.color_space);
    return words;
}

void add_picture_entries(const AimArguments& arguments, const std::filesystem::path& output, Image& image) {
    add_display_entries(arguments.display, image);
    if (arguments.background.empty()) return;
    const bool is_over = arguments.background == "transparent" || is_png(output);
    image.metadata["relief:background"] = is_over ? arguments.background : "linear " + arguments.background;
}

std::filesystem::path name_turn(const std::filesystem::path& output, int index) {
    return name_frame(output, index + 1);
}

} // namespace relief::cli
