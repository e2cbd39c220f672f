// Levels of many objects that show one surface.
#include <gtest/gtest.h>

#include "math/affine.h"
#include "prepare/scene_levels.h"
#include "support/bodies.h"
#include "surface/patch/level_field.h"

namespace relief {
namespace {

TEST(SharedLines, objects_of_one_surface_have_the_levels_that_each_has_alone) {
    Scene scene = test::make_body_scene(
        test::make_cube_sphere(4),
        test::make_displacement(test::make_random_map(64, 48, 0.1f, 3), DisplacementSpace::tangent));
    const Object object = scene.objects[0];
    for (int k = 1; k < 12; ++k) {
        scene.objects.push_back(object);
        const float size = 0.3f + 0.2f * float(k);
        scene.objects.back().world_from_object = make_scale({size, 1, k % 2 == 0 ? size : -0.4f});
        scene.objects.back().world_from_object.translation = {float(3 * k), float(k % 3), float(-k)};
    }
    scene.camera.from = {0, 2, 5};
    const auto prepared = prepare_scene(scene, make_small_settings(256, 1, 0));
    size_t different = 0;
    for (const Instance& instance : prepared->instances) {
        const Surface& surface = prepared->surfaces[instance.surface];
        EXPECT_TRUE(*instance.levels ==
                    LevelField::compute(surface, instance.world_from_object, prepared->levels));
        different += !(*instance.levels == *prepared->instances[0].levels);
    }
    EXPECT_GT(different, 6u);
}

} // namespace
} // namespace relief
