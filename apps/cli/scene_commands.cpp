// scene and devices.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/suggest.h"
#include "commands.h"
#include "common/console.h"
#include "common/exit_codes.h"
#include "common/inputs.h"
#include "common/progress.h"
#include "common/report.h"
#include "lab/scenes/peer_scenes.h"
#include "relief/devices.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/render.h"
#include "relief/samples.h"

namespace relief::cli {

namespace {

struct SceneOptions {
    std::string name, folder;
    bool is_instanced = false;
    ProgressOptions progress;
};

std::string list_scenes() {
    return fmt::format("{}; for comparisons {}", fmt::join(sample_scene_names(), ", "),
                       fmt::join(peer_scene_names(), ", "));
}

bool is_sample(const std::string& name) {
    const std::vector<std::string> samples = sample_scene_names();
    return std::find(samples.begin(), samples.end(), name) != samples.end();
}

/// A sample scene, or a scene of the renderer comparisons.
Scene make_named_scene(const SceneOptions& options, const ProgressFunction& on_progress) {
    if (is_sample(options.name))
        return make_sample_scene(options.name, options.is_instanced ? Instancing::shared : Instancing::none,
                                 on_progress);
    return make_peer_scene(options.name, 1, PeerWorld::sky);
}

SceneMotion make_named_motion(const SceneOptions& options, const ProgressFunction& on_progress) {
    return is_sample(options.name) ? make_sample_motion(options.name, on_progress) : SceneMotion{};
}

void check_name(const SceneOptions& options) {
    if (options.name.empty())
        throw Error(ErrorKind::usage, {"no scene named", "", "known: " + list_scenes()});
    if (is_sample(options.name)) return;
    const std::vector<std::string> peers = peer_scene_names();
    if (std::find(peers.begin(), peers.end(), options.name) == peers.end()) {
        std::vector<std::string> names = sample_scene_names();
        names.insert(names.end(), peers.begin(), peers.end());
        const std::string hint =
            suggest_word(options.name, std::vector<std::string_view>(names.begin(), names.end()));
        throw Error(ErrorKind::usage, {"there is no sample scene of this name", options.name,
                                       hint.starts_with("did") ? hint : "known: " + list_scenes()});
    }
    if (options.is_instanced)
        throw Error(ErrorKind::usage,
                    {"nothing in this scene can be shared", options.name, "leave out --instanced"});
}

/// The folder and those in it, before the scene, which takes longer. Throws Error{usage}.
void make_folders(const std::filesystem::path& folder) {
    std::error_code code;
    for (std::filesystem::path part = folder; !part.empty(); part = part.parent_path()) {
        if (std::filesystem::exists(part, code) && !std::filesystem::is_directory(part, code))
            throw Error(ErrorKind::usage, {"is a file, not a folder", part.string(),
                                           "a scene is a folder of files: name another one, -o DIR"});
        if (part == part.parent_path()) break;
    }
    for (const std::filesystem::path& part : {folder, folder / "meshes", folder / "maps"}) {
        std::filesystem::create_directories(part, code);
        if (code)
            throw Error(ErrorKind::usage, {"the folder cannot be made: " + code.message(), part.string(),
                                           "check the rights of what it is in, or name another one, -o DIR"});
    }
    check_text_writable(folder / "scene.json");
}

/// Contents of a file; empty if it does not exist.
std::string read_text(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// FILE.bak, or FILE.bak2, FILE.bak3... if that exists.
std::string find_free_copy(const std::string& file) {
    std::string copy = file + ".bak";
    for (int k = 2; std::filesystem::exists(copy); ++k) copy = fmt::format("{}.bak{}", file, k);
    return copy;
}

int run_scene(const SceneOptions& options) {
    check_name(options);
    const std::filesystem::path folder = options.folder.empty() ? options.name : options.folder;
    const std::filesystem::path file = folder / "scene.json";
    refuse_link_loop(file, ErrorKind::failed);
    make_folders(folder);
    const std::string before = read_text(file);
    const std::string copy = find_free_copy(file.string());
    if (!before.empty()) write_text_file(copy, before);
    {
        constexpr double kMade = 0.7;
        WorkProgress progress(options.progress);
        const Scene scene = make_named_scene(options, progress.part(0, kMade / 2));
        const SceneMotion motion = make_named_motion(options, progress.part(kMade / 2, kMade));
        save_shot(scene, motion, folder, progress.part(kMade, 1));
    }
    if (before == read_text(file))
        std::filesystem::remove(copy);
    else if (!before.empty())
        print_error("relief: the scene that was there is kept as {}\n", copy);
    print_output("wrote {}\n", file.string());
    return kExitDone;
}

constexpr StructureKind kStructures[] = {StructureKind::bvh, StructureKind::lbvh, StructureKind::kdtree};

std::vector<std::string> list_traversals(EngineKind engine, StructureKind structure) {
    std::vector<std::string> names;
    for (const TraversalKind traversal : available_traversals(engine, structure))
        names.emplace_back(traversal_name(traversal));
    return names;
}

Value traversals_to_json(EngineKind engine) {
    Value structures;
    for (const StructureKind structure : kStructures)
        structures[structure_name(structure)] = list_traversals(engine, structure);
    return structures;
}

void print_traversals(EngineKind engine) {
    for (const StructureKind structure : kStructures)
        print_output("        --structure {:<6}  --traversal {}\n", structure_name(structure),
                     fmt::join(list_traversals(engine, structure), " | "));
}

Value to_json(const DeviceInfo& device) {
    return {{"engine", "vulkan"},
            {"device", device.index},
            {"name", device.name},
            {"driver", device.driver},
            {"kind", device.kind},
            {"memory_bytes", device.memory_bytes},
            {"methods", device.methods},
            {"missing", device.missing},
            {"missing_to_draw", device.missing_to_draw},
            {"structures", traversals_to_json(EngineKind::vulkan)}};
}

void print_device(const DeviceInfo& device) {
    print_output("vulkan  device {}  {}  {}  {}  {:.1f} GiB\n", device.index, device.kind, device.name,
                 device.driver, double(device.memory_bytes) / double(1u << 30));
}

void print_methods(const DeviceInfo& device) {
    if (!device.missing.empty())
        print_output("        cannot render: lacks {}\n", fmt::join(device.missing, ", "));
    else
        print_output("        methods {}\n", fmt::join(device.methods, " "));
    if (device.missing.empty() && !device.missing_to_draw.empty())
        print_output("        fragment and hybrid: lacks {}\n", fmt::join(device.missing_to_draw, ", "));
}

struct DevicesOptions {
    bool is_json = false, is_quiet = false;
};

int run_devices(const DevicesOptions& options) {
    const std::vector<std::string> isas = available_isas();
    const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    const std::vector<DeviceInfo> devices = vulkan_devices();
    if (options.is_json) {
        Value list = Value::list();
        list.push_back({{"engine", "cpu"},
                        {"threads", threads},
                        {"isa", isas},
                        {"structures", traversals_to_json(EngineKind::cpu)}});
        for (const DeviceInfo& device : devices) list.push_back(to_json(device));
        print_output("{}\n", write_json(list));
    } else {
        print_output("cpu     {} threads  {}\n", threads, fmt::join(isas, " "));
        if (!options.is_quiet) print_traversals(EngineKind::cpu);
        for (const DeviceInfo& device : devices) {
            print_device(device);
            if (!options.is_quiet) print_methods(device);
        }
        if (!devices.empty() && !options.is_quiet) print_traversals(EngineKind::vulkan);
    }
    return kExitDone;
}

} // namespace

Command add_scene(CLI::App& verb) {
    const auto options = std::make_shared<SceneOptions>();
    verb.add_option("name", options->name, "one of: " + list_scenes())->type_name("NAME");
    verb.add_option("-o", options->folder, "folder to write; default: the name")->type_name("DIR");
    verb.add_flag("--instanced", options->is_instanced, "copies share their mesh");
    add_progress_options(verb, options->progress, "no progress on stderr");
    return [options] { return run_scene(*options); };
}

Command add_devices(CLI::App& verb) {
    const auto options = std::make_shared<DevicesOptions>();
    verb.add_flag("--json", options->is_json, "print a JSON array");
    verb.add_flag("-q", options->is_quiet, "one line per device, without methods and traversals");
    return [options] { return run_devices(*options); };
}

} // namespace relief::cli
