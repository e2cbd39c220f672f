// Scenes whose values have keys: frames are shown, and saved as they were seen.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "relief/io.h"
#include "viewer/workbench_fixture.h"

namespace relief::viewer {

class FrameTest : public WorkbenchTest {
  protected:
    /// The bumpy plane with keys in place of one value.
    void write_animated(const std::string& key, const std::string& value) {
        std::ifstream stream(folder_ / "scene.json");
        std::string text(std::istreambuf_iterator<char>(stream), {});
        const size_t at = text.find(key);
        ASSERT_NE(at, std::string::npos) << text;
        const size_t start = text.find_first_not_of(" :", at + key.size());
        const size_t end = text[start] == '[' ? text.find(']', start) + 1 : text.find_first_of(",\n}", start);
        text.replace(start, end - start, value);
        const size_t brace = text.find('{');
        text.insert(brace + 1, R"("render": {"frames": "1-5"},)");
        std::ofstream(folder_ / "shot.json") << text;
        bench_->open({folder_ / "shot.json", {}, {}});
        ASSERT_TRUE(reach_done()) << bench_->message();
    }
};

TEST_F(FrameTest, a_frame_is_shown_and_saved_without_its_keys) {
    write_animated("\"scale\"", R"({"keys": [[1, 0], [5, 2]]})");
    EXPECT_EQ(bench_->frame(), 1);
    EXPECT_EQ(bench_->frames(), (std::vector<int>{1, 2, 3, 4, 5}));
    const std::vector<float> first = bench_->picture()->image.pixels;
    ASSERT_TRUE(bench_->show_frame(4));
    ASSERT_TRUE(reach([&] { return !bench_->is_loading(); }));
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->frame(), 4);
    EXPECT_EQ(bench_->document()->scene().displacements[0].scale.x, 1.5f);
    EXPECT_NE(bench_->picture()->image.pixels, first);
    ASSERT_TRUE(bench_->save(folder_ / "seen.json")) << bench_->message();
    EXPECT_EQ(render_file("seen.json"), bench_->picture()->image.pixels);
}

TEST_F(FrameTest, changes_that_are_not_saved_are_not_dropped_for_another_frame) {
    write_animated("\"scale\"", R"({"keys": [[1, 1], [5, 2]]})");
    bench_->change_document([](Document& document) {
        document.change_displacement(0, [](Displacement& map) { map.midlevel = {0, 0, 0.1f}; });
    });
    EXPECT_FALSE(bench_->show_frame(3));
    EXPECT_NE(bench_->message().find("save"), std::string::npos);
    EXPECT_EQ(bench_->frame(), 1);
    ASSERT_TRUE(bench_->save(folder_ / "changed.json"));
    EXPECT_TRUE(bench_->show_frame(3));
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->document()->scene().displacements[0].scale.x, 1.5f);
}

TEST_F(FrameTest, a_camera_with_keys_moves_until_somebody_else_moves_it) {
    write_animated("\"from\"", R"({"keys": [[1, [0, 0, 4]], [5, [4, 0, 4]]]})");
    ASSERT_TRUE(bench_->show_frame(3));
    EXPECT_FALSE(bench_->is_loading());
    EXPECT_EQ(bench_->camera().get().from.x, 2);
    ASSERT_TRUE(reach_done());
    ASSERT_TRUE(bench_->show_frame(5));
    EXPECT_EQ(bench_->camera().get().from.x, 4);
    press_key(kLeft);
    const Vec3f from = bench_->camera().get().from;
    ASSERT_TRUE(bench_->show_frame(1));
    EXPECT_EQ(bench_->camera().get().from, from);
    EXPECT_EQ(bench_->frame(), 1);
}

TEST_F(FrameTest, a_scene_without_keys_has_no_frames) {
    open_scene();
    EXPECT_FALSE(bench_->frame());
    EXPECT_TRUE(bench_->frames().empty());
    EXPECT_FALSE(bench_->show_frame(2));
}

} // namespace relief::viewer
