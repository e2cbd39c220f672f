// bench: the suites of measurements.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "bench/paper1.h"
#include "bench/triangles.h"
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
    bench::Paper1Options paper1;
    std::vector<std::string> mesh_files;
    bool is_quick = false, is_quiet = false;
};

void print_goals(const nlohmann::ordered_json& goals) {
    for (const auto& goal : goals)
        fmt::print("{}  {}: {:.4g} {}, goal {:.4g}\n", goal["met"].get<bool>() ? "met    " : "not met",
                   goal["name"].get<std::string>(), goal["reached"].get<double>(),
                   goal["unit"].get<std::string>(), goal["goal"].get<double>());
}

struct Outcome {
    nlohmann::ordered_json result;
    std::vector<bench::ReportFile> files;
};

Outcome run_paper1_suite(const BenchOptions& options, const bench::Report& report) {
    const auto result =
        bench::run_paper1(options.is_quick ? make_quick_options(options.paper1) : options.paper1, report);
    return {result, bench::make_paper1_files(result)};
}

#ifdef RELIEF_EMBREE
Outcome run_triangles_suite(const BenchOptions& options, const bench::Report& report) {
    bench::TrianglesOptions triangles;
    triangles.runs = options.paper1.runs;
    triangles.isa = options.paper1.settings.isa;
    for (const std::string& file : options.mesh_files)
        triangles.meshes.push_back(bench::make_triangle_mesh(file, load_mesh(file)));
    const auto result =
        bench::run_triangles(options.is_quick ? make_quick_options(triangles) : triangles, report);
    return {result, bench::make_triangles_files(result)};
}
#endif

struct Suite {
    std::string_view name, help;
    Outcome (*run)(const BenchOptions& options, const bench::Report& report);
};

constexpr Suite kSuites[] = {
    {"paper1", "table and figures of Harada 2015 (default)", run_paper1_suite},
#ifdef RELIEF_EMBREE
    {"triangles", "plain triangle meshes against Embree", run_triangles_suite},
#endif
};

const Suite& find_suite(const std::string& name) {
    std::vector<std::string_view> names;
    for (const Suite& suite : kSuites) {
        if (suite.name == name) return suite;
        names.push_back(suite.name);
    }
    throw Error(ErrorKind::usage, {fmt::format("unknown suite '{}'", name), "", suggest_word(name, names)});
}

std::string describe_suites() {
    std::string text;
    for (const Suite& suite : kSuites)
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", suite.name, suite.help);
    return text;
}

int run_bench(const BenchOptions& options) {
    const Suite& suite = find_suite(options.suite);
    if (!options.mesh_files.empty() && suite.name != "triangles")
        throw Error(ErrorKind::usage, {fmt::format("the suite '{}' takes no meshes", suite.name), "--mesh",
                                       "bench triangles does"});
    const std::filesystem::path folder =
        options.folder.empty() ? std::filesystem::path(options.suite) : options.folder;
    std::filesystem::create_directories(folder);
    check_text_writable(folder / (options.suite + ".json"));
    const bench::Report report = [&](const std::string& line) {
        if (!options.is_quiet) fmt::print(stderr, "relief bench: {}\n", line);
    };
    const Outcome outcome = suite.run(options, report);
    for (const bench::ReportFile& file : outcome.files) {
        write_text_file(folder / file.name, file.text);
        fmt::print("wrote {}\n", (folder / file.name).string());
    }
    print_goals(outcome.result["goals"]);
    return kExitDone;
}

std::vector<std::string> parse_scenes(const std::string& text) {
    const std::vector<std::string_view> known(bench::kPaper1Scenes.begin(), bench::kPaper1Scenes.end());
    const std::vector<std::string> scenes = split(text, ',');
    for (const std::string& scene : scenes)
        if (std::find(known.begin(), known.end(), scene) == known.end())
            throw Error(ErrorKind::usage,
                        {fmt::format("'{}' is not one of: {}", scene, fmt::join(known, ", ")), "--scenes",
                         suggest_word(scene, known)});
    if (scenes.empty()) refuse_value("--scenes", text, "a list of scenes");
    return scenes;
}

void add_run_options(CLI::App& verb, BenchOptions& o) {
    const auto add = [&](const char* name, const char* value, const char* help, auto parse) {
        verb.add_option_function<std::string>(name, parse, help)->type_name(value);
    };
    add("--runs", "N", "that count, after one to warm up; default 5",
        [&o](const std::string& text) { o.paper1.runs = int(parse_integer("--runs", text, 1, kMaxRuns)); });
    add("--scenes", "LIST", "of party,bark,barks,pumpkin; default: all",
        [&o](const std::string& text) { o.paper1.scenes = parse_scenes(text); });
    add("--tessellated-limit", "MB", "leave out pre-tessellated scenes above; default 4096",
        [&o](const std::string& text) {
            o.paper1.tessellated_limit_bytes =
                uint64_t(parse_integer("--tessellated-limit", text, 0, kMaxLimitMegabytes)) << 20;
        });
#ifdef RELIEF_EMBREE
    verb.add_option("--mesh", o.mesh_files, "triangles: measured besides; may be given again")
        ->type_name("FILE");
#endif
    verb.add_flag("--quick", o.is_quick, "64x36 pixels, one run: only shows that it works");
    verb.add_flag("-q", o.is_quiet, "no progress on stderr");
}

void add_setting_options(CLI::App& verb, RenderSettings& s) {
    const auto add = [&](const char* name, const char* value, const char* help, auto parse) {
        verb.add_option_function<std::string>(name, parse, help)->type_name(value);
    };
    add("--size", "WxH", "pixels; default 1280x720", [&s](const std::string& text) {
        const std::vector<int64_t> size = parse_integers("--size", text, 'x', 2, {1, kMaxPictureSize});
        s.width = int(size[0]), s.height = int(size[1]);
    });
    add("--level", "auto|N", "from the size on screen (default), or 2^N cells a side",
        [&s](const std::string& text) { s.level = parse_level(text); });
}

} // namespace

Command add_bench(CLI::App& verb) {
    const auto options = std::make_shared<BenchOptions>();
    verb.add_option("suite", options->suite, describe_suites())->type_name("SUITE");
    verb.add_option("-o", options->folder, "folder for JSON, CSV and charts; default: the suite's name")
        ->type_name("DIR");
    add_run_options(verb, *options);
    add_setting_options(verb, options->paper1.settings);
    add_engine_options(verb, options->engine, options->paper1.settings);
    return [options] {
        complete_engine_options(options->engine, options->paper1.settings);
        return run_bench(*options);
    };
}

} // namespace relief::cli
