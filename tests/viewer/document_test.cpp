// Documents: what is saved is what was seen.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "common/texel_values.h"
#include "relief/error.h"
#include "relief/io.h"
#include "viewer/event_script.h"
#include "viewer/file_watch.h"
#include "viewer/fixture.h"

namespace relief::viewer {

namespace {

Document open_document(const SceneInput& input) { return Document(input, load_input(input).scene); }

std::vector<float> render_colors(const Scene& scene) {
    return render(scene, make_small_settings()).image.pixels;
}

} // namespace

class DocumentTest : public FolderTest {
  protected:
    void SetUp() override {
        FolderTest::SetUp();
        write_scene_files();
    }
    ImageSettings image_ = make_small_settings().image;
};

TEST_F(DocumentTest, a_changed_scene_is_read_again_as_it_was_seen) {
    Document document = open_document({folder_ / "scene.json", {}, {}});
    EXPECT_FALSE(document.has_changes());
    document.change_displacement(0, [](Displacement& map) {
        map.scale = {2, 2, 2};
        map.axes = {{0, 2, 1}, {1, -1, 1}};
        map.wrap = WrapMode::repeat;
    });
    document.change_material(0, [](Material& clay) { clay.roughness = 0.25f, clay.metallic = 0.5f; });
    document.change_environment([](Environment& environment) { environment.strength = 0.5f; });
    Camera camera = document.scene().camera;
    camera.from = {1, 1, 3};
    document.set_camera(camera);
    EXPECT_TRUE(document.has_changes());
    EXPECT_EQ(document.version(), 4u);
    document.save(folder_ / "changed.json", image_);
    EXPECT_FALSE(document.has_changes());
    const Scene again = load_scene(folder_ / "changed.json");
    EXPECT_EQ(again.picture.width, 48);
    EXPECT_EQ(again.picture.spp, 4);
    EXPECT_EQ(again.displacements[0].axes, (AxisMap{{0, 2, 1}, {1, -1, 1}}));
    EXPECT_EQ(again.materials[0].metallic, 0.5f);
    EXPECT_EQ(render_colors(again), render_colors(make_whole(*document.snapshot())));
}

TEST_F(DocumentTest, a_mesh_and_its_map_are_saved_with_their_convention) {
    SceneInput input{folder_ / "meshes" / "plane.obj", {}, {}};
    input.mesh.displacement_map = folder_ / "maps" / "bumps.exr";
    input.mesh.map.preset = "mudbox";
    Document document = open_document(input);
    document.change_displacement(0, [](Displacement& map) { map.scale = {3, 3, 3}, map.axes = {}; });
    document.save(folder_ / "mesh.json", image_);
    const Scene again = load_scene(folder_ / "mesh.json");
    EXPECT_EQ(again.displacements[0].axes, AxisMap());
    EXPECT_EQ(render_colors(again), render_colors(make_whole(*document.snapshot())));
}

TEST_F(DocumentTest, painted_maps_are_written_beside_the_scene) {
    Document document = open_document({folder_ / "scene.json", {}, {}});
    const std::string before = document.scene().displacements[0].tiles[0].texture->file;
    for (uint32_t k = 10; k < 30; ++k) write_texel(document.paint_tile(0, 1001), k, 20, {0, 0, 0.37f});
    EXPECT_TRUE(document.has_painted());
    EXPECT_EQ(document.version(), 1u); // sessions follow by edits
    const auto written = document.save(folder_ / "painted.json", image_);
    ASSERT_EQ(written.size(), 2u);
    EXPECT_EQ(written[0], folder_ / "painted_bumps.exr");
    EXPECT_FALSE(document.has_painted());
    const Scene again = load_scene(folder_ / "painted.json");
    EXPECT_EQ(read_texel(*again.displacements[0].tiles[0].texture, 12, 20).z, 0.37f);
    EXPECT_EQ(render_colors(again), render_colors(make_whole(*document.snapshot())));
    EXPECT_EQ(read_texel(read_texture(before), 12, 20).z,
              read_texel(*make_bumps(false), 12, 20).z); // the map that was opened stays
}

TEST_F(DocumentTest, what_was_opened_is_never_written_over) {
    Document document = open_document({folder_ / "scene.json", {}, {}});
    EXPECT_THROW(document.save(folder_ / "scene.json", image_), Error);
    const std::string map = document.scene().displacements[0].tiles[0].texture->file;
    EXPECT_THROW(document.save_map(0, map, document.scene().displacements[0]), Error);
    Displacement mudbox = document.scene().displacements[0];
    mudbox.axes = {{0, 2, 1}, {1, 1, 1}};
    document.save_map(0, folder_ / "mudbox.exr", mudbox);
    const Vec3f there = read_texel(read_texture(folder_ / "mudbox.exr"), 12, 20);
    EXPECT_EQ(there.y, read_texel(*make_bumps(false), 12, 20).z);
}

TEST_F(DocumentTest, painting_asks_for_a_tile_that_is_there) {
    Document document = open_document({folder_ / "scene.json", {}, {}});
    EXPECT_THROW(document.paint_tile(0, 1002), Error);
    document.change_displacement(0, [](Displacement& map) { map.dequantize = true; });
    EXPECT_THROW(document.paint_tile(0, 1001), Error);
    EXPECT_FALSE(document.has_painted());
}

TEST_F(DocumentTest, a_picture_is_no_scene) {
    try {
        load_input({folder_ / "maps" / "bumps.exr", {}, {}});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(error.hint().find("--vdm"), std::string::npos);
    }
}

class FileWatchTest : public FolderTest {
  protected:
    void write(const std::string& text) { std::ofstream(folder_ / "a.txt") << text; }
};

TEST_F(FileWatchTest, changes_are_told_once_and_after_they_are_over) {
    write("one");
    FileWatch watch;
    watch.watch({folder_ / "a.txt", folder_ / "missing.txt"});
    EXPECT_TRUE(watch.poll().empty());
    write("other");
    EXPECT_TRUE(watch.poll().empty()); // maybe it is still being written
    EXPECT_EQ(watch.poll().size(), 1u);
    EXPECT_TRUE(watch.poll().empty());
    std::filesystem::remove(folder_ / "a.txt");
    EXPECT_TRUE(watch.poll().empty());
    EXPECT_TRUE(watch.poll().empty());
    write("third one");
    watch.poll();
    EXPECT_EQ(watch.poll().size(), 1u);
    write("by ourselves");
    watch.accept(folder_ / "a.txt");
    watch.poll();
    EXPECT_TRUE(watch.poll().empty());
}

TEST(EventScript, lines_become_steps) {
    std::istringstream text(R"(// a demonstration

{"wait": "done"}
{"wait": 0.5}
{"drag": "middle", "from": [10, 20], "to": [30, 40], "seconds": 2, "modifiers": ["shift"]}
{"key": "s", "modifiers": ["control"]}
{"set": {"scale": 2}}
{"open": "a.obj", "vdm": "b.exr"}
{"quit": true}
)");
    const std::vector<ScriptLine> lines = read_script(text, "demo.jsonl");
    ASSERT_EQ(lines.size(), 7u);
    EXPECT_EQ(lines[0].number, 3u);
    EXPECT_EQ(std::get<WaitStep>(lines[0].step).what, WaitStep::For::done);
    EXPECT_EQ(std::get<WaitStep>(lines[1].step).seconds, 0.5);
    const DragStep& drag = std::get<DragStep>(lines[2].step);
    EXPECT_EQ(drag.button, MouseButton::middle);
    EXPECT_TRUE(drag.modifiers.shift);
    EXPECT_EQ(drag.to.x, 30);
    EXPECT_EQ(std::get<EventStep>(lines[3].step).event.key, 'S');
    EXPECT_EQ(std::get<FileStep>(lines[5].step).map, "b.exr");
    EXPECT_TRUE(std::holds_alternative<QuitStep>(lines[6].step));
}

TEST(EventScript, has_a_mark_and_any_ends_of_lines_and_little_nesting) {
    for (const std::string end : {"\n", "\r", "\r\n"}) {
        std::istringstream text("\xef\xbb\xbf// first" + end + R"({"quit": true})" + end);
        const std::vector<ScriptLine> lines = read_script(text, "demo.jsonl");
        ASSERT_EQ(lines.size(), 1u);
        EXPECT_EQ(lines[0].number, 2u);
    }
    std::istringstream deep("{\"set\": " + std::string(1000000, '['));
    try {
        read_script(deep, "demo.jsonl");
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_NE(error.message().find("levels deep"), std::string::npos) << error.what();
    }
}

TEST_F(FileWatchTest, a_script_that_cannot_be_read_is_refused) {
    for (const std::filesystem::path& file : {folder_, folder_ / "missing.jsonl"}) {
        std::ifstream stream(file);
        try {
            read_script(stream, file.string());
            ADD_FAILURE() << file;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::bad_input);
            EXPECT_EQ(error.where(), file.string());
        }
    }
}

TEST(EventScript, mistakes_name_their_line) {
    for (const char* line :
         {"{", "3", R"({"jump": 1})", R"({"wait": "for it"})", R"({"drag": "left", "from": [1, 2]})",
          R"({"drag": "left", "from": [1], "to": [1, 2]})", R"({"key": "hyper"})", R"({"set": 1})",
          R"({"open": "a", "vmd": "b"})", R"({"press": "left", "at": [0, 0], "modifiers": ["super"]})",
          R"({"wait": 4000})", R"({"wait": -1})"}) {
        std::istringstream text(std::string("\n") + line + "\n");
        try {
            read_script(text, "demo.jsonl");
            ADD_FAILURE() << line;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::bad_input);
            EXPECT_EQ(error.where(), "demo.jsonl:2") << error.what();
        }
    }
}

} // namespace relief::viewer
