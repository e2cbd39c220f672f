#include "bench/character_inputs.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "relief/half.h"

namespace relief::bench {

namespace {

constexpr float kChange = 0.8f;     ///< of the displacement, of the changed map
constexpr float kMoveShare = 0.05f; ///< of the object's way, of the distance of the camera

/// The same image with displacements `kChange` times as long.
std::shared_ptr<const Texture> shorten(const Texture& image, const Vec3f& midlevel) {
    auto changed = std::make_shared<Texture>(image);
    const auto shorten_value = [&](float value, size_t channel) {
        const float middle[] = {midlevel.x, midlevel.y, midlevel.z};
        return channel < 3 ? middle[channel] + (value - middle[channel]) * kChange : value;
    };
    const size_t count = size_t(changed->stride) * changed->width * changed->height;
    for (size_t k = 0; k < std::min(count, changed->floats.size()); ++k)
        changed->floats[k] = shorten_value(changed->floats[k], k % changed->stride);
    for (size_t k = 0; k < std::min(count, changed->halves.size()); ++k)
        changed->halves[k] =
            float_to_half(shorten_value(half_to_float(changed->halves[k]), k % changed->stride));
    return changed;
}

std::filesystem::path write_changed_map(const Scene& scene, const std::filesystem::path& folder) {
    const uint32_t index = scene.objects.at(0).displacement;
    if (index == kNoIndex) return {};
    Displacement map = scene.displacements.at(index);
    for (MapTile& tile : map.tiles) tile.texture = shorten(*tile.texture, map.midlevel);
    const std::filesystem::path file = folder / (map.is_udim ? "changed.<UDIM>.exr" : "changed.exr");
    const bool is_half = !map.tiles.at(0).texture->halves.empty();
    write_map(map, file, is_half ? MapSamples::float16 : MapSamples::float32);
    return std::filesystem::absolute(file);
}

CharacterInput write_input(const std::string& name, const Scene& scene, const std::filesystem::path& folder) {
    const std::filesystem::path place = folder / name;
    save_scene(scene, place);
    const Camera& camera = scene.camera;
    const float way = kMoveShare * std::hypot(camera.from.x - camera.to.x, camera.from.y - camera.to.y,
                                              camera.from.z - camera.to.z);
    return {name, place / "scene.json", write_changed_map(scene, place), {way, 0, way}};
}

} // namespace

std::string name_character(const CharacterFile& file) { return file.mesh.filename().string(); }

CharacterInput write_character(const std::string& name, CharacterDetail detail,
                               const std::filesystem::path& folder) {
    return write_input(name, make_character_scene(name, detail), folder);
}

CharacterInput write_character(const CharacterFile& file, const std::filesystem::path& folder) {
    MeshSceneOptions options = file.options;
    options.subdivision = "catmark";
    Scene scene = load_mesh_scene(file.mesh, options);
    scene.lights.clear();
    scene.environment = make_character_sky();
    scene.materials = {make_character_material()};
    for (Object& object : scene.objects) object.material = 0;
    return write_input(name_character(file), scene, folder);
}

} // namespace relief::bench
