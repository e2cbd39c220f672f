// What differs in a scene from one time to the next, and what lies between two files of a sequence.
#include <algorithm>
#include <cmath>
#include <memory>

#include "io/scene_files.h"
#include "relief/half.h"
#include "relief/shot.h"

namespace relief {

namespace {

constexpr const char* kUpdatedScene = R"({"render": {"frames": "1-4", "fps": 24},
  "camera": {"from": {"keys": [[1, [0, 0, 5]], [5, [4, 0, 5]]]}, "to": [0, 0, 0]},
  "materials": {"clay": {"roughness": {"keys": [[2, 0.5], [3, 0.5], [4, 1]]}}},
  "displacements": {"ear": {"file": "map.exr", "type": "vector", "scale": {"keys": [[4, 1], [5, 2]]}}},
  "meshes": {"plane": {"file": "plane.obj"}},
  "objects": [{"mesh": "plane", "displacement": "ear", "material": "clay"},
              {"mesh": "plane", "transform": {"translate": {"keys": [[5, [0, 0, 0]], [6, [2, 0, 0]]]}}}]})";

class ShotUpdates : public SceneFiles {
  protected:
    Shot make_shot(const std::string& text) {
        write("s.json", text);
        return Shot(folder_ / "s.json");
    }
    Shot make_wave_shot(const std::string& shutter, const std::string& file = "wave.####.exr") {
        return make_shot(R"({"camera": {"shutter": )" + shutter +
                         R"(}, "displacements": {"w": {"type": "vector", "file": ")" + file +
                         R"("}}, "meshes": {"plane": {"file": "plane.obj"}},
                             "objects": [{"mesh": "plane", "displacement": "w"}]})");
    }
    void write_wave(const std::string& name, float value, OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT) {
        auto output = OIIO::ImageOutput::create((folder_ / name).string());
        const float values[] = {value, 2 * value, -value};
        ASSERT_TRUE(output->open((folder_ / name).string(), OIIO::ImageSpec(1, 1, 3, type)));
        ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values));
        ASSERT_TRUE(output->close());
    }
    void write_waves(int first, int last) {
        for (int k = first; k <= last; ++k) write_wave("wave.000" + std::to_string(k) + ".exr", float(k * k));
    }
    void write_body(int frame, const std::string& faces = "f 1//1 2//1 3//1\n") {
        const std::string x = std::to_string(10 * frame);
        write("body.000" + std::to_string(frame) + ".obj",
              "v " + x + " 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\n" + faces);
    }
    Shot make_body_shot(const std::string& shutter) {
        return make_shot(R"({"camera": {"shutter": )" + shutter +
                         R"(}, "meshes": {"still": {"file": "plane.obj"}, "body": {"file": "body.####.obj"}},
                             "objects": [{"mesh": "still"}, {"mesh": "body"}]})");
    }
    void remove(const std::string& name) { std::filesystem::remove(folder_ / name); }
    /// From now on the file cannot be read.
    void spoil(const std::string& name) { write(name, "gone"); }
};

std::shared_ptr<const Texture> get_wave(const Scene& scene) {
    return scene.displacements[0].tiles[0].texture;
}

float get_first(const SceneUpdate& update) { return get_wave(*update.scene)->floats[0]; }

TEST_F(ShotUpdates, hold_no_scene_where_the_camera_alone_moves) {
    Shot shot = make_shot(kUpdatedScene);
    shot.load(1);
    const SceneUpdate update = shot.update(2.5);
    EXPECT_FALSE(update.scene.has_value());
    EXPECT_EQ(update.camera.from.x, 1.5f);
    EXPECT_EQ(update.scene_hash, shot.load(2.5).hash);
    EXPECT_NE(update.scene_hash, shot.load(2.25).hash);
    Shot still = make_shot(with_object(""));
    const Scene scene = still.load(1);
    const SceneUpdate same = still.update(7);
    EXPECT_FALSE(same.scene.has_value());
    EXPECT_EQ(same.scene_hash, scene.hash);
}

TEST_F(ShotUpdates, hold_all_but_meshes_that_stay_and_share_textures) {
    Shot shot = make_shot(kUpdatedScene);
    const Scene first = shot.load(1);
    const SceneUpdate update = shot.update(3.5);
    ASSERT_TRUE(update.scene.has_value());
    const Scene& scene = *update.scene;
    EXPECT_EQ(scene.materials[0].roughness, 0.75f);
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_TRUE(scene.meshes[0].positions.empty() && scene.meshes[0].face_sizes.empty());
    EXPECT_EQ(scene.meshes[0].name, "plane");
    EXPECT_EQ(get_wave(scene), get_wave(first));
    EXPECT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.hash, update.scene_hash);
    EXPECT_EQ(scene.camera.from.x, 2.5f);
    const Scene loaded = shot.load(3.5);
    EXPECT_EQ(loaded.hash, scene.hash);
    EXPECT_FALSE(loaded.meshes[0].positions.empty());
}

