// save_scene_copy: the scene that is rendered as a scene file that names the files it was read from.
#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "io/file_system.h"
#include "io/mesh/mesh_writer.h"
#include "io/mesh/up_axis.h"
#include "io/picture/image_coders.h"
#include "io/scene/keyed_values.h"
#include "io/scene/scene_values.h"
#include "io/scene/studio.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

namespace fs = std::filesystem;

/// What each section is for: written above it.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kComments = {
    {{"render", "Size in pixels, samples a pixel, path length. Options of the command win over these."},
     {"camera",
      "Position, target and up axis in scene units; vertical angle; radius and distance for depth of field."},
     {"environment", "A latitude-longitude picture or a colour; strength is a factor on its radiance."},
     {"materials", "base_color is linear, 0 to 1; roughness and metallic 0 to 1; ior 1: no clear surface."},
     {"displacements", "(value - midlevel) * scale, channel by channel, along the axes in this order."},
     {"meshes", "Paths are relative to this file."},
     {"objects", "A mesh with its displacement, material and transform."},
     {"lights",
      "sun: direction in which its light travels, angle of its disc; point: position and radius."}}};

/// `file`, read from `folder`, as it is named from the folder of the copy.
std::string move_path(const std::string& file, const fs::path& folder, const fs::path& copy_folder) {
    const fs::path path(file);
    if (path.is_absolute()) return file;
    return fs::absolute(folder / path)
        .lexically_relative(fs::absolute(copy_folder).lexically_normal())
        .generic_string();
}

/// Every file that a section names.
void move_paths(Json& node, const fs::path& folder, const fs::path& copy_folder) {
    for (auto& [key, value] : node.items()) {
        if (value.is_structured())
            move_paths(value, folder, copy_folder);
        else if (value.is_string() &&
                 (key == "file" || key == "geometry_normal" || key.ends_with("_texture")))
            value = move_path(value.get<std::string>(), folder, copy_folder);
    }
}

Json write_map_options(const MapOptions& map, const std::string& file) {
    Json node;
    node["file"] = file;
    if (!map.preset.empty()) node["preset"] = map.preset;
    const std::pair<const char*, const std::optional<std::string>*> texts[] = {
        {"type", &map.type},       {"space", &map.space},       {"axes", &map.axes}, {"frame", &map.frame},
        {"lengths", &map.lengths}, {"encoding", &map.encoding}, {"wrap", &map.wrap}, {"filter", &map.filter}};
    for (const auto& [key, text] : texts)
        if (*text) node[key] = **text;
    if (map.midlevel) node["midlevel"] = to_json(*map.midlevel);
    if (map.scale) node["scale"] = to_json(*map.scale);
    if (map.flip_v) node["flip_v"] = true;
    if (!map.dilate) node["dilate"] = false;
    if (map.dequantize) node["dequantize"] = true;
    if (map.autobump) node["autobump"] = true;
    return node;
}

/// A material of the library itself: clay, or of the ground.
Json write_plain_material(const Material& material) {
    Json node = {{"base_color", to_json(material.base_color)}, {"roughness", to_json(material.roughness)}};
    if (material.ior != Material().ior) node["ior"] = to_json(material.ior);
    return node;
}

/// Sections of a mesh that came alone.
Json write_mesh_scene(const Scene& scene, const MeshSceneOptions& options, const fs::path& folder) {
    const auto move = [&](const fs::path& file) { return move_path(file.string(), ".", folder); };
    Json root;
    const Material& clay = scene.materials.front();
    root["materials"][clay.name] = write_plain_material(clay);
    Json object = {{"name", scene.objects.front().name}, {"mesh", "mesh"}};
    if (!options.displacement_map.empty()) {
        root["displacements"]["map"] = write_map_options(options.map, move(options.displacement_map));
        object["displacement"] = "map";
    }
    object["material"] = clay.name;
    if (options.up != UpAxis::y)
        object["transform"]["rotate_degrees"] = to_json(get_upright_turn(options.up));
    root["meshes"]["mesh"]["file"] = move(scene.meshes.front().source);
    if (options.subdivision) {
        Json& subdivision = root["meshes"]["mesh"]["subdivision"];
        subdivision["scheme"] = *options.subdivision;
        if (options.subdivision_level) subdivision["level"] = *options.subdivision_level;
    }
    if (options.weld) root["meshes"]["mesh"]["weld"] = to_json(*options.weld);
    root["objects"] = Json::array({object});
    if (!options.environment.empty()) root["environment"]["file"] = move(options.environment);
    return root;
}

