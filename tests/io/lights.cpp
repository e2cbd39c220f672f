// Lights of scene files: read, refused, written.
#include "io/scene/scene_reader.h"
#include "io/test_files.h"
#include "relief/half.h"
#include "relief/io.h"

namespace relief {

class LightFiles : public FileTest {
  protected:
    LightFiles() {
        write("plane.obj", kQuadObj);
        write_pixels<uint8_t>("shown.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {128, 128, 128});
    }
    Scene parse(const std::string& text) const { return parse_scene(text, folder_, "s.json"); }
    std::string error_of(const std::string& text) const {
        return message_of([&] { parse(text); });
    }
};

TEST_F(LightFiles, lights_of_all_types_are_read_and_written) {
    Scene scene = parse(R"({"meshes": {"plane": {"file": "plane.obj"}}, "objects": [{"mesh": "plane"},
        {"mesh": "plane", "name": "other"}],
      "lights": [{"type": "rectangle", "position": [1, 2, 3], "direction": [1, 0, 0], "up": [0, 0, 2],
        "width": 4, "height": 0.5, "strength": 7, "color": [1, 0.5, 0], "visible_to_camera": true,
        "light_link_includes": ["plane", "other"], "light_link_excludes": ["other"]},
      {"type": "disk", "position": [3, 2, 1], "direction": [0, 1, 0], "radius": 0.25},
      {"type": "spot", "position": [0, 5, 0], "direction": [0, -1, 1], "angle_degrees": 30, "blend": 0.2,
        "radius": 0.1, "visible_to_camera": true},
      {"type": "sun", "visible_to_camera": true}, {"type": "rectangle"}, {"type": "disk"},
      {"type": "spot"}, {"type": "point"},
      {"type": "disk", "up": [0, 0, 1], "color_texture": "shown.png"}]})");
    for (int round = 0; round < 3; ++round) {
        ASSERT_EQ(scene.lights.size(), 9u);
        ASSERT_TRUE(scene.lights[8].color_texture);
        EXPECT_EQ(scene.lights[8].up, (Vec3f{0, 0, 1}));
        const Texture& shown = *scene.lights[8].color_texture;
        EXPECT_NEAR(shown.halves.empty() ? shown.floats[0] : half_to_float(shown.halves[0]), 0.2158f, 1e-3f)
            << "decoded from sRGB";
        const Light &rectangle = scene.lights[0], &disk = scene.lights[1], &spot = scene.lights[2];
        EXPECT_EQ(rectangle.type, LightType::rectangle);
        EXPECT_EQ(rectangle.position, (Vec3f{1, 2, 3}));
        EXPECT_EQ(rectangle.direction, (Vec3f{1, 0, 0}));
        EXPECT_EQ(rectangle.up, (Vec3f{0, 0, 2}));
        EXPECT_EQ(rectangle.width, 4);
        EXPECT_EQ(rectangle.height, 0.5f);
        EXPECT_EQ(rectangle.strength, 7);
        EXPECT_EQ(rectangle.color, (Vec3f{1, 0.5f, 0}));
        EXPECT_EQ(disk.type, LightType::disk);
        EXPECT_EQ(disk.position, (Vec3f{3, 2, 1}));
        EXPECT_EQ(disk.direction, (Vec3f{0, 1, 0}));
        EXPECT_EQ(disk.radius, 0.25f);
        EXPECT_EQ(spot.type, LightType::spot);
        EXPECT_EQ(spot.position, (Vec3f{0, 5, 0}));
        EXPECT_EQ(spot.direction, (Vec3f{0, -1, 1}));
        EXPECT_EQ(spot.cone_degrees, 30);
        EXPECT_EQ(spot.blend, 0.2f);
        EXPECT_EQ(spot.radius, 0.1f);
        for (size_t k = 0; k < 8; ++k)
            EXPECT_EQ(scene.lights[k].is_visible_to_camera, k == 0 || k == 2 || k == 3) << k;
        EXPECT_EQ(rectangle.link_includes, (std::vector<std::string>{"plane", "other"}));
        EXPECT_EQ(rectangle.link_excludes, std::vector<std::string>{"other"});
        EXPECT_TRUE(disk.link_includes.empty() && disk.link_excludes.empty());
        EXPECT_EQ(scene.lights[4].width, 1);
        EXPECT_EQ(scene.lights[5].radius, 0.5f);
        EXPECT_EQ(scene.lights[6].cone_degrees, 45);
        // The same again, written in both ways and read.
        if (round == 0) save_scene(scene, folder_ / "lit");
        if (round == 1)
            save_scene_copy(scene, folder_ / "lit" / "scene.json", {}, folder_ / "lit" / "copy.json");
        if (round < 2) scene = load_scene(folder_ / "lit" / (round == 0 ? "scene.json" : "copy.json"));
    }
}