TEST_F(ShotUpdates, follow_scales_and_transforms_and_say_nothing_twice) {
    Shot shot = make_shot(kUpdatedScene);
    shot.load(4);
    spoil("map.exr"), spoil("plane.obj");
    EXPECT_EQ(shot.update(4.5).scene->displacements[0].scale.x, 1.5f);
    const SceneUpdate moved = shot.update(5.25);
    EXPECT_EQ(moved.scene->objects[1].world_from_object.translation.x, 0.5f);
    EXPECT_FALSE(shot.update(5.25).scene.has_value());
}

TEST_F(ShotUpdates, place_instances_again) {
    write("points.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                        "property float z\nend_header\n0 0 0\n1 0 0\n");
    Shot shot = make_shot(R"({"meshes": {"plane": {"file": "plane.obj"}}, "objects": [
        {"mesh": "plane", "instances": {"file": "points.ply"},
         "transform": {"translate": {"keys": [[1, [0, 0, 0]], [2, [0, 4, 0]]]}}}, {"mesh": "plane"}]})");
    ASSERT_EQ(shot.load(1).objects.size(), 3u);
    const SceneUpdate update = shot.update(1.5);
    ASSERT_EQ(update.scene->objects.size(), 3u);
    EXPECT_EQ(update.scene->objects[1].world_from_object.translation, (Vec3f{1, 2, 0}));
    EXPECT_EQ(update.scene->objects[2].world_from_object.translation, Vec3f{});
    EXPECT_EQ(update.scene_hash, shot.load(1.5).hash);
}

TEST_F(ShotUpdates, hold_all_of_a_scene_that_nobody_has) {
    Shot shot = make_shot(kUpdatedScene);
    const SceneUpdate first = shot.update(1);
    ASSERT_TRUE(first.scene.has_value());
    EXPECT_FALSE(first.scene->meshes[0].positions.empty());
    Shot broken = make_shot(R"({"meshes": {"plane": {"file": "plane.obj"}}, "objects": [{"mesh": "plane"}],
        "materials": {"a": {"roughness": {"keys": [[1, 0], [2, 5]]}}}})");
    broken.load(1);
    EXPECT_HAS(message_of([&] { broken.update(1.5); }), "materials.a.roughness");
    const SceneUpdate again = broken.update(1.1);
    ASSERT_TRUE(again.scene.has_value());
    EXPECT_FALSE(again.scene->meshes[0].positions.empty()) << "nobody has what failed";
}

TEST_F(ShotUpdates, blend_maps_between_whole_frames) {
    write_waves(1, 3);
    Shot shot = make_wave_shot("[0, 0]");
    const Scene whole = shot.load(2);
    EXPECT_EQ(get_wave(whole)->floats[0], 4);
    const SceneUpdate update = shot.update(2.25);
    EXPECT_EQ(get_first(update), 0.75f * 4 + 0.25f * 9);
    EXPECT_EQ(get_wave(*update.scene)->floats[2], -(0.75f * 4 + 0.25f * 9));
    EXPECT_TRUE(update.scene->meshes[0].positions.empty());
    const Scene loaded = shot.load(2.25);
    EXPECT_EQ(get_wave(loaded)->floats, get_wave(*update.scene)->floats);
    EXPECT_EQ(loaded.hash, update.scene_hash);
    EXPECT_EQ(get_wave(*shot.update(2).scene), get_wave(whole)) << "nothing is blended there";
}

TEST_F(ShotUpdates, blend_halves_to_halves) {
    write_wave("wave.0001.exr", 1, OIIO::TypeDesc::HALF);
    write_wave("wave.0002.exr", 2, OIIO::TypeDesc::HALF);
    write_wave("wave.0003.exr", 3);
    Shot shot = make_wave_shot("[0, 0]");
    const auto halves = get_wave(shot.load(1.1));
    ASSERT_EQ(halves->halves.size(), 4u);
    EXPECT_EQ(halves->halves[0], float_to_half(0.9f * 1 + 0.1f * 2));
    EXPECT_EQ(halves->source_type, SampleType::float16);
    const auto floats = get_wave(shot.load(2.5));
    ASSERT_EQ(floats->floats.size(), 4u) << "one of them has floats";
    EXPECT_EQ(floats->floats[0], 2.5f);
    EXPECT_EQ(floats->source_type, SampleType::float32);
}

