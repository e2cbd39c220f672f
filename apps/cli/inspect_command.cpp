// inspect: properties, cost and problems of a scene, mesh or map.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.h"
#include "common/console.h"
#include "common/exit_codes.h"
#include "common/inputs.h"
#include "common/map_options.h"
#include "common/mesh_options.h"
#include "common/mesh_reader.h"
#include "common/option_names.h"
#include "common/progress.h"
#include "common/report.h"
#include "common/values.h"
#include "reading_notice.h"
#include "relief/error.h"
#include "relief/inspect.h"
#include "relief/io.h"
#include "relief/render.h"
#include "render_warnings.h"

namespace relief::cli {

namespace {

struct InspectOptions {
    std::string file, mesh, picture;
    MeshSceneOptions scene;             ///< its `map` also applies to a map alone
    std::vector<std::string> mesh_only; ///< given options that only meshes support
    std::vector<std::string> map_only;  ///< given options that only maps, or meshes with a map, support
    bool is_json = false, is_strict = false;
    ProgressOptions progress;
};

constexpr double kRead = 0.3; ///< of the work; a check picture comes last

double get_picture_start(const InspectOptions& options) { return options.picture.empty() ? 1 : 0.6; }

std::string get_severity_name(Severity severity) {
    switch (severity) {
    case Severity::note:
        return "note";
    case Severity::warning:
        return "warning";
    case Severity::error:
        break;
    }
    return "error";
}

/// Appends facts and findings of a mesh to those of its map.
void append(Inspection mesh, Inspection& map) {
    for (Fact& fact : mesh.facts) {
        fact.name = "mesh." + fact.name;
        map.facts.push_back(std::move(fact));
    }
    for (Finding& finding : mesh.findings) {
        finding.text = "mesh: " + finding.text;
        map.findings.push_back(std::move(finding));
    }
}

/// Facts and findings of a mesh, after what its reader noticed, as in those of scenes.
Inspection inspect_read_mesh(const Mesh& mesh, const std::vector<std::string>& warnings,
                             const Displacement* displacement = nullptr) {
    Inspection inspection = inspect_mesh(mesh, displacement);
    std::vector<Finding> findings;
    for (const std::string& warning : warnings) findings.push_back({Severity::warning, "W-READ", warning});
    inspection.findings.insert(inspection.findings.begin(), findings.begin(), findings.end());
    return inspection;
}

std::string describe_layer(const PicturePart::Layer& layer) {
    std::string text = layer.name.empty() ? "channels" : fmt::format("layer '{}'", layer.name);
    for (size_t k = 0; k < layer.channels.size(); ++k) {
        text += fmt::format(" {}", layer.channels[k]);
        if (k + 1 == layer.channels.size() || layer.types[k + 1] != layer.types[k])
            text += fmt::format(" ({})", layer.types[k]);
    }
    return text;
}

/// Adds one fact per part of an EXR file: its windows and layers.
void add_parts(const std::string& file, Inspection& inspection) {
    const std::vector<PicturePart> parts = list_picture_parts(file);
    for (size_t k = 0; k < parts.size(); ++k) {
        const PicturePart& part = parts[k];
        std::string text = part.name.empty() ? std::string() : fmt::format("'{}': ", part.name);
        text += fmt::format("{} x {} pixels", part.width, part.height);
        if (part.x != part.full_x || part.y != part.full_y || part.width != part.full_width ||
            part.height != part.full_height)
            text += fmt::format(" at ({}, {}) of {} x {}", part.x - part.full_x, part.y - part.full_y,
                                part.full_width, part.full_height);
        if (part.is_deep) text += ", deep";
        for (const PicturePart::Layer& layer : part.layers) text += "; " + describe_layer(layer);
        inspection.facts.push_back({fmt::format("part.{}", k),
                                    text,
                                    {{"width", double(part.width), "texels"},
                                     {"height", double(part.height), "texels"},
                                     {"layers", double(part.layers.size()), "count"}}});
    }
}

/// A quarter of the check picture.
RenderSettings make_check_settings() {
    RenderSettings settings;
    settings.image.width = 640, settings.image.height = 480;
    settings.image.spp = 8, settings.image.bounces = 1;
    return settings;
}

void write_check_picture(const Scene& scene, const RenderSettings& settings, const InspectOptions& options,
                         WorkProgress& progress) {
    const std::string& file = options.picture;
    if (file.empty()) return;
    keep_files(list_files(scene), file);
    write_image(make_check_picture(scene, settings, progress.part(get_picture_start(options), 1)), file);
    // On stderr: stdout is machine readable.
    print_error("wrote {}\n", file);
}

Inspection inspect_map_file(const InspectOptions& options, WorkProgress& progress) {
    std::vector<std::string> warnings, mesh_warnings;
    const Displacement map = read_with_notice(
        options.progress, options.file, [&] { return load_map(options.file, options.scene.map, warnings); });
    progress.tell(kRead);
    const MapMeaning meaning = options.map_only.empty() ? MapMeaning::unknown : MapMeaning::declared;
    std::optional<Mesh> mesh;
    if (!options.mesh.empty()) {
        mesh = load_mesh(options.mesh, {.reader = make_mesh_reader()}, mesh_warnings);
        mesh->weld = options.scene.weld;
    }
    const Mesh* mesh_or_null = mesh ? &*mesh : nullptr;
    const Displacement meant = meaning == MapMeaning::declared ? map : guess_map_meaning(map, mesh_or_null);
    Inspection inspection =
        inspect_map(map, meaning, mesh_or_null, progress.part(kRead, get_picture_start(options)));
    add_parts(split_picture_name(map.tiles.front().texture->file).file, inspection);
    if (mesh) {
        append(inspect_read_mesh(*mesh, mesh_warnings, &meant), inspection);
        const bool can_render = std::ranges::none_of(
            inspection.findings, [](const Finding& finding) { return finding.severity == Severity::error; });
        if (can_render)
            for (const std::string& warning : find_seam_warnings(make_mesh_scene(*mesh, &map)))
                inspection.findings.push_back({Severity::warning, "W-SCENE", name_setting(warning, true)});
    }
    const std::string file = split_picture_name(options.file).file;
    if (const std::string pattern = find_tile_pattern(file); !pattern.empty())
        inspection.findings.push_back(
            {Severity::warning, "W-TILE",
             fmt::format("one tile of several, and the only one read; name them all as {}", pattern)});
    if (options.picture.empty()) return inspection;
    const auto stands_in_the_way = [](const Finding& finding) {
        return finding.severity == Severity::error && finding.code != "E-NONEG";
    };
    const auto found =
        std::find_if(inspection.findings.begin(), inspection.findings.end(), stands_in_the_way);
    if (found != inspection.findings.end())
        throw Error(ErrorKind::bad_input, {found->text, options.file, "no check picture can be made"});
    // The picture shows the map as a render reads it, whatever its values look like.
    const Scene scene = mesh ? make_mesh_scene(std::move(*mesh), &map) : make_map_scene(map);
    write_check_picture(scene, make_check_settings(), options, progress);
    return inspection;
}

Inspection inspect_plain_mesh(const InspectOptions& options, WorkProgress& progress) {
    std::vector<std::string> warnings;
    Mesh mesh = read_with_notice(options.progress, options.file, [&] {
        return load_mesh(options.file, {.reader = make_mesh_reader()}, warnings);
    });
    turn_upright(mesh, options.scene.up);
    progress.tell(kRead);
    Inspection inspection = inspect_read_mesh(mesh, warnings);
    progress.tell(get_picture_start(options));
    if (!options.picture.empty())
        write_check_picture(make_mesh_scene(std::move(mesh), nullptr), make_check_settings(), options,
                            progress);
    return inspection;
}

Inspection inspect_as_scene(const Scene& scene, const InspectOptions& options, WorkProgress& progress) {
    RenderSettings settings;
    settings.image.width = scene.picture.width.value_or(settings.image.width);
    settings.image.height = scene.picture.height.value_or(settings.image.height);
    settings.image.spp = scene.picture.spp.value_or(settings.image.spp);
    settings.image.bounces = scene.picture.bounces.value_or(settings.image.bounces);
    Inspection inspection = inspect_scene(scene, settings, progress.part(kRead, get_picture_start(options)));
    if (!options.picture.empty()) {
        RenderSettings check = make_check_settings();
        check.image.width =
            std::max(1, int(int64_t(check.image.height) * settings.image.width / settings.image.height));
        write_check_picture(scene, check, options, progress);
    }
    return inspection;
}

/// Facts of the mesh, then those of the scene that a render would make of it, without duplicates.
Inspection inspect_mesh_as_rendered(const InspectOptions& options, WorkProgress& progress) {
    const Scene scene = read_with_notice(options.progress, options.file,
                                         [&] { return load_mesh_scene(options.file, options.scene); });
    const Displacement* map = scene.displacements.empty() ? nullptr : &scene.displacements.front();
    Inspection inspection = inspect_mesh(scene.meshes.front(), map);
    progress.tell(kRead);
    Inspection rendered = inspect_as_scene(scene, options, progress);
    // The mesh's own findings say the same.
    const std::vector<std::string> known = find_tile_warnings(scene);
    std::erase_if(rendered.findings, [&](const Finding& finding) {
        return std::find(known.begin(), known.end(), finding.text) != known.end();
    });
    std::erase_if(rendered.facts, [&](const Fact& fact) {
        return std::any_of(inspection.facts.begin(), inspection.facts.end(),
                           [&](const Fact& own) { return own.name == fact.name; });
    });
    std::erase_if(rendered.findings, [&](const Finding& finding) {
        return std::any_of(inspection.findings.begin(), inspection.findings.end(),
                           [&](const Finding& own) { return own.code == finding.code; });
    });
    std::move(rendered.facts.begin(), rendered.facts.end(), std::back_inserter(inspection.facts));
    std::move(rendered.findings.begin(), rendered.findings.end(), std::back_inserter(inspection.findings));
    return inspection;
}

Inspection inspect_file(const InspectOptions& options) {
    WorkProgress progress(options.progress);
    switch (get_kind(options.file)) {
    case FileKind::map:
        return inspect_map_file(options, progress);
    case FileKind::mesh:
        if (std::ranges::all_of(options.mesh_only, [](const std::string& name) { return name == "--up"; }))
            return inspect_plain_mesh(options, progress);
        return inspect_mesh_as_rendered(options, progress);
    case FileKind::scene:
        break;
    }
    const Scene scene = read_with_notice(options.progress, options.file,
                                         [&] { return load_scene(options.file, make_mesh_reader()); });
    refuse_empty_scene(scene, options.file);
    progress.tell(kRead);
    return inspect_as_scene(scene, options, progress);
}

/// JSON readers get an unreadable input as a finding.
Inspection inspect_or_report(const InspectOptions& options) {
    try {
        return inspect_file(options);
    } catch (const Error& error) {
        if (!options.is_json || error.kind() != ErrorKind::bad_input) throw;
        Inspection inspection;
        inspection.findings.push_back({Severity::error, "E-READ", error.what()});
        for (const Error::Parts& other : error.further())
            inspection.findings.push_back({Severity::error, "E-READ", Error::describe(other)});
        return inspection;
    }
}

void print_inspection(const Inspection& inspection) {
    size_t width = 0;
    for (const Fact& fact : inspection.facts) width = std::max(width, fact.name.size());
    for (const Fact& fact : inspection.facts) print_output("{:<{}}  {}\n", fact.name, width, fact.value);
    for (const Finding& finding : inspection.findings)
        print_output("{}: {}: {}\n", get_severity_name(finding.severity), finding.code,
                     name_options(finding.text));
}

/// Whole numbers without a fraction; nothing where a number is not finite, which JSON cannot say.
Value make_number(double number) {
    constexpr double kMostExact = 9007199254740992; // 2^53
    if (!std::isfinite(number)) return {};
    if (number == std::floor(number) && std::fabs(number) <= kMostExact) return int64_t(number);
    return number;
}

void print_inspection_json(const Inspection& inspection, const std::string& file) {
    Value json = {
        {"file", file}, {"facts", Value::record()}, {"values", Value::record()}, {"findings", Value::list()}};
    for (const Fact& fact : inspection.facts) {
        json["facts"][fact.name] = fact.value;
        for (const FactNumber& number : fact.numbers)
            json["values"][number.part.empty() ? fact.name : fact.name + "." + number.part] = {
                {"value", make_number(number.value)}, {"unit", number.unit}};
    }
    for (const Finding& finding : inspection.findings)
        json["findings"].push_back({{"severity", get_severity_name(finding.severity)},
                                    {"code", finding.code},
                                    {"text", name_options(finding.text)}});
    print_output("{}", write_json(json, 2));
}

/// The one option of meshes that counts for the mesh of a map, too.
bool is_weld(const std::string& option) { return option == "--weld"; }

void check_options(const InspectOptions& options) {
    if (options.file.empty())
        throw Error(ErrorKind::usage, {"no file given", "", "relief inspect SCENE.json, a mesh or a map"});
    refuse_foreign_file(options.file);
    const FileKind kind = get_kind(options.file);
    const bool is_of_mesh =
        options.mesh.empty() ? kind == FileKind::mesh : std::ranges::all_of(options.mesh_only, is_weld);
    if (!is_of_mesh && !options.mesh_only.empty())
        throw Error(ErrorKind::usage,
                    {fmt::format("{} goes with a mesh", options.mesh_only.front()), options.file,
                     "relief inspect MESH --vdm MAP, or a scene file that says it all"});
    const bool has_map = kind == FileKind::map || !options.scene.displacement_map.empty();
    if (kind != FileKind::map && !options.mesh.empty())
        throw Error(ErrorKind::usage,
                    {"--mesh goes with a map", options.file, "relief inspect MAP --mesh MESH"});
    if (!has_map && !options.map_only.empty())
        throw Error(ErrorKind::usage,
                    {fmt::format("{} goes with a map", options.map_only.front()), options.file,
                     "relief inspect MAP, or MESH --vdm MAP, or a scene file that says it all"});
    check_mesh_options(options.scene);
    check_map_words(options.scene.map);
    keep_files({options.file, options.mesh, options.scene.displacement_map.string()}, options.picture);
    if (!options.picture.empty()) check_writable(options.picture);
}

int run_inspect(const InspectOptions& options) {
    check_options(options);
    const Inspection inspection = inspect_or_report(options);
    if (options.is_json)
        print_inspection_json(inspection, options.file);
    else
        print_inspection(inspection);
    const auto has = [&](Severity severity) {
        return std::any_of(inspection.findings.begin(), inspection.findings.end(),
                           [&](const Finding& finding) { return finding.severity == severity; });
    };
    if (has(Severity::error)) return int(ErrorKind::bad_input);
    return options.is_strict && has(Severity::warning) ? kExitWarnings : kExitDone;
}

} // namespace

Command add_inspect(CLI::App& verb) {
    const auto options = std::make_shared<InspectOptions>();
    verb.add_option("file", options->file, "scene file, mesh or map")->type_name("SCENE|MESH|MAP");
    verb.add_option("--mesh", options->mesh, "the mesh that a map is for")->type_name("MESH");
    verb.add_option("-o", options->picture, "check picture: base, displaced, displacement as colours, folds")
        ->type_name("FILE");
    verb.add_flag("--json", options->is_json, "print a JSON object");
    verb.add_flag("--strict", options->is_strict, "exit 6 when there are warnings");
    add_progress_options(verb, options->progress, "no progress on stderr");
    add_mesh_options(verb, "With a mesh, to inspect what a render would make of it", options->scene,
                     options->mesh_only);
    add_map_options(verb, options->scene.map,
                    {"What a map means, where it is known", "--preset", "", &options->map_only});
    return [options] { return run_inspect(*options); };
}

} // namespace relief::cli
