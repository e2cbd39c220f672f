// What was painted survives: names that other files have, files that change, and the end of the viewer.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "common/texel_values.h"
#include "relief/error.h"
#include "relief/io.h"
#include "viewer/document.h"
#include "viewer/file_watch.h"
#include "viewer/user_state.h"
#include "viewer/workbench_fixture.h"

namespace relief::viewer {

class KeptPaint : public FolderTest {
  protected:
    void SetUp() override {
        FolderTest::SetUp();
        write_scene_files();
    }
    Document open_document() {
        const SceneInput input{folder_ / "scene.json", {}, {}};
        return Document(input, load_input(input).scene);
    }
    static void paint(Document& document, float height, size_t map = 0) {
        write_texel(document.paint_tile(map, 1001), 12, 20, {0, 0, height});
    }
    static float read_height(const std::filesystem::path& file) {
        return read_texel(read_texture(file), 12, 20).z;
    }
    std::filesystem::path state() const { return folder_ / "state"; }
    ImageSettings image_ = make_small_settings().image;
};

TEST_F(KeptPaint, saved_maps_take_the_place_of_no_other_files) {
    Document first = open_document();
    paint(first, 0.25f);
    first.save(folder_ / "painted.json", image_);
    paint(first, 0.5f);
    EXPECT_EQ(first.save(folder_ / "painted.json", image_)[0], folder_ / "painted_bumps.exr");
    Document second = open_document();
    paint(second, 0.75f);
    EXPECT_EQ(second.save(folder_ / "painted.json", image_)[0], folder_ / "painted_bumps-2.exr");
    EXPECT_EQ(read_height(folder_ / "painted_bumps.exr"), 0.5f);
    EXPECT_EQ(read_height(folder_ / "painted_bumps-2.exr"), 0.75f);
    EXPECT_THROW(second.save_map(0, folder_ / "painted_bumps.exr", second.scene().displacements[0]), Error);
}

TEST_F(KeptPaint, names_alike_in_files_stay_two_files) {
    Scene scene = load_scene(folder_ / "scene.json");
    scene.displacements.push_back(scene.displacements[0]);
    scene.displacements[0].name = "a.b", scene.displacements[1].name = "a_b";
    scene.displacements[1].tiles[0].texture =
        std::make_shared<const Texture>(*scene.displacements[0].tiles[0].texture);
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].displacement = 1;
    save_scene(scene, folder_ / "two");
    const SceneInput input{folder_ / "two" / "scene.json", {}, {}};
    Document document(input, load_input(input).scene);
    paint(document, 0.25f, 0);
    paint(document, 0.5f, 1);
    const auto written = document.save(folder_ / "painted.json", image_);
    ASSERT_EQ(written.size(), 3u);
    EXPECT_EQ(read_height(written[0]), 0.25f);
    EXPECT_EQ(read_height(written[1]), 0.5f);
}

TEST_F(KeptPaint, is_kept_after_half_a_minute_and_found_by_the_next_run) {
    Document document = open_document();
    {
        UserState state(this->state());
        state.keep_painted(100, document);
        paint(document, 0.25f);
        state.keep_painted(120, document);
        EXPECT_FALSE(std::filesystem::exists(this->state()));
        state.keep_painted(131, document);
    } // waits for the thread
    UserState state(this->state());
    const auto kept = state.claim_painted(document.input().file);
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_EQ(read_height(kept[0]), 0.25f);
    EXPECT_TRUE(state.claim_painted(document.input().file).empty());
    // Neither a save nor other paint takes it away.
    Document next = open_document();
    paint(next, 0.5f);
    state.keep_now(next);
    state.forget_painted();
    EXPECT_EQ(read_height(kept[0]), 0.25f);
    EXPECT_EQ(state.claim_painted(next.input().file).size(), 1u);
}

TEST_F(KeptPaint, is_forgotten_once_it_was_saved) {
    Document document = open_document();
    UserState state(this->state());
    state.keep_painted(0, document);
    paint(document, 0.25f);
    state.keep_painted(31, document);
    document.save(folder_ / "painted.json", image_);
    state.forget_painted();
    EXPECT_TRUE(state.claim_painted(document.input().file).empty());
}

TEST_F(KeptPaint, stays_with_a_viewer_that_still_runs) {
    Document document = open_document();
    paint(document, 0.25f);
    UserState state(this->state());
    state.keep_now(document);
    // As if process 1, which always runs, had kept it.
    const std::filesystem::path kept = *std::filesystem::directory_iterator(this->state());
    std::string name = kept.string();
    const std::string process = "-" + std::to_string(getpid()) + "-";
    name.replace(name.rfind(process), process.size(), "-1-");
    std::filesystem::rename(kept, name);
    EXPECT_TRUE(state.claim_painted(document.input().file).empty());
    EXPECT_TRUE(std::filesystem::exists(name));
}

TEST_F(KeptPaint, of_maps_that_are_set_aside_faster_than_they_are_written_the_last_one_stays) {
    Document document = open_document();
    UserState state(this->state());
    std::filesystem::path file;
    for (int k = 1; k <= 40; ++k) {
        paint(document, float(k) / 64);
        const auto scene = document.snapshot();
        file = state.set_aside(document.input().file, scene->scene.displacements[0], 2);
    }
    state.forget_painted(); // waits
    EXPECT_EQ(read_height(file), 40.0f / 64);
    EXPECT_TRUE(state.take_errors().empty());
    for (const auto& entry : std::filesystem::directory_iterator(this->state()))
        EXPECT_EQ(entry.path(), file);
}

