// Scenes that differ from frame to frame: frames are shown and played, and what a user did stays.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "common/texel_values.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/shot.h"
#include "viewer/workbench_fixture.h"

namespace relief::viewer {

class FrameTest : public WorkbenchTest {
  protected:
    static std::string read_text(const std::filesystem::path& file) {
        std::ifstream stream(file);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    /// That text of a scene with five frames.
    void open_text(std::string text) {
        text.insert(text.find('{') + 1, R"("render": {"frames": "1-5", "fps": 50},)");
        std::ofstream(folder_ / "shot.json") << text;
        bench_->open({folder_ / "shot.json", {}, {}});
        ASSERT_TRUE(reach_done()) << bench_->message();
    }
    /// The bumpy plane with keys in place of one value.
    void open_animated(const std::string& key, const std::string& value) {
        std::string text = read_text(folder_ / "scene.json");
        const size_t at = text.find(key);
        ASSERT_NE(at, std::string::npos) << text;
        const size_t start = text.find_first_not_of(" :", at + key.size());
        const size_t end = text[start] == '[' ? text.find(']', start) + 1 : text.find_first_of(",\n}", start);
        open_text(text.replace(start, end - start, value));
    }
    /// The same with a map a frame, whose ridges lie in different rows.
    void open_sequence() {
        Displacement map = load_scene(folder_ / "scene.json").displacements[0];
        const Texture texels = *map.tiles[0].texture;
        for (uint32_t frame = 1; frame <= 5; ++frame) {
            auto texture = std::make_shared<Texture>(texels);
            for (uint32_t x = 0; x < 64; ++x) write_texel(*texture, x, 10 * frame, {0, 0, 0.3f});
            map.tiles[0].texture = texture;
            write_map(map, name_frame(folder_ / "maps" / "bumps.####.exr", int(frame)), MapSamples::float32);
        }
        std::string text = read_text(folder_ / "scene.json");
        const std::string name = "bumps.exr";
        open_text(text.replace(text.find(name), name.size(), "bumps.####.exr"));
    }
    void show(int frame) {
        ASSERT_TRUE(bench_->show_frame(frame));
        ASSERT_TRUE(reach_done()) << bench_->message();
        ASSERT_EQ(bench_->frame(), frame) << bench_->message();
    }
    /// What a render of the file at a frame gives.
    std::vector<float> render_frame(int frame) {
        return render(Shot(folder_ / "shot.json").load(frame), settings_).image.pixels;
    }
    /// Of the maps that are shown, and waits until it was read again and is seen.
    void rewrite_map(const std::string& name) {
        const std::shared_ptr<const Texture> before = map().tiles[0].texture;
        const std::vector<float> picture = bench_->picture()->image.pixels;
        Displacement next = map();
        auto texture = std::make_shared<Texture>(*before);
        for (uint32_t x = 0; x < 64; ++x) write_texel(*texture, x, 33, {0, 0, 0.4f});
        next.tiles[0].texture = texture;
        write_map(next, folder_ / "maps" / name, MapSamples::float32);
        ASSERT_TRUE(reach([&] { return map().tiles[0].texture != before; })) << bench_->message();
        ASSERT_TRUE(reach_done()) << bench_->message();
        EXPECT_EQ(bench_->message(), "read again: the map changed");
        EXPECT_NE(bench_->picture()->image.pixels, picture);
    }
    const Displacement& map() const { return bench_->document()->scene().displacements[0]; }
    void paint(float height) { write_texel(bench_->document()->paint_tile(0, 1001), 12, 20, {0, 0, height}); }
    std::shared_ptr<const Texture> painted_texture() {
        return bench_->document()->snapshot()->scene.displacements[0].tiles[0].texture;
    }
    float read_height() { return read_texel(*painted_texture(), 12, 20).z; }
};

TEST_F(FrameTest, a_frame_is_shown_and_saved_without_its_keys) {
    open_animated("\"scale\"", R"({"keys": [[1, 0], [5, 2]]})");
    EXPECT_EQ(bench_->frame(), 1);
    EXPECT_EQ(bench_->timeline().frames(), (std::vector<int>{1, 2, 3, 4, 5}));
    EXPECT_EQ(bench_->timeline().fps(), 50);
    const std::vector<float> first = bench_->picture()->image.pixels;
    show(4);
    EXPECT_EQ(map().scale.x, 1.5f);
    EXPECT_NE(bench_->picture()->image.pixels, first);
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(4));
    ASSERT_TRUE(bench_->save(folder_ / "seen.json")) << bench_->message();
    EXPECT_EQ(render_file("seen.json"), bench_->picture()->image.pixels);
}

TEST_F(FrameTest, what_was_changed_stays_and_all_else_follows_its_keys) {
    open_animated("\"scale\"", R"({"keys": [[1, 1], [5, 2]]})");
    bench_->change_document([](Document& document) {
        document.change_displacement(0, [](Displacement& map) { map.midlevel = {0, 0, 0.1f}; });
        document.change_material(0, [](Material& material) { material.roughness = 0.125f; });
    });
    bench_->change_settings([](RenderSettings& settings) { settings.image.spp = 2; });
    show(3);
    EXPECT_EQ(map().scale.x, 1.5f);
    EXPECT_EQ(map().midlevel.z, 0.1f);
    EXPECT_EQ(bench_->document()->scene().materials[0].roughness, 0.125f);
    EXPECT_EQ(bench_->settings().image.spp, 2);
    EXPECT_TRUE(bench_->document()->has_changes());
    show(1);
    EXPECT_EQ(map().scale.x, 1);
    EXPECT_EQ(map().midlevel.z, 0.1f);
    ASSERT_TRUE(bench_->save(folder_ / "changed.json")) << bench_->message();
    settings_.image.spp = 2;
    EXPECT_EQ(render_file("changed.json"), bench_->picture()->image.pixels);
}

TEST_F(FrameTest, what_is_taken_back_at_another_frame_follows_its_keys_again) {
    open_animated("\"scale\"", R"({"keys": [[1, 1], [5, 2]]})");
    bench_->change_displacement(0, [](Displacement& map) { map.midlevel = {0, 0, 0.1f}; });
    show(3);
    EXPECT_EQ(map().midlevel.z, 0.1f);
    bench_->undo();
    EXPECT_EQ(map().midlevel.z, 0);
    EXPECT_EQ(map().scale.x, 1.5f);
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(3));
    bench_->change_displacement(0, [](Displacement& map) { map.scale = {9, 9, 9}; });
    bench_->undo();
    show(5);
    EXPECT_EQ(map().scale.x, 2);
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(5));
}

