#include "viewer/document.h"

#include <algorithm>
#include <cctype>
#include <exception>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "common/whole_names.h"
#include "relief/convert.h"
#include "relief/error.h"
#include "relief/inspect.h"
#include "viewer/conventions.h"

namespace relief::viewer {

namespace {

MapTile& find_map_tile(Displacement& map, int udim) {
    for (MapTile& tile : map.tiles)
        if (tile.udim == udim) return tile;
    throw Error(ErrorKind::usage,
                {fmt::format("there is no tile {}", udim), fmt::format("displacement '{}'", map.name),
                 "paint where the map has one"});
}

std::vector<std::string> list_doubts(const Scene& scene) {
    std::vector<std::string> texts;
    for (const Finding& finding : find_doubtful_assumptions(scene))
        texts.push_back(cli::name_map_keys(finding.text));
    return texts;
}

std::string make_stem(std::string name) {
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
    return name;
}

} // namespace

void make_names_distinct(std::vector<Displacement>& maps) {
    std::set<std::string> taken;
    for (Displacement& map : maps) {
        const std::string base = map.name.empty() ? "map" : map.name;
        map.name = base;
        for (int k = 2; !taken.insert(map.name).second; ++k) map.name = fmt::format("{}_{}", base, k);
    }
}

std::filesystem::path name_tile(const std::filesystem::path& pattern, int udim) {
    constexpr std::string_view kToken = "<UDIM>";
    std::string name = pattern.string();
    const size_t place = name.rfind(kToken);
    return place == std::string::npos ? name : name.replace(place, kToken.size(), std::to_string(udim));
}

LoadedInput load_input(const SceneInput& input) {
    LoadedInput loaded;
    if (is_mesh_file(input.file)) {
        loaded.scene = load_mesh_scene(input.file, input.mesh);
        loaded.meshes = share_meshes(loaded.scene.meshes);
        loaded.doubts = list_doubts(loaded.scene);
        return loaded;
    }
    if (input.file.extension() != ".json") {
        refuse_foreign_file(input.file);
        throw Error(ErrorKind::usage, {"this is neither a scene nor a mesh", input.file.string(),
                                       "a map goes with its mesh: relief view MESH --vdm MAP"});
    }
    loaded.shot = std::make_shared<ShotReader>(input.file, input.mesh.reader);
    loaded.frames = loaded.shot->frames();
    loaded.frame = input.frame.value_or(loaded.frames.empty() ? 1 : std::ranges::min(loaded.frames));
    ShotFrame first = loaded.shot->read(loaded.frame);
    loaded.scene = std::move(*first.scene);
    loaded.meshes = std::move(first.meshes);
    loaded.content = first.content;
    if (!loaded.shot->is_animated()) loaded.shot.reset(), loaded.content = 0; // it holds all textures
    loaded.doubts = list_doubts(loaded.scene);
    return loaded;
}

const Mesh* find_mesh(const Scene& scene, size_t displacement) {
    for (const Object& object : scene.objects)
        if (object.displacement == displacement) return &scene.meshes[object.mesh];
    return nullptr;
}

Document::Document(SceneInput input, LoadedInput loaded)
    : input_(std::move(input)),
      scene_(std::move(loaded.scene)),
      meshes_(std::move(loaded.meshes)),
      content_(loaded.content),
      doubts_(std::move(loaded.doubts)) {
    if (meshes_.size() != scene_.meshes.size()) meshes_ = share_meshes(scene_.meshes);
    if (loaded.shot) input_.frame = loaded.frame;
    make_names_distinct(scene_.displacements);
    note_read_maps();
}

void Document::touch() {
    ++version_;
    has_changes_ = true;
}

std::shared_ptr<const SharedScene> Document::snapshot() {
    commit();
    std::vector<Mesh> meshes = std::exchange(scene_.meshes, {}); // to be left out of the copy
    auto shared = std::make_shared<const SharedScene>(SharedScene{scene_, meshes_});
    scene_.meshes = std::move(meshes);
    return shared;
}

SceneValue Document::change_displacement(size_t index, const std::function<void(Displacement&)>& change) {
    Displacement& map = scene_.displacements.at(index);
    const Displacement before = map;
    const SceneValue value{index, get_meaning(before), changed_.of(before, index)};
    change(map);
    map.assumed = {};
    changed_.note(before, map, read_maps_.at(index));
    doubts_.clear();
    changes_.displacements.insert(map.name);
    touch();
    return value;
}

void Document::note_preset(size_t displacement, const std::string& preset) {
    presets_[scene_.displacements.at(displacement).name] = preset;
}

std::string Document::find_preset(size_t displacement) const {
    const Displacement& map = scene_.displacements.at(displacement);
    const auto chosen = presets_.find(map.name);
    return viewer::find_preset(map, chosen == presets_.end() ? input_.mesh.map.preset : chosen->second);
}

SceneValue Document::change_material(size_t index, const std::function<void(Material&)>& change) {
    Material& material = scene_.materials.at(index);
    const Material before = material;
    const SceneValue value{index, before, changed_.of(before, index)};
    change(material);
    changed_.note(before, material);
    changes_.materials.insert(material.name);
    touch();
    return value;
}

std::optional<SceneValue> Document::change_environment(const std::function<void(Environment&)>& change) {
    if (!scene_.environment) return std::nullopt;
    const Environment before = *scene_.environment;
    const SceneValue value{0, before, changed_.of(before, 0)};
    change(*scene_.environment);
    changed_.note(before, *scene_.environment);
    touch();
    return value;
}

SceneValue Document::change_light(size_t index, const std::function<void(Light&)>& change) {
    const Light before = scene_.lights.at(index);
    const SceneValue value{index, before, changed_.of(before, index)};
    change(scene_.lights[index]);
    changed_.note(index, before, scene_.lights[index]);
    touch();
    return value;
}

void Document::load_environment(const std::filesystem::path& file) {
    const Environment before = scene_.environment.value_or(Environment());
    Environment sky = before;
    sky.texture = std::make_shared<const Texture>(read_texture(file));
    if (is_mesh_file(input_.file)) {
        place_light(std::move(sky));
        input_.mesh.environment = file;
    } else {
        scene_.environment = std::move(sky);
    }
    changed_.note(before, *scene_.environment);
    changes_.environment = file;
    touch();
}

/// Changes nothing where it throws.
void Document::place_light(Environment sky) {
    Scene lit;
    lit.objects = scene_.objects, lit.materials = scene_.materials;
    lit.displacements = scene_.displacements, lit.environment = std::move(sky);
    lit.meshes = std::move(scene_.meshes);
    std::exception_ptr error;
    try {
        complete_mesh_scene(lit);
    } catch (...) {
        error = std::current_exception();
    }
    scene_.meshes = std::move(lit.meshes);
    if (error) std::rethrow_exception(error);
    scene_.environment = std::move(lit.environment), scene_.lights = std::move(lit.lights);
}

Texture& Document::paint_tile(size_t displacement, int udim) {
    Displacement& map = scene_.displacements.at(displacement);
    if (map.dequantize)
        throw Error(ErrorKind::usage,
                    {"a map that is dequantised cannot be painted on",
                     fmt::format("displacement '{}'", map.name), "convert it with dequantize first"});
    const Texture* const held = find_map_tile(map, udim).texture.get();
    std::unique_ptr<Texture>& texels = painted_[held];
    if (!texels) texels = std::make_unique<Texture>(*held);
    uncommitted_.insert(held);
    ++paint_count_;
    for (const Displacement& other : scene_.displacements)
        for (const MapTile& tile : other.tiles)
            if (tile.texture.get() == held) painted_maps_.insert(other.name), unsaved_.insert(other.name);
    has_changes_ = true;
    return *texels;
}

void Document::commit() {
    for (const TileKey held : std::exchange(uncommitted_, {})) {
        auto node = painted_.extract(held);
        const auto texture = std::make_shared<const Texture>(*node.mapped());
        for (Displacement& map : scene_.displacements)
            for (MapTile& tile : map.tiles)
                if (tile.texture.get() == held) tile.texture = texture;
        node.key() = texture.get();
        painted_.insert(std::move(node));
    }
}

bool Document::replace_tile(size_t displacement, int udim, Texture texels) {
    const std::shared_ptr<const Texture> held =
        find_map_tile(scene_.displacements.at(displacement), udim).texture;
    if (texels.width != held->width || texels.height != held->height ||
        texels.channel_count != held->channel_count || texels.stride != held->stride ||
        texels.halves.empty() != held->halves.empty())
        return false;
    painted_.erase(held.get());
    uncommitted_.erase(held.get());
    const auto texture = std::make_shared<const Texture>(std::move(texels));
    for (Displacement& map : scene_.displacements)
        for (MapTile& tile : map.tiles)
            if (tile.texture == held) tile.texture = texture;
    return true;
}

bool Document::may_write(const std::filesystem::path& pattern, const Displacement& map) const {
    std::error_code ignored;
    return std::ranges::all_of(map.tiles, [&](const MapTile& tile) {
        const std::filesystem::path file = name_tile(pattern, tile.udim);
        const auto written = written_.find(file);
        if (written == written_.end()) return !std::filesystem::exists(file, ignored);
        return written->second == name_source(*read_.at({map.name, tile.udim}));
    });
}

void Document::note_written(const std::filesystem::path& pattern, const Displacement& map) {
    for (const MapTile& tile : map.tiles)
        written_[name_tile(pattern, tile.udim)] = name_source(*read_.at({map.name, tile.udim}));
}

std::filesystem::path Document::name_painted(const Displacement& map,
                                             const std::filesystem::path& scene_file) const {
    const auto is_of_another = [&](const std::filesystem::path& file) {
        return std::ranges::any_of(changes_.maps, [&](const auto& saved) {
            return saved.first != map.name && saved.second == file;
        });
    };
    const std::string base = scene_file.stem().string() + "_" + make_stem(map.name);
    const char* const token = map.is_udim ? ".<UDIM>" : "";
    std::filesystem::path file = scene_file;
    file.replace_filename(fmt::format("{}{}.exr", base, token));
    for (int k = 2; is_of_another(file) || !may_write(file, map); ++k)
        file.replace_filename(fmt::format("{}-{}{}.exr", base, k, token));
    return file;
}

std::filesystem::path Document::save_painted(const Displacement& map,
                                             const std::filesystem::path& scene_file) {
    const std::filesystem::path file = name_painted(map, scene_file);
    const bool has_halves =
        std::ranges::all_of(map.tiles, [](const MapTile& t) { return !t.texture->halves.empty(); });
    write_map(map, file, has_halves ? MapSamples::float16 : MapSamples::float32);
    note_written(file, map);
    return file;
}

std::vector<std::filesystem::path> Document::save(const std::filesystem::path& file,
                                                  const ImageSettings& image) {
    commit();
    std::vector<std::filesystem::path> written;
    if (file.extension() != ".json")
        throw Error(ErrorKind::usage,
                    {"a scene file has the extension .json", file.string(), file.stem().string() + ".json"});
    std::error_code ignored;
    if (std::filesystem::equivalent(file, input_.file, ignored))
        throw Error(ErrorKind::usage, {"the file that was opened would be written over", file.string(),
                                       "name another one to write"});
    for (const Displacement& map : scene_.displacements) {
        if (!painted_maps_.contains(map.name)) continue;
        changes_.maps[map.name] = save_painted(map, file);
        written.push_back(changes_.maps[map.name]);
    }
    Scene scene = scene_;
    if (input_.frame) changes_.frame = *input_.frame;
    scene.picture = {image.width, image.height, image.spp, image.bounces, image.seed, scene.picture.fps};
    save_scene_copy(scene, input_.file, input_.mesh, file, {}, changes_);
    written.push_back(file);
    has_changes_ = false, is_saved_ = true;
    unsaved_.clear();
    return written;
}

void Document::save_map(size_t displacement, const std::filesystem::path& file, const Displacement& to) {
    commit();
    const Displacement& map = scene_.displacements.at(displacement);
    if (!may_write(file, map))
        throw Error(ErrorKind::usage, {"a file that is there would be written over", file.string(),
                                       "name another one to write"});
    write_map(convert_map(map, to, find_mesh(scene_, displacement)), file, MapSamples::float32);
    note_written(file, map);
    unsaved_.erase(map.name);
}

} // namespace relief::viewer