[[noreturn]] void refuse_other_file(const fs::path& file) {
    throw Error(ErrorKind::usage, {"another file would be written over", file.string(),
                                   "move it away, or give the scene another name"});
}

void keep_inputs(const Scene& scene, const fs::path& file) {
    std::error_code ignored;
    for (const Mesh& mesh : scene.meshes)
        if (fs::equivalent(mesh.source, file, ignored))
            throw Error(ErrorKind::usage, {"a file that is read would be written over", file.string(),
                                           "give the scene another name"});
}

/// A mesh that was not read from a file is written beside the scene.
void add_ground(const Scene& scene, const fs::path& file, Json& root) {
    const Object& object = scene.objects.back();
    const Mesh& mesh = scene.meshes[object.mesh];
    if (!mesh.source.empty()) return;
    const Material& material = scene.materials[object.material];
    const fs::path mesh_file = file.stem().string() + "_" + mesh.name + ".obj";
    const fs::path written = file.parent_path() / mesh_file;
    keep_inputs(scene, written);
    const std::string text = format_obj(mesh);
    if (std::ifstream there(written, std::ios::binary); there)
        if (std::string(std::istreambuf_iterator<char>(there), {}) != text) refuse_other_file(written);
    write_text_file(written, text);
    root["materials"][material.name] = write_plain_material(material);
    root["meshes"][mesh.name]["file"] = mesh_file.string();
    Json node = {{"name", object.name}, {"mesh", mesh.name}, {"material", material.name}};
    if (object.is_shadow_catcher) node["shadow_catcher"] = true;
    root["objects"].push_back(std::move(node));
}

bool is_studio(const fs::path& file) {
    try {
        const Texture there = read_texture(file);
        return there.stride == get_studio()->stride && there.floats == get_studio()->floats;
    } catch (const Error&) {
        return false;
    }
}

/// The picture of the studio is written beside the scene.
void add_studio(const Scene& scene, const fs::path& file, Json& root) {
    if (!scene.environment || scene.environment->texture != get_studio()) return;
    const fs::path picture = file.stem().string() + "_studio.exr", written = file.parent_path() / picture;
    keep_inputs(scene, written);
    std::error_code ignored;
    if (fs::exists(written, ignored) && !is_studio(written)) refuse_other_file(written);
    write_checked(written, [](CheckedFile& stream) { encode_exr(*get_studio(), stream); });
    root["environment"]["file"] = picture.string();
}

/// What options may have changed.
void update_values(const Scene& scene, Json& root) {
    if (Json node = write_picture(scene.picture); !node.empty()) root["render"] = std::move(node);
    root["camera"] = write_camera(scene.camera);
    if (scene.environment) write_environment(*scene.environment, root["environment"]);
    const Json lights = std::exchange(root["lights"], Json::array());
    // Options exchange suns, which have no textures: those of the others come in their order.
    std::vector<Json> textures;
    for (const Json& light : lights)
        if (light.contains("color_texture")) textures.push_back(light["color_texture"]);
    auto next = textures.begin();
    for (const Light& light : scene.lights) {
        Json node = write_light(light);
        if (light.color_texture && next != textures.end()) node["color_texture"] = *next++;
        root["lights"].push_back(std::move(node));
    }
}

/// The displacements of a mesh that came alone are called "map", whatever the scene calls them.
Json* find_entry(Json& root, const char* section, const std::string& name) {
    if (!root.contains(section)) return nullptr;
    Json& entries = root[section];
    if (entries.contains(name)) return &entries[name];
    return entries.size() == 1 ? &entries.front() : nullptr;
}

/// A number or colour, which is the factor of a texture where the key has one.
void set_input(Json& node, const char* name, const char* alias, Json value) {
    const char* key = node.contains(name) ? name : alias;
    if (node.contains(key) && node[key].is_object())
        node[key]["factor"] = std::move(value);
    else
        node[key] = std::move(value);
}

void write_convention(const Displacement& map, Json& node) {
    node.erase("preset"), node.erase("encoding");
    write_map_convention(map, node);
}