TEST_F(KeptPaint, what_was_set_aside_is_written_again_where_it_was_painted_on_alone) {
    Document document = open_document();
    UserState state(this->state());
    paint(document, 0.25f);
    std::filesystem::path file;
    const auto set_aside = [&] {
        const auto scene = document.snapshot();
        file = state.set_aside(document.input().file, scene->scene.displacements[0], 2);
    };
    set_aside();
    ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(file); }));
    const auto long_ago = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
    std::filesystem::last_write_time(file, long_ago);
    const auto written = std::filesystem::last_write_time(file);
    set_aside();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(std::filesystem::last_write_time(file), written);
    paint(document, 0.5f);
    set_aside();
    EXPECT_TRUE(wait_until([&] { return std::filesystem::last_write_time(file) != written; }));
    EXPECT_EQ(read_height(file), 0.5f);
}

TEST_F(KeptPaint, of_other_frames_goes_with_what_is_discarded) {
    Document document = open_document();
    paint(document, 0.25f);
    const std::shared_ptr<const SharedScene> scene = document.snapshot();
    {
        UserState state(this->state());
        const auto file = state.set_aside(document.input().file, scene->scene.displacements[0], 2);
        ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(file); }));
        state.discard();
        EXPECT_FALSE(std::filesystem::exists(file));
    }
    EXPECT_TRUE(UserState(this->state()).claim_painted(document.input().file).empty());
}

TEST_F(KeptPaint, a_file_that_comes_later_is_reported) {
    FileWatch watch;
    watch.watch({folder_ / "late.txt"});
    std::ofstream(folder_ / "late.txt") << "here";
    watch.poll();
    watch.watch({folder_ / "late.txt"}); // as it was reported last: not at all
    EXPECT_EQ(watch.poll().size(), 1u);
}

class PaintedWorkbench : public WorkbenchTest {
  protected:
    void SetUp() override {
        WorkbenchTest::SetUp();
        bench_ = std::make_unique<Workbench>(settings_, given_, nullptr, folder_ / "state");
        open_scene();
        write_texel(bench_->document()->paint_tile(0, 1001), 12, 20, {0, 0, 0.25f});
    }
};

TEST_F(PaintedWorkbench, what_was_painted_is_kept_at_the_end) {
    const std::filesystem::path file = bench_->document()->input().file;
    bench_.reset();
    EXPECT_EQ(UserState(folder_ / "state").claim_painted(file).size(), 1u);
}

TEST_F(PaintedWorkbench, what_was_discarded_is_not_kept) {
    const std::filesystem::path file = bench_->document()->input().file;
    bench_->ask_to_open({file});
    ASSERT_TRUE(bench_->is_asked_to_open());
    bench_->open_asked();
    ASSERT_TRUE(reach([&] { return !bench_->is_loading(); }));
    EXPECT_EQ(bench_->message().find("painted before"), std::string::npos) << bench_->message();
    write_texel(bench_->document()->paint_tile(0, 1001), 12, 20, {0, 0, 0.5f});
    bench_->ask_to_open({folder_ / "maps" / "bumps.exr"});
    bench_->open_asked(); // opens nothing, so that nothing goes
    bench_.reset();
    EXPECT_EQ(UserState(folder_ / "state").claim_painted(file).size(), 1u);
}

TEST_F(PaintedWorkbench, what_was_discarded_at_the_end_is_not_kept) {
    const std::filesystem::path file = bench_->document()->input().file;
    bench_->discard();
    bench_.reset();
    EXPECT_EQ(UserState(folder_ / "state").claim_painted(file).size(), 0u);
}

TEST_F(PaintedWorkbench, another_scene_does_not_take_it_away) {
    const std::filesystem::path file = bench_->document()->input().file;
    bench_->open({file, {}, {}});
    bench_->open({file, {}, {}}); // the first one is dropped, and nothing waits for it
    ASSERT_TRUE(reach([&] { return !bench_->is_loading(); }));
    EXPECT_NE(bench_->message().find("painted before and not saved"), std::string::npos) << bench_->message();
    EXPECT_FALSE(bench_->document()->has_painted());
}

TEST_F(PaintedWorkbench, files_that_change_do_not_take_it_away) {
    const std::filesystem::path map = bench_->document()->scene().displacements[0].tiles[0].texture->file;
    Displacement flat = load_scene(folder_ / "scene.json").displacements[0];
    Texture texels = *flat.tiles[0].texture;
    write_texel(texels, 12, 20, {0, 0, 0.75f});
    flat.tiles[0].texture = std::make_shared<const Texture>(texels);
    write_map(flat, map, MapSamples::float32);
    ASSERT_TRUE(
        reach([&] { return bench_->message().find("what was painted on it stays") != std::string::npos; }));
    EXPECT_EQ(read_texel(bench_->document()->paint_tile(0, 1001), 12, 20).z, 0.25f);
    std::ofstream(folder_ / "scene.json", std::ios::app) << "\n";
    ASSERT_TRUE(reach([&] { return bench_->message().find("changed on the disk") != std::string::npos; }));
    EXPECT_TRUE(bench_->document()->has_painted());
}

} // namespace relief::viewer
