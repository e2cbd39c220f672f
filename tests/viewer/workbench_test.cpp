// The viewer as a user drives it, without a window.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <ios>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/texel_values.h"
#include "relief/error.h"
#include "relief/io.h"
#include "viewer/event_script.h"
#include "viewer/fixture.h"
#include "viewer/workbench.h"

namespace relief::viewer {

namespace {

using Kind = InputEvent::Kind;

double read_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace

class WorkbenchTest : public FolderTest {
  protected:
    void SetUp() override {
        FolderTest::SetUp();
        write_scene_files();
        settings_ = make_small_settings();
        given_.spp = settings_.image.spp;
        bench_ = std::make_unique<Workbench>(settings_, given_);
        bench_->set_area({0, 0, 48, 32});
    }
    void TearDown() override {
        bench_.reset();
        FolderTest::TearDown();
    }
    bool reach(const std::function<bool()>& is_true) {
        return wait_until([&] {
            bench_->update(read_now());
            return is_true();
        });
    }
    bool reach_done() {
        return reach([&] { return bench_->is_done(); });
    }
    void open_scene() {
        bench_->open({folder_ / "scene.json", {}});
        ASSERT_TRUE(reach_done()) << bench_->message();
    }
    void send(Kind kind, float x, float y, MouseButton button = MouseButton::left, Modifiers modifiers = {}) {
        InputEvent event;
        event.kind = kind, event.x = x, event.y = y, event.button = button, event.modifiers = modifiers;
        bench_->handle(event);
    }
    void press_key(int key, Modifiers modifiers = {}) {
        InputEvent event;
        event.kind = Kind::key_down, event.key = key, event.modifiers = modifiers;
        bench_->handle(event);
        event.kind = Kind::key_up;
        bench_->handle(event);
    }
    void drag(float x0, float y0, float x1, float y1, MouseButton button = MouseButton::left) {
        send(Kind::press, x0, y0, button);
        for (int k = 1; k <= 8; ++k)
            send(Kind::move, x0 + (x1 - x0) * float(k) / 8, y0 + (y1 - y0) * float(k) / 8, button);
        send(Kind::release, x1, y1, button);
    }
    /// What the command makes of a saved scene.
    std::vector<float> render_file(const std::string& name) {
        const Scene scene = load_scene(folder_ / name);
        RenderSettings settings = settings_;
        settings.image.width = scene.picture.width.value(),
        settings.image.height = scene.picture.height.value();
        settings.image.spp = scene.picture.spp.value();
        return render(scene, settings).image.pixels;
    }

    RenderSettings settings_;
    PictureDefaults given_;
    std::unique_ptr<Workbench> bench_;
};

TEST_F(WorkbenchTest, turned_changed_and_saved_it_renders_to_what_was_seen) {
    open_scene();
    const Vec3f from = bench_->camera().get().from;
    drag(10, 10, 30, 14, MouseButton::middle);
    EXPECT_NE(bench_->camera().get().from, from);
    ViewSettings view;
    apply_values(read_json(R"({"scale": 2.5, "axes": "t,-b,n", "wrap": "repeat"})"), *bench_, view);
    ASSERT_TRUE(reach_done());
    press_key('S');
    ASSERT_TRUE(std::filesystem::exists(folder_ / "scene-view.json")) << bench_->message();
    EXPECT_EQ(render_file("scene-view.json"), bench_->picture()->image.pixels);
}

TEST_F(WorkbenchTest, a_stroke_is_seen_undone_made_again_and_saved) {
    open_scene();
    const std::vector<float> before = bench_->picture()->image.pixels;
    press_key('B');
    EXPECT_EQ(bench_->tool(), Tool::paint);
    bench_->brush().radius = 6;
    bench_->brush().strength = 1;
    drag(18, 14, 32, 18);
    EXPECT_TRUE(bench_->can_undo());
    ASSERT_TRUE(reach_done());
    const std::vector<float> painted = bench_->picture()->image.pixels;
    EXPECT_NE(painted, before);
    press_key('Z', {.control = true});
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, before);
    press_key('Y', {.control = true});
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, painted);
    ASSERT_TRUE(bench_->save(folder_ / "painted.json")) << bench_->message();
    EXPECT_EQ(render_file("painted.json"), painted);
}

TEST_F(WorkbenchTest, a_changed_convention_keeps_what_was_painted) {
    open_scene();
    bench_->set_tool(Tool::paint);
    drag(18, 14, 32, 18);
    bench_->change_document([](Document& document) {
        document.change_displacement(0, [](Displacement& map) { map.scale = {2, 2, 2}; });
    });
    ASSERT_TRUE(reach_done());
    ASSERT_TRUE(bench_->save(folder_ / "both.json"));
    EXPECT_EQ(render_file("both.json"), bench_->picture()->image.pixels);
}

