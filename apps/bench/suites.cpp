#include "bench/suites.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "bench/characters.h"
#include "bench/cycles.h"
#include "bench/edits.h"
#include "bench/frame.h"
#include "bench/paper1.h"
#include "bench/paper2.h"
#include "bench/paper3.h"
#include "bench/quality.h"
#include "bench/tables.h"
#include "common/mesh_reader.h"
#ifdef RELIEF_EMBREE
#include "bench/peers.h"
#include "bench/peers_goals.h"
#include "bench/triangles.h"
#endif
#include "relief/error.h"
#include "relief/io.h"

namespace relief::bench {

namespace {

/// Settings of a suite with this default picture size.
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

/// Mesh files get an automatic camera and the sun of our own scenes.
std::vector<Scene> load_meshes(const BenchOptions& o) {
    std::vector<Scene> scenes;
    for (const std::string& file : o.meshes) {
        Scene scene = load_mesh_scene(file, {.reader = cli::make_mesh_reader()});
        scene.meshes.resize(1), scene.objects.resize(1);
        scene.meshes[0].name = std::filesystem::path(file).filename().string();
        scene.environment.reset();
        scene.lights = make_structure_scene("body", MeshDetail::reduced).lights;
        scenes.push_back(std::move(scene));
    }
    return scenes;
}

/// Common part of all suites, after parsing.
template <class Options>
SuiteResult run_with_options(const BenchOptions& o, Options options, const Report& report,
                             Value (*run)(const Options&, const Report&), Table (*make_table)(const Value&)) {
    options.runs = o.runs.value_or(options.runs);
    const Value result = run(o.is_quick ? make_quick_options(options) : options, report);
    return {result,
            {{o.suite + ".json", write_json(result, 1)}, {o.suite + ".csv", write_csv(make_table(result))}}};
}

SuiteResult run_paper1_suite(const BenchOptions& o, const Report& report) {
    Paper1Options options;
    options.settings = make_settings(o, 1280, 720);
    options.settings.surface.level = o.level.value_or(options.settings.surface.level);
    options.tessellated_limit_bytes = o.tessellated_limit_bytes.value_or(options.tessellated_limit_bytes);
    options.scenes = check_scenes(o, kPaper1Scenes);
    return run_with_options(o, std::move(options), report, run_paper1, make_paper1_table);
}

SuiteResult run_paper2_suite(const BenchOptions& o, const Report& report) {
    Paper2Options options;
    options.settings = make_settings(o, 320, 180);
    options.scenes = check_scenes(o, structure_scene_names());
    options.meshes = load_meshes(o);
    return run_with_options(o, std::move(options), report, run_paper2, make_paper2_table);
}

SuiteResult run_paper3_suite(const BenchOptions& o, const Report& report) {
    Paper3Options options;
    options.settings = make_settings(o, 640, 360);
    options.scenes = check_scenes(o, paper3_scenes());
    options.meshes = load_meshes(o);
    return run_with_options(o, std::move(options), report, run_paper3, make_paper3_table);
}

/// Own scenes, rendered by Cycles and by the command `relief` beside this program.
template <class Options>
SuiteResult run_beside_cycles(const BenchOptions& o, const Report& report, std::pair<int, int> size,
                              Value (*run)(const Options&, const Report&),
                              Table (*make_table)(const Value&)) {
    Options options;
    options.settings = make_settings(o, size.first, size.second);
    options.folder = o.folder.empty() ? std::filesystem::path(o.suite) : o.folder;
    options.relief = std::filesystem::read_symlink("/proc/self/exe").replace_filename("relief");
    check_scenes(o, cycles_scene_names());
    if (!o.scenes.empty()) options.scenes = o.scenes;
    return run_with_options(o, std::move(options), report, run, make_table);
}

SuiteResult run_cycles_suite(const BenchOptions& o, const Report& report) {
    return run_beside_cycles(o, report, {1280, 720}, run_cycles, make_cycles_table);
}

SuiteResult run_quality_suite(const BenchOptions& o, const Report& report) {
    return run_beside_cycles(o, report, {640, 360}, run_quality, make_quality_table);
}

/// The n-th map belongs to the n-th mesh.
std::vector<CharacterFile> list_character_files(const BenchOptions& o) {
    if (!o.maps.empty() && o.maps.size() != o.meshes.size())
        throw Error(ErrorKind::usage, {fmt::format("{} maps for {} meshes", o.maps.size(), o.meshes.size()),
                                       "--vdm", "give one --vdm for each --mesh, in the same order"});
    if (o.maps.empty() && !o.map_space.empty())
        throw Error(ErrorKind::usage, {"--space needs a displacement map", "--space", "add --vdm MAP"});
    std::vector<CharacterFile> files;
    for (size_t k = 0; k < o.meshes.size(); ++k) {
        CharacterFile file{o.meshes[k], {.reader = cli::make_mesh_reader()}};
        if (!o.maps.empty()) file.options.displacement_map = o.maps[k];
        if (!o.map_space.empty()) file.options.map.space = o.map_space;
        files.push_back(std::move(file));
    }
    return files;
}

/// Mesh files replace the suite's own scenes, unless those are requested as well.
SuiteResult run_characters_suite(const BenchOptions& o, const Report& report) {
    CharactersOptions options;
    options.threads = o.settings.device.threads;
    options.folder = o.folder.empty() ? std::filesystem::path(o.suite) : o.folder;
    options.relief = std::filesystem::read_symlink("/proc/self/exe").replace_filename("relief");
    options.files = list_character_files(o);
    options.blenders = {o.blenders.begin(), o.blenders.end()};
    if (o.size) options.sizes = {*o.size};
    options.scenes = check_scenes(o, character_scene_names());
    if (!o.meshes.empty()) options.scenes = o.scenes;
    return run_with_options(o, std::move(options), report, run_characters, make_characters_table);
}

/// CPU engine, own scene.
SuiteResult run_edits_suite(const BenchOptions& o, const Report& report) {
    EditsOptions options;
    options.settings = make_settings(o, 1280, 720);
    options.folder = o.folder.empty() ? std::filesystem::path(o.suite) : o.folder;
    return run_with_options(o, std::move(options), report, run_edits, make_edits_table);
}

/// Sample scenes, rendered by the command `relief` beside this program and by that of another build.
SuiteResult run_frame_suite(const BenchOptions& o, const Report& report) {
    FrameOptions options;
    options.settings = make_settings(o, 1280, 720);
    options.settings.image.spp = o.spp.value_or(16);
    options.folder = o.folder.empty() ? std::filesystem::path(o.suite) : o.folder;
    options.relief = std::filesystem::read_symlink("/proc/self/exe").replace_filename("relief");
    options.baseline = o.baseline;
    check_scenes(o, frame_scene_names());
    if (!o.scenes.empty()) options.scenes = o.scenes;
    if (options.settings.device.engine == EngineKind::vulkan) options.isas.clear();
    if (!o.engine.cpu_only.empty()) options.isas = {std::string(cli::isa_name(o.settings.device.isa))};
    SuiteResult outcome = run_with_options(o, std::move(options), report, run_frame, make_frame_table);
    outcome.files.push_back({"frame.md", make_frame_page(outcome.result)});
    return outcome;
}

#ifdef RELIEF_EMBREE
/// CPU engine, one thread; its own meshes are always measured.
SuiteResult run_triangles_suite(const BenchOptions& o, const Report& report) {
    TrianglesOptions options;
    options.isa = o.settings.device.isa;
    options.meshes = load_meshes(o);
    return run_with_options(o, std::move(options), report, run_triangles, make_triangles_table);
}

/// Scene files replace the suite's own scenes, unless those are requested as well.
SuiteResult run_peers_suite(const BenchOptions& o, const Report& report) {
    PeersOptions options;
    const RenderSettings settings = make_settings(o, options.width, options.height);
    options.width = settings.image.width, options.height = settings.image.height;
    options.isa = settings.device.isa, options.threads = settings.device.threads;
    options.scenes = check_scenes(o, peers_scene_names());
    for (const std::string& file : o.scene_files) {
        options.files.push_back(load_scene(file, cli::make_mesh_reader()));
        options.files.back().source = file;
    }
    if (!o.scene_files.empty()) options.scenes = o.scenes;
    if (!o.levels.empty()) options.levels = o.levels;
    options.tessellated_limit_bytes = o.tessellated_limit_bytes.value_or(options.tessellated_limit_bytes);
    SuiteResult outcome = run_with_options(o, std::move(options), report, run_peers, make_peers_table);
    outcome.files.push_back({"peers_goals.md", make_goal_table(outcome.result["goals"])});
    return outcome;
}
#endif

using Run = SuiteResult (*)(const BenchOptions&, const Report&);

constexpr std::pair<std::string_view, Run> kRuns[] = {
    {"paper1", run_paper1_suite},       {"paper2", run_paper2_suite},   {"paper3", run_paper3_suite},
    {"cycles", run_cycles_suite},       {"quality", run_quality_suite}, {"characters", run_characters_suite},
    {"edits", run_edits_suite},         {"frame", run_frame_suite},
#ifdef RELIEF_EMBREE
    {"triangles", run_triangles_suite}, {"peers", run_peers_suite},
#endif
};

} // namespace

SuiteResult run_suite(const BenchOptions& options, const Report& report) {
    const SuiteText& suite = find_suite(options.suite);
    for (const auto& [name, run] : kRuns)
        if (name == suite.name) return run(options, report);
    throw Error(ErrorKind::failed, {fmt::format("suite '{}' has no program", suite.name), "", ""});
}

void refuse_options_of_others(const SuiteText& suite, const BenchOptions& o) {
    for (const std::string_view option : list_given(o)) {
        if (std::find(suite.options.begin(), suite.options.end(), option) != suite.options.end()) continue;
        throw Error(ErrorKind::usage, {fmt::format("{} has no such option", suite.name), std::string(option),
                                       fmt::format("beside --runs, --quick, -o and -q it takes {}",
                                                   fmt::join(suite.options, ", "))});
    }
}

} // namespace relief::bench
