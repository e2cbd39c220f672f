#include "io/scene/scene_reader.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "io/file_system.h"
#include "io/mesh/point_ply.h"
#include "io/scene/error_list.h"
#include "io/scene/json_node.h"
#include "io/scene/keyed_values.h"
#include "io/scene/scene_content.h"
#include "io/scene/scene_keys.h"
#include "io/scene/scene_sections.h"
#include "io/scene/subdivision_json.h"
#include "math/affine.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

using NameIndex = std::unordered_map<std::string, uint32_t>;

uint32_t find_named(const JsonNode& node, const NameIndex& index, const char* what) {
    const std::string name = node.as_string();
    const auto found = index.find(name);
    if (found != index.end()) return found->second;
    std::vector<std::string_view> names;
    for (const auto& [known, position] : index) names.push_back(known);
    std::sort(names.begin(), names.end());
    node.fail(fmt::format("there is no {} '{}'", what, name), suggest_word(name, names));
}

/// Reads the members of a section of names into a list and remembers where each went.
template <class Item, class Read>
NameIndex read_section(const JsonNode& root, std::string_view key, std::vector<Item>& items,
                       ErrorList& errors, const Read& read) {
    NameIndex index;
    std::vector<std::pair<std::string, JsonNode>> members;
    errors.attempt([&] {
        if (const auto section = root.find(key)) members = section->members();
    });
    for (const auto& [name, node] : members) {
        index[name] = uint32_t(items.size());
        items.emplace_back(); // has its place, for objects that name it, though it may not be readable
        errors.attempt([&, &name = name, &node = node] { items.back() = read(name, node); });
    }
    return index;
}

/// From memory or a file.
Mesh read_polygons(const JsonNode& node, AssetCache& assets, const MeshReaderSettings& reader) {
    const JsonNode file = node.get("file");
    const std::string file_name = file.as_string();
    const auto uv_set = node.find("uv_set");
    if (std::optional<Mesh> mesh = file.with_place([&] { return assets.take_mesh(file_name); })) {
        if (uv_set) uv_set->fail("is that of a file, and this mesh is in memory", "leave it out");
        return std::move(*mesh);
    }
    constexpr int kLastUvSet = 255;
    MeshReadOptions options;
    options.reader = reader;
    if (uv_set) options.uv_set = int(uv_set->as_integer(0, kLastUvSet));
    return file.with_place([&] { return load_mesh(assets.resolve(file_name), options); });
}

Mesh read_mesh(const JsonNode& node, const std::string& name, AssetCache& assets,
               const MeshReaderSettings& reader) {
    node.check_keys(scene_keys::kMesh);
    Mesh mesh = read_polygons(node, assets, reader);
    mesh.name = name;
    if (const auto subdivision = node.find("subdivision")) read_subdivision(*subdivision, mesh);
    return mesh;
}

struct ObjectNames {
    NameIndex meshes, displacements, materials;
};

Object read_object(const JsonNode& node, const ObjectNames& names) {
    node.check_keys(scene_keys::kObject);
    Object object;
    if (const auto name = node.find("name")) object.name = name->as_string();
    object.mesh = find_named(node.get("mesh"), names.meshes, "mesh");
    if (const auto found = node.find("displacement"))
        object.displacement = find_named(*found, names.displacements, "displacement");
    if (const auto found = node.find("material"))
        object.material = find_named(*found, names.materials, "material");
    if (const auto found = node.find("shadow_catcher")) object.is_shadow_catcher = found->as_bool();
    if (const auto found = node.find("transform")) object.world_from_object = read_transform(*found);
    return object;
}

/// The object once for each point of a file; the transform of the object moves them all.
void add_instances(const JsonNode& node, const Object& object, const NameIndex& materials,
                   const AssetCache& assets, std::vector<Object>& objects, ContentHash& hash) {
    node.check_keys(scene_keys::kInstances);
    std::vector<uint32_t> choice;
    if (const auto names = node.find("materials"))
        for (const JsonNode& name : names->elements())
            choice.push_back(find_named(name, materials, "material"));
    const JsonNode file = node.get("file");
    const std::filesystem::path path = assets.resolve(file.as_string());
    const InstancePoints points = file.with_place([&] {
        const std::string bytes = read_file_bytes(path);
        hash.add(bytes);
        return parse_points(bytes, path.string(), choice.size());
    });
    objects.reserve(objects.size() + points.transforms.size());
    for (size_t k = 0; k < points.transforms.size(); ++k) {
        objects.push_back(object);
        objects.back().world_from_object = compose(object.world_from_object, points.transforms[k]);
        if (!points.materials.empty()) objects.back().material = choice[points.materials[k]];
    }
}

void read_objects(const JsonNode& node, const ObjectNames& names, const AssetCache& assets, Scene& scene,
                  ContentHash& hash) {
    Object object = read_object(node, names);
    if (const auto instances = node.find("instances"))
        add_instances(*instances, object, names.materials, assets, scene.objects, hash);
    else
        scene.objects.push_back(std::move(object));
}

