#include "viewer/viewer_options.h"

#include <functional>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/map_options.h"
#include "common/mesh_options.h"
#include "common/values.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::viewer {

namespace {

const char* const kMeshGroup = "With a mesh in place of a scene";

} // namespace

void add_viewer_options(CLI::App& app, ViewerOptions& o) {
    const auto add = [&](const char* name, const char* value, const char* help,
                         const std::function<void(const std::string&)>& set) {
        return app.add_option_function<std::string>(name, set, help)->type_name(value);
    };
    add("input", "SCENE|MESH", "scene file or mesh; none: drop one onto the window",
        [&o](const std::string& text) { o.input.file = text; });
    add("--size", "WxH", "pixels of the picture; default: what the window has room for",
        [&o](const std::string& text) {
            const auto [width, height] = cli::parse_size("--size", text, kMaxPictureSize);
            o.given.width = width, o.given.height = height;
        });
    add("--spp", "N", "samples a pixel; default: those of the scene, else 64", [&o](const std::string& text) {
        o.given.spp = int(cli::parse_integer("--spp", text, 1, kMaxSamples));
    });
    add("--bounces", "N", "path length; 0: direct light only; default: that of the scene, else 4",
        [&o](const std::string& text) {
            o.given.bounces = int(cli::parse_integer("--bounces", text, 0, kMaxBounces));
        });
    add("--script", "FILE", "do what its lines say and print times; docs/viewer.md lists them",
        [&o](const std::string& text) { o.script = text; });
    app.add_flag("-q", o.is_quiet, "with --script: print no times");
    add("--serve", "PORT", "no window: a page for browsers on this machine at 127.0.0.1; 0: any port",
        [&o](const std::string& text) { o.port = int(cli::parse_integer("--serve", text, 0, 65535)); });
    cli::add_engine_options(app, o.engine, o.settings);
    cli::add_mesh_options(app, kMeshGroup, o.input.mesh, o.mesh_only);
    cli::add_map_options(app, o.input.mesh.map, {kMeshGroup, "--preset", "", &o.mesh_only});
    add("--env", "FILE", "environment; default: a studio with a key light", [&o](const std::string& text) {
        o.mesh_only.push_back("--env");
        o.input.mesh.environment = text;
    })->group(kMeshGroup);
}

void complete_viewer_options(ViewerOptions& o) {
    cli::complete_engine_options(o.engine, o.settings);
    if (o.input.file.empty() || !is_mesh_file(o.input.file)) {
        if (!o.mesh_only.empty())
            throw Error(
                ErrorKind::usage,
                {fmt::format("{} goes with a mesh", o.mesh_only.front()), o.input.file.string(),
                 o.input.file.empty() ? "relief view MESH --vdm MAP" : "a scene file says it itself"});
    }
    cli::check_mesh_options(o.input.mesh);
    cli::check_map_options(o.input.mesh);
    cli::check_map_words(o.input.mesh.map);
    const std::filesystem::path& map = o.input.mesh.displacement_map;
    const bool has_tiles = map.string().find('<') != std::string::npos; // a token
    for (const std::filesystem::path& file : {o.input.file, o.script, o.input.mesh.environment, map})
        if (!file.empty() && !(has_tiles && file == map) && !std::filesystem::exists(file))
            throw Error(ErrorKind::bad_input, {"there is no such file", file.string(), ""});
    if (o.port && (o.input.file.empty() || !o.script.empty()))
        throw Error(ErrorKind::usage,
                    {o.script.empty() ? "a scene or a mesh is needed" : "--script goes with a window",
                     "--serve", "relief view SCENE --serve 0"});
    ImageSettings& image = o.settings.image;
    image.width = o.given.width.value_or(image.width), image.height = o.given.height.value_or(image.height);
    image.spp = o.given.spp.value_or(image.spp), image.bounces = o.given.bounces.value_or(image.bounces);
}

} // namespace relief::viewer
