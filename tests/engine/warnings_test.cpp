// What a scene is warned of when it is prepared.
#include <gtest/gtest.h>

#include "engine/prepared_scene.h"
#include "support/bodies.h"

namespace relief {
namespace {

std::vector<std::string> prepare_with_crease(float sharpness, int level, CreaseRule rule) {
    Scene scene = test::make_body_scene(
        test::make_torus(4, 6),
        test::make_displacement(test::make_random_map(8, 8, 0.1f, 1), DisplacementSpace::object));
    scene.meshes[0].creases = {{0, 1, sharpness}, {1, 2, kInfiniteSharpness}};
    scene.meshes[0].subdivision.scheme = SubdivisionScheme::catmark;
    scene.meshes[0].subdivision.level = level;
    scene.meshes[0].subdivision.creases = rule;
    return prepare_scene(std::move(scene), {})->warnings;
}

TEST(Warnings, name_the_level_that_shows_a_semi_sharp_crease_as_it_is) {
    const std::vector<std::string> warnings = prepare_with_crease(2.5f, 2, CreaseRule::obey);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("sharpness 2.5"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find("level 3 shows"), std::string::npos) << warnings[0];
    EXPECT_TRUE(prepare_with_crease(2.5f, 3, CreaseRule::obey).empty());
    EXPECT_TRUE(prepare_with_crease(2.5f, 2, CreaseRule::ignore).empty());
    EXPECT_TRUE(prepare_with_crease(0, 0, CreaseRule::obey).empty());
    EXPECT_NE(prepare_with_crease(9, 1, CreaseRule::obey)[0].find("10 makes"), std::string::npos);
}

} // namespace
} // namespace relief