TEST_F(FrameTest, a_change_of_a_value_with_keys_is_taken_back_and_made_again_at_another_frame) {
    open_animated("\"scale\"", R"({"keys": [[1, 1], [5, 2]]})");
    bench_->change_displacement(0, [](Displacement& map) { map.scale = {9, 9, 9}; });
    show(3);
    EXPECT_EQ(map().scale.x, 9);
    bench_->undo();
    EXPECT_EQ(map().scale.x, 1.5f);
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(3));
    show(5);
    EXPECT_EQ(map().scale.x, 2);
    bench_->redo();
    EXPECT_EQ(map().scale.x, 9);
    show(1);
    EXPECT_EQ(map().scale.x, 9);
    bench_->undo();
    show(3);
    EXPECT_EQ(map().scale.x, 1.5f);
}

TEST_F(FrameTest, a_material_and_light_that_are_taken_back_at_another_frame_follow_their_keys_again) {
    open_animated("\"roughness\"", R"({"keys": [[1, 0.25], [5, 0.75]]})");
    const auto get_material = [&]() -> const Material& { return bench_->document()->scene().materials[0]; };
    const auto get_strength = [&] { return bench_->document()->scene().environment->strength; };
    bench_->change_material(0, [](Material& material) { material.roughness = 0.125f; });
    bench_->change_environment([](Environment& environment) { environment.strength = 2; });
    bench_->change_material(0, [](Material& material) { material.metallic = 1; });
    show(3);
    EXPECT_EQ(get_material().roughness, 0.125f);
    bench_->undo();
    EXPECT_EQ(get_material().metallic, 0);
    EXPECT_EQ(get_material().roughness, 0.125f);
    bench_->undo();
    EXPECT_EQ(get_strength(), 1);
    bench_->undo();
    EXPECT_EQ(get_material().roughness, 0.5f);
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(3));
    show(5);
    EXPECT_EQ(get_material().roughness, 0.75f);
    bench_->redo();
    bench_->redo();
    show(1);
    EXPECT_EQ(get_material().roughness, 0.125f);
    EXPECT_EQ(get_strength(), 2);
    bench_->undo();
    bench_->undo();
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(1));
}