TEST_F(WorkbenchTest, a_map_written_anew_is_shown_and_half_of_one_is_not) {
    open_scene();
    const std::vector<float> before = bench_->picture()->image.pixels;
    const std::filesystem::path file = bench_->document()->scene().displacements[0].tiles[0].texture->file;
    std::string bytes;
    {
        std::ifstream stream(file, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(stream), {});
    }
    std::ofstream(file, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
    ASSERT_TRUE(reach([&] { return !bench_->message().empty(); }));
    EXPECT_NE(bench_->message().find("bumps.exr"), std::string::npos) << bench_->message();
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, before);

    Displacement map = bench_->document()->scene().displacements[0];
    auto texture = std::make_shared<Texture>(*map.tiles[0].texture);
    for (uint32_t k = 0; k < 64; ++k) write_texel(*texture, k, 30, {0, 0, 0.4f});
    map.tiles[0].texture = texture;
    write_map(map, file, MapSamples::float32);
    ASSERT_TRUE(reach([&] { return bench_->message().find("read again") != std::string::npos; }));
    ASSERT_TRUE(reach_done());
    EXPECT_NE(bench_->picture()->image.pixels, before);
    EXPECT_EQ(bench_->picture()->image.pixels,
              render(load_scene(folder_ / "scene.json"), settings_).image.pixels);
}

TEST_F(WorkbenchTest, files_that_are_wrong_leave_what_was_open) {
    open_scene();
    std::ofstream(folder_ / "broken.json") << "{";
    bench_->drop(folder_ / "broken.json");
    ASSERT_TRUE(reach([&] { return !bench_->is_loading(); }));
    EXPECT_NE(bench_->message().find("broken.json"), std::string::npos) << bench_->message();
    ASSERT_TRUE(bench_->document());
    EXPECT_EQ(bench_->document()->input().file, folder_ / "scene.json");
}

TEST_F(WorkbenchTest, a_map_dropped_on_a_mesh_displaces_it) {
    bench_->drop(folder_ / "maps" / "bumps.exr");
    EXPECT_FALSE(bench_->is_loading());
    bench_->drop(folder_ / "meshes" / "plane.obj");
    ASSERT_TRUE(reach_done()) << bench_->message();
    EXPECT_TRUE(bench_->document()->scene().displacements.empty());
    press_key(kLeft);
    const Camera camera = bench_->camera().get();
    bench_->drop(folder_ / "maps" / "bumps.exr");
    ASSERT_TRUE(reach_done()) << bench_->message();
    EXPECT_EQ(bench_->document()->scene().displacements.size(), 1u);
    EXPECT_EQ(bench_->camera().get().from, camera.from);
}

TEST_F(WorkbenchTest, a_click_explains_a_pixel_and_a_picture_is_written_when_it_is_done) {
    open_scene();
    send(Kind::press, 24, 16), send(Kind::release, 24, 16);
    ASSERT_TRUE(reach([&] { return bench_->explanation().size() > 10; }));
    for (const char* word : {"object   0 'plane'", "patch ", "texel (", "moved ", "colour "})
        EXPECT_NE(bench_->explanation().find(word), std::string::npos) << bench_->explanation();
    bench_->write_picture(folder_ / "out.exr");
    ASSERT_TRUE(reach([&] { return std::filesystem::exists(folder_ / "out.exr"); }));
    EXPECT_EQ(read_image(folder_ / "out.exr").pixels.size(), bench_->picture()->image.pixels.size());
}

TEST_F(WorkbenchTest, keys_turn_frame_and_end) {
    open_scene();
    const Vec3f from = bench_->camera().get().from;
    press_key(kRight), press_key('+');
    EXPECT_NE(bench_->camera().get().from, from);
    EXPECT_LT(bench_->camera().distance(), 3.9f);
    press_key('.');
    EXPECT_GT(bench_->camera().distance(), 3.5f);
    press_key(kF1);
    EXPECT_TRUE(bench_->is_help_shown());
    EXPECT_FALSE(bench_->wants_to_end());
    press_key('Q', {.control = true});
    EXPECT_TRUE(bench_->wants_to_end());
}

TEST_F(WorkbenchTest, focus_brings_the_place_of_a_click_into_the_middle) {
    open_scene();
    send(Kind::press, 34, 10, MouseButton::left, {.control = true});
    send(Kind::release, 34, 10);
    EXPECT_GT(bench_->camera().get().to.x, 0.3f);
    EXPECT_GT(bench_->camera().get().to.y, 0.2f);
    EXPECT_NEAR(bench_->camera().distance(), 4, 0.3f);
}

TEST_F(WorkbenchTest, values_that_mean_nothing_are_refused) {
    open_scene();
    ViewSettings view;
    for (const char* text :
         {R"({"scael": 2})", R"({"scale": [1, 2]})", R"({"view": "smell"})", R"({"tool": "hammer"})",
          R"({"displacement": "none", "scale": 1})", R"({"spp": 0})", R"({"axes": "t,t,t"})"})
        EXPECT_THROW(apply_values(read_json(text), *bench_, view), Error) << text;
    apply_values(read_json(R"({"view": "depth", "exposure": 2, "tool": "smooth", "radius": 12})"), *bench_,
                 view);
    EXPECT_EQ(view.view, View::depth);
    EXPECT_EQ(bench_->brush().kind, BrushKind::smooth);
}

} // namespace relief::viewer
