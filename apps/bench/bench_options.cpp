#include "bench/bench_options.h"

#include <algorithm>
#include <iterator>

#include <CLI/CLI.hpp>

#include "bench/suite_list.h"
#include "common/values.h"

namespace relief::bench {

namespace {

using namespace cli; // parse_integer, refuse_value and the like

constexpr int kMaxRuns = 1000;
constexpr int64_t kMaxLimitMegabytes = int64_t(1) << 30;

void add_run_options(CLI::App& verb, BenchOptions& o) {
    const auto add = [&](const char* name, const char* value, const char* help, auto parse) {
        verb.add_option_function<std::string>(name, parse, help)->type_name(value);
    };
    add("--runs", "N", "that count, after one to warm up; default 5, of cycles and characters 3",
        [&o](const std::string& text) { o.runs = int(parse_integer("--runs", text, 1, kMaxRuns)); });
    add("--scenes", "LIST",
        "paper1: of party,bark,barks,pumpkin; paper2: of body,hall,knot; paper3: these and pumpkin,bark; "
        "peers: of party,rock,rock_mild,rocks,rocks_mild,rock_close,rock_close_mild,pumpkin,bark; "
        "cycles: of rock,rocks,rock_close,pumpkin,ear; characters: of body,head,crowd; frame: sample scenes; "
        "default: all, of cycles "
        "rock,rocks,pumpkin, of frame pumpkin,bark,party",
        [&o](const std::string& text) {
            o.scenes = split(text, ',');
            if (o.scenes.empty()) refuse_value("--scenes", text, "a list of scenes");
        });
    verb.add_option("--mesh", o.meshes,
                    "paper2, paper3, triangles: measure this mesh, too; characters: in place of its own "
                    "scenes; may be "
                    "repeated")
        ->type_name("FILE");
    verb.add_option("--vdm", o.maps,
                    "characters: displacement map of the mesh, may hold <UDIM>; once for each --mesh")
        ->type_name("MAP");
    add("--space", "NAME", "characters: space of the maps: object, tangent or world",
        [&o](const std::string& text) {
            constexpr std::string_view kSpaces[] = {"object", "tangent", "world"};
            if (std::ranges::find(kSpaces, text) == std::end(kSpaces))
                refuse_value("--space", text, "object, tangent or world");
            o.map_space = text;
        });
    verb.add_option(
            "--blender", o.blenders,
            "characters: a program blender, or a python3 with the package bpy; may be repeated; default: "
            "the one in PATH")
        ->type_name("PROGRAM");
    verb.add_option("--scene", o.scene_files, "peers: measure this scene; may be repeated")
        ->type_name("FILE");
    verb.add_option("--baseline", o.baseline,
                    "frame: the command `relief` of another build, which takes turns with this one")
        ->type_name("PROGRAM");
    add("--tessellated-limit", "MB",
        "leave out pre-tessellated scenes above; default 4096 for paper1, 2048 for peers",
        [&o](const std::string& text) {
            o.tessellated_limit_bytes =
                uint64_t(parse_integer("--tessellated-limit", text, 0, kMaxLimitMegabytes)) << 20;
        });
    verb.add_flag("--quick", o.is_quick, "tiny pictures and meshes, one run: only shows that it works");
    add_progress_options(verb, o.progress, "no progress on stderr");
}

void add_setting_options(CLI::App& verb, BenchOptions& o) {
    const auto add = [&](const char* name, const char* value, const char* help, auto parse) {
        verb.add_option_function<std::string>(name, parse, help)->type_name(value);
    };
    add("--size", "WxH",
        "pixels; default 1280x720 for paper1, peers, cycles, edits and frame, 320x180 for paper2, 640x360 "
        "for paper3; characters: 240x320 and 1280x1706",
        [&o](const std::string& text) { o.size = parse_size("--size", text, kMaxPictureSize); });
    add("--spp", "N", "frame: samples a pixel; default 16",
        [&o](const std::string& text) { o.spp = int(parse_integer("--spp", text, 1, kMaxSamples)); });
    add("--level", "auto|N", "paper1: from the size on screen (default), or 2^N cells a side",
        [&o](const std::string& text) { o.level = parse_level(text); });
    add("--levels", "LIST", "peers: levels to measure, of auto and 0 to 12; default 3,4,5,6,auto",
        [&o](const std::string& text) {
            for (const std::string& level : split(text, ',')) o.levels.push_back(parse_level(level));
            if (o.levels.empty()) refuse_value("--levels", text, "a list of levels");
        });
}

} // namespace

void add_bench_options(CLI::App& app, BenchOptions& o) {
    app.add_option("suite", o.suite, describe_suites())->type_name("SUITE");
    app.add_option("-o", o.folder, "folder for JSON, CSV and charts; default: the suite's name")
        ->type_name("DIR");
    add_run_options(app, o);
    add_setting_options(app, o);
    add_engine_options(app, o.engine, o.settings);
}

std::vector<std::string_view> list_given(const BenchOptions& o) {
    const RenderSettings plain;
    const std::pair<std::string_view, bool> options[] = {
        {"--scenes", !o.scenes.empty()},
        {"--mesh", !o.meshes.empty()},
        {"--scene", !o.scene_files.empty()},
        {"--vdm", !o.maps.empty()},
        {"--space", !o.map_space.empty()},
        {"--blender", !o.blenders.empty()},
        {"--baseline", !o.baseline.empty()},
        {"--size", o.size.has_value()},
        {"--spp", o.spp.has_value()},
        {"--level", o.level.has_value()},
        {"--levels", !o.levels.empty()},
        {"--tessellated-limit", o.tessellated_limit_bytes.has_value()},
        {"--engine", o.settings.device.engine != plain.device.engine},
        {"--bottom", o.settings.experiment.bottom != plain.experiment.bottom},
        {"--threads", o.settings.device.threads != plain.device.threads},
        {"--isa", o.settings.device.isa != plain.device.isa}};
    std::vector<std::string_view> given;
    for (const auto& [name, is_given] : options)
        if (is_given) given.push_back(name);
    return given;
}

} // namespace relief::bench
