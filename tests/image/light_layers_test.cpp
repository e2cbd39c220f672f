#include "image/light_layers.h"

#include <gtest/gtest.h>

#include "relief/scene.h"

namespace relief {
namespace {

TEST(LightGroupNames, have_letters_digits_and_two_signs) {
    for (const char* name : {"key", "Key_2", "sky-dome", "0", "default"})
        EXPECT_TRUE(is_light_group_name(name));
    for (const char* name : {"", "a b", "a.R", "a,b", "k\xc3\xa4y"}) EXPECT_FALSE(is_light_group_name(name));
    EXPECT_TRUE(is_light_group_name(std::string(kMaxLightGroupName, 'a')));
    EXPECT_FALSE(is_light_group_name(std::string(kMaxLightGroupName + 1, 'a')));
}

TEST(LightLayerNames, are_told_from_others_and_sorted) {
    const std::vector<std::string> layers{"depth",     "light_rim", "emission",
                                          "light_key", "light_rim", "light_"};
    const LightLayers found = find_light_layers(layers);
    EXPECT_TRUE(found.has_kinds);
    EXPECT_EQ(found.groups, (std::vector<std::string>{"key", "rim"}));
    EXPECT_EQ(found.count(), 10u);
    EXPECT_EQ(find_light_layers(std::vector<std::string>{"depth", "N"}).count(), 0u);
    EXPECT_EQ(find_light_layers(std::vector<std::string>{"light_a"}).count(), 1u);
    EXPECT_EQ(find_group_of_layer("light_key"), "key");
    EXPECT_EQ(find_group_of_layer("highlight_key"), "");
}

} // namespace
} // namespace relief
