// Scenes whose meshes and pictures are in memory are those of the same files.
#include <memory>
#include <string>
#include <vector>

#include "io/scene_files.h"
#include "relief/io.h"
#include "relief/shot.h"
#include "support/input_textures.h"

namespace relief {

namespace {

constexpr const char* kText =
    R"({"materials": {"m": {"base_color_texture": "paint", "roughness_texture": {"file": "paint",
    "channel": "g"}}}, "displacements": {"d": {"file": "map", "space": "object", "midlevel": 0}},
    "meshes": {"plane": {"file": "quad", "subdivision": {"scheme": "bilinear", "level": 2}}},
    "environment": {"file": "map"}, "objects": [{"mesh": "plane", "displacement": "d", "material": "m"}]})";

/// `text` with other names of files.
std::string rename(std::string text, const std::string& name, const std::string& by) {
    for (size_t at = 0; (at = text.find('"' + name + '"', at)) != std::string::npos; at += by.size())
        text.replace(at, name.size() + 2, '"' + by + '"');
    return text;
}

std::shared_ptr<const Texture> read(const std::filesystem::path& file) {
    return std::make_shared<const Texture>(read_texture(file));
}

} // namespace

TEST_F(SceneFiles, assets_in_memory_make_the_scene_of_their_files) {
    write_pixels<uint8_t>("paint.png", 2, 1, 3, OIIO::TypeDesc::UINT8, {255, 128, 0, 10, 20, 30});
    SceneAssets assets;
    assets.meshes["quad"] = load_mesh(folder_ / "plane.obj");
    assets.meshes["quad"].creases = {{0, 1, 2.5f}};
    assets.textures = {{"paint", read(folder_ / "paint.png")}, {"map", read(folder_ / "map.exr")}};
    const Scene made = parse_scene_text(kText, folder_, assets);
    const Scene filed =
        parse(rename(rename(rename(kText, "paint", "paint.png"), "map", "map.exr"), "quad", "plane.obj"));
    EXPECT_EQ(made.meshes[0].positions, filed.meshes[0].positions);
    EXPECT_EQ(made.meshes[0].creases, (std::vector<Crease>{{0, 1, 2.5f}}));
    EXPECT_EQ(made.meshes[0].subdivision.level, 2);
    EXPECT_EQ(made.meshes[0].name, "plane");
    EXPECT_EQ(test::get_texture(made.materials[0], MaterialInput::base_color)->floats,
              test::get_texture(filed.materials[0], MaterialInput::base_color)->floats);
    EXPECT_EQ(test::get_texture(made.materials[0], MaterialInput::roughness)->floats,
              test::get_texture(filed.materials[0], MaterialInput::roughness)->floats);
    EXPECT_EQ(made.displacements[0].tiles[0].texture, assets.textures["map"]) << "data are not copied";
    EXPECT_EQ(made.environment->texture->floats, filed.environment->texture->floats);
    EXPECT_EQ(made.warnings, filed.warnings);
    EXPECT_EQ(made.hash, parse_scene_text(kText, folder_, assets).hash);
    SceneAssets broken = assets;
    auto paint = std::make_shared<Texture>(*assets.textures["paint"]);
    paint->stride = 1;
    broken.textures["paint"] = paint;
    EXPECT_THROW(parse_scene_text(kText, folder_, broken), Error);
    assets.meshes["quad"].positions[0].x += 1;
    EXPECT_NE(made.hash, parse_scene_text(kText, folder_, assets).hash);
}

TEST_F(SceneFiles, tiles_in_memory_have_the_numbers_of_their_names) {
    SceneAssets assets;
    const auto map = read(folder_ / "map.exr");
    assets.textures = {{"hide.1002", map}, {"hide.1001", map}, {"hide.x", map}, {"hid.1003", map}};
    const Scene scene = parse_scene_text(
        R"({"displacements": {"d": {"file": "hide.<UDIM>", "space": "object", "midlevel": 0}}})", folder_,
        assets);
    ASSERT_EQ(scene.displacements[0].tiles.size(), 2u);
    EXPECT_TRUE(scene.displacements[0].is_udim);
    EXPECT_EQ(scene.displacements[0].tiles[0].udim, 1001);
    EXPECT_EQ(scene.displacements[0].tiles[1].udim, 1002);
}