TEST_F(ShotUpdates, last_where_a_sequence_ends_and_miss_what_is_not_there) {
    write_waves(1, 3);
    Shot shot = make_wave_shot("[-0.5, 0.5]");
    shot.load(3);
    EXPECT_FALSE(shot.update(3.25).scene.has_value());
    EXPECT_FALSE(shot.update(5.5).scene.has_value());
    shot.load(1);
    EXPECT_FALSE(shot.update(0.75).scene.has_value());
    EXPECT_HAS(message_of([&] { shot.load(4); }), "wave.0004.exr");
    write_waves(5, 6);
    EXPECT_HAS(message_of([&] { shot.load(3.25); }), "wave.0004.exr");
    EXPECT_EQ(get_wave(shot.load(7.25))->floats[0], 36);
}

TEST_F(ShotUpdates, blend_tiles_of_one_number) {
    for (const char* name : {"wave.0001.1001.exr", "wave.0001.1002.exr", "wave.0002.1001.exr"})
        write_wave(name, name[8] == '1' ? 1.0f : 3.0f);
    write_wave("wave.0002.1002.exr", 7), write_wave("wave.0003.1001.exr", 5);
    Shot shot = make_wave_shot("[0, 0]", "wave.####.<UDIM>.exr");
    const Scene scene = shot.load(1.5);
    ASSERT_TRUE(scene.displacements[0].is_udim);
    ASSERT_EQ(scene.displacements[0].tiles.size(), 2u);
    EXPECT_EQ(scene.displacements[0].tiles[0].texture->floats[0], 2);
    EXPECT_EQ(scene.displacements[0].tiles[1].udim, 1002);
    EXPECT_EQ(scene.displacements[0].tiles[1].texture->floats[0], 4);
    const std::string message = message_of([&] { shot.load(2.5); });
    EXPECT_HAS(message, "wave.0002.<UDIM>.exr");
    EXPECT_HAS(message, "tiles 1001, 1002 and 1001");
}

TEST_F(ShotUpdates, refuse_to_blend_maps_of_two_forms) {
    write_waves(1, 1);
    write_pixels<float>("wave.0002.exr", 2, 1, 3, OIIO::TypeDesc::FLOAT, {1, 2, 3, 4, 5, 6});
    write_pixels<float>("wave.0003.exr", 2, 1, 1, OIIO::TypeDesc::FLOAT, {1, 2});
    Shot shot = make_wave_shot("[0, 0]");
    shot.load(1);
    const std::string message = message_of([&] { shot.update(1.5); });
    for (const char* part : {"displacements.w", "wave.0001.exr", "wave.0002.exr", "1 x 1 and 2 x 1 pixels"})
        EXPECT_HAS(message, part);
    EXPECT_HAS(message_of([&] { shot.load(2.5); }), "3 and 1 channels");
    write_pixels<float>("wave.0003.exr", 2, 1, 3, OIIO::TypeDesc::FLOAT, {1, NAN, 3, 4, 5, 6});
    EXPECT_HAS(message_of([&] { make_wave_shot("[0, 0]").load(2.5); }), "NaN");
}

TEST_F(ShotUpdates, read_no_file_twice_and_let_go_of_what_is_behind) {
    write_waves(1, 4);
    Shot shot = make_wave_shot("[-0.5, 0.5]");
    shot.load(2);
    for (int k = 1; k <= 3; ++k) spoil("wave.000" + std::to_string(k) + ".exr");
    for (const double time : {1.5, 2.25, 1.75, 2.5, 2.0}) {
        const double whole = std::floor(time), a = whole * whole, b = (whole + 1) * (whole + 1);
        const SceneUpdate update = shot.update(time);
        EXPECT_FLOAT_EQ(get_first(update), float(a + (b - a) * (time - whole))) << time;
        EXPECT_TRUE(update.scene->meshes[0].positions.empty());
    }
    std::weak_ptr<const Texture> third = get_wave(*shot.update(3).scene);
    write_waves(5, 8);
    shot.load(4);
    EXPECT_FALSE(third.expired()) << "the shutter of frame 4 sees it";
    shot.load(6);
    EXPECT_TRUE(third.expired());
}