/// Calls `read` for each element of a section, if it is there.
template <class Read>
void read_list(const JsonNode& root, std::string_view key, ErrorList& errors, const Read& read) {
    std::vector<JsonNode> nodes;
    errors.attempt([&] {
        if (const auto section = root.find(key)) nodes = section->elements();
    });
    for (const JsonNode& node : nodes) errors.attempt([&] { read(node); });
}

/// Content of files that the scene does not hold goes into `hash`.
void read_root(const JsonNode& root, const MeshReaderSettings& reader, Scene& scene, AssetCache& assets,
               ContentHash& hash) {
    root.check_keys(scene_keys::kRoot);
    if (const auto version = root.find("version"); version && version->as_integer(0, INT32_MAX) != 1)
        version->fail("only version 1 is known", "use a newer version of the program");
    ErrorList errors;
    const auto read_node = [&](const char* key, const auto& read) {
        if (const auto node = root.find(key)) errors.attempt([&] { read(*node); });
    };
    read_node("render", [&](const JsonNode& node) { scene.picture = read_picture(node); });
    read_node("camera", [&](const JsonNode& node) { scene.camera = read_camera(node); });
    read_node("environment",
              [&](const JsonNode& node) { scene.environment = read_environment(node, assets); });
    errors.throw_if_any(); // before large files are read
    ObjectNames names;
    names.materials =
        read_section(root, "materials", scene.materials, errors,
                     [&](const auto& name, const auto& n) { return read_material(n, name, assets); });
    names.displacements =
        read_section(root, "displacements", scene.displacements, errors,
                     [&](const auto& name, const auto& n) { return read_displacement(n, name, assets); });
    names.meshes = read_section(root, "meshes", scene.meshes, errors, [&](const auto& name, const auto& n) {
        return read_mesh(n, name, assets, reader);
    });
    read_list(root, "objects", errors,
              [&](const JsonNode& node) { read_objects(node, names, assets, scene, hash); });
    read_list(root, "lights", errors,
              [&](const JsonNode& node) { scene.lights.push_back(read_light(node, assets)); });
    errors.throw_if_any();
}

} // namespace

/// Size, samples and frames of the picture may change without its being another picture.
uint64_t hash_scene(const Json& document, uint64_t content_hash) {
    nlohmann::json canonical = document; // sorts the keys
    if (const auto render = canonical.find("render"); render != canonical.end())
        for (const char* key : {"width", "height", "spp", "frames"}) render->erase(key);
    ContentHash hash(content_hash);
    hash.add(canonical.dump());
    return hash.value();
}

ReadScene read_scene(const Json& document, AssetCache& assets, const std::string& name,
                     const MeshReaderSettings& reader) {
    ReadScene result;
    Scene& scene = result.scene;
    scene.source = name;
    ContentHash content;
    read_root(JsonNode(document, "", name), reader, scene, assets, content);
    scene.warnings = std::move(assets.warnings());
    try {
        validate_scene(scene);
    } catch (const Error& error) {
        throw Error(error.kind(), {error.message(), name + ": " + error.where(), error.hint()});
    }
    add_scene_content(content, scene);
    result.content_hash = content.value();
    scene.hash = hash_scene(document, result.content_hash);
    return result;
}

std::vector<int> read_frames(const Json& document, const std::string& name) {
    const auto render = JsonNode(document, "", name).find("render");
    const auto frames = render ? render->find("frames") : std::nullopt;
    return frames ? parse_frames_at(*frames) : std::vector<int>();
}

namespace {

/// Without a frame: at the first one, or 1.
Scene read_text(std::string_view text, const std::string& name, AssetCache assets,
                const MeshReaderSettings& reader, std::optional<double> frame = {}) {
    if (frame) check_frame(*frame);
    const Json document = parse_json(text, name);
    const std::vector<int> frames = read_frames(document, name);
    if (!is_animated(document)) return read_scene(document, assets, name, reader).scene;
    const Json at_frame = evaluate_frame(document, frame.value_or(frames.empty() ? 1 : frames.front()), name);
    return read_scene(at_frame, assets, name, reader).scene;
}

} // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& folder, const std::string& name,
                  const MeshReaderSettings& reader) {
    return read_text(text, name, AssetCache(folder), reader);
}

Scene parse_scene_text(std::string_view text, const std::filesystem::path& folder, SceneAssets assets,
                       std::optional<double> frame, const MeshReaderSettings& reader) {
    return read_text(text, "scene", AssetCache(folder, std::move(assets)), reader, frame);
}

Scene load_scene(const std::filesystem::path& file, const MeshReaderSettings& reader) {
    refuse_foreign_file(file);
    return parse_scene(read_file_bytes(file), file.parent_path(), file.string(), reader);
}

} // namespace relief
