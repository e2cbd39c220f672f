// save_scene: scene.json with meshes as OBJ and maps as EXR beside it.
#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include <fmt/format.h>

#include "base/progress.h"
#include "io/mesh/mesh_writer.h"
#include "io/picture/image_coders.h"
#include "io/scene/json_node.h"
#include "io/scene/keyed_values.h"
#include "io/scene/motion_json.h"
#include "io/scene/scene_values.h"
#include "io/scene/subdivision_json.h"
#include "relief/error.h"
#include "relief/io.h"
#include "scene/displacement_conventions.h"
#include "scene/material_inputs.h"
#include "scene/object_names.h"
#include "scene/words.h"

namespace relief {

namespace {

/// Gives every item a name of its own, close to the one it has.
class Namer {
  public:
    explicit Namer(std::string fallback) : fallback_(std::move(fallback)) {}

    std::string make_unique(const std::string& wanted) {
        const std::string base = wanted.empty() ? fallback_ : wanted;
        std::string name = base;
        for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{}_{}", base, i);
        return name;
    }

  private:
    std::string fallback_;
    std::set<std::string> taken_;
};

std::string make_file_stem(std::string name) {
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
    return name;
}

void write_texels(const Texture& texture, const std::filesystem::path& file) {
    write_checked(file, [&](CheckedFile& stream) { encode_exr(texture, stream); });
}

/// Fails where a map goes through tangents of its mesh, which an OBJ cannot hold.
void check_tangents(const Scene& scene, const Object& object) {
    if (object.displacement == kNoIndex) return;
    const Displacement& map = scene.displacements[object.displacement];
    const Mesh& mesh = scene.meshes[object.mesh];
    if (map.frame != FrameKind::file || map.type != DisplacementType::vector ||
        map.space != DisplacementSpace::tangent || mesh.tangents.empty())
        return;
    throw Error(ErrorKind::bad_input,
                {fmt::format("displacement '{}' uses the tangents of its mesh, and a scene is saved with OBJ "
                             "meshes, which hold none",
                             map.name),
                 fmt::format("mesh '{}'", mesh.name), "use frame mikk, or write the scene file by hand"});
}

/// Fails where a texture lies on another uv set than that of its mesh, which an OBJ cannot hold.
void check_uv_sets(const Scene& scene, const Object& object) {
    if (object.material == kNoIndex) return;
    const Material& material = scene.materials[object.material];
    const Mesh& mesh = scene.meshes[object.mesh];
    for (const InputTexture& texture : material.textures)
        if (texture.uv_set != kOwnUvSet && texture.uv_set != mesh.uv_set)
            throw Error(
                ErrorKind::bad_input,
                {fmt::format("the {} of material '{}' lies on uv set {}, and a scene is saved with OBJ "
                             "meshes, which hold one set",
                             get_input_name(texture.input), material.name, texture.uv_set),
                 fmt::format("mesh '{}'", mesh.name), "write the scene file by hand"});
}

/// Whether the key that is a texture's own says all of it.
bool has_own_key(const InputTexture& texture) {
    InputTexture plain;
    plain.input = texture.input, plain.tiles = texture.tiles, plain.filter = texture.filter;
    plain.uv_set = texture.uv_set; // the mesh is written with it alone
    return get_input_kind(texture.input).texture_key && texture == plain;
}

/// Maps are saved as floats, which have no steps to smooth.
void check_steps(const Displacement& map) {
    if (map.dequantize)
        throw Error(ErrorKind::bad_input,
                    {"a map that is dequantised cannot be saved: maps are written as floats",
                     fmt::format("displacement '{}'", map.name),
                     "convert the map with dequantize first, or name its file in a scene file by hand"});
}

class SceneWriter {
  public:
    SceneWriter(const Scene& scene, const SceneMotion& motion, std::filesystem::path folder,
                const ProgressFunction& on_progress)
        : scene_(scene),
          motion_(motion),
          folder_(std::move(folder)),
          progress_(on_progress, count_work(scene, motion)) {}

    void write() {
        for (const char* name : {"meshes", "maps"}) {
            std::error_code code;
            std::filesystem::create_directories(folder_ / name, code);
            if (code)
                throw Error(ErrorKind::failed, {"the folder cannot be made: " + code.message(),
                                                (folder_ / name).string(), "check its rights"});
        }
        root_["version"] = 1;
        add_picture(), add_camera(), add_environment(), add_materials(), add_displacements(), add_meshes();
        add_objects(), add_lights();
        write_text_file(folder_ / "scene.json", root_.dump(2) + "\n");
    }

