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

namespace {

/// Patches of a surface up to which the points of its lines are kept while levels are chosen: 76 MB.
constexpr uint32_t kMostShared = 1 << 16;
/// Patches of all objects up to which their lines are kept for views to come: 200 MB.
constexpr uint64_t kMostMeasured = 1 << 20;

/// Per surface: the points of its lines, where several objects need them.
std::vector<std::vector<LinePoints>> share_points(const PreparedScene& scene) {
    std::vector<uint32_t> users(scene.surfaces.size());
    for (const Instance& instance : scene.instances)
        if (!instance.lines) ++users[instance.surface];
    std::vector<std::vector<LinePoints>> points(scene.surfaces.size());
    for (size_t k = 0; k < points.size(); ++k)
        if (scene.levels.fixed_level < 0 && users[k] > 1 && scene.surfaces[k].patch_count() <= kMostShared)
            points[k] = list_line_points(scene.surfaces[k]);
    return points;
}

LevelField make_levels(const PreparedScene& scene, const Instance& instance,
                       std::span<const LinePoints> points) {
    const Surface& surface = scene.surfaces[instance.surface];
    if (instance.lines) return LevelField::choose(surface, *instance.lines, scene.levels);
    return points.empty() ? LevelField::compute(surface, instance.world_from_object, scene.levels)
                          : LevelField::compute(surface, points, instance.world_from_object, scene.levels);
}

bool measures_lines(const PreparedScene& scene, ViewsToCome views) {
    if (views != ViewsToCome::many || scene.levels.fixed_level >= 0) return false;
    uint64_t patches = 0;
    for (const Instance& instance : scene.instances)
        patches += scene.surfaces[instance.surface].patch_count();
    return patches <= kMostMeasured;
}

} // namespace

void update_scene_levels(PreparedScene& scene, const RenderSettings& settings, ViewsToCome views) {
    scene.levels = make_level_config(scene.camera, settings);
    if (measures_lines(scene, views))
        parallel_for("lines", scene.instances.size(), 1, [&](size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k) {
                Instance& instance = scene.instances[k];
                if (!instance.lines)
                    instance.lines = std::make_shared<const std::vector<PatchLines>>(
                        measure_lines(scene.surfaces[instance.surface], instance.world_from_object));
            }
        });
    const std::vector<std::vector<LinePoints>> points = share_points(scene);
    parallel_for("level_fields", scene.instances.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            Instance& instance = scene.instances[k];
            instance.levels =
                std::make_shared<const LevelField>(make_levels(scene, instance, points[instance.surface]));
        }
    });
}

} // namespace relief
