#include "prepare/scene_levels.h"

#include <cmath>
#include <numbers>

#include "base/parallel.h"

namespace relief {

namespace {

LevelFieldConfig make_level_config(const Camera& camera, const RenderSettings& settings) {
    LevelFieldConfig config;
    config.fixed_level = settings.surface.level == kAutoLevel ? -1 : settings.surface.level;
    config.pixel_error = settings.surface.pixel_error;
    config.camera = camera.from;
    config.pixel_angle =
        float(2 * std::tan(camera.fov_degrees * std::numbers::pi / 360) / settings.image.height);
    return config;
}

} // namespace

void update_scene_levels(PreparedScene& scene, const RenderSettings& settings) {
    scene.levels = make_level_config(scene.camera, settings);
    parallel_for("level_fields", scene.instances.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            Instance& instance = scene.instances[k];
            instance.levels = std::make_shared<const LevelField>(LevelField::compute(
                scene.surfaces[instance.surface], instance.world_from_object, scene.levels));
        }
    });
}

} // namespace relief