TEST_F(ShotUpdates, blend_meshes_of_one_topology) {
    for (int k = 1; k <= 3; ++k) write_body(k);
    Shot shot = make_body_shot("[-0.5, 0.5]");
    shot.load(2);
    for (int k = 1; k <= 3; ++k) spoil("body.000" + std::to_string(k) + ".obj");
    const SceneUpdate update = shot.update(1.75);
    ASSERT_TRUE(update.scene.has_value());
    EXPECT_TRUE(update.scene->meshes[0].positions.empty()) << "it stays";
    EXPECT_EQ(update.scene->meshes[0].name, "still");
    ASSERT_EQ(update.scene->meshes[1].positions.size(), 3u);
    EXPECT_EQ(update.scene->meshes[1].positions[0].x, 17.5f);
    EXPECT_EQ(update.scene->meshes[1].name, "body");
    EXPECT_EQ(shot.update(2.25).scene->meshes[1].positions[0].x, 22.5f);
    EXPECT_EQ(shot.update(2).scene->meshes[1].positions[0].x, 20);
    EXPECT_FALSE(shot.update(2).scene.has_value());
}

TEST_F(ShotUpdates, blend_normals_though_they_are_indexed_in_another_way) {
    write_body(1), write_body(2, "f 1//1 2//1 3//2\n");
    const Mesh mesh = make_body_shot("[0, 0]").load(1.5).meshes[1];
    ASSERT_EQ(mesh.normals.size(), 3u);
    EXPECT_EQ(mesh.normals[mesh.normal_indices[0]], (Vec3f{0, 0, 1}));
    EXPECT_EQ(mesh.normals[mesh.normal_indices[2]], (Vec3f{0, 0.5f, 0.5f}));
}

TEST_F(ShotUpdates, refuse_to_blend_meshes_of_two_topologies) {
    write_body(1), write_body(2, "f 1//1 3//1 2//1\n"), write_body(3, "f 1 2 3\n");
    const std::string message = message_of([&] { make_body_shot("[0, 0]").load(1.5); });
    for (const char* part :
         {"meshes.body.file", "body.0001.obj", "body.0002.obj", "corners of faces differ at 1"})
        EXPECT_HAS(message, part);
    EXPECT_HAS(message_of([&] { make_body_shot("[0, 0]").load(2.5); }), "body.0003.obj");
}

TEST_F(ShotUpdates, keep_other_files_of_the_whole_part) {
    for (int k = 1; k <= 2; ++k)
        write_pixels<float>("sky.0" + std::to_string(k) + ".exr", 1, 1, 3, OIIO::TypeDesc::FLOAT,
                            {float(k), 1, 1});
    Shot shot =
        make_shot(R"({"environment": {"file": "sky.##.exr"}, "meshes": {"plane": {"file": "plane.obj"}},
                              "objects": [{"mesh": "plane"}]})");
    EXPECT_EQ(shot.load(1.75).environment->texture->floats[0], 1);
    EXPECT_EQ(shot.update(2.75).scene->environment->texture->floats[0], 2) << "the last one lasts";
    EXPECT_EQ(shot.update(0.75).scene->environment->texture->floats[0], 1);
}

TEST_F(ShotUpdates, list_files_that_an_open_shutter_reads) {
    write_waves(1, 3);
    const auto list = [&](const std::string& shutter, double frame) {
        std::vector<std::string> names;
        for (const auto& file : make_wave_shot(shutter).list_files(frame))
            if (file.filename().string().starts_with("wave")) names.push_back(file.filename().string());
        std::ranges::sort(names);
        return names;
    };
    using Files = std::vector<std::string>;
    EXPECT_EQ(list("[0, 0]", 2), (Files{"wave.0002.exr"}));
    EXPECT_EQ(list("[-0.25, 0.25]", 2), (Files{"wave.0001.exr", "wave.0002.exr", "wave.0003.exr"}));
    EXPECT_EQ(list("[-0.25, 0.25]", 3), (Files{"wave.0002.exr", "wave.0003.exr"}));
    EXPECT_EQ(list("[0, 1]", 1), (Files{"wave.0001.exr", "wave.0002.exr"})) << "it closes before frame 2";
    EXPECT_EQ(list("[0, 0]", 2.5), (Files{"wave.0002.exr", "wave.0003.exr"}));
    EXPECT_HAS(message_of([&] { list("[-0.25, 0.25]", 4); }), "wave.0004.exr");
    remove("wave.0002.exr");
    EXPECT_HAS(message_of([&] { list("[-0.25, 0.25]", 3); }), "wave.0002.exr");
}

