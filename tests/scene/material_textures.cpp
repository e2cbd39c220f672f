// Textures of the inputs of materials made in memory.
#include <memory>

#include <gtest/gtest.h>

#include "relief/scene.h"
#include "support/input_textures.h"

namespace relief {
namespace {

TEST(MaterialTextures, are_set_replaced_and_removed_by_input) {
    const auto first = std::make_shared<const Texture>(), second = std::make_shared<const Texture>();
    Material material;
    set_input_texture(material, MaterialInput::opacity, first);
    set_input_texture(material, MaterialInput::normal, first, MapFilter::cubic);
    EXPECT_TRUE(is_cut_out(material));
    EXPECT_TRUE(has_normal_map(material));
    EXPECT_EQ(material.textures.size(), 2u);
    EXPECT_EQ(test::get_filter(material, MaterialInput::opacity), MapFilter::none);
    EXPECT_EQ(test::get_filter(material, MaterialInput::normal), MapFilter::cubic);

    material.textures[0].uv_scale = {2, 2};
    set_input_texture(material, MaterialInput::opacity, second);
    ASSERT_EQ(material.textures.size(), 2u);
    EXPECT_EQ(test::get_texture(material, MaterialInput::opacity), second);
    EXPECT_EQ(find_input_texture(material, MaterialInput::opacity)->uv_scale, (Vec2f{1, 1}));
    EXPECT_EQ(find_input_texture(material, MaterialInput::opacity)->tiles[0].udim, 1001);

    set_input_texture(material, MaterialInput::opacity, nullptr);
    set_input_texture(material, MaterialInput::coat_weight, nullptr);
    ASSERT_EQ(material.textures.size(), 1u);
    EXPECT_FALSE(is_cut_out(material));
    EXPECT_EQ(find_input_texture(material, MaterialInput::opacity), nullptr);
    EXPECT_TRUE(has_normal_map(material));
}

} // namespace
} // namespace relief