TEST_F(SceneFiles, faults_of_assets_name_their_place) {
    const auto message = [&](const std::string& text, const SceneAssets& assets) {
        return message_of([&] { parse_scene_text(text, folder_, assets); });
    };
    SceneAssets assets;
    assets.meshes["quad"] = load_mesh(folder_ / "plane.obj");
    const std::string uv_set = R"({"meshes": {"a": {"file": "quad", "uv_set": 1}}})";
    EXPECT_NE(message(uv_set, assets).find("meshes.a.uv_set: is that of a file"), std::string::npos);
    const std::string twice = R"({"meshes": {"a": {"file": "quad"}, "b": {"file": "quad"}}})";
    EXPECT_NE(message(twice, assets).find("named twice"), std::string::npos);
    EXPECT_NE(message(R"({"meshes": {"a": {"file": "quat"}}})", assets).find("quat"), std::string::npos);
}

TEST_F(SceneFiles, a_scene_of_one_object_is_completed_as_a_mesh_alone_is) {
    const Scene alone = load_mesh_scene(folder_ / "plane.obj", {});
    SceneAssets assets;
    assets.meshes["quad"] = load_mesh(folder_ / "plane.obj");
    Scene scene = parse_scene_text(R"({"meshes": {"q": {"file": "quad"}}, "objects": [{"mesh": "q"}]})",
                                   folder_, assets);
    complete_mesh_scene(scene);
    EXPECT_EQ(scene.camera.from, alone.camera.from);
    EXPECT_EQ(scene.lights.at(0).direction, alone.lights.at(0).direction);
    EXPECT_EQ(scene.materials.at(scene.objects[0].material).base_color, alone.materials[0].base_color);
    scene.objects.push_back(scene.objects[0]);
    EXPECT_NE(message_of([&] { complete_mesh_scene(scene); }, ErrorKind::usage).find("2 objects"),
              std::string::npos);
}

TEST_F(SceneFiles, another_text_goes_on_with_the_pictures_of_the_last_one) {
    write_pixels<uint8_t>("paint.png", 2, 1, 3, OIIO::TypeDesc::UINT8, {255, 128, 0, 10, 20, 30});
    SceneAssets assets;
    assets.meshes["quad"] = load_mesh(folder_ / "plane.obj");
    assets.textures["map"] = read(folder_ / "map.exr");
    const std::string text = rename(kText, "paint", "paint.png");
    Shot shot(text, folder_, assets);
    const Scene first = shot.load(1);
    SceneAssets next;
    next.textures = assets.textures;
    next.kept_meshes["plane"] = hash_mesh(first.meshes[0]);
    shot.change_text(text, next);
    const Scene second = shot.load(1);
    EXPECT_EQ(test::get_texture(second.materials[0], MaterialInput::base_color),
              test::get_texture(first.materials[0], MaterialInput::base_color));
    EXPECT_EQ(second.displacements[0].tiles[0].texture, first.displacements[0].tiles[0].texture);
    EXPECT_EQ(second.meshes[0].name, "plane");
    EXPECT_TRUE(second.meshes[0].face_sizes.empty());
    EXPECT_EQ(second.hash, first.hash) << "it is the same scene";
    EXPECT_NE(message_of([&] { shot.change_text("{", next); }), "");
    EXPECT_EQ(shot.load(1).hash, first.hash) << "nothing has changed";

    write_pixels<uint8_t>("paint.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {1, 2, 3});
    next.textures["map"] = std::make_shared<Texture>(*assets.textures["map"]);
    shot.change_text(text, next);
    const Scene third = shot.load(1);
    EXPECT_EQ(test::get_texture(third.materials[0], MaterialInput::base_color)->width, 1u)
        << "the file has changed";
    EXPECT_EQ(third.displacements[0].tiles[0].texture, next.textures["map"]);
    EXPECT_NE(third.environment->texture, second.environment->texture) << "made of the map";
    EXPECT_NE(third.hash, first.hash);
}

} // namespace relief