TEST_F(FrameTest, a_camera_with_keys_moves_until_somebody_else_moves_it) {
    open_animated("\"from\"", R"({"keys": [[1, [0, 0, 4]], [5, [4, 0, 4]]]})");
    const uint64_t content = bench_->document()->content();
    show(3);
    EXPECT_EQ(bench_->document()->content(), content);
    EXPECT_EQ(bench_->camera().get().from.x, 2);
    show(5);
    EXPECT_EQ(bench_->camera().get().from.x, 4);
    press_key(kUp);
    const Vec3f from = bench_->camera().get().from;
    EXPECT_TRUE(bench_->has_own_camera());
    show(1);
    EXPECT_EQ(bench_->camera().get().from, from);
    bench_->take_scene_camera();
    EXPECT_EQ(bench_->camera().get().from.x, 0);
    show(3);
    EXPECT_EQ(bench_->camera().get().from.x, 2);
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(3));
}

TEST_F(FrameTest, the_keys_of_other_programs_step_and_play) {
    open_animated("\"scale\"", R"({"keys": [[1, 1], [5, 2]]})");
    const auto reach_frame = [&](int frame) { return reach([&] { return bench_->frame() == frame; }); };
    press_key(kRight);
    EXPECT_TRUE(reach_frame(2));
    press_key(kRight, {.shift = true});
    EXPECT_TRUE(reach_frame(5));
    press_key(kLeft);
    EXPECT_TRUE(reach_frame(4));
    press_key(kLeft, {.shift = true});
    EXPECT_TRUE(reach_frame(1));
    EXPECT_FALSE(bench_->has_own_camera());
    press_key(' ');
    EXPECT_TRUE(bench_->timeline().is_playing());
    std::set<int> seen;
    EXPECT_TRUE(reach([&] { return seen.insert(*bench_->frame()), seen.size() >= 3; }));
    press_key(' ');
    EXPECT_FALSE(bench_->timeline().is_playing());
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(*bench_->frame()));
}

TEST_F(FrameTest, of_frames_that_are_wanted_faster_than_they_come_the_last_one_is_shown) {
    open_sequence();
    for (int k = 0; k < 40; ++k) {
        ASSERT_TRUE(bench_->show_frame(1 + k % 5));
        bench_->update(1e-3 * k);
    }
    EXPECT_EQ(bench_->wanted_frame(), 5);
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->frame(), 5);
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(5));
    for (const int frame : {3, 1, 4}) {
        show(frame);
        EXPECT_EQ(bench_->picture()->image.pixels, render_frame(frame)) << frame;
    }
}

TEST_F(FrameTest, strokes_on_a_map_of_all_frames_stay_and_can_be_taken_back) {
    open_animated("\"roughness\"", R"({"keys": [[1, 0.2], [5, 0.9]]})");
    bench_->set_tool(Tool::paint);
    ASSERT_TRUE(reach_done());
    const float before = read_height();
    drag(20, 16, 26, 16);
    ASSERT_TRUE(bench_->can_undo());
    ASSERT_TRUE(reach_done());
    const std::shared_ptr<const Texture> painted = painted_texture();
    show(4);
    EXPECT_TRUE(bench_->document()->has_painted());
    EXPECT_EQ(map().tiles[0].texture, painted);
    ASSERT_TRUE(bench_->can_undo());
    bench_->undo();
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(read_height(), before);
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(4));
}

TEST_F(FrameTest, strokes_on_a_map_of_one_frame_come_back_with_it) {
    bench_ = std::make_unique<Workbench>(settings_, given_, nullptr, folder_ / "state");
    bench_->set_area({0, 0, 48, 32});
    open_sequence();
    show(2);
    paint(0.75f);
    show(3);
    EXPECT_NE(bench_->message().find("comes back with frame 2"), std::string::npos) << bench_->message();
    EXPECT_FALSE(bench_->document()->has_painted());
    EXPECT_TRUE(bench_->document()->has_strokes_aside());
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(3));
    show(2);
    EXPECT_EQ(bench_->message(), "");
    show(3);
    ASSERT_TRUE(bench_->save(folder_ / "third.json"));
    EXPECT_EQ(render_file("third.json"), bench_->picture()->image.pixels);
    show(2);
    EXPECT_TRUE(bench_->document()->has_painted());
    EXPECT_FALSE(bench_->document()->has_strokes_aside());
    EXPECT_EQ(read_height(), 0.75f);
    show(4);
    ASSERT_TRUE(bench_->save(folder_ / "fourth.json"));
    bench_.reset();
    const auto kept = UserState(folder_ / "state").claim_painted(folder_ / "shot.json");
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_EQ(read_texel(read_texture(kept[0]), 12, 20).z, 0.75f);
}

