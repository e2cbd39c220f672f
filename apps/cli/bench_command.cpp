// bench: the suites of measurements.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cycles.h"
#include "bench/edits.h"
#include "bench/paper1.h"
#include "bench/paper2.h"
#include "bench/paper3.h"
#ifdef RELIEF_EMBREE
#include "bench/peers.h"
#include "bench/triangles.h"
#endif
#include "commands.h"
#include "engine_options.h"
#include "exit_codes.h"
#include "relief/error.h"
#include "relief/io.h"
#include "values.h"

namespace relief::cli {

namespace {

constexpr int kMaxRuns = 1000;
constexpr int64_t kMaxLimitMegabytes = int64_t(1) << 30;

struct BenchOptions {
    std::string suite = "paper1";
    std::filesystem::path folder;
    EngineOptions engine;
    RenderSettings settings; ///< of the engine; the size is below
    std::optional<std::pair<int, int>> size;
    std::vector<std::string> scenes; ///< none: all of the suite
    std::vector<std::string> meshes, scene_files;
    std::optional<int> runs;
    std::optional<uint64_t> tessellated_limit_bytes;
    std::optional<int> level;
    std::vector<int> levels; ///< none: all of the suite
    bool is_quick = false, is_quiet = false;
};

void print_goals(const nlohmann::ordered_json& goals) {
    for (const auto& goal : goals)
        fmt::print("{}  {}: {:.4g} {}, goal {:.4g}\n", goal["met"].get<bool>() ? "met    " : "not met",
                   goal["name"].get<std::string>(), goal["reached"].get<double>(),
                   goal["unit"].get<std::string>(), goal["goal"].get<double>());
}

struct SuiteResult {
    nlohmann::ordered_json result;
    std::vector<bench::ReportFile> files;
};

/// The settings for a suite whose pictures are of that size unless the command says otherwise.
RenderSettings make_settings(const BenchOptions& o, int width, int height) {
    RenderSettings settings = o.settings;
    std::tie(settings.image.width, settings.image.height) = o.size.value_or(std::pair(width, height));
    return settings;
}

std::vector<std::string> check_scenes(const BenchOptions& o, const std::vector<std::string>& all) {
    const std::vector<std::string_view> known(all.begin(), all.end());
    for (const std::string& scene : o.scenes)
        if (std::find(known.begin(), known.end(), scene) == known.end())
            throw Error(ErrorKind::usage,
                        {fmt::format("'{}' is not one of: {}", scene, fmt::join(known, ", ")), "--scenes",
                         suggest_word(scene, known)});
    return o.scenes.empty() ? all : o.scenes;
}

/// Meshes of files come with a camera; they are measured under the sun of our own scenes.
std::vector<Scene> load_meshes(const BenchOptions& o) {
    std::vector<Scene> scenes;
    for (const std::string& file : o.meshes) {
        Scene scene = load_mesh_scene(file, {});
        scene.meshes.resize(1), scene.objects.resize(1);
        scene.meshes[0].name = std::filesystem::path(file).filename().string();
        scene.environment.reset();
        scene.lights = make_structure_scene("body", MeshDetail::reduced).lights;
        scenes.push_back(std::move(scene));
    }
    return scenes;
}

SuiteResult run_paper1_suite(const BenchOptions& o, const bench::Report& report) {
    bench::Paper1Options options;
    options.settings = make_settings(o, 1280, 720);
    options.settings.surface.level = o.level.value_or(options.settings.surface.level);
    options.tessellated_limit_bytes = o.tessellated_limit_bytes.value_or(options.tessellated_limit_bytes);
    options.scenes = check_scenes(o, bench::kPaper1Scenes);
    options.runs = o.runs.value_or(options.runs);
    const auto result = bench::run_paper1(o.is_quick ? make_quick_options(options) : options, report);
    return {result, bench::make_paper1_files(result)};
}

SuiteResult run_paper2_suite(const BenchOptions& o, const bench::Report& report) {
    bench::Paper2Options options;
    options.settings = make_settings(o, 320, 180);
    options.scenes = check_scenes(o, structure_scene_names());
    options.meshes = load_meshes(o);
    options.runs = o.runs.value_or(options.runs);
    const auto result = bench::run_paper2(o.is_quick ? make_quick_options(options) : options, report);
    return {result, bench::make_paper2_files(result)};
}

SuiteResult run_paper3_suite(const BenchOptions& o, const bench::Report& report) {
    bench::Paper3Options options;
    options.settings = make_settings(o, 640, 360);
    options.scenes = check_scenes(o, bench::paper3_scenes());
    options.meshes = load_meshes(o);
    options.runs = o.runs.value_or(options.runs);
    const auto result = bench::run_paper3(o.is_quick ? make_quick_options(options) : options, report);
    return {result, bench::make_paper3_files(result)};
}

/// Scenes of its own, rendered by this very command.
SuiteResult run_cycles_suite(const BenchOptions& o, const bench::Report& report) {
    bench::CyclesOptions options;
    options.settings = make_settings(o, 1280, 720);
    options.folder = o.folder.empty() ? std::filesystem::path(o.suite) : o.folder;
    options.relief = std::filesystem::read_symlink("/proc/self/exe");
    options.runs = o.runs.value_or(options.runs);
    check_scenes(o, bench::cycles_scene_names());
    if (!o.scenes.empty()) options.scenes = o.scenes;
    const auto result = bench::run_cycles(o.is_quick ? make_quick_options(options) : options, report);
    return {result, bench::make_cycles_files(result)};
}

/// The CPU engine, a scene of its own.
SuiteResult run_edits_suite(const BenchOptions& o, const bench::Report& report) {
    bench::EditsOptions options;
    options.settings = make_settings(o, 1280, 720);
    options.folder = o.folder.empty() ? std::filesystem::path(o.suite) : o.folder;
    options.runs = o.runs.value_or(options.runs);
    const auto result = bench::run_edits(o.is_quick ? make_quick_options(options) : options, report);
    return {result, bench::make_edits_files(result)};
}

#ifdef RELIEF_EMBREE
/// One thread of the CPU engine; its own meshes are always measured.
SuiteResult run_triangles_suite(const BenchOptions& o, const bench::Report& report) {
    bench::TrianglesOptions options;
    options.runs = o.runs.value_or(options.runs);
    options.isa = o.settings.device.isa;
    options.meshes = load_meshes(o);
    const auto result = bench::run_triangles(o.is_quick ? make_quick_options(options) : options, report);
    return {result, bench::make_triangles_files(result)};
}

/// Scenes of files take the place of the suite's own, unless those are asked for as well.
SuiteResult run_peers_suite(const BenchOptions& o, const bench::Report& report) {
    bench::PeersOptions options;
    const RenderSettings settings = make_settings(o, options.width, options.height);
    options.width = settings.image.width, options.height = settings.image.height;
    options.isa = settings.device.isa, options.threads = settings.device.threads;
    options.runs = o.runs.value_or(options.runs);
    options.scenes = check_scenes(o, bench::peers_scene_names());
    for (const std::string& file : o.scene_files) {
        options.files.push_back(load_scene(file));
        options.files.back().source = file;
    }
    if (!o.scene_files.empty()) options.scenes = o.scenes;
    if (!o.levels.empty()) options.levels = o.levels;
    options.tessellated_limit_bytes = o.tessellated_limit_bytes.value_or(options.tessellated_limit_bytes);
    const auto result = bench::run_peers(o.is_quick ? make_quick_options(options) : options, report);
    return {result, bench::make_peers_files(result)};
}
#endif

struct Suite {
    std::string_view name, help;
    SuiteResult (*run)(const BenchOptions& options, const bench::Report& report);
    std::vector<std::string_view> options; ///< those that not every suite has
};

const std::vector<Suite>& list_suites() {
    static const std::vector<Suite> kSuites = {
        {"paper1",
         "table and figures of Harada 2015 (default)",
         run_paper1_suite,
         {"--scenes", "--size", "--level", "--tessellated-limit", "--engine", "--bottom", "--threads",
          "--isa"}},
        {"paper2",
         "builders and traversals over triangle meshes",
         run_paper2_suite,
         {"--scenes", "--mesh", "--size", "--engine", "--threads"}},
        {"paper3",
         "structures, traversals and render methods of GRAPP 2019",
         run_paper3_suite,
         {"--scenes", "--mesh", "--size", "--engine", "--threads"}},
        {"cycles",
         "displaced scenes beside Blender's Cycles, where `blender` is found",
         run_cycles_suite,
         {"--scenes", "--size", "--threads"}},
        {"edits",
         "a painted rectangle of a map until the next picture, beside a fresh load",
         run_edits_suite,
         {"--size", "--threads", "--isa"}},
#ifdef RELIEF_EMBREE
        {"triangles",
         "plain triangle meshes on the CPU against Embree",
         run_triangles_suite,
         {"--mesh", "--isa"}},
        {"peers",
         "displaced surfaces on the CPU against Embree's three ways",
         run_peers_suite,
         {"--scenes", "--scene", "--levels", "--size", "--tessellated-limit", "--threads", "--isa"}},
#endif
    };
    return kSuites;
}

/// Options of this command line that not every suite has.
std::vector<std::string_view> list_given(const BenchOptions& o) {
    const RenderSettings plain;
    const std::pair<std::string_view, bool> options[] = {
        {"--scenes", !o.scenes.empty()},
        {"--mesh", !o.meshes.empty()},
        {"--scene", !o.scene_files.empty()},
        {"--size", o.size.has_value()},
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

void refuse_options_of_others(const Suite& suite, const BenchOptions& o) {
    for (const std::string_view option : list_given(o)) {
        if (std::find(suite.options.begin(), suite.options.end(), option) != suite.options.end()) continue;
        throw Error(ErrorKind::usage, {fmt::format("{} has no such option", suite.name), std::string(option),
                                       fmt::format("beside --runs, --quick, -o and -q it takes {}",
                                                   fmt::join(suite.options, ", "))});
    }
}

const Suite& find_suite(const std::string& name) {
    std::vector<std::string_view> names;
    for (const Suite& suite : list_suites()) {
        if (suite.name == name) return suite;
        names.push_back(suite.name);
    }
    throw Error(ErrorKind::usage, {fmt::format("unknown suite '{}', known: {}", name, fmt::join(names, ", ")),
                                   "", suggest_word(name, names)});
}

std::string describe_suites() {
    std::string text;
    for (const Suite& suite : list_suites())
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", suite.name, suite.help);
    return text;
}

int run_bench(const BenchOptions& options) {
    const Suite& suite = find_suite(options.suite);
    refuse_options_of_others(suite, options);
    const std::filesystem::path folder =
        options.folder.empty() ? std::filesystem::path(options.suite) : options.folder;
    std::filesystem::create_directories(folder);
    check_text_writable(folder / (options.suite + ".json"));
    const bench::Report report = [&](const std::string& line) {
        if (!options.is_quiet) fmt::print(stderr, "relief bench: {}\n", line);
    };
    const SuiteResult outcome = suite.run(options, report);
    for (const bench::ReportFile& file : outcome.files) {
        write_text_file(folder / file.name, file.text);
        fmt::print("wrote {}\n", (folder / file.name).string());
    }
    print_goals(outcome.result["goals"]);
    return kExitDone;
}

void add_run_options(CLI::App& verb, BenchOptions& o) {
    const auto add = [&](const char* name, const char* value, const char* help, auto parse) {
        verb.add_option_function<std::string>(name, parse, help)->type_name(value);
    };
    add("--runs", "N", "that count, after one to warm up; default 5, of cycles 3",
        [&o](const std::string& text) { o.runs = int(parse_integer("--runs", text, 1, kMaxRuns)); });
    add("--scenes", "LIST",
        "paper1: of party,bark,barks,pumpkin; paper2: of body,hall,knot; paper3: these and pumpkin,bark; "
        "peers: of party,rock,rock_mild,rocks,rocks_mild,rock_close,rock_close_mild,pumpkin,bark; "
        "cycles: of rock,rocks,rock_close,pumpkin,ear; default: all, of cycles rock,rocks,pumpkin",
        [&o](const std::string& text) {
            o.scenes = split(text, ',');
            if (o.scenes.empty()) refuse_value("--scenes", text, "a list of scenes");
        });
    verb.add_option("--mesh", o.meshes, "paper2, paper3, triangles: measure this mesh, too; may be repeated")
        ->type_name("FILE");
    verb.add_option("--scene", o.scene_files, "peers: measure this scene; may be repeated")
        ->type_name("FILE");
    add("--tessellated-limit", "MB",
        "leave out pre-tessellated scenes above; default 4096 for paper1, 2048 for peers",
        [&o](const std::string& text) {
            o.tessellated_limit_bytes =
                uint64_t(parse_integer("--tessellated-limit", text, 0, kMaxLimitMegabytes)) << 20;
        });
    verb.add_flag("--quick", o.is_quick, "tiny pictures and meshes, one run: only shows that it works");
    verb.add_flag("-q", o.is_quiet, "no progress on stderr");
}

void add_setting_options(CLI::App& verb, BenchOptions& o) {
    const auto add = [&](const char* name, const char* value, const char* help, auto parse) {
        verb.add_option_function<std::string>(name, parse, help)->type_name(value);
    };
    add("--size", "WxH",
        "pixels; default 1280x720 for paper1, peers, cycles and edits, 320x180 for paper2, 640x360 for "
        "paper3",
        [&o](const std::string& text) {
            const std::vector<int64_t> size = parse_integers("--size", text, 'x', 2, {1, kMaxPictureSize});
            o.size = {int(size[0]), int(size[1])};
        });
    add("--level", "auto|N", "paper1: from the size on screen (default), or 2^N cells a side",
        [&o](const std::string& text) { o.level = parse_level(text); });
    add("--levels", "LIST", "peers: levels to measure, of auto and 0 to 12; default 3,4,5,6,auto",
        [&o](const std::string& text) {
            for (const std::string& level : split(text, ',')) o.levels.push_back(parse_level(level));
            if (o.levels.empty()) refuse_value("--levels", text, "a list of levels");
        });
}

} // namespace

Command add_bench(CLI::App& verb) {
    const auto options = std::make_shared<BenchOptions>();
    verb.add_option("suite", options->suite, describe_suites())->type_name("SUITE");
    verb.add_option("-o", options->folder, "folder for JSON, CSV and charts; default: the suite's name")
        ->type_name("DIR");
    add_run_options(verb, *options);
    add_setting_options(verb, *options);
    add_engine_options(verb, options->engine, options->settings);
    return [options] {
        complete_engine_options(options->engine, options->settings);
        return run_bench(*options);
    };
}

} // namespace relief::cli
