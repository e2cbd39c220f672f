#include "prepare/scene_levels.h"

#include <cmath>
#include <numbers>

#include "base/parallel.h"

namespace relief {

LevelFieldConfig make_level_config(const Camera& camera, const RenderSettings& settings) {
    LevelFieldConfig config;
    config.fixed_level = settings.surface.level == kAutoLevel ? -1 : settings.surface.level;
    config.pixel_error = settings.surface.pixel_error;
    config.camera = camera.from;
    const int rows = settings.image.detail_height > 0 ? settings.image.detail_height : settings.image.height;
    config.pixel_angle = float(2 * std::tan(camera.fov_degrees * std::numbers::pi / 360) / rows);
    return config;
}

void update_scene_levels(PreparedScene& scene, const RenderSettings& settings, ViewsToCome views) {
    scene.levels = make_level_config(scene.camera, settings);
    const bool measures = views == ViewsToCome::many && scene.levels.fixed_level < 0;
    parallel_for("level_fields", scene.instances.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            Instance& instance = scene.instances[k];
            const Surface& surface = scene.surfaces[instance.surface];
            if (measures && !instance.lines)
                instance.lines = std::make_shared<const std::vector<PatchLines>>(
                    measure_lines(surface, instance.world_from_object));
            instance.levels = std::make_shared<const LevelField>(
                instance.lines ? LevelField::choose(surface, *instance.lines, scene.levels)
                               : LevelField::compute(surface, instance.world_from_object, scene.levels));
        }
    });
}

} // namespace relief
