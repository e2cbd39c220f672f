// Whole renders: the picture, its parts, its statistics and its interruption.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "command.h"
#include "relief/io.h"
#include "small_disk.h"

namespace relief::cli {
namespace {

using nlohmann::json;

class Render : public CommandTest {
  protected:
    void render_ok(const std::string& output, const std::vector<std::string>& more) {
        const CommandResult result = render_bump(output, more);
        ASSERT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_NE(result.output.find("wrote " + output + "\n"), std::string::npos) << result.output;
    }
    void expect_same(const std::string& a, const std::string& b, const char* threshold) {
        const CommandResult result = run({"compare", a, b, "--threshold", threshold, "--json"});
        EXPECT_EQ(result.exit_code, 0) << result.output << result.errors;
    }
};

TEST_F(Render, makes_a_picture_with_layers_and_a_header) {
    render_ok("a.exr", {"--layers", "depth,N,id", "--seed", "7"});
    const Image image = read_image(folder_ / "a.exr");
    EXPECT_EQ(image.width, 24);
    EXPECT_EQ(image.height, 16);
    for (const char* name : {"R", "G", "B", "A", "depth.Z", "N.X", "id.I", "samples.Y"})
        EXPECT_TRUE(image.find_channel(name).has_value()) << name;
    EXPECT_EQ(image.metadata.at("relief:seed"), "7");
    EXPECT_EQ(image.metadata.at("relief:samples"), "0:4");
    EXPECT_EQ(image.metadata.at("relief:scene_hash").size(), 16u);
    EXPECT_TRUE(image.metadata.count("relief:version"));
    float covered = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x) covered += image.at(x, y, *image.find_channel("A"));
    EXPECT_GT(covered, 40) << "the plane is in view";
}

TEST_F(Render, writes_png_and_hdr_by_extension) {
    render_ok("a.png", {});
    render_ok("a.hdr", {});
    EXPECT_EQ(read("a.png").substr(1, 3), "PNG");
    EXPECT_EQ(read("a.hdr").substr(0, 2), "#?");
}

TEST_F(Render, tiles_and_sample_ranges_merge_into_the_whole) {
    render_ok("whole.exr", {});
    std::vector<std::string> merge = {"merge", "-o", "merged.exr"};
    for (const char* tile : {"0/3", "1/3", "2/3"}) {
        const std::string name = std::string("tile") + tile[0] + ".exr";
        render_ok(name, {"--tile", tile});
        merge.push_back(name);
    }
    const CommandResult joined = run(merge);
    ASSERT_EQ(joined.exit_code, 0);
    EXPECT_EQ(joined.errors, "");
    expect_same("whole.exr", "merged.exr", "0");
    render_ok("s0.exr", {"--samples", "0:1"});
    render_ok("s1.exr", {"--samples", "1:4"});
    const CommandResult merged = run({"merge", "s1.exr", "s0.exr", "-o", "samples.exr"});
    ASSERT_EQ(merged.exit_code, 0) << merged.errors;
    expect_same("whole.exr", "samples.exr", "1e-4");
}

TEST_F(Render, exits_5_before_it_starts_when_the_picture_does_not_fit_into_memory) {
    const CommandResult result = run({"render", "plane.obj", "-o", "a.exr", "--size", "65536x65536",
                                      "--layers", "depth,N,Ng,P,albedo,uv,id,samples,variance,cost"});
    EXPECT_EQ(result.exit_code, 5) << result.errors;
    EXPECT_NE(result.errors.find("the picture needs"), std::string::npos) << result.errors;
    EXPECT_FALSE(exists("a.exr"));
}

TEST_F(Render, gives_the_same_bits_for_any_number_of_threads) {
    render_ok("one.exr", {"--threads", "1"});
    render_ok("two.exr", {"--threads", "2"});
    expect_same("one.exr", "two.exr", "0");
}

TEST_F(Render, how_a_map_is_read_can_be_said_on_the_command_line) {
    // Waves finer than the cells, on an island in the middle of a map without displacement.
    Image map;
    map.width = map.full_width = map.height = map.full_height = 64;
    map.channels = {"R", "G", "B"};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const bool is_inside = x >= 16 && x < 48 && y >= 16 && y < 48;
            map.pixels.insert(map.pixels.end(), {0, 0, is_inside ? 0.3f + 0.1f * float((x + y) % 3) : 0});
        }
    write_image(map, folder_ / "waves.exr");
    write("island.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                        "vt .25 .25\nvt .75 .25\nvt .75 .75\nvt .25 .75\nf 1/1 2/2 3/3 4/4\n");
    const auto render_island = [&](const std::string& output, const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"render", "island.obj", "--vdm",   "waves.exr",
                                              "--size", "48x32",      "--level", "3",
                                              "--spp",  "4",          "-o",      output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const CommandResult result = run(arguments);
        ASSERT_EQ(result.exit_code, 0) << result.errors;
    };
    const auto expect_differs = [&](const std::string& a, const std::string& b) {
        EXPECT_EQ(run({"compare", a, b, "--threshold", "0.01"}).exit_code, 7) << a << " and " << b;
    };
    render_island("plain.exr", {});
    render_island("none.exr", {"--filter", "none"});
    expect_same("plain.exr", "none.exr", "0");
    render_island("mip.exr", {"--filter", "mip"});
    expect_differs("plain.exr", "mip.exr");
    render_island("bump.exr", {"--autobump"});
    expect_differs("plain.exr", "bump.exr");
    render_island("raw.exr", {"--no-dilate"});
    expect_differs("plain.exr", "raw.exr");
}

TEST_F(Render, compare_exits_7_above_the_threshold_only) {
    render_ok("a.exr", {"--seed", "1"});
    render_ok("b.exr", {"--seed", "2"});
    const CommandResult result = run({"compare", "a.exr", "b.exr", "--json"});
    EXPECT_EQ(result.exit_code, 7);
    const json difference = json::parse(result.output);
    EXPECT_EQ(difference["pixels"], 24 * 16);
    EXPECT_GT(difference["over_threshold"], 0);
    EXPECT_GT(difference["max"], 0.0);
    EXPECT_EQ(run({"compare", "a.exr", "b.exr", "--threshold", "1e6"}).exit_code, 0);
}

TEST_F(Render, statistics_hold_every_stable_key) {
    render_ok("a.exr", {"--stats", "s.json"});
    const json s = json::parse(read("s.json"));
    for (const char* key : {"/relief/version",
                            "/device/engine",
                            "/device/name",
                            "/device/threads",
                            "/device/isa",
                            "/image/width",
                            "/image/height",
                            "/image/spp",
                            "/image/bounces",
                            "/scene/meshes",
                            "/scene/instances",
                            "/scene/patches",
                            "/scene/triangles",
                            "/scene/displacement_texels",
                            "/time_s/load",
                            "/time_s/prepare",
                            "/time_s/first_image",
                            "/time_s/render",
                            "/time_s/write",
                            "/time_s/total",
                            "/stage_s/top_traversal",
                            "/stage_s/sort",
                            "/stage_s/bottom_build",
                            "/stage_s/bottom_traversal",
                            "/stage_s/shade",
                            "/stage_s/film",
                            "/rays/camera",
                            "/rays/shadow",
                            "/rays/bounce",
                            "/rays/total",
                            "/rays/per_second",
                            "/casts/0/depth",
                            "/casts/0/kind",
                            "/casts/0/rays",
                            "/casts/0/pairs",
                            "/casts/0/top_traversal_s",
                            "/casts/0/sort_s",
                            "/casts/0/bottom_build_s",
                            "/casts/0/bottom_traversal_s",
                            "/pairs/emitted",
                            "/pairs/with_hit",
                            "/visits/upper_nodes",
                            "/visits/patch_nodes",
                            "/visits/blocks",
                            "/bottom/built",
                            "/bottom/reused",
                            "/bottom/levels",
                            "/memory_bytes/geometry",
                            "/memory_bytes/structures",
                            "/memory_bytes/displacement",
                            "/memory_bytes/bottom_cache",
                            "/memory_bytes/ray_buffers",
                            "/memory_bytes/total",
                            "/memory_bytes/peak_resident",
                            "/warnings"})
        EXPECT_TRUE(s.contains(json::json_pointer(key))) << key;
    EXPECT_EQ(s["device"]["engine"], "cpu");
    EXPECT_EQ(s["rays"]["camera"], 24 * 16 * 4);
    EXPECT_EQ(s["scene"]["patches"], 1);
    EXPECT_EQ(s["scene"]["displacement_texels"], 16 * 16);
    EXPECT_GT(s["memory_bytes"]["total"], 0);
    EXPECT_GT(s["time_s"]["total"], 0.0);
}

TEST_F(Render, statistics_add_up) {
    render_ok("a.exr", {"--stats", "s.json", "--level", "4"});
    const json s = json::parse(read("s.json"));
    EXPECT_EQ(s["image"]["is_complete"], true);
    EXPECT_EQ(s["image"]["whole_samples"], s["image"]["spp"]);
    const json& rays = s["rays"];
    for (const char* kind : {"camera", "shadow", "bounce"}) EXPECT_GT(rays[kind], 0) << kind;
    EXPECT_EQ(rays["total"], rays["camera"].get<uint64_t>() + rays["shadow"].get<uint64_t>() +
                                 rays["bounce"].get<uint64_t>());
    EXPECT_GT(rays["per_second"], 0.0);
    EXPECT_EQ(s["casts"][0]["kind"], "camera");
    EXPECT_EQ(s["casts"][0]["rays"], rays["camera"]);
    EXPECT_EQ(s["casts"][1]["kind"], "shadow");
    const json& memory = s["memory_bytes"];
    uint64_t parts = 0;
    for (const char* kind : {"geometry", "structures", "displacement", "bottom_cache", "ray_buffers"}) {
        EXPECT_GT(memory[kind], 0) << kind;
        parts += memory[kind].get<uint64_t>();
    }
    EXPECT_EQ(memory["total"], parts);
    EXPECT_GE(memory["peak_resident"], memory["total"]);
    EXPECT_GE(s["pairs"]["emitted"], s["pairs"]["with_hit"]);
    EXPECT_GT(s["pairs"]["with_hit"], 0);
    EXPECT_GT(s["bottom"]["built"], 0);
    uint64_t built = 0;
    for (const json& count : s["bottom"]["levels"]) built += count.get<uint64_t>();
    EXPECT_EQ(s["bottom"]["built"], built);
    const json& time = s["time_s"];
    for (const char* part : {"load", "prepare", "first_image", "render", "write"}) {
        EXPECT_GT(time[part], 0.0) << part;
        EXPECT_LE(time[part], time["total"]) << part;
    }
    EXPECT_LE(time["load"].get<double>() + time["prepare"].get<double>() + time["render"].get<double>() +
                  time["write"].get<double>(),
              time["total"].get<double>());
    for (const auto& [stage, seconds] : s["stage_s"].items()) EXPECT_GE(seconds, 0.0) << stage;
}

TEST_F(Render, limits_indirect_light_as_cycles_does_unless_told_otherwise) {
    render_ok("a.exr", {"--stats", "s.json"});
    EXPECT_EQ(json::parse(read("s.json"))["image"]["clamp_indirect"], 10);
    render_ok("b.exr", {"--clamp-indirect", "0", "--stats", "s.json"});
    EXPECT_EQ(json::parse(read("s.json"))["image"]["clamp_indirect"], 0);
    EXPECT_NE(run({"render", "--help"}).output.find("--clamp-indirect F"), std::string::npos);
}

TEST_F(Render, the_structure_and_traversal_of_the_options_are_those_that_trace) {
    ASSERT_EQ(run({"scene", "rock", "-o", "rock"}).exit_code, 0);
    const auto trace = [&](const std::vector<std::string>& options) {
        std::vector<std::string> all = {"render", "rock/scene.json", "-o",    "a.exr",     "--size",
                                        "16x16",  "--spp",           "1",     "--bounces", "0",
                                        "-q",     "--stats",         "s.json"};
        all.insert(all.end(), options.begin(), options.end());
        const CommandResult result = run(all);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return json::parse(read("s.json"));
    };
    const auto count_bytes = [](const json& s) { return s["memory_bytes"]["structures"].get<uint64_t>(); };
    const json usual = trace({}), wide = trace({"--structure", "bvh", "--traversal", "wide"});
    EXPECT_EQ(wide["visits"], usual["visits"]);
    EXPECT_EQ(count_bytes(wide), count_bytes(usual));
    EXPECT_GT(wide["visits"]["upper_nodes"], 0);

    // Links and cells take room of their own, and each tree leads to patches in an order of its own.
    const json stack = trace({"--traversal", "stack"}), link = trace({"--traversal", "parent-link"});
    EXPECT_EQ(stack["visits"]["upper_nodes"], 0);
    EXPECT_NE(count_bytes(stack), count_bytes(usual));
    EXPECT_GT(count_bytes(link), count_bytes(stack));
    const json linear = trace({"--structure", "lbvh", "--traversal", "stack"});
    EXPECT_NE(linear["visits"], stack["visits"]);
    const json restart = trace({"--structure", "kdtree", "--traversal", "restart"});
    const json backtrack = trace({"--structure", "kdtree", "--traversal", "backtrack"});
    EXPECT_NE(count_bytes(restart), count_bytes(stack));
    EXPECT_GT(count_bytes(backtrack), count_bytes(restart));
}

TEST_F(Render, a_picture_that_fills_the_disk_goes_elsewhere) {
    for (const char* folder : {"full", "spare"}) std::filesystem::create_directory(folder_ / folder);
    const std::string temporary = (folder_ / "spare").string();
    const pid_t process = start(
        {"render", "plane.obj", "--size", "96x96", "--spp", "1", "--bounces", "0", "-o", "full/a.exr"}, [&] {
            if (!mount_small_disk("full", "size=16k")) _exit(kNoSmallDisk);
            setenv("TMPDIR", temporary.c_str(), 1);
        });
    const CommandResult result = finish(process);
    if (result.exit_code == kNoSmallDisk) GTEST_SKIP() << "no small disk can be made here";
    EXPECT_EQ(result.exit_code, 1) << result.errors;
    EXPECT_NE(result.errors.find("full/a.exr"), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("No space left"), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("it was written to " + temporary + "/a.exr"), std::string::npos)
        << result.errors;
    EXPECT_EQ(read_image(folder_ / "spare" / "a.exr").width, 96);
}

TEST_F(Render, an_interrupt_leaves_a_valid_partial_picture_and_two_at_once_do_as_well) {
    for (const int strokes : {1, 2}) {
        const pid_t process =
            start({"render", "plane.obj", "--size", "64x64", "--spp", "1048576", "--bounces", "0",
                   "--progress", "json", "--stats", "part.json", "-o", "part.exr"});
        for (int i = 0; i < 1000 && read("stderr.txt").find("percent") == std::string::npos; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        for (int k = 0; k < strokes; ++k)
            kill(process, SIGINT), std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const CommandResult result = finish(process);
        EXPECT_EQ(result.exit_code, 130) << result.errors;
        EXPECT_EQ(json::parse(read("part.json"))["image"]["is_complete"], false);
        const Image image = read_image(folder_ / "part.exr");
        EXPECT_EQ(image.width, 64);
        const std::optional<size_t> samples = image.find_channel("samples.Y");
        ASSERT_TRUE(samples.has_value());
        float most = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) most = std::max(most, image.at(x, y, *samples));
        EXPECT_GT(most, 0);
        EXPECT_LT(most, 1048576);
        for (const char* name : {"part.exr", "part.json", "stderr.txt"})
            std::filesystem::remove(folder_ / name);
    }
}

TEST_F(Render, goes_on_where_its_maker_had_it_ignore_interrupts) {
    const pid_t process = start({"render", "plane.obj", "--size", "64x64", "--spp", "2000", "--bounces", "0",
                                 "--progress", "json", "-o", "whole.exr"},
                                [] { std::signal(SIGINT, SIG_IGN); });
    for (int i = 0; i < 1000 && read("stderr.txt").find("percent") == std::string::npos; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    kill(process, SIGINT);
    EXPECT_EQ(finish(process).exit_code, 0);
    EXPECT_FALSE(read_image(folder_ / "whole.exr").metadata.contains("relief:interrupted"));
}

TEST_F(Render, plain_progress_ends_with_all_samples) {
    const CommandResult result = render_bump("a.exr", {"--progress", "plain"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.errors.find("100 %  4/4 samples"), std::string::npos) << result.errors;
}

TEST_F(Render, one_pixel_is_explained_without_a_picture) {
    const CommandResult result = run({"render", "plane.obj", "--vdm", "bump.exr", "--preset", "blender-brush",
                                      "--size", "25x25", "--spp", "2", "--pixel", "12,12"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    for (const char* part : {"object", "patch    0 ", "normal", "colour"})
        EXPECT_NE(result.output.find(part), std::string::npos) << part << "\n" << result.output;
    EXPECT_FALSE(exists("plane.exr"));
}

TEST_F(Render, a_written_sample_scene_can_be_rendered) {
    const CommandResult written = run({"scene", "ear", "-o", "ear"});
    ASSERT_EQ(written.exit_code, 0) << written.errors;
    EXPECT_NE(written.output.find("wrote ear/scene.json\n"), std::string::npos) << written.output;
    const CommandResult result =
        run({"render", "ear/scene.json", "--size", "16x16", "--spp", "1", "--bounces", "0", "-o", "ear.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(run({"scene", "eer", "-o", "x"}).exit_code, 0);
}

TEST_F(Render, a_sample_scene_that_was_edited_is_kept) {
    ASSERT_EQ(run({"scene", "rock", "-o", "rock"}).exit_code, 0);
    ASSERT_EQ(run({"scene", "rock", "-o", "rock"}).exit_code, 0);
    EXPECT_FALSE(exists("rock/scene.json.bak")) << "nothing was edited";
    std::ofstream(folder_ / "rock/scene.json", std::ios::app) << "\n";
    const std::string edited = read("rock/scene.json");
    const CommandResult again = run({"scene", "rock", "-o", "rock"});
    ASSERT_EQ(again.exit_code, 0) << again.errors;
    EXPECT_NE(again.errors.find("kept as rock/scene.json.bak"), std::string::npos) << again.errors;
    EXPECT_EQ(read("rock/scene.json.bak"), edited);
    EXPECT_NE(read("rock/scene.json"), edited);
}

TEST_F(Render, devices_lists_the_cpu) {
    const json devices = json::parse(run({"devices", "--json"}).output);
    EXPECT_EQ(devices[0]["engine"], "cpu");
    ASSERT_FALSE(devices[0]["isa"].empty());
    for (const json& isa : devices[0]["isa"]) // those that the build was configured with
        EXPECT_EQ(run({"render", "plane.obj", "--size", "8x8", "--spp", "1", "--isa", isa, "-o", "a.png"})
                      .exit_code,
                  0)
            << isa;
    EXPECT_GE(devices[0]["threads"], 1);
}

} // namespace
} // namespace relief::cli
