#include "scenes.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "exit_gate.h"
#include "meshes.h"
#include "parts.h"
#include "relief/convert.h"
#include "relief/inspect.h"
#include "relief/io.h"
#include "relief/shot.h"
#include "scene_values.h"
#include "settings.h"
#include "textures.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

using ScenePointer = std::unique_ptr<ParsedScene>;

/// The shot is let go unless motion blur needs it.
ScenePointer load_shot(std::unique_ptr<Shot> shot, std::optional<double> frame) {
    auto parsed = std::make_unique<ParsedScene>();
    parsed->frame = frame.value_or(shot->frames().empty() ? 1 : shot->frames().front());
    parsed->scene = shot->load(parsed->frame);
    const Camera& camera = parsed->scene.camera;
    if (shot->is_animated() && camera.shutter_open < camera.shutter_close) parsed->shot = std::move(shot);
    return parsed;
}

ScenePointer parse(const std::string& text, const std::string& folder, const nb::dict& meshes,
                   const nb::dict& textures, std::optional<double> frame) {
    SceneAssets assets = read_assets(meshes, textures);
    const GateVisit visit;
    const nb::gil_scoped_release release;
    return load_shot(std::make_unique<Shot>(text, folder, std::move(assets)), frame);
}

ScenePointer load(const std::string& file, std::optional<double> frame) {
    const GateVisit visit;
    const nb::gil_scoped_release release;
    return load_shot(std::make_unique<Shot>(file), frame);
}

nb::dict describe_picture(const ParsedScene& parsed) {
    const PictureDefaults& picture = parsed.scene.picture;
    nb::dict node;
    const auto add = [&](const char* key, const auto& value) {
        if (value) node[key] = *value;
    };
    add("width", picture.width), add("height", picture.height), add("spp", picture.spp);
    add("bounces", picture.bounces), add("seed", picture.seed);
    return node;
}

/// Camera, environment, suns, and what the last object is made of: all that aiming and completing may change.
/// Its mesh where there are more than `known` objects.
nb::dict describe(const ParsedScene& parsed, size_t known) {
    const Scene& scene = parsed.scene;
    nb::dict node;
    node["camera"] = describe_camera(scene.camera);
    if (scene.environment) node["environment"] = describe_environment(*scene.environment);
    node["suns"] = describe_suns(scene.lights);
    node["object_count"] = scene.objects.size();
    if (scene.objects.empty()) return node;
    const Object& last = scene.objects.back();
    nb::dict object;
    object["name"] = last.name;
    if (scene.objects.size() > known) object["mesh"] = make_mesh_arrays(Mesh(scene.meshes[last.mesh]));
    if (last.material != kNoIndex) object["material"] = describe_material(scene.materials[last.material]);
    object["shadow_catcher"] = last.is_shadow_catcher;
    node["last_object"] = object;
    return node;
}

/// `is_completed`: its light may be that of complete().
void aim(ParsedScene& parsed, const nb::dict& keywords, float aspect, bool is_completed) {
    const AimOptions options = read_aim(keywords);
    const GateVisit visit;
    const nb::gil_scoped_release release;
    if (is_completed) recognize_studio(parsed.scene);
    aim_scene(parsed.scene, options, aspect);
}

void complete(ParsedScene& parsed) {
    const GateVisit visit;
    const nb::gil_scoped_release release;
    complete_mesh_scene(parsed.scene);
}

/// None where the environment has no picture.
nb::object make_environment_texels(const ParsedScene& parsed) {
    const std::optional<Environment>& environment = parsed.scene.environment;
    if (!environment || !environment->texture) return nb::none();
    return make_texel_array(*environment->texture);
}

void save(const ParsedScene& parsed, const std::string& folder) {
    const GateVisit visit;
    const nb::gil_scoped_release release;
    save_scene(parsed.scene, folder);
}

nb::dict displace(const ParsedScene& parsed, int level) {
    Mesh mesh;
    {
        const GateVisit visit;
        const nb::gil_scoped_release release;
        mesh = make_displaced_mesh(parsed.scene, level);
    }
    return make_mesh_arrays(std::move(mesh));
}

