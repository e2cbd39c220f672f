// convert: maps to other conventions, meshes to other files, displaced surfaces to plain meshes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
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
#include "common/values.h"
#include "reading_notice.h"
#include "relief/convert.h"
#include "relief/error.h"
#include "relief/inspect.h"
#include "relief/io.h"
#include "relief/render.h"
#include "render_warnings.h"

namespace relief::cli {

namespace {

constexpr int kUsualLevel = 5, kUsualSubdivision = 3;

struct ConvertOptions {
    std::string input, output, mesh, displacement_map;
    MapOptions from, to;
    std::vector<std::string> from_given, to_given;
    std::optional<int> level;
    std::optional<MapSamples> samples;
    std::optional<std::string> subdivision;
    std::optional<int> subdivision_level;
    std::optional<float> weld; ///< of the mesh, also of that of a map
    std::optional<UpAxis> up;
    ProgressOptions progress;
};

constexpr double kBeforeConversion = 0.1,
                 kConverted = 0.7; ///< parts of the work, before and after which files are read and written

[[noreturn]] void refuse(const std::string& message, const std::string& where, const std::string& hint) {
    throw Error(ErrorKind::usage, {message, where, hint});
}

/// Prints warnings in the words of options, or of keys for a scene file. `progress` may have a bar on the
/// line; null: there is none.
void print_warnings(const ConvertOptions& options, const std::vector<std::string>& warnings,
                    WorkProgress* progress = nullptr) {
    if (options.progress.is_quiet || warnings.empty()) return;
    if (progress) progress->end_line();
    cli::print_warnings(warnings, get_kind(options.input) != FileKind::scene);
}

/// Prints the doubts that a render would print about the maps of a scene, and no other warnings of it. A
/// scene that no render takes is converted nevertheless, as far as that needs no render. `has_mesh`: seams
/// and tiles count.
void print_doubts(const ConvertOptions& options, const std::function<Scene()>& make_scene, bool has_mesh,
                  WorkProgress* progress = nullptr) {
    if (options.progress.is_quiet) return;
    if (progress) progress->end_line();
    std::vector<std::string> warnings;
    try {
        Scene scene = make_scene();
        scene.warnings.clear();
        add_assumption_warnings(scene, false, get_kind(options.input) != FileKind::scene);
        warnings = std::move(scene.warnings);
        if (has_mesh) {
            std::ranges::move(find_tile_warnings(scene), std::back_inserter(warnings));
            std::ranges::move(find_seam_warnings(scene), std::back_inserter(warnings));
        }
    } catch (const Error&) { // the conversion reports what it cannot do itself
    }
    print_warnings(options, warnings, progress);
}

/// Prints doubts about a map without its mesh, which is tried on a plane.
void print_doubts(const ConvertOptions& options, Displacement map) {
    map.is_udim = false;
    map.tiles.resize(std::min<size_t>(map.tiles.size(), 1));
    if (map.frame == FrameKind::file) map.frame = FrameKind::mikk; // the plane has no tangents
    print_doubts(
        options, [&] { return make_map_scene(map); }, false);
}

std::string format_factors(const Vec3f& v) {
    return v.x == v.y && v.y == v.z ? fmt::format("{:g}", v.x) : fmt::format("{:g},{:g},{:g}", v.x, v.y, v.z);
}

/// How the reading program must interpret the new map.
std::string describe(const Displacement& map) {
    const char* const flip = map.flip_v ? " --flip-v" : "";
    if (map.type == DisplacementType::height)
        return fmt::format("--type height --midlevel {:g} --vdm-scale {:g}{}", map.midlevel.x, map.scale.x,
                           flip);
    const char* space = map.space == DisplacementSpace::tangent  ? "tangent"
                        : map.space == DisplacementSpace::object ? "object"
                                                                 : "world";
    std::string frames;
    if (map.space == DisplacementSpace::tangent && map.frame != FrameKind::mikk)
        frames += map.frame == FrameKind::dpdu ? " --frame dpdu" : " --frame file";
    if (map.space == DisplacementSpace::tangent && map.lengths == FrameLengths::relative)
        frames += " --lengths relative";
    return fmt::format("--space {} --axes {}{} --midlevel {} --vdm-scale {}{}", space,
                       format_map_axes(map.axes, map.space), frames, format_factors(map.midlevel),
                       format_factors(map.scale), flip);
}

/// Rounds up to two significant digits.
float round_up(float value) {
    if (!(value > 0)) return 1;
    const double step = std::pow(10.0, std::floor(std::log10(double(value))) - 1);
    return float(std::ceil(double(value) / step - 1e-6) * step);
}

/// Convention of the new map: as given, else that of the old one; for integer formats a scale that fits.
Displacement make_target(const ConvertOptions& options, const Displacement& from, const Mesh* mesh,
                         MapSamples samples) {
    MapOptions said = options.to;
    if (!said.space && !said.axes && said.preset.empty())
        said.space = from.space == DisplacementSpace::tangent  ? "tangent"
                     : from.space == DisplacementSpace::object ? "object"
                                                               : "world";
    const bool keeps_axes = !said.axes && said.preset.empty();
    Displacement to = make_map_meaning(said);
    if (keeps_axes && to.space == from.space) to.axes = from.axes;
    if (!said.type) to.type = from.type;
    if (!said.frame) to.frame = from.frame;
    if (!said.lengths) to.lengths = from.lengths;
    const auto is_given = [&](const char* name) {
        return std::find(options.to_given.begin(), options.to_given.end(), name) != options.to_given.end();
    };
    if (!is_given("--to-flip-v")) to.flip_v = from.flip_v;
    if (samples != MapSamples::uint16) return to;
    if (!said.midlevel && !said.encoding) to.midlevel = {0.5f, 0.5f, 0.5f};
    if (said.scale || said.encoding) return to;
    const float scale = round_up(2 * find_largest_displacement(convert_map(from, to, mesh)));
    to.scale = {scale, scale, scale};
    return to;
}

MapSamples choose_samples(const ConvertOptions& options, const Displacement& from) {
    if (options.samples) return *options.samples;
    if (get_lower_extension(options.output) == ".png") return MapSamples::uint16;
    const bool is_half = std::all_of(from.tiles.begin(), from.tiles.end(), [](const MapTile& tile) {
        return tile.texture->source_type == SampleType::float16;
    });
    return is_half ? MapSamples::float16 : MapSamples::float32;
}

int convert_map_file(const ConvertOptions& options) {
    if (options.level) refuse("--level goes with a mesh to be written", options.output, "-o MESH.ply");
    std::vector<std::string> warnings;
    if (options.from.filter)
        refuse("--filter goes with --vdm MAP", options.input, "texels are converted one by one");
    MapOptions meaning = options.from;
    if (meaning.dequantize) meaning.filter = "cubic"; // dequantize asks for a smooth one
    const Displacement from = read_with_notice(options.progress, options.input,
                                               [&] { return load_map(options.input, meaning, warnings); });
    print_warnings(options, warnings);
    warnings.clear();
    std::optional<Mesh> mesh;
    if (!options.mesh.empty()) {
        mesh = load_mesh(options.mesh, {.reader = make_mesh_reader()}, warnings);
        mesh->weld = options.weld;
    }
    print_warnings(options, warnings);
    warnings.clear();
    if (mesh)
        print_doubts(
            options, [&] { return make_mesh_scene(*mesh, &from); }, true);
    else
        print_doubts(options, from);
    WorkProgress progress(options.progress);
    progress.tell(kBeforeConversion);
    const MapSamples samples = choose_samples(options, from);
    const Mesh* mesh_or_null = mesh ? &*mesh : nullptr;
    const Displacement converted =
        convert_map(from, make_target(options, from, mesh_or_null, samples), mesh_or_null, &warnings,
                    progress.part(kBeforeConversion, kConverted));
    print_warnings(options, warnings, &progress);
    write_map(converted, options.output, samples, progress.part(kConverted, 1));
    print_output("wrote {}: {}\n", options.output, describe(converted));
    return kExitDone;
}

/// Adds the warnings of a render that concern the written surface, too.
Scene add_edge_warnings(Scene scene) {
    for (std::string& warning : find_edge_warnings(scene)) scene.warnings.push_back(std::move(warning));
    return scene;
}

Scene load_surface(const ConvertOptions& options) {
    if (get_kind(options.input) == FileKind::scene)
        return add_edge_warnings(load_scene(options.input, make_mesh_reader()));
    MeshSceneOptions scene;
    scene.reader = make_mesh_reader();
    scene.displacement_map = options.displacement_map;
    scene.map = options.from;
    scene.subdivision = options.subdivision, scene.weld = options.weld;
    scene.up = options.up.value_or(UpAxis::y);
    // Without a view no level can be chosen by it.
    if (options.subdivision) scene.subdivision_level = options.subdivision_level.value_or(kUsualSubdivision);
    return add_edge_warnings(load_mesh_scene(options.input, scene));
}

int convert_surface(const ConvertOptions& options) {
    if (!options.to_given.empty())
        refuse(options.to_given.front() + " goes with a map to be written", options.output, "");
    const bool is_mesh = get_kind(options.input) == FileKind::mesh;
    if (options.subdivision_level && !options.subdivision)
        refuse("--subdivision-level needs a subdivision scheme", options.input, "--subdivision catmark");
    if (is_mesh && options.displacement_map.empty() && !options.subdivision && !options.weld) {
        if (options.level || !options.from_given.empty())
            refuse((options.level ? std::string("--level") : options.from_given.front()) +
                       " goes with --vdm MAP",
                   options.input, "a plain mesh is written as it is");
        WorkProgress progress(options.progress);
        std::vector<std::string> warnings;
        Mesh mesh = read_with_notice(options.progress, options.input, [&] {
            return load_mesh(options.input, {.reader = make_mesh_reader()}, warnings);
        });
        turn_upright(mesh, options.up.value_or(UpAxis::y));
        progress.tell(kBeforeConversion);
        print_warnings(options, warnings, &progress);
        write_mesh(mesh, options.output, progress.part(kBeforeConversion, 1));
        print_output("wrote {}\n", options.output);
        return kExitDone;
    }
    if (!is_mesh && (!options.displacement_map.empty() || !options.from_given.empty() ||
                     options.subdivision || options.weld || options.up))
        refuse("a scene file says itself what its meshes and maps are", options.input, "");
    WorkProgress progress(options.progress);
    const Scene scene =
        read_with_notice(options.progress, options.input, [&] { return load_surface(options); });
    progress.tell(kBeforeConversion);
    keep_files(list_files(scene), options.output);
    print_warnings(options, scene.warnings, &progress);
    print_doubts(
        options, [&] { return scene; }, true, &progress);
    const Mesh mesh = make_displaced_mesh(scene, options.level.value_or(kUsualLevel),
                                          progress.part(kBeforeConversion, kConverted));
    write_mesh(mesh, options.output, progress.part(kConverted, 1));
    print_output("wrote {}: {} vertices, {} faces\n", options.output, mesh.positions.size(),
                 mesh.face_sizes.size());
    return kExitDone;
}

int run_convert(const ConvertOptions& options) {
    if (options.input.empty() || options.output.empty())
        refuse("one file in and one file out are needed", "", "relief convert IN -o OUT");
    refuse_foreign_file(options.input);
    check_map_words(options.from), check_map_words(options.to);
    keep_files({options.input, options.mesh, options.displacement_map}, options.output);
    check_text_writable(options.output);
    const FileKind input = get_kind(options.input);
    if (input == FileKind::map) {
        if (is_mesh_file(options.output))
            refuse("a map alone is no surface", options.input, "relief convert MESH --vdm MAP -o OUT.ply");
        if (!options.displacement_map.empty())
            refuse("--vdm goes with a mesh", options.input, "name the mesh by --mesh");
        if (options.weld && options.mesh.empty())
            refuse("--weld needs a mesh", options.input, "name the mesh by --mesh");
        if (options.up) refuse("--up goes with a mesh or its surface", options.input, "");
        return convert_map_file(options);
    }
    if (!options.mesh.empty() || options.samples)
        refuse(std::string(options.mesh.empty() ? "--samples" : "--mesh") + " goes with a map", options.input,
               "");
    if (!is_mesh_file(options.output)) refuse("a mesh is written as .obj or .ply", options.output, "");
    return convert_surface(options);
}

void add_surface_options(CLI::App& verb, ConvertOptions& options) {
    const char* const kGroup = "With a mesh or a scene, to write its surface";
    const auto add = [&](const char* name, const char* value, const std::string& help, auto set) {
        verb.add_option_function<std::string>(name, set, help)->type_name(value)->group(kGroup);
    };
    add("--vdm", "MAP", "the map of a mesh; may name a layer: FILE.exr:LAYER",
        [&](const std::string& text) { options.displacement_map = text; });
    verb.add_option_function<std::string>(
            "--filter",
            [&](const std::string& text) {
                options.from.filter = text;
                options.from_given.push_back("--filter");
            },
            "of the map: cubic, bspline, mip, none (default)")
        ->type_name("NAME")
        ->group(kGroup);
    add("--level", "N", fmt::format("2^N quads a side of each displaced patch; default {}", kUsualLevel),
        [&](const std::string& text) { options.level = int(parse_integer("--level", text, 0, kMaxLevel)); });
    add("--subdivision", "NAME", "of a mesh: catmark, bilinear, none (default)",
        [&](const std::string& text) { options.subdivision = text; });
    add("--subdivision-level", "N", "2^N x 2^N patches a quad of the mesh; default 3",
        [&](const std::string& text) {
            options.subdivision_level =
                int(parse_integer("--subdivision-level", text, 0, kMaxSubdivisionLevel));
        });
    add("--weld", "EPS", "distance at which open edges are joined (default: rounding errors; 0: never)",
        [&](const std::string& text) { options.weld = parse_weld(text); });
    add("--up", "AXIS", "axis of the mesh that points up, and becomes y: x, y (default), z",
        [&](const std::string& text) { options.up = parse_up_axis(text); });
}

void set_samples(ConvertOptions& options, const std::string& text) {
    constexpr std::array<std::pair<std::string_view, MapSamples>, 3> words{
        {{"half", MapSamples::float16}, {"float", MapSamples::float32}, {"uint16", MapSamples::uint16}}};
    options.samples = parse_word("--samples", text, words);
}

} // namespace

Command add_convert(CLI::App& verb) {
    const auto options = std::make_shared<ConvertOptions>();
    verb.add_option("input", options->input, "map, mesh or scene file")->type_name("MAP|MESH|SCENE");
    verb.add_option("-o", options->output, "map (.exr, .png of 16 bits) or mesh (.obj, .ply)")
        ->type_name("FILE");
    verb.add_option("--mesh", options->mesh, "the mesh of a map, to go between tangent and object space")
        ->type_name("MESH");
    verb.add_option_function<std::string>(
            "--samples", [options](const std::string& text) { set_samples(*options, text); },
            "of the map written: half, float, uint16; default by file")
        ->type_name("NAME");
    verb.add_flag_callback(
        "--dequantize",
        [options] {
            options->from.dequantize = true;
            options->from_given.push_back("--dequantize");
        },
        "smooth the steps of a map of 8 or 16-bit integers");
    add_progress_options(verb, options->progress, "no progress, no warnings on stderr");
    add_surface_options(verb, *options);
    add_map_options(verb, options->from, {"What the map means", "--from,--preset", "", &options->from_given});
    add_map_options(verb, options->to, {"What the new map shall mean", "--to", "to-", &options->to_given});
    return [options] { return run_convert(*options); };
}

} // namespace relief::cli
