#include "io/scene/scene_reader.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "io/file_system.h"
#include "io/mesh/point_ply.h"
#include "io/scene/error_list.h"
#include "io/scene/frame_reader.h"
#include "io/scene/json_node.h"
#include "io/scene/scene_keys.h"
#include "io/scene/scene_sections.h"
#include "io/scene/subdivision_json.h"
#include "math/affine.h"
#include "relief/error.h"
#include "relief/io.h"
#include "scene/left_out_mesh.h"
#include "scene/uv_sets.h"

namespace relief {

namespace {

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

void read_animation(const JsonNode& node, MeshReadOptions& options) {
    const auto animation = node.find("animation"), time = node.find("time");
    if (animation)
        options.animation = animation->is_string() ? animation->as_string()
                                                   : std::to_string(animation->as_integer(0, INT32_MAX));
    if (time && !animation) time->fail("is that of an animation, and none is named", "add 'animation'");
    if (time) options.time = double(time->as_float());
}

/// From memory or a file, with what it has of further uv sets.
Mesh read_polygons(const JsonNode& node, AssetCache& assets, const MeshReaderSettings& reader,
                   const std::vector<int>& uv_sets) {
    const JsonNode file = node.get("file");
    const std::string file_name = file.as_string();
    const auto uv_set = node.find("uv_set");
    if (std::optional<Mesh> mesh = file.with_place([&] { return assets.take_mesh(file_name); })) {
        if (uv_set) uv_set->fail("is that of a file, and this mesh is in memory", "leave it out");
        return std::move(*mesh);
    }
    MeshReadOptions options;
    options.reader = reader, options.further_uv_sets = uv_sets;
    if (uv_set) options.uv_set = int(uv_set->as_integer(0, kMaxUvSet));
    read_animation(node, options);
    return file.with_place([&] { return assets.load_polygons(file_name, options); });
}

Mesh read_mesh(const JsonNode& node, const std::string& name, AssetCache& assets,
               const MeshReaderSettings& reader, const std::vector<int>& uv_sets) {
    node.check_keys(scene_keys::kMesh);
    Mesh mesh;
    if (!assets.find_kept(name)) mesh = read_polygons(node, assets, reader, uv_sets);
    mesh.name = name;
    if (const auto subdivision = node.find("subdivision")) read_subdivision(*subdivision, mesh);
    if (const auto weld = node.find("weld")) mesh.weld = weld->as_float(0);
    return mesh;
}

/// The object once for each point of a file; the transform of the object moves them all.
std::vector<Object> make_instances(const JsonNode& node, const Object& object, const NameIndex& materials,
                                   const AssetCache& assets, uint64_t& points_hash) {
    node.check_keys(scene_keys::kInstances);
    std::vector<uint32_t> choice;
    if (const auto names = node.find("materials"))
        for (const JsonNode& name : names->elements())
            choice.push_back(find_named(name, materials, "material"));
    const JsonNode file = node.get("file");
    const std::filesystem::path path = assets.resolve(file.as_string());
    const InstancePoints points = file.with_place([&] {
        const std::string bytes = read_file_bytes(path);
        ContentHash hash;
        hash.add(bytes);
        points_hash = hash.value();
        return parse_points(bytes, path.string(), choice.size());
    });
    std::vector<Object> objects(points.transforms.size(), object);
    for (size_t k = 0; k < objects.size(); ++k) {
        objects[k].world_from_object = compose(object.world_from_object, points.transforms[k]);
        if (!points.materials.empty()) objects[k].material = choice[points.materials[k]];
    }
    return objects;
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

} // namespace

Object SceneReader::read_object(const JsonNode& node) const {
    node.check_keys(scene_keys::kObject);
    Object object;
    if (const auto name = node.find("name")) object.name = name->as_string();
    object.mesh = find_named(node.get("mesh"), names_.meshes, "mesh");
    if (const auto found = node.find("displacement"))
        object.displacement = find_named(*found, names_.displacements, "displacement");
    if (const auto found = node.find("material"))
        object.material = find_named(*found, names_.materials, "material");
    if (const auto found = node.find("shadow_catcher")) object.is_shadow_catcher = found->as_bool();
    if (const auto found = node.find("transform")) object.world_from_object = read_transform(*found);
    return object;
}

std::vector<Object> SceneReader::read_objects(const JsonNode& node, const AssetCache& assets,
                                              uint64_t& points_hash) const {
    const Object object = read_object(node);
    const auto instances = node.find("instances");
    if (!instances) return {object};
    return make_instances(*instances, object, names_.materials, assets, points_hash);
}

void SceneReader::read_root(const JsonNode& root, AssetCache& assets) {
    root.check_keys(scene_keys::kRoot);
    if (const auto version = root.find("version"); version && version->as_integer(0, INT32_MAX) != 1)
        version->fail("only version 1 is known", "use a newer version of the program");
    ErrorList errors;
    const auto read_node = [&](const char* key, const auto& read) {
        if (const auto node = root.find(key)) errors.attempt([&] { read(*node); });
    };
    read_node("render", [&](const JsonNode& node) { scene_.picture = read_picture(node); });
    read_node("camera", [&](const JsonNode& node) { scene_.camera = read_camera(node); });
    read_node("environment",
              [&](const JsonNode& node) { scene_.environment = read_environment(node, assets); });
    errors.throw_if_any(); // before large files are read
    names_.materials =
        read_section(root, "materials", scene_.materials, errors,
                     [&](const auto& name, const auto& n) { return read_material(n, name, assets); });
    names_.displacements =
        read_section(root, "displacements", scene_.displacements, errors,
                     [&](const auto& name, const auto& n) { return read_displacement(n, name, assets); });
    const std::vector<int> uv_sets = list_uv_sets(scene_.materials);
    names_.meshes = read_section(root, "meshes", scene_.meshes, errors, [&](const auto& name, const auto& n) {
        return read_mesh(n, name, assets, reader_, uv_sets);
    });
    read_list(root, "objects", errors, [&](const JsonNode& node) {
        ObjectRange range{scene_.objects.size(), 0, 0};
        std::vector<Object> objects = read_objects(node, assets, range.points_hash);
        range.count = objects.size();
        std::ranges::move(objects, std::back_inserter(scene_.objects));
        ranges_.push_back(range);
    });
    read_list(root, "lights", errors,
              [&](const JsonNode& node) { scene_.lights.push_back(read_light(node, assets)); });
    errors.throw_if_any();
}

void SceneReader::read(const Json& document, AssetCache& assets) {
    scene_.source = name_;
    read_root(JsonNode(document, "", name_), assets);
    scene_.warnings = std::move(assets.warnings());
    for (size_t k = 0; k < scene_.meshes.size(); ++k)
        if (const uint64_t* hash = assets.find_kept(scene_.meshes[k].name)) content_.set_mesh(k, *hash);
    try {
        assets.has_kept() ? validate_without_left_out(scene_) : validate_scene(scene_);
    } catch (const Error& error) {
        throw Error(error.kind(), {error.message(), name_ + ": " + error.where(), error.hint()});
    }
}

void SceneReader::replace_objects(size_t index, std::vector<Object> objects) {
    ObjectRange& range = ranges_.at(index);
    const auto first = scene_.objects.begin() + ptrdiff_t(range.first);
    if (objects.size() == range.count) {
        std::ranges::move(objects, first);
        return;
    }
    scene_.objects.erase(first, first + ptrdiff_t(range.count));
    scene_.objects.insert(scene_.objects.begin() + ptrdiff_t(range.first),
                          std::make_move_iterator(objects.begin()), std::make_move_iterator(objects.end()));
    range.count = objects.size();
    for (size_t k = index + 1; k < ranges_.size(); ++k)
        ranges_[k].first = ranges_[k - 1].first + ranges_[k - 1].count;
}

void SceneReader::read_part(const ScenePart& part, const Json& value, AssetCache& assets) {
    const JsonNode node(value, part.path, name_);
    if (part.section == "render") {
        scene_.picture = read_picture(node);
    } else if (part.section == "camera") {
        scene_.camera = read_camera(node);
        node.with_place([&] { validate_camera(scene_.camera); });
    } else if (part.section == "environment") {
        scene_.environment = read_environment(node, assets);
    } else if (part.section == "materials") {
        scene_.materials.at(part.index) = read_material(node, part.name, assets);
    } else if (part.section == "displacements") {
        scene_.displacements.at(part.index) = read_displacement(node, part.name, assets);
    } else if (part.section == "meshes") {
        Mesh& mesh = scene_.meshes.at(part.index) =
            read_mesh(node, part.name, assets, reader_, list_uv_sets(scene_.materials));
        node.with_place([&] { validate_mesh(mesh); });
    } else if (part.section == "objects") {
        replace_objects(part.index, read_objects(node, assets, ranges_.at(part.index).points_hash));
    } else if (part.section == "lights") {
        scene_.lights.at(part.index) = read_light(node, assets);
    }
}

Scene SceneReader::take_scene() {
    std::vector<Mesh> meshes = std::exchange(scene_.meshes, {});
    Scene scene = scene_;
    for (const Mesh& mesh : meshes) {
        Mesh& empty = scene_.meshes.emplace_back();
        empty.name = mesh.name, empty.source = mesh.source;
    }
    scene.meshes = std::move(meshes);
    return scene;
}

uint64_t SceneReader::hash_content() {
    ContentHash hash;
    std::vector<uint64_t> points;
    for (const ObjectRange& range : ranges_)
        if (range.points_hash != 0) points.push_back(range.points_hash);
    hash.add(points);
    content_.add_to(hash, scene_);
    return hash.value();
}

namespace {

/// Without a frame: at the first one, or 1.
Scene read_text(std::string_view text, const std::string& name, AssetCache assets,
                const MeshReaderSettings& reader, std::optional<double> frame = {}) {
    FrameReader frames(parse_json(text, name), name, std::move(assets), reader);
    return frames.load(frame.value_or(frames.frames().empty() ? 1 : frames.frames().front()));
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
