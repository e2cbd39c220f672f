#include "prepare/bounce_lod.h"

#include <algorithm>

namespace relief {

scalar::BounceLod make_bounce_lod(const PreparedScene& scene, const RenderSettings& settings) {
    const bool has_levels =
        settings.surface.level == kAutoLevel && settings.surface.lod == LodRule::field &&
        std::ranges::any_of(scene.surfaces, [](const Surface& s) { return s.has_displacement; });
    if (!has_levels || scene.may_enclose_camera || settings.surface.bounce_levels == BounceLevels::camera)
        return {};
    return {scene.levels.camera, scene.levels.pixel_error * scene.levels.pixel_angle};
}

} // namespace relief