TEST_F(ShotUpdates, pass_on_what_later_files_are_warned_of) {
    for (int k = 1; k <= 2; ++k)
        write_pixels<float>("sky.0" + std::to_string(k) + ".exr", 1, 1, 3, OIIO::TypeDesc::FLOAT,
                            {k == 1 ? 1.0f : -1.0f, 1, 1});
    Shot shot =
        make_shot(R"({"environment": {"file": "sky.##.exr"}, "meshes": {"plane": {"file": "plane.obj"}},
                              "objects": [{"mesh": "plane"}]})");
    EXPECT_TRUE(shot.load(1).warnings.empty());
    const std::vector<std::string> warnings = shot.update(2).scene->warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "negative radiance counts as 0");
    EXPECT_TRUE(shot.update(1).scene->warnings.empty());
}

TEST_F(ShotUpdates, list_the_buffers_of_gltf_files) {
    write("body.gltf",
          R"({"buffers": [{"uri": "a%20b.bin"}, {"uri": "data:;base64,AAAA"}, {"uri": "../out.bin"}, 3]})");
    Shot shot = make_shot(R"({"meshes": {"body": {"file": "body.gltf"}}})");
    std::vector<std::string> names;
    for (const auto& file : shot.list_files(1)) names.push_back(file.filename().string());
    EXPECT_EQ(names, (std::vector<std::string>{"s.json", "body.gltf", "a b.bin"}));
    write("body.gltf", "{");
    EXPECT_EQ(shot.list_files(1).size(), 2u) << "reading it tells what is wrong";
}

TEST_F(ShotUpdates, have_hashes_of_all_that_a_shutter_sees) {
    write_waves(1, 4);
    const auto hash = [&](const std::string& shutter) { return make_wave_shot(shutter).load(2).hash; };
    const uint64_t still = hash("[0, 0]"), open = hash("[-0.25, 0.25]");
    write_wave("wave.0004.exr", 100);
    EXPECT_EQ(hash("[0, 0]"), still);
    EXPECT_EQ(hash("[-0.25, 0.25]"), open) << "it is out of sight";
    write_wave("wave.0003.exr", 100);
    EXPECT_EQ(hash("[0, 0]"), still);
    EXPECT_NE(hash("[-0.25, 0.25]"), open);
}

TEST_F(ShotUpdates, have_hashes_of_the_keys_that_a_shutter_sees) {
    const auto hash = [&](const std::string& keys, const std::string& shutter) {
        Shot shot = make_shot(R"({"camera": {"shutter": )" + shutter +
                              R"(}, "meshes": {"plane": {"file": "plane.obj"}}, "objects": [{"mesh": "plane",
                                "transform": {"translate": {"keys": [)" +
                              keys + "]}}}]}");
        const uint64_t first = shot.load(2).hash;
        const auto view = shot.find_view(2);
        EXPECT_EQ(view->scene_hash, first);
        EXPECT_EQ(shot.update(2).scene_hash, first);
        return first;
    };
    const std::string plain = "[1, [0, 0, 0]], [2, [1, 0, 0]], [3, [2, 0, 0]], [9, [8, 0, 0]]";
    const std::string beside = "[1, [0, 0, 0]], [2, [1, 0, 0]], [3, [5, 0, 0]], [9, [8, 0, 0]]";
    const std::string within = "[1, [0, 0, 0]], [2, [1, 0, 0]], [2.1, [7, 0, 0]], [2.2, [1.2, 0, 0]], [3, "
                               "[2, 0, 0]], [9, [8, 0, 0]]";
    const std::string far = "[1, [0, 0, 0]], [2, [1, 0, 0]], [3, [2, 0, 0]], [9, [8, 0, 0]], [12, [0, 0, 0]]";
    EXPECT_EQ(hash(plain, "[0, 0]"), hash(beside, "[0, 0]"));
    EXPECT_NE(hash(plain, "[-0.25, 0.25]"), hash(beside, "[-0.25, 0.25]"));
    EXPECT_NE(hash(plain, "[-0.25, 0.25]"), hash(within, "[-0.25, 0.25]"));
    EXPECT_EQ(hash(plain, "[-0.25, 0.25]"), hash(far, "[-0.25, 0.25]"));
}

TEST_F(ShotUpdates, keep_the_rate_of_frames) {
    EXPECT_EQ(make_shot(kUpdatedScene).load(1).picture.fps, 24);
    save_scene(make_shot(kUpdatedScene).load(1), folder_ / "copy");
    EXPECT_EQ(load_scene(folder_ / "copy" / "scene.json").picture.fps, 24);
    EXPECT_HAS(error_of(R"({"render": {"fps": 0}})"), "render.fps");
}

} // namespace

} // namespace relief