  private:
    /// A vertex takes as long as so many texels.
    static constexpr uint64_t kTexelsPerVertex = 16;

    static uint64_t count_texels(const Texture& texture) { return uint64_t(texture.width) * texture.height; }

    /// Texels, and vertices counted as texels.
    static uint64_t count_work(const Scene& scene, const SceneMotion& motion) {
        std::set<const Texture*> textures;
        if (scene.environment) textures.insert(scene.environment->texture.get());
        for (const Light& light : scene.lights) textures.insert(light.color_texture.get());
        for (const Material& material : scene.materials)
            visit_textures(material, [&](const char*, const auto& texture, MapFilter) {
                textures.insert(texture.get());
            });
        for (const Displacement& map : scene.displacements)
            for (const MapTile& tile : map.tiles)
                if (!motion.maps.contains(map.name)) textures.insert(tile.texture.get());
        for (const auto& [name, maps] : motion.maps)
            for (const auto& map : maps) textures.insert(map.get());
        textures.erase(nullptr);
        uint64_t work = 0;
        for (const Texture* texture : textures) work += count_texels(*texture);
        for (const Mesh& mesh : scene.meshes) work += kTexelsPerVertex * mesh.positions.size();
        return work;
    }

    void write_counted(const Texture& texture, const std::filesystem::path& file) {
        write_texels(texture, file);
        progress_.add(count_texels(texture));
    }

    /// Writes a texture once, however often it is used; returns its path relative to the scene.
    std::string add_map(const std::shared_ptr<const Texture>& texture, const std::string& name) {
        std::string& file = files_[texture.get()];
        if (file.empty()) {
            file = "maps/" + map_names_.make_unique(make_file_stem(name)) + ".exr";
            write_counted(*texture, folder_ / file);
        }
        return file;
    }

    Json add_texture(const std::shared_ptr<const Texture>& texture, MapFilter filter,
                     const std::string& name) {
        const std::string file = add_map(texture, name);
        if (filter == MapFilter::none) return file;
        return {{"file", file}, {"filter", get_word(filter)}};
    }

    void add_picture() {
        if (Json node = write_picture(scene_.picture); !node.empty()) root_["render"] = std::move(node);
        if (motion_.frame_count > 0)
            root_["render"]["frames"] =
                fmt::format("{}-{}", motion_.first_frame, motion_.first_frame + int(motion_.frame_count) - 1);
    }

    void add_camera() {
        root_["camera"] = write_camera(scene_.camera);
        if (!motion_.views.empty()) write_views(motion_, root_["camera"]);
    }

    void add_environment() {
        if (!scene_.environment) return;
        const Environment& environment = *scene_.environment;
        Json& node = root_["environment"];
        if (environment.texture) node["file"] = add_map(environment.texture, "environment");
        write_environment(environment, node);
    }

    void add_materials() {
        Namer namer("material");
        for (const Material& material : scene_.materials) {
            material_names_.push_back(namer.make_unique(material.name));
            Json& node = root_["materials"][material_names_.back()];
            write_inputs(material, node);
            if (!material.light_group.empty()) node["light_group"] = material.light_group;
            for (const InputTexture& texture : material.textures)
                if (has_own_key(texture))
                    add_own(texture, node);
                else
                    add_input(material, texture, node);
            write_emission(material, node);
            write_normal_options(material, node);
        }
    }

    std::string add_tiles(const std::vector<MapTile>& tiles, bool is_udim, const std::string& name) {
        if (!is_udim) return add_map(tiles.front().texture, name);
        const std::string stem = "maps/" + map_names_.make_unique(make_file_stem(name));
        for (const MapTile& tile : tiles)
            write_counted(*tile.texture, folder_ / fmt::format("{}.{}.exr", stem, tile.udim));
        return stem + ".<UDIM>.exr";
    }

    std::string add_sequence(const std::vector<std::shared_ptr<const Texture>>& maps,
                             const std::string& name) {
        const std::string pattern = "maps/" + map_names_.make_unique(make_file_stem(name)) + ".####.exr";
        int frame = motion_.first_frame;
        for (const std::shared_ptr<const Texture>& map : maps)
            write_counted(*map, folder_ / fill_frame_number(pattern, frame++));
        return pattern;
    }