TEST_F(FrameTest, strokes_that_cannot_be_kept_are_told_of) {
    std::ofstream(folder_ / "state") << "no folder";
    bench_ = std::make_unique<Workbench>(settings_, given_, nullptr, folder_ / "state");
    bench_->set_area({0, 0, 48, 32});
    open_sequence();
    paint(0.75f);
    show(2);
    EXPECT_TRUE(reach([&] { return bench_->message().find("is not kept") != std::string::npos; }))
        << bench_->message();
}

TEST_F(FrameTest, a_frame_whose_file_is_missing_leaves_what_is_shown) {
    open_sequence();
    std::filesystem::remove(folder_ / "maps" / "bumps.0003.exr");
    ASSERT_TRUE(bench_->show_frame(3));
    ASSERT_TRUE(reach([&] { return bench_->wanted_frame() == bench_->frame(); }));
    EXPECT_EQ(bench_->frame(), 1);
    EXPECT_NE(bench_->message().find("frame 3"), std::string::npos) << bench_->message();
    show(4);
    EXPECT_EQ(bench_->message(), "");
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(4));
}

TEST_F(FrameTest, frames_before_the_first_file_and_after_the_last_are_refused) {
    open_sequence();
    for (const int frame : {0, 6, 9}) {
        ASSERT_TRUE(bench_->show_frame(frame));
        ASSERT_TRUE(reach([&] { return bench_->wanted_frame() == bench_->frame(); }));
        EXPECT_EQ(bench_->frame(), 1);
        EXPECT_EQ(bench_->message().find("frame " + std::to_string(frame)), 0u) << bench_->message();
        EXPECT_THROW(render_frame(frame), Error);
    }
    show(5);
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(5));
}

TEST_F(FrameTest, a_map_that_is_rewritten_is_read_again_at_a_frame_with_keys) {
    open_animated("\"scale\"", R"({"keys": [[1, 1], [5, 2]]})");
    show(3);
    rewrite_map("bumps.exr");
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(3));
    show(4);
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(4));
}

TEST_F(FrameTest, a_numbered_map_that_is_rewritten_is_read_again) {
    open_sequence();
    show(2);
    rewrite_map("bumps.0002.exr");
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(2));
    show(3);
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(3));
}

TEST_F(FrameTest, frames_go_on_while_the_camera_moves) {
    open_animated("\"scale\"", R"({"keys": [[1, 1], [5, 2]]})");
    bench_->set_playing(true);
    std::set<int> seen;
    EXPECT_TRUE(reach([&] { // each time before the next update
        bench_->change_camera([](OrbitCamera& camera) { camera.orbit(0.01f, 0); });
        return seen.insert(*bench_->frame()), seen.size() >= 4;
    }));
    bench_->set_playing(false);
    EXPECT_TRUE(reach_done());
}

TEST_F(FrameTest, a_save_names_the_frames_whose_strokes_it_leaves_and_writes_over_none) {
    open_sequence();
    show(2);
    paint(0.75f);
    show(3);
    paint(0.5f);
    ASSERT_TRUE(bench_->save(folder_ / "same.json"));
    EXPECT_NE(bench_->message().find("painted at frame 2:"), std::string::npos) << bench_->message();
    EXPECT_TRUE(bench_->has_unsaved());
    show(2);
    ASSERT_TRUE(bench_->save(folder_ / "same.json"));
    EXPECT_EQ(bench_->message(), "wrote " + (folder_ / "same.json").string());
    EXPECT_FALSE(bench_->has_unsaved());
    EXPECT_EQ(render_file("same.json"), bench_->picture()->image.pixels);
    EXPECT_EQ(read_texel(read_texture(folder_ / "same_bumps.exr"), 12, 20).z, 0.5f);
    EXPECT_EQ(read_texel(read_texture(folder_ / "same_bumps-2.exr"), 12, 20).z, 0.75f);
}