/// Arrays, and warnings.
nb::tuple load_mesh_arrays(const std::string& file, int uv_set, std::vector<int> further_uv_sets) {
    Mesh mesh;
    std::vector<std::string> warnings;
    {
        const GateVisit visit;
        const nb::gil_scoped_release release;
        mesh = load_mesh(
            file, {.uv_set = uv_set, .further_uv_sets = std::move(further_uv_sets), .reader = {}}, warnings);
    }
    return nb::make_tuple(make_mesh_arrays(std::move(mesh)), warnings);
}

void write_mesh_arrays(const nb::dict& arrays, const std::string& file) {
    const Mesh mesh = make_mesh(arrays);
    const GateVisit visit;
    const nb::gil_scoped_release release;
    write_mesh(mesh, file);
}

/// In the words of keywords and keys.
std::vector<std::string> list_warnings(const ParsedScene& parsed) {
    std::vector<std::string> warnings;
    {
        const GateVisit visit;
        const nb::gil_scoped_release release;
        warnings = parsed.scene.warnings;
        for (std::string& doubt : find_doubts(parsed.scene)) warnings.push_back(std::move(doubt));
    }
    for (std::string& warning : warnings) warning = name_keywords(std::move(warning));
    return warnings;
}

} // namespace

SceneAssets read_assets(const nb::dict& meshes, const nb::dict& textures) {
    SceneAssets assets;
    for (const auto& [name, arrays] : meshes)
        assets.meshes[nb::cast<std::string>(name)] = make_mesh(nb::cast<nb::dict>(arrays));
    for (const auto& [name, array] : textures) {
        const std::string text_name = nb::cast<std::string>(name);
        assets.textures[text_name] = nb::isinstance<SharedTexture>(array)
                                         ? nb::cast<const SharedTexture&>(array).texture
                                         : std::make_shared<const Texture>(make_texture(array, text_name));
    }
    return assets;
}

std::vector<std::string> find_doubts(const Scene& scene) {
    std::vector<std::string> doubts;
    for (Finding& finding : find_doubtful_assumptions(scene))
        doubts.push_back((finding.severity == Severity::note ? "note: " : "") + std::move(finding.text));
    return doubts;
}

void add_scenes(nb::module_& module) {
    nb::class_<ParsedScene>(module, "Scene",
                            "A scene that was read whole: from a file, or from text and arrays.")
        .def("aim", &aim, nb::arg("keywords"), nb::arg("aspect"), nb::arg("is_completed"))
        .def("complete", &complete)
        .def("describe", &describe, nb::arg("known"))
        .def("environment_texels", &make_environment_texels)
        .def("displace", &displace, nb::arg("level"))
        .def("save", &save, nb::arg("folder"))
        .def_prop_ro("picture", &describe_picture)
        .def_prop_ro("hash", [](const ParsedScene& p) { return p.scene.hash; })
        .def_prop_ro("warnings", &list_warnings);
    nb::class_<SharedTexture>(module, "Texture", "Texels that several scenes share.")
        .def(
            "__init__",
            [](SharedTexture* place, nb::handle array, const std::string& name) {
                new (place) SharedTexture{std::make_shared<const Texture>(make_texture(array, name))};
            },
            nb::arg("array"), nb::arg("name"));
    module.def("parse_scene", &parse, nb::arg("text"), nb::arg("folder"), nb::arg("meshes"),
               nb::arg("textures"), nb::arg("frame").none());
    module.def("load_scene", &load, nb::arg("file"), nb::arg("frame") = nb::none());
    module.def("parse_frames", &parse_frames, nb::arg("text"));
    module.def(
        "name_frame",
        [](const std::string& pattern, int frame) { return name_frame(pattern, frame).string(); },
        nb::arg("pattern"), nb::arg("frame"));
    module.def("load_mesh", &load_mesh_arrays, nb::arg("file"), nb::arg("uv_set") = 0,
               nb::arg("further_uv_sets") = std::vector<int>());
    module.def("write_mesh", &write_mesh_arrays, nb::arg("arrays"), nb::arg("file"));
    module.def(
        "is_mesh_file", [](const std::string& file) { return is_mesh_file(file); }, nb::arg("file"));
}

} // namespace relief::python