    /// A texture under the key that is its own.
    void add_own(const InputTexture& texture, Json& node) {
        const std::string_view key = get_input_kind(texture.input).texture_key;
        std::string_view input = key.substr(0, key.rfind('_')); // without "_texture"
        if (input == "base_color") input = "color";             // files have had this name from the first
        node[key] = add_texture(texture.tiles.front().texture, texture.filter,
                                fmt::format("{}_{}", material_names_.back(), input));
    }

    /// A texture in place of its number, which becomes its factor.
    void add_input(const Material& material, const InputTexture& texture, Json& node) {
        const MaterialInputKind& kind = get_input_kind(texture.input);
        const bool is_emission = kind.is_emission();
        Json& entry = node[is_emission ? kind.name : kind.short_name()];
        entry = {{"file", add_tiles(texture.tiles, texture.is_udim,
                                    fmt::format("{}_{}", material_names_.back(), kind.name))}};
        if (kind.number) entry["factor"] = to_json(material.*kind.number);
        if (kind.color && !is_emission) entry["factor"] = to_json(material.*kind.color);
        entry.update(write_placement(texture));
    }

    void add_displacements() {
        Namer namer("displacement");
        for (const Displacement& map : scene_.displacements) {
            displacement_names_.push_back(namer.make_unique(map.name));
            Json& node = root_["displacements"][displacement_names_.back()];
            const auto moving = motion_.maps.find(map.name);
            node["file"] = moving == motion_.maps.end()
                               ? add_tiles(map.tiles, map.is_udim, displacement_names_.back())
                               : add_sequence(moving->second, displacement_names_.back());
            write_map_convention(map, node);
        }
    }

    void add_meshes() {
        Namer namer("mesh"), file_namer("mesh");
        for (const Mesh& mesh : scene_.meshes) {
            mesh_names_.push_back(namer.make_unique(mesh.name));
            const std::string file =
                "meshes/" + file_namer.make_unique(make_file_stem(mesh_names_.back())) + ".obj";
            write_text_file(folder_ / file, format_obj(mesh));
            progress_.add(kTexelsPerVertex * mesh.positions.size());
            Json& node = root_["meshes"][mesh_names_.back()];
            node["file"] = file;
            if (has_subdivision(mesh)) node["subdivision"] = write_subdivision(mesh);
            if (mesh.weld) node["weld"] = to_json(*mesh.weld);
        }
    }

    void add_objects() {
        root_["objects"] = Json::array();
        const bool has_links = std::ranges::any_of(scene_.lights, is_linked);
        for (const Object& object : scene_.objects) {
            Json node;
            // Meshes may get other names in the file than lights call their objects by.
            if (!object.name.empty() || has_links) node["name"] = name_object(scene_, object);
            node["mesh"] = mesh_names_.at(object.mesh);
            if (object.displacement != kNoIndex)
                node["displacement"] = displacement_names_.at(object.displacement);
            if (object.material != kNoIndex) node["material"] = material_names_.at(object.material);
            if (object.is_shadow_catcher) node["shadow_catcher"] = true;
            const auto moving = motion_.objects.find(object.name);
            if (moving != motion_.objects.end())
                node["transform"] = write_placements(moving->second, motion_.first_frame);
            else if (!(object.world_from_object == Affine{}))
                node["transform"]["matrix"] = write_matrix(object.world_from_object);
            root_["objects"].push_back(node);
        }
    }

    void add_lights() {
        if (scene_.lights.empty()) return;
        root_["lights"] = Json::array();
        for (const Light& light : scene_.lights) {
            Json node = write_light(light);
            if (light.color_texture) node["color_texture"] = add_map(light.color_texture, "light");
            root_["lights"].push_back(std::move(node));
        }
    }

    const Scene& scene_;
    const SceneMotion& motion_;
    std::filesystem::path folder_;
    ProgressCounter progress_;
    Json root_;
    Namer map_names_{"map"};
    std::map<const Texture*, std::string> files_;
    std::vector<std::string> mesh_names_, material_names_, displacement_names_;
};

} // namespace

void save_scene(const Scene& scene, const std::filesystem::path& folder,
                const ProgressFunction& on_progress) {
    save_shot(scene, {}, folder, on_progress);
}

void save_shot(const Scene& scene, const SceneMotion& motion, const std::filesystem::path& folder,
               const ProgressFunction& on_progress) {
    validate_scene(scene);
    check_motion(scene, motion);
    for (const Object& object : scene.objects) check_tangents(scene, object), check_uv_sets(scene, object);
    for (const Displacement& map : scene.displacements) check_steps(map);
    SceneWriter(scene, motion, folder, on_progress).write();
}

} // namespace relief
