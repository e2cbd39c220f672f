// Light linking: from names of objects to sets of instances.
#include "prepare/light_links.h"

#include <gtest/gtest.h>

#include "relief/error.h"
#include "support/shading_scenes.h"

namespace relief {
namespace {

Scene make_crowd() {
    Scene scene;
    add_object(scene, make_floor(1), make_matte(0.5f));
    scene.objects[0].name = "";
    for (int k = 0; k < 70; ++k) {
        scene.objects.push_back(scene.objects[0]);
        scene.objects.back().name = k % 2 == 0 ? "even" : "odd";
    }
    scene.lights.resize(4);
    return scene;
}

bool is_lit(const LightLinks& links, size_t light, uint32_t instance) {
    return (links.words.at(links.first_word.at(light) + instance / 32) >> instance % 32 & 1) != 0;
}

TEST(LightLinks, are_bits_of_the_instances_that_have_a_name) {
    Scene scene = make_crowd();
    scene.lights[1].link_includes = {"even", "quad"}; // the first has its mesh's name
    scene.lights[2].link_excludes = {"odd"};
    scene.lights[3].link_includes = {"even", "odd"}, scene.lights[3].link_excludes = {"even"};
    const LightLinks links = make_light_links(scene);
    EXPECT_EQ(links.first_word.at(0), kNoIndex);
    EXPECT_EQ(links.first_word[1], links.first_word[2]) << "one set, said in two ways";
    EXPECT_EQ(links.words.size(), 2 * 3u);
    for (uint32_t k = 0; k < scene.objects.size(); ++k) {
        EXPECT_EQ(is_lit(links, 1, k), scene.objects[k].name != "odd") << k;
        EXPECT_EQ(is_lit(links, 3, k), scene.objects[k].name == "odd") << k;
    }
}

TEST(LightLinks, are_nothing_where_no_light_is_linked) {
    const LightLinks links = make_light_links(make_crowd());
    EXPECT_TRUE(links.first_word.empty());
    EXPECT_TRUE(links.words.empty());
}

TEST(LightLinks, to_objects_that_do_not_exist_are_refused) {
    Scene scene = make_crowd();
    scene.lights[2].link_excludes = {"quad", "evne"};
    try {
        validate_scene(scene);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.where(), "light 2");
        EXPECT_EQ(error.message(), "light_link_excludes names no object: 'evne'");
        EXPECT_EQ(error.hint(), "did you mean 'even'?");
    }
}

} // namespace
} // namespace relief
