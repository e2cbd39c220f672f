#include "render_options.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/command_line.h"
#include "common/inputs.h"
#include "common/map_options.h"
#include "common/mesh_options.h"
#include "common/values.h"
#include "relief/denoise.h"
#include "relief/error.h"
#include "relief/shot.h"

namespace relief::cli {

namespace {

constexpr int kMaxCacheMegabytes = 1 << 20;
const char* const kMeshGroup = "With a mesh in place of a scene";

template <class T> using Word = std::pair<std::string_view, T>;

constexpr std::string_view kLayers[] = {"depth",
                                        "N",
                                        "N_camera",
                                        "Ng",
                                        "P",
                                        "albedo",
                                        "uv",
                                        "id",
                                        "samples",
                                        "variance",
                                        "cost",
                                        "shadow",
                                        "motion",
                                        "guide_albedo",
                                        "guide_N",
                                        "direct",
                                        "diffuse_direct",
                                        "diffuse_indirect",
                                        "specular_direct",
                                        "specular_indirect",
                                        "transmission_direct",
                                        "transmission_indirect",
                                        "emission",
                                        "background",
                                        "light_GROUP",
                                        "CryptoObject",
                                        "CryptoMaterial"};
constexpr std::string_view kLightGroupPrefix = "light_";

/// Which groups of lights there are, the scene says.
void check_layer(const std::string& layer) {
    if (layer.starts_with(kLightGroupPrefix)) {
        const std::string group = layer.substr(kLightGroupPrefix.size());
        if (is_light_group_name(group)) return;
        throw Error(ErrorKind::usage,
                    {fmt::format("'{}' is no name of a light group", group), "--layers",
                     fmt::format("1 to {} letters, digits, '_' and '-'", kMaxLightGroupName)});
    }
    if (std::find(std::begin(kLayers), std::end(kLayers), layer) != std::end(kLayers)) return;
    const std::string hint = suggest_word(layer, kLayers);
    throw Error(ErrorKind::usage, {fmt::format("unknown layer '{}'", layer), "--layers",
                                   hint.empty() ? fmt::format("known: {}", fmt::join(kLayers, ", ")) : hint});
}

/// Adds an option parsed by `parse`; its value is called `value` in the help.
template <class Parse>
CLI::Option* add(CLI::App& verb, const std::string& name, const char* value, const std::string& help,
                 Parse parse) {
    return verb.add_option_function<std::string>(name, parse, help)->type_name(value);
}

void add_picture_options(CLI::App& verb, RenderOptions& o) {
    add(verb, "-o", "FILE", "picture: .exr (layers), .hdr or .png; default: the input's name as .exr",
        [&o](const std::string& text) { o.output = text; });
    add(verb, "--size", "WxH", "pixels; default 1280x720", [&o](const std::string& text) {
        const auto [width, height] = parse_size("--size", text, kMaxPictureSize);
        o.given.width = width, o.given.height = height;
    });
    add(verb, "--spp", "N", "samples a pixel; default 64",
        [&o](const std::string& text) { o.given.spp = int(parse_integer("--spp", text, 1, kMaxSamples)); });
    add(verb, "--bounces", "N", "path length; 0: direct light only; default 4",
        [&o](const std::string& text) {
            o.given.bounces = int(parse_integer("--bounces", text, 0, kMaxBounces));
        });
    add(verb, "--seed", "N", "of the random numbers; default 0", [&o](const std::string& text) {
        o.given.seed = uint32_t(parse_integer("--seed", text, 0, 0xffffffffll));
    });
    add(verb, "--noise", "F",
        "no more samples where the error is below this share of the brightness, e.g. 0.1",
        [&o](const std::string& text) {
            o.settings.image.noise = float(parse_number("--noise", text, 1e-6, 1));
        });
    add(verb, "--time-limit", "S",
        "ends after so many seconds, preparing and denoising included; every pixel gets a sample",
        [&o](const std::string& text) {
            o.settings.image.time_limit_s = parse_number("--time-limit", text, 1e-3, 1e9);
        });
    add(verb, "--clamp-indirect", "F",
        "limits the light of one path after its first bounce, which removes specks; 0: no limit; default 10",
        [&o](const std::string& text) {
            o.settings.image.clamp_indirect = float(parse_number("--clamp-indirect", text, 0, 1e9));
        });
    verb.add_flag("--denoise", o.is_denoised,
                  "by Open Image Denoise 2, if it is installed; .exr keeps the noisy colour as a layer");
    add(verb, "--layers", "LIST", fmt::format("of {}", fmt::join(kLayers, ",")),
        [&o](const std::string& text) {
            for (const std::string& layer : split(text, ',')) {
                check_layer(layer);
                o.settings.image.layers.push_back(layer);
            }
        });
}

void add_part_options(CLI::App& verb, RenderOptions& o) {
    add(verb, "--crop", "x0,y0,x1,y1", "part of the picture, half open", [&o](const std::string& text) {
        const std::vector<int64_t> c = parse_integers("--crop", text, ',', 4, {0, kMaxPictureSize});
        if (c[0] >= c[2] || c[1] >= c[3]) refuse_value("--crop", text, "a window with x0 < x1 and y0 < y1");
        o.settings.image.crop = {int(c[0]), int(c[1]), int(c[2]), int(c[3])};
    });
    add(verb, "--tile", "i/n", "band i of n bands of rows, i from 0 to n - 1", [&o](const std::string& text) {
        const std::vector<int64_t> tile = parse_integers("--tile", text, '/', 2, {0, kMaxPictureSize});
        if (tile[0] >= tile[1]) refuse_value("--tile", text, "i/n with i from 0 to n - 1");
        o.tile = Tile{int(tile[0]), int(tile[1])};
    });
    add(verb, "--samples", "A:B",
        "samples A to B - 1 of each pixel; within --spp if given, not bound by the scene file's spp",
        [&o](const std::string& text) {
            if (!text.empty() && text.find_first_not_of("0123456789") == std::string::npos)
                throw Error(
                    ErrorKind::usage,
                    {fmt::format("'{}' is no range A:B", text), "--samples",
                     fmt::format("--spp {0} for the number of samples, --samples 0:{0} for the first of them",
                                 text)});
            const std::vector<int64_t> range = parse_integers("--samples", text, ':', 2, {0, kMaxSamples});
            if (range[0] >= range[1]) refuse_value("--samples", text, "A:B with A < B");
            o.samples = {int(range[0]), int(range[1])};
        });
    add(verb, "--frames", "LIST", "of a scene file with keys: 1-100x2,150; OUT.####.exr, one each",
        [&o](const std::string& text) { o.frames = parse_frames(text); });
    verb.add_flag("--skip-existing", o.skips_existing, "keep frames whose whole pictures are there already");
    add(verb, "--edits", "FILE",
        "then a picture after each edit of a map in FILE (-: as they come on standard input); "
        "paths in it start from the current folder",
        [&o](const std::string& text) { o.edits = text; });
    add(verb, "--pixel", "x,y", "trace one pixel and explain it; no picture is written",
        [&o](const std::string& text) {
            const std::vector<int64_t> pixel =
                parse_integers("--pixel", text, ',', 2, {0, kMaxPictureSize - 1});
            o.pixel = {int(pixel[0]), int(pixel[1])};
        });
}

void add_options_of_meshes(CLI::App& verb, RenderOptions& o) {
    add_mesh_options(verb, kMeshGroup, o.mesh, o.mesh_only);
    add(verb, "--env", "MAP", "environment picture", [&o](const std::string& text) {
        o.mesh_only.push_back("--env");
        o.mesh.environment = text;
    })->group(kMeshGroup);
    add_map_options(verb, o.mesh.map, {kMeshGroup, "--preset", "", &o.mesh_only});
}

void add_level_options(CLI::App& verb, RenderOptions& o) {
    add(verb, "--surface", "NAME", "direct (default) or tessellated up front", [&o](const std::string& text) {
        constexpr std::array<Word<SurfaceMode>, 2> words{
            {{"direct", SurfaceMode::direct}, {"tessellated", SurfaceMode::tessellated}}};
        o.settings.surface.mode = parse_word("--surface", text, words);
    });
    add(verb, "--level", "auto|N", "from the size on screen, or 2^N cells a side",
        [&o](const std::string& text) { o.settings.surface.level = parse_level(text); });
    add(verb, "--pixel-error", "F", "cell size aimed at, pixels; default 1", [&o](const std::string& text) {
        o.settings.surface.pixel_error = float(parse_number("--pixel-error", text, 1e-3, 1e3));
    });
    add(verb, "--lod", "NAME", "field (default), or ray: a level for each ray",
        [&o](const std::string& text) {
            constexpr std::array<Word<LodRule>, 2> words{{{"field", LodRule::field}, {"ray", LodRule::ray}}};
            o.settings.surface.lod = parse_word("--lod", text, words);
        });
    add(verb, "--bounce-levels", "NAME",
        "auto (default): coarser away from where a bounce begins, or camera: the camera's everywhere",
        [&o](const std::string& text) {
            constexpr std::array<Word<BounceLevels>, 2> words{
                {{"auto", BounceLevels::automatic}, {"camera", BounceLevels::camera}}};
            o.settings.surface.bounce_levels = parse_word("--bounce-levels", text, words);
        });
    add(verb, "--leaf", "NAME", "exact (default) triangles, or their box", [&o](const std::string& text) {
        constexpr std::array<Word<LeafKind>, 2> words{{{"exact", LeafKind::exact}, {"box", LeafKind::box}}};
        o.settings.surface.leaf = parse_word("--leaf", text, words);
    });
}

void add_machine_options(CLI::App& verb, RenderOptions& o) {
    add_engine_options(verb, o.engine, o.settings);
    add(verb, "--method", "NAME",
        "of the Vulkan engine: compute (default), fragment, or hybrid: first hits are drawn",
        [&o](const std::string& text) {
            constexpr std::array<Word<RenderMethod>, 3> words{{{"compute", RenderMethod::compute},
                                                               {"fragment", RenderMethod::fragment},
                                                               {"hybrid", RenderMethod::hybrid}}};
            o.settings.experiment.method = parse_word("--method", text, words);
            o.engine.vulkan_only.push_back("--method");
        });
    add(verb, "--structure", "NAME", "over meshes and their patches: bvh (default), lbvh, kdtree",
        [&o](const std::string& text) {
            constexpr std::array<Word<StructureKind>, 3> words{{{"bvh", StructureKind::bvh},
                                                                {"lbvh", StructureKind::lbvh},
                                                                {"kdtree", StructureKind::kdtree}}};
            o.settings.experiment.structure = parse_word("--structure", text, words);
        });
    add(verb, "--traversal", "NAME",
        "how rays walk it: auto (default), wide, stack, restart-trail, parent-link, skip-link, trail, "
        "pair-trail; kdtree: push-down, restart, backtrack",
        [&o](const std::string& text) {
            std::array<Word<TraversalKind>, kTraversalCount> words;
            for (size_t k = 0; k < words.size(); ++k)
                words[k] = {traversal_name(TraversalKind(k)), TraversalKind(k)};
            o.settings.experiment.traversal = parse_word("--traversal", text, words);
        });
    add(verb, "--bottom-cache", "MB",
        "cap of the cache of patch trees; 0: off; default: 176, and more while memory is available and "
        "needed",
        [&o](const std::string& text) {
            o.settings.surface.cache_bytes =
                size_t(parse_integer("--bottom-cache", text, 0, kMaxCacheMegabytes)) << 20;
        });
}

void add_report_options(CLI::App& verb, RenderOptions& o) {
    add(verb, "--stats", "FILE", "write statistics as JSON",
        [&o](const std::string& text) { o.statistics_file = text; });
    add_progress_options(verb, o.progress, "no progress, no warnings on stderr")
        ->excludes(verb.add_flag("-v", o.is_verbose, "say what was rendered and what it cost"));
    verb.add_flag("--strict", o.is_strict, "render nothing that there are warnings of: exit 6");
}

void check_input(const std::filesystem::path& input, const std::filesystem::path& vdm) {
    if (input.empty())
        throw Error(ErrorKind::usage,
                    {"no scene file or mesh given", "", "relief render SCENE.json -o OUT.exr"});
    refuse_foreign_file(input);
    if (!vdm.empty() && is_mesh_file(vdm))
        throw Error(ErrorKind::usage, {fmt::format("--vdm takes a map, and '{}' is a mesh", vdm.string()), "",
                                       "the mesh stands first: relief render MESH --vdm MAP"});
    std::error_code code;
    if (!std::filesystem::is_directory(input, code)) return;
    const std::filesystem::path scene = input / "scene.json";
    throw Error(ErrorKind::bad_input,
                {"is a folder, neither a scene file nor a mesh", input.string(),
                 std::filesystem::exists(scene, code) ? fmt::format("relief render {}", scene.string())
                                                      : "give the name of a file in it"});
}

void check_aim(const RenderOptions& o) {
    if (o.aim.turntable > 0 && (!o.edits.empty() || o.pixel || !o.statistics_file.empty()))
        throw Error(ErrorKind::usage, {"a turntable makes several pictures", "--turntable",
                                       "leave out --edits, --pixel and --stats"});
    if (o.aim.saved_scene.empty()) return;
    if (get_lower_extension(o.aim.saved_scene) != ".json")
        throw Error(ErrorKind::usage,
                    {"a scene file ends in .json", o.aim.saved_scene.string(), "--save-scene FILE.json"});
    check_text_writable(o.aim.saved_scene);
}

void check_frames(const RenderOptions& o) {
    if ((!o.frames.empty() || o.skips_existing) && is_mesh_file(o.input))
        throw Error(ErrorKind::usage,
                    {"frames are those of a scene file", "--frames",
                     fmt::format("--turntable {} turns the camera about a mesh",
                                 o.frames.empty() ? "N" : std::to_string(o.frames.back()))});
    if (o.frames.size() > 1 || o.skips_existing) check_series(o);
    if (o.skips_existing && get_lower_extension(o.output) != ".exr")
        throw Error(ErrorKind::usage,
                    {"only .exr files say what they show", "--skip-existing", "-o FILE.####.exr"});
}

/// Parts of a picture differ at their edges and in their noise, so they are denoised when they are one.
void check_denoise(const RenderOptions& o) {
    if (!o.tile && !o.samples) return;
    throw Error(ErrorKind::usage,
                {"a part of a picture is not denoised", "--denoise",
                 "--layers guide_albedo,guide_N,direct for the parts, then relief merge PARTS --denoise"});
}

void add_layers(std::span<const char* const> names, std::vector<std::string>& layers) {
    for (const char* name : names)
        if (std::find(layers.begin(), layers.end(), name) == layers.end()) layers.emplace_back(name);
}

/// --pixel goes with nothing that a picture is needed for.
void check_pixel(const RenderOptions& o) {
    if (o.pixel && (!o.output.empty() || !o.statistics_file.empty() || o.tile || o.samples ||
                    o.settings.image.crop != Window{} || !o.settings.image.layers.empty() ||
                    !o.edits.empty() || o.is_denoised || o.checkpoint.is_on()))
        throw Error(ErrorKind::usage,
                    {"--pixel explains one pixel and makes no picture", "--pixel",
                     "leave out -o, --stats, --crop, --tile, --samples, --layers, --denoise, --edits, "
                     "--checkpoint and --resume"});
}

void check_edits(const RenderOptions& o) {
    refuse_link_loop(o.edits, ErrorKind::bad_input);
    if (!o.edits.empty() && o.edits != "-" && !std::filesystem::is_regular_file(o.edits))
        throw Error(ErrorKind::usage,
                    {std::filesystem::exists(o.edits) ? "not a plain file, which is read twice"
                                                      : "there is no such file",
                     "--edits " + o.edits, "-: standard input, which may be a pipe"});
}

/// No file is both read and written, or written twice, and all can be written. Checked before the scene is
/// read, and again with all of its files.
void check_outputs(const RenderOptions& o) {
    const std::vector<std::string> files = {o.input.string(), o.mesh.displacement_map.string(),
                                            o.mesh.environment.string(), o.edits};
    keep_files(files, o.output), keep_files(files, o.statistics_file);
    if (!o.statistics_file.empty() && find_place(o.output) == find_place(o.statistics_file))
        throw Error(ErrorKind::usage, {"the picture and its statistics cannot be one file",
                                       o.statistics_file.string(), "name another one for --stats"});
    for (const std::filesystem::path& other : {o.output, o.statistics_file})
        if (!o.aim.saved_scene.empty() && !other.empty() &&
            find_place(o.aim.saved_scene) == find_place(other))
            throw Error(ErrorKind::usage, {"the scene would be written over by another output",
                                           o.aim.saved_scene, "name another one for --save-scene"});
    const std::vector<std::string> films = list_films(o.checkpoint, o.output);
    keep_files(films, o.output), keep_files(films, o.statistics_file), keep_files(films, o.aim.saved_scene);
    check_writable(o.output);
    if (!o.statistics_file.empty()) check_text_writable(o.statistics_file);
}

} // namespace

void check_series(const RenderOptions& o) {
    if (o.edits.empty() && !o.pixel && o.statistics_file.empty() && o.aim.turntable == 0 &&
        o.aim.saved_scene.empty() && !o.checkpoint.is_on())
        return;
    throw Error(
        ErrorKind::usage,
        {"several frames are several pictures", "--frames, or render.frames of the scene file",
         "--frames with one frame, or leave out --edits, --pixel, --stats, --turntable, --save-scene, "
         "--checkpoint and --resume"});
}

void add_render_options(CLI::App& verb, RenderOptions& o) {
    verb.add_option_function<std::string>(
            "input", [&o](const std::string& text) { o.input = text; }, "scene file (.json) or mesh")
        ->type_name("SCENE|MESH");
    add_picture_options(verb, o);
    add_aim_options(verb, o.aim);
    add_part_options(verb, o);
    add_level_options(verb, o);
    add_checkpoint_options(verb, o.checkpoint);
    add_machine_options(verb, o);
    add_report_options(verb, o);
    add_options_of_meshes(verb, o);
    for (const char* name :
         {"--seed", "--edits", "--pixel", "--pixel-error", "--bottom-cache", "--surface", "--lod",
          "--bounce-levels", "--leaf", "--bottom", "--isa", "--method", "--structure", "--traversal"})
        verb.get_option(name)->group(kResearchGroup);
    for (const char* name :
         {"--filter", "--dequantize", "--frame-all", "--weld", "--subdivision-level", "--autobump",
          "--no-dilate", "--type", "--frame", "--lengths", "--encoding", "--wrap", "--png-bits",
          "--color-space", "--skip-existing", "--tile", "--samples", "--progress"})
        verb.get_option(name)->group(kMapDetailGroup);
}

void complete_render_options(RenderOptions& o) {
    complete_engine_options(o.engine, o.settings);
    check_input(o.input, o.mesh.displacement_map);
    if (!is_mesh_file(o.input) && !o.mesh_only.empty() && std::filesystem::exists(o.input))
        throw Error(ErrorKind::usage,
                    {fmt::format("{} goes with a mesh, not with a scene file", o.mesh_only.front()),
                     o.input.string(),
                     "the scene file says this under 'meshes', 'displacements' and 'environment'"});
    AimOptions& aim = o.aim.scene;
    if (o.aim.turntable > 0 && is_mesh_file(o.input) && !aim.view && !aim.from) aim.frame_all = true;
    check_mesh_options(o.mesh);
    check_map_options(o.mesh), check_map_words(o.mesh.map);
    check_pixel(o);
    check_aim(o);
    if (o.pixel) return;
    if (o.is_denoised) check_denoise(o);
    if (o.checkpoint.is_on() && (!o.edits.empty() || o.aim.turntable > 0))
        throw Error(ErrorKind::usage, {"the samples of one picture are kept", "--checkpoint, --resume",
                                       "leave out --edits and --turntable"});
    if (o.output.empty()) o.output = o.checkpoint.resumed;
    if (o.output.empty()) o.output = o.input.stem().string() + ".exr";
    if (get_lower_extension(o.output) == ".exr") {
        add_layers(std::array{"samples"}, o.settings.image.layers);
    } else if (!o.settings.image.layers.empty()) {
        throw Error(ErrorKind::usage, {"only .exr files hold layers", o.output.string(), "-o FILE.exr"});
    }
    check_frames(o);
    if (o.is_denoised) add_layers(kDenoiserLayers, o.settings.image.layers);
    check_edits(o);
    check_outputs(o);
}

Window make_tile_window(const Window& window, const Tile& tile) {
    const int64_t rows = window.y1 - window.y0;
    if (tile.count > rows)
        refuse_value("--tile", fmt::format("{}/{}", tile.index, tile.count),
                     fmt::format("possible: there are only {} rows", rows));
    Window band = window;
    band.y0 = window.y0 + int(rows * tile.index / tile.count);
    band.y1 = window.y0 + int(rows * (tile.index + 1) / tile.count);
    return band;
}

RenderSettings make_settings(const RenderOptions& o, const PictureDefaults& picture) {
    RenderSettings s = o.settings;
    s.image.width = o.given.width.value_or(picture.width.value_or(s.image.width));
    s.image.height = o.given.height.value_or(picture.height.value_or(s.image.height));
    s.image.spp = o.given.spp.value_or(picture.spp.value_or(s.image.spp));
    s.image.bounces = o.given.bounces.value_or(picture.bounces.value_or(s.image.bounces));
    s.image.seed = o.given.seed.value_or(picture.seed.value_or(s.image.seed));
    if (o.samples) {
        if (o.given.spp && o.samples->second > *o.given.spp)
            throw Error(ErrorKind::usage,
                        {fmt::format("'{}:{}' is not inside the {} samples of --spp", o.samples->first,
                                     o.samples->second, *o.given.spp),
                         "--samples", "leave out --spp: --samples alone says which samples to take"});
        s.image.whole_samples = o.given.spp.value_or(0);
        s.image.first_sample = o.samples->first;
        s.image.spp = o.samples->second - o.samples->first;
    }
    if (s.image.crop.x1 > s.image.width || s.image.crop.y1 > s.image.height)
        refuse_value(
            "--crop",
            fmt::format("{},{},{},{}", s.image.crop.x0, s.image.crop.y0, s.image.crop.x1, s.image.crop.y1),
            fmt::format("inside the picture of {}x{} pixels", s.image.width, s.image.height));
    if (o.tile) {
        s.image.whole_window =
            s.image.crop == Window{} ? Window{0, 0, s.image.width, s.image.height} : s.image.crop;
        s.image.crop = make_tile_window(s.image.whole_window, *o.tile);
    }
    if (o.pixel && (o.pixel->first >= s.image.width || o.pixel->second >= s.image.height))
        refuse_value("--pixel", fmt::format("{},{}", o.pixel->first, o.pixel->second),
                     fmt::format("inside the picture of {}x{} pixels", s.image.width, s.image.height));
    return s;
}

} // namespace relief::cli