void apply_changes(const Scene& scene, const SceneChanges& changes, const fs::path& folder, Json& root) {
    if (!changes.environment.empty())
        root["environment"]["file"] = move_path(changes.environment.string(), ".", folder);
    for (const Displacement& map : scene.displacements) {
        Json* const node = find_entry(root, "displacements", map.name);
        if (!node) continue;
        const auto painted = changes.maps.find(map.name);
        if (painted != changes.maps.end()) (*node)["file"] = move_path(painted->second.string(), ".", folder);
        // Texels that were integers become floats, whose zero is another.
        if (painted != changes.maps.end() || changes.displacements.contains(map.name))
            write_convention(map, *node);
    }
    for (const Material& material : scene.materials) {
        Json* const node = changes.materials.contains(material.name)
                               ? find_entry(root, "materials", material.name)
                               : nullptr;
        if (!node) continue;
        set_input(*node, "base_color", "base_color", to_json(material.base_color));
        set_input(*node, "roughness", "specular_roughness", to_json(material.roughness));
        set_input(*node, "metallic", "base_metalness", to_json(material.metallic));
    }
}

/// Vectors on one line.
std::string join_numbers(const std::string& text) {
    std::string result;
    bool is_string = false;
    for (size_t k = 0; k < text.size(); ++k) {
        if (text[k] == '"') is_string = !is_string;
        if (is_string && text[k] == '\\') result += text[k++];
        const size_t end = !is_string && text[k] == '[' ? text.find(']', k) : std::string::npos;
        if (end == std::string::npos || text.find_first_of("{[\"", k + 1) < end) {
            result += text[k];
            continue;
        }
        for (; k < end; ++k) {
            if (text[k] == '\n' || text[k] == ' ') continue;
            result += text[k];
            if (text[k] == ',') result += ' ';
        }
        result += ']';
    }
    return result;
}

std::string indent(const std::string& text) {
    std::string result;
    for (const char c : text) {
        result += c;
        if (c == '\n') result += "  ";
    }
    return result;
}

std::string format_commented(const Json& root, const std::vector<std::string>& picture_options) {
    std::string text = "// A scene of Relief: docs/formats.md says what each key means.\n";
    if (!picture_options.empty())
        text += fmt::format("// Its picture was rendered with {}, which are no part of a scene.\n",
                            fmt::join(picture_options, " "));
    text += "{\n  \"version\": 1";
    for (const auto& [key, comment] : kComments)
        if (root.contains(key) && !root[std::string(key)].empty())
            text += fmt::format(",\n\n  // {}\n  \"{}\": {}", comment, key,
                                indent(join_numbers(root[std::string(key)].dump(2))));
    return text + "\n}\n";
}

/// A file with other text stays beside the new one: somebody may have gone on with it.
void keep_backup(const fs::path& file, const std::string& text) {
    std::error_code code;
    if (!fs::is_regular_file(file, code)) return;
    const std::string kept = read_file_bytes(file);
    if (kept == text) return;
    fs::path backup = file;
    backup += ".bak";
    for (int k = 2; fs::exists(backup, code); ++k) { // none is written over
        if (fs::is_regular_file(backup, code) && read_file_bytes(backup) == kept) return;
        backup = file;
        backup += fmt::format(".bak{}", k);
    }
    fs::copy_file(file, backup, code);
    if (code)
        throw Error(ErrorKind::failed, {"what the file holds cannot be kept: " + code.message(),
                                        backup.string(), "check free space and rights"});
}

} // namespace

void save_scene_copy(const Scene& scene, const fs::path& input, const MeshSceneOptions& options,
                     const fs::path& file, const std::vector<std::string>& picture_options,
                     const SceneChanges& changes) {
    validate_scene(scene);
    const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
    Json root;
    if (is_mesh_file(input)) {
        root = write_mesh_scene(scene, options, folder);
    } else {
        root = parse_json(read_file_bytes(input), input.string());
        if (changes.frame) root = evaluate_frame(root, *changes.frame, input.string());
        for (const char* section :
             {"environment", "materials", "displacements", "meshes", "objects", "lights"})
            if (root.contains(section))
                move_paths(root[section], input.has_parent_path() ? input.parent_path() : ".", folder);
    }
    add_studio(scene, file, root);
    update_values(scene, root);
    apply_changes(scene, changes, folder, root);
    if (!scene.objects.empty()) add_ground(scene, file, root);
    const std::string text = format_commented(root, picture_options);
    keep_backup(file, text);
    write_text_file(file, text);
}

} // namespace relief