TEST_F(FrameTest, a_picture_is_written_of_the_frame_that_it_was_asked_for_at) {
    open_animated("\"scale\"", R"({"keys": [[1, 1], [5, 2]]})");
    bench_->set_playing(true);
    ASSERT_TRUE(reach([&] { return *bench_->frame() > 1; }));
    const int frame = *bench_->frame();
    EXPECT_EQ(bench_->suggest_file(".exr"), folder_ / ("shot-view.000" + std::to_string(frame) + ".exr"));
    bench_->write_picture(folder_ / "first.exr");
    EXPECT_FALSE(bench_->timeline().is_playing());
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->frame(), frame);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "first.exr"));
    bench_->change_camera([](OrbitCamera& camera) { camera.orbit(0.1f, 0); });
    bench_->write_picture(folder_ / "second.exr");
    show(frame == 5 ? 4 : 5);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "second.exr"));
    EXPECT_NE(std::ranges::find(bench_->messages(), "second.exr is not written: another frame is shown"),
              bench_->messages().end());
}

TEST_F(FrameTest, a_frame_that_is_being_read_is_not_shown_when_the_one_before_is_wanted_again) {
    open_animated("\"scale\"", R"({"keys": [[1, 1], [5, 2]]})");
    bench_->show_frame(2);
    bench_->show_frame(1);
    ASSERT_TRUE(reach_done());
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->frame(), 1);
}

TEST_F(FrameTest, strokes_on_a_map_that_was_read_again_from_the_same_file_have_not_left) {
    open_animated("\"scale\"", R"({"keys": [[1, 1], [5, 2]]})");
    paint(0.25f);
    const std::filesystem::path mesh = folder_ / "meshes" / "plane.obj";
    std::filesystem::last_write_time(mesh, std::filesystem::last_write_time(mesh) + std::chrono::hours(1));
    show(3);
    EXPECT_EQ(read_height(), 0.25f);
    EXPECT_TRUE(bench_->document()->has_painted());
    for (const std::string& message : bench_->messages())
        EXPECT_EQ(message.find("comes back"), std::string::npos) << message;
}

TEST_F(FrameTest, frames_are_those_of_the_scene_that_was_opened) {
    open_animated("\"scale\"", R"({"keys": [[1, 1], [5, 2]]})");
    bench_->change_material(0, [](Material& material) { material.roughness = 0.125f; });
    std::string text = read_text(folder_ / "shot.json");
    const std::string keys = "[[1, 1], [5, 2]]";
    ASSERT_NE(text.find(keys), std::string::npos);
    std::ofstream(folder_ / "shot.json") << text.replace(text.find(keys), keys.size(), "[[1, 7], [5, 7]]");
    show(3);
    EXPECT_EQ(map().scale.x, 1.5f);
    EXPECT_EQ(bench_->document()->scene().materials[0].roughness, 0.125f);
}

TEST_F(FrameTest, a_map_that_was_rewritten_while_its_frame_was_left_is_read_again) {
    open_sequence();
    show(2);
    show(3);
    Displacement next = map();
    auto texture = std::make_shared<Texture>(*next.tiles[0].texture);
    for (uint32_t x = 0; x < 64; ++x) write_texel(*texture, x, 12, {0, 0, 0.5f});
    next.tiles[0].texture = texture;
    write_map(next, folder_ / "maps" / "bumps.0002.exr", MapSamples::float32);
    show(2);
    EXPECT_EQ(read_texel(*map().tiles[0].texture, 20, 12).z, 0.5f);
    EXPECT_EQ(bench_->picture()->image.pixels, render_frame(2));
}

TEST_F(FrameTest, a_scene_without_keys_has_no_frames) {
    open_scene();
    EXPECT_FALSE(bench_->frame());
    EXPECT_TRUE(bench_->timeline().frames().empty());
    EXPECT_FALSE(bench_->show_frame(2));
    press_key(' ');
    EXPECT_FALSE(bench_->timeline().is_playing());
    press_key(kLeft);
    EXPECT_TRUE(bench_->has_own_camera());
}

} // namespace relief::viewer
