// Scenes that move, written and read again.
#include <memory>
#include <utility>

#include "io/scene_files.h"
#include "math/affine.h"
#include "math/vec.h"
#include "relief/shot.h"

namespace relief {

namespace {

std::shared_ptr<const Texture> make_map(float value) {
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 1;
    texture->channel_count = 3;
    texture->floats = {value, 0, 0, 1};
    return texture;
}

class ShotWriter : public SceneFiles {
  protected:
    ShotWriter()
        : scene_(parse(R"({"camera": {"shutter": [-0.5, 0.25]}, "render": {"fps": 25},
            "displacements": {"w": {"type": "vector", "file": "map.exr"}}, "meshes": {"plane": {"file": "plane.obj"}},
            "objects": [{"name": "sea", "mesh": "plane", "displacement": "w"}, {"name": "boat", "mesh": "plane"}]})")) {
        motion_.first_frame = 7;
        motion_.frame_count = 3;
        for (int k = 0; k < 3; ++k) {
            const auto f = float(k);
            motion_.objects["boat"].push_back({{f, 2 * f, 0}, {0, 10 * f, 0}, {2, 2, 2}});
            motion_.maps["w"].push_back(make_map(f + 1));
        }
        motion_.views = {{7, {0, 0, 5}, {0, 0, 0}}, {9, {2, 0, 5}, {0, 0, 0}}};
    }

    Scene scene_;
    SceneMotion motion_;
};

TEST_F(ShotWriter, makes_keys_and_numbered_files) {
    save_shot(scene_, motion_, folder_ / "out");
    Shot shot(folder_ / "out" / "scene.json");
    EXPECT_EQ(shot.frames(), (std::vector<int>{7, 8, 9}));
    const Scene second = shot.load(8);
    EXPECT_EQ(second.displacements[0].tiles[0].texture->floats[0], 2);
    EXPECT_EQ(second.objects[1].world_from_object.translation, (Vec3f{1, 2, 0}));
    const Affine turned = make_rotation_degrees({0, 10, 0});
    for (size_t row = 0; row < 3; ++row)
        EXPECT_LT(length(second.objects[1].world_from_object.rows[row] - turned.rows[row] * 2.0f), 1e-6f);
    EXPECT_EQ(second.objects[0].world_from_object, Affine{});
    EXPECT_EQ(second.camera.from.x, 1);
    EXPECT_EQ(second.camera.shutter_open, -0.5f);
    EXPECT_EQ(second.camera.shutter_close, 0.25f);
    EXPECT_EQ(second.picture.fps, 25);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "maps" / "w.exr")) << "no frame reads it";
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "maps" / "w.0009.exr"));
}

TEST_F(ShotWriter, refuses_motion_of_nothing) {
    const auto message = [&](const SceneMotion& motion) {
        return message_of([&] { save_shot(scene_, motion, folder_ / "out"); }, ErrorKind::usage);
    };
    SceneMotion short_one = motion_;
    short_one.maps["w"].pop_back();
    EXPECT_HAS(message(short_one), "displacement 'w'");
    EXPECT_HAS(message(short_one), "2 values for 3 frames");
    SceneMotion unknown = motion_;
    unknown.objects["ship"] = unknown.objects["boat"];
    EXPECT_HAS(message(unknown), "object 'ship'");
    SceneMotion empty = motion_;
    empty.maps["w"][1] = nullptr;
    EXPECT_HAS(message(empty), "a map is missing");
}

} // namespace

} // namespace relief
