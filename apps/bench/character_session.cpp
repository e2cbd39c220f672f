#include "bench/character_session.h"

#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "relief/io.h"
#include "relief/session.h"

namespace relief::bench {

namespace {

using Clock = std::chrono::steady_clock;

double get_seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

Camera turn(Camera camera, float degrees) {
    const float angle = degrees * std::numbers::pi_v<float> / 180, c = std::cos(angle), s = std::sin(angle);
    const float x = camera.from.x - camera.to.x, z = camera.from.z - camera.to.z;
    camera.from.x = camera.to.x + c * x + s * z;
    camera.from.z = camera.to.z - s * x + c * z;
    return camera;
}

void replace_map(Displacement& map, const std::filesystem::path& pattern) {
    for (MapTile& tile : map.tiles) {
        std::string file = pattern.string();
        if (const size_t token = file.find("<UDIM>"); token != std::string::npos)
            file.replace(token, 6, std::to_string(tile.udim));
        tile.texture = std::make_shared<Texture>(read_texture(file));
    }
}

/// The scene as it is then; its meshes stay as they were.
SceneUpdate make_update(const Scene& scene) {
    SceneUpdate update{.scene = scene, .camera = scene.camera};
    for (Mesh& mesh : update.scene->meshes) {
        Mesh same;
        same.name = mesh.name;
        mesh = std::move(same);
    }
    return update;
}

} // namespace

Measures run_character_session(const CharacterInput& input, const CharacterTask& task) {
    Scene scene = load_scene(input.scene);
    RenderSettings settings;
    settings.image.width = task.width, settings.image.height = task.height;
    settings.image.spp = task.samples, settings.image.bounces = task.bounces;
    settings.device.threads = task.threads;
    Measures measures;
    Clock::time_point start = Clock::now();
    Session session(scene, settings, SessionUse::scenes);
    session.render();
    measures["first_s"] = get_seconds_since(start);

    scene.camera = turn(scene.camera, kSessionTurnDegrees);
    start = Clock::now();
    session.change_view(scene.camera, settings.image);
    session.render();
    measures["turned_s"] = get_seconds_since(start);

    Object& object = scene.objects.at(0);
    Vec3f& place = object.world_from_object.translation;
    place = {place.x + input.move.x, place.y + input.move.y, place.z + input.move.z};
    start = Clock::now();
    session.change_scene(make_update(scene), settings.image);
    session.render();
    measures["moved_s"] = get_seconds_since(start);

    if (input.changed_map.empty()) return measures;
    start = Clock::now();
    replace_map(scene.displacements.at(object.displacement), input.changed_map);
    session.change_scene(make_update(scene), settings.image);
    session.render();
    measures["changed_s"] = get_seconds_since(start);
    return measures;
}

} // namespace relief::bench
