// Files that are dropped onto a mesh are changes of it, and scenes are saved under names of their own.
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "relief/io.h"
#include "viewer/workbench_fixture.h"

namespace relief::viewer {

class DroppedTest : public WorkbenchTest {
  protected:
    void SetUp() override {
        WorkbenchTest::SetUp();
        bench_->drop({folder_ / "meshes" / "plane.obj"});
        ASSERT_TRUE(reach_done()) << bench_->message();
    }
    void drop_map() {
        bench_->ask_to_open({folder_ / "maps" / "bumps.exr"});
        ASSERT_TRUE(reach_done()) << bench_->message();
        ASSERT_EQ(bench_->document()->scene().displacements.size(), 1u);
    }
    /// Bright in the upper left.
    std::filesystem::path write_sky() {
        Image sky;
        sky.width = 16, sky.height = 8;
        sky.channels = {"R", "G", "B"};
        for (int k = 0; k < 16 * 8; ++k)
            for (int c = 0; c < 3; ++c) sky.pixels.push_back(k == 20 ? 90.0f : 0.2f);
        write_image(sky, folder_ / "sky.hdr");
        return folder_ / "sky.hdr";
    }
};

TEST_F(DroppedTest, a_map_is_a_change_until_it_is_saved) {
    EXPECT_FALSE(bench_->has_unsaved());
    drop_map();
    EXPECT_TRUE(bench_->has_unsaved());
    drop_map(); // another one takes its place without a question
    EXPECT_FALSE(bench_->is_asked_to_open());
    bench_->change_document([](Document& document) {
        document.change_material(0, [](Material& material) { material.roughness = 0.25f; });
    });
    bench_->ask_to_open({folder_ / "maps" / "bumps.exr"});
    EXPECT_TRUE(bench_->is_asked_to_open());
    bench_->forget_asked();
    ASSERT_TRUE(bench_->save(folder_ / "mine.json")) << bench_->message();
    EXPECT_FALSE(bench_->has_unsaved());
}

TEST_F(DroppedTest, an_environment_lights_a_mesh_as_it_does_when_it_is_opened_with_it) {
    const std::filesystem::path sky = write_sky();
    bench_->drop({sky});
    ASSERT_TRUE(reach_done()) << bench_->message();
    MeshSceneOptions options;
    options.environment = sky;
    const Scene lit = load_mesh_scene(folder_ / "meshes" / "plane.obj", options);
    const Scene& scene = bench_->document()->scene();
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_EQ(scene.environment->strength, lit.environment->strength);
    EXPECT_EQ(scene.environment->rotate_degrees, lit.environment->rotate_degrees);
    ASSERT_TRUE(bench_->save(folder_ / "lit.json")) << bench_->message();
    EXPECT_EQ(render_file("lit.json"), bench_->picture()->image.pixels);
}

TEST_F(DroppedTest, a_map_and_an_environment_come_together_and_stay_together) {
    const std::filesystem::path sky = write_sky();
    bench_->drop({folder_ / "maps" / "bumps.exr", sky});
    ASSERT_TRUE(reach_done()) << bench_->message();
    EXPECT_EQ(bench_->document()->scene().displacements.size(), 1u) << bench_->message();
    EXPECT_TRUE(bench_->document()->scene().lights.empty());
    bench_->drop({folder_ / "meshes" / "plane.obj"});
    ASSERT_TRUE(reach_done()) << bench_->message();
    EXPECT_FALSE(bench_->document()->scene().lights.empty());
    bench_->drop({sky});
    bench_->drop({folder_ / "maps" / "bumps.exr"}); // does not take the light away
    ASSERT_TRUE(reach_done()) << bench_->message();
    EXPECT_EQ(bench_->document()->scene().displacements.size(), 1u);
    EXPECT_TRUE(bench_->document()->scene().lights.empty());
}

TEST_F(DroppedTest, an_environment_that_cannot_be_read_changes_nothing) {
    bench_->change_light(0, [](Light& light) { light.strength = 3; });
    const std::shared_ptr<const Texture> before = bench_->document()->scene().environment->texture;
    std::ofstream(folder_ / "bad.hdr") << "#?RADIANCE";
    bench_->drop({folder_ / "bad.hdr"});
    EXPECT_NE(bench_->message().find("bad.hdr"), std::string::npos) << bench_->message();
    EXPECT_EQ(bench_->document()->scene().environment->texture, before);
    EXPECT_EQ(bench_->document()->scene().lights.at(0).strength, 3);
}

TEST_F(DroppedTest, what_an_environment_replaced_is_not_taken_back) {
    bench_->change_material(0, [](Material& material) { material.roughness = 0.125f; });
    bench_->change_light(0, [](Light& light) { light.strength = 3; });
    bench_->change_environment([](Environment& sky) { sky.strength = 5; });
    bench_->drop({write_sky()});
    const float strength = bench_->document()->scene().environment->strength;
    bench_->undo();
    EXPECT_EQ(bench_->document()->scene().environment->strength, strength);
    EXPECT_NE(bench_->document()->scene().materials[0].roughness, 0.125f);
    EXPECT_FALSE(bench_->can_undo());
}

TEST_F(DroppedTest, a_scene_takes_the_place_of_no_file_of_another_kind) {
    drop_map();
    const std::filesystem::path mesh = folder_ / "meshes" / "other.obj";
    std::filesystem::copy_file(folder_ / "meshes" / "plane.obj", mesh);
    EXPECT_FALSE(bench_->save(mesh));
    EXPECT_NE(bench_->message().find(".json"), std::string::npos) << bench_->message();
    EXPECT_EQ(std::filesystem::file_size(mesh), std::filesystem::file_size(folder_ / "meshes" / "plane.obj"));
    EXPECT_TRUE(bench_->has_unsaved());
}

TEST_F(DroppedTest, a_picture_has_the_name_and_the_look_that_were_chosen) {
    const auto write = [&](const char* name, const char* exposure) {
        bench_->set_output((folder_ / name).string(),
                           {{"relief:display", "standard"}, {"relief:exposure", exposure}});
        press_key(kF12);
        return reach([&] { return std::filesystem::exists(folder_ / name); });
    };
    ASSERT_TRUE(write("dark.png", "-4") && write("bright.png", "2")) << bench_->message();
    const Texture dark = read_texture(folder_ / "dark.png"), bright = read_texture(folder_ / "bright.png");
    const size_t middle = 4 * (size_t(dark.height / 2) * dark.width + dark.width / 2);
    EXPECT_GT(bright.floats.at(middle), 2 * dark.floats.at(middle));
}

} // namespace relief::viewer