TEST_F(LightFiles, groups_of_all_that_shines_are_read_and_written) {
    Scene scene = parse(R"({"meshes": {"plane": {"file": "plane.obj"}},
      "materials": {"lamp": {"emission": [1, 1, 1], "light_group": "practical"}, "wall": {}},
      "objects": [{"mesh": "plane", "material": "lamp"}], "environment": {"light_group": "sky"},
      "lights": [{"type": "sun", "light_group": "key"}, {"type": "point", "light_group": "rim-2"},
        {"type": "rectangle", "light_group": "a"}, {"type": "disk", "light_group": "b"},
        {"type": "spot", "light_group": "c"}, {"type": "point"}]})");
    for (int round = 0; round < 2; ++round) {
        EXPECT_EQ(scene.environment->light_group, "sky");
        EXPECT_EQ(scene.materials.at(0).light_group, "practical");
        EXPECT_EQ(scene.materials.at(1).light_group, "");
        std::string groups;
        for (const Light& light : scene.lights) groups += light.light_group + ";";
        EXPECT_EQ(groups, "key;rim-2;a;b;c;;");
        save_scene(scene, folder_ / "lit");
        scene = load_scene(folder_ / "lit" / "scene.json");
    }
    EXPECT_HAS(error_of(R"({"lights": [{"type": "sun", "light_group": "a b"}]})"),
               "lights[0].light_group: 'a b' is no name of a light group");
    EXPECT_HAS(error_of(R"({"materials": {"m": {"light_group": ""}}})"), "1 to 64 letters");
    EXPECT_HAS(error_of(R"({"environment": {"light_group": 3}})"), "environment.light_group");
    EXPECT_HAS(error_of(R"({"environment": {"lightgroup": "a"}})"), "did you mean 'light_group'?");
}

TEST_F(LightFiles, wrong_lights_are_refused_and_others_count_in_the_hash) {
    const auto of_light = [&](const std::string& keys) {
        return error_of(R"({"lights": [{)" + keys + "}]}");
    };
    EXPECT_HAS(of_light(R"("type": "rectangel")"), "did you mean 'rectangle'?");
    EXPECT_HAS(of_light(R"("type": "rectangle", "radius": 1)"), "unknown key 'radius'");
    EXPECT_HAS(of_light(R"("type": "disk", "widht": 1)"), "unknown key 'widht'");
    EXPECT_HAS(of_light(R"("type": "rectangle", "width": 0)"), "lights[0].width: must be in");
    EXPECT_HAS(of_light(R"("type": "disk", "radius": 0)"), "lights[0].radius: must be in");
    EXPECT_HAS(of_light(R"("type": "disk", "direction": [0, 0, 0])"), "the direction has no length");
    EXPECT_HAS(of_light(R"("type": "rectangle", "up": [0, 0, 0])"), "the up has no length");
    EXPECT_HAS(of_light(R"("type": "spot", "angle_degrees": 200)"), "lights[0].angle_degrees: must be in");
    EXPECT_HAS(of_light(R"("type": "spot", "blend": 2)"), "lights[0].blend: must be in");
    EXPECT_HAS(of_light(R"("type": "sun", "visible_to_camera": 1)"), "lights[0].visible_to_camera");
    EXPECT_HAS(of_light(R"("type": "point", "visible_to_camera": true)"), "cannot be seen");
    EXPECT_HAS(of_light(R"("type": "sun", "light_link_includes": [])"), "leave it out to light all objects");
    EXPECT_HAS(of_light(R"("type": "sun", "light_link_includes": [1])"), "lights[0].light_link_includes[0]");
    EXPECT_HAS(error_of(R"({"meshes": {"plane": {"file": "plane.obj"}}, "objects": [{"mesh": "plane"}],
      "lights": [{"type": "disk", "light_link_excludes": ["plain"]}]})"),
               "light_link_excludes names no object: 'plain'");
    EXPECT_HAS(of_light(R"("type": "disk", "up": [0, 0, 1])"), "turns the texture of a disk");
    EXPECT_HAS(of_light(R"("type": "spot", "color_texture": "shown.png")"), "unknown key 'color_texture'");
    EXPECT_HAS(of_light(R"("type": "disk", "color_texture": "absent.png")"), "absent.png");
    const auto hash = [&](const std::string& keys) { return parse(R"({"lights": [{)" + keys + "}]}").hash; };
    EXPECT_NE(hash(R"("type": "disk")"), hash(R"("type": "disk", "visible_to_camera": true)"));
    const uint64_t with_texture = hash(R"("type": "disk", "color_texture": "shown.png")");
    write_pixels<uint8_t>("shown.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {128, 127, 128});
    EXPECT_NE(hash(R"("type": "disk", "color_texture": "shown.png")"), with_texture);
}

} // namespace relief
