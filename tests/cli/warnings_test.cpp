// Warnings of a render: what inspect would say of maps whose convention nobody stated.
#include <nlohmann/json.hpp>

#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class Warnings : public CommandTest {
  protected:
    void SetUp() override {
        CommandTest::SetUp();
        // The bump, which slides to both sides, with its normal in G; and with 0.5 for zero.
        Image swapped = read_image(folder_ / "bump.exr"), half = swapped;
        for (size_t k = 0; k < swapped.pixels.size(); k += 3) {
            std::swap(swapped.pixels[k + 1], swapped.pixels[k + 2]);
            if (k / 3 % size_t(swapped.width) < size_t(swapped.width) / 2)
                swapped.pixels[k] = -swapped.pixels[k];
            for (size_t c = k; c < k + 3; ++c) half.pixels[c] = 0.5f + 0.5f * half.pixels[c];
        }
        write_image(swapped, folder_ / "swapped.exr");
        write_image(half, folder_ / "half.exr");
    }
    CommandResult render(const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"render", "plane.obj", "--size", "8x8", "--spp",
                                              "1",      "--bounces", "0",      "-o",  "a.exr"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    void expect_warning(const std::vector<std::string>& more, const std::string& warning) {
        const CommandResult result = render(more);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_TRUE(contains(result.errors, "relief: warning: ")) << result.errors;
        EXPECT_TRUE(contains(result.errors, warning)) << result.errors;
        EXPECT_TRUE(exists("a.exr"));
        std::filesystem::remove(folder_ / "a.exr");
        std::vector<std::string> strict = more;
        strict.insert(strict.end(), {"--strict", "--stats", "s.json"});
        const CommandResult refused = render(strict);
        EXPECT_EQ(refused.exit_code, 6) << refused.errors;
        EXPECT_TRUE(contains(refused.errors, warning)) << refused.errors;
        EXPECT_TRUE(contains(refused.errors, "--strict")) << refused.errors;
        EXPECT_FALSE(exists("a.exr"));
    }
    void expect_silence(const std::vector<std::string>& more) {
        std::vector<std::string> arguments = more;
        arguments.emplace_back("--strict");
        const CommandResult result = render(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_FALSE(contains(result.errors, "warning")) << result.errors;
    }
};

TEST_F(Warnings, of_a_map_are_those_of_convert_too) {
    const auto convert = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "convert");
        const CommandResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return result.errors;
    };
    const std::string doubt = "relief: warning: displacement 'swapped': axes t,b,n are assumed, but ";
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"plane.obj", "--vdm", "swapped.exr", "--level", "1", "-o", "o.ply"},
          {"swapped.exr", "--to-space", "object", "--mesh", "plane.obj", "-o", "o.exr"},
          {"swapped.exr", "--to", "mudbox", "-o", "o.exr"}}) {
        const std::string errors = convert(arguments);
        EXPECT_TRUE(contains(errors, doubt)) << errors;
        std::vector<std::string> quiet = arguments, known = arguments;
        quiet.emplace_back("-q"), known.insert(known.end(), {"--preset", "mudbox"});
        EXPECT_EQ(convert(quiet), "");
        EXPECT_FALSE(contains(convert(known), "warning"));
    }
}

TEST_F(Warnings, of_convert_neither_refuse_a_map_nor_speak_of_tiles_without_a_mesh) {
    for (const char* tile : {"t.1002.exr", "t.1003.exr"})
        std::filesystem::copy(folder_ / "bump.exr", folder_ / tile);
    const CommandResult tiles =
        run({"convert", "t.<UDIM>.exr", "--from", "genvdm", "--to", "mudbox", "-o", "o.<UDIM>.exr"});
    EXPECT_EQ(tiles.exit_code, 0) << tiles.errors;
    EXPECT_FALSE(contains(tiles.errors, "tile")) << tiles.errors;
    write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    const CommandResult bare = run(
        {"convert", "bump.exr", "--mesh", "bare.obj", "--from", "genvdm", "--to", "mudbox", "-o", "p.exr"});
    EXPECT_EQ(bare.exit_code, 0) << bare.errors;
    const CommandResult framed = run(
        {"convert", "bump.exr", "--frame", "file", "--axes", "t,b,n", "--to-axes", "t,n,b", "-o", "q.exr"});
    EXPECT_EQ(framed.exit_code, 0) << framed.errors;
}

TEST_F(Warnings, axes_that_the_values_contradict_name_the_option) {
    expect_warning({"--vdm", "swapped.exr"}, "set --axes to an order with G along n: the values do not show "
                                             "which of the other two is along t (presets mudbox");
    expect_silence({"--vdm", "swapped.exr", "--axes", "t,n,b"});
    expect_silence({"--vdm", "swapped.exr", "--preset", "mudbox"});
    const CommandResult declared = render({"--vdm", "swapped.exr", "--axes", "t,b,n", "--strict"});
    EXPECT_EQ(declared.exit_code, 0) << "said is said: " << declared.errors;
    EXPECT_TRUE(
        contains(declared.errors, "relief: note: displacement 'swapped': axes t,b,n are declared, but "))
        << declared.errors;
    EXPECT_TRUE(contains(declared.errors, "set --axes to an order with G along n: the values do not show "
                                          "which of the other two is along t (presets mudbox"))
        << declared.errors;
    expect_silence({"--vdm", "bump.exr"});
}

TEST_F(Warnings, a_midlevel_that_the_values_contradict_names_the_option) {
    expect_warning({"--vdm", "half.exr"}, ": --encoding signed");
    expect_warning({"--vdm", "half.exr", "--preset", "blender-brush"}, ": --encoding signed");
    expect_silence({"--vdm", "half.exr", "--encoding", "signed"});
    expect_silence({"--vdm", "half.exr", "--midlevel", "0"});
    ASSERT_EQ(run({"convert", "bump.exr", "-o", "w.png"}).exit_code, 0);
    expect_warning({"--vdm", "w.png"}, "0.5 is assumed; --midlevel 0.5 says so");
}

TEST_F(Warnings, gaps_and_wrong_tiles_are_told) {
    for (const char* name : {"t.1001.exr", "t.1003.exr"})
        std::filesystem::copy_file(folder_ / "bump.exr", folder_ / name);
    write("plane.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n"
                       "vt 0.1 0.1\nvt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9\n"
                       "vt 1.1 0.1\nvt 1.9 0.1\nvt 1.9 0.9\nvt 1.1 0.9\n"
                       "f 1/1 2/2 5/3 4/4\nf 2/5 3/6 6/7 5/8\n");
    expect_warning({"--vdm", "t.<UDIM>.exr"}, "has no file for tile(s) 1002");
    expect_warning({"--vdm", "t.1001.exr"}, "name them all as t.<UDIM>.exr");
    expect_warning({"--vdm", "bump.exr"}, "leave the unit square");
    expect_silence({"--vdm", "bump.exr", "--wrap", "repeat"});
}

std::string make_grid(int n) {
    std::string text;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double x = double(i) / n, y = double(j) / n;
            text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\nvt " + std::to_string(x) + " " +
                    std::to_string(y) + "\n";
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            text += "f";
            for (const int corner :
                 {j * (n + 1) + i, j * (n + 1) + i + 1, (j + 1) * (n + 1) + i + 1, (j + 1) * (n + 1) + i})
                text += " " + std::to_string(corner + 1) + "/" + std::to_string(corner + 1);
            text += "\n";
        }
    return text;
}

TEST_F(Warnings, of_axes_come_for_meshes_of_many_faces) {
    write("plane.obj", make_grid(230));
    expect_warning({"--vdm", "swapped.exr"}, "set --axes to an order with G along n: the values do not show "
                                             "which of the other two is along t (presets mudbox");
}

TEST_F(Warnings, tell_of_each_mesh_that_uses_a_map) {
    write("good.obj", read("plane.obj"));
    write("wide.obj",
          "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 3 0\nvt 3 3\nvt 0 3\nf 1/1 2/2 3/3 4/4\n");
    write("scene.json", R"({"environment": {}, "displacements": {"m": {"file": "bump.exr"}},
        "meshes": {"good": {"file": "good.obj"}, "wide": {"file": "wide.obj"}},
        "objects": [{"mesh": "good", "displacement": "m"}, {"mesh": "wide", "displacement": "m"}]})");
    const CommandResult result =
        run({"render", "scene.json", "--size", "8x8", "--spp", "1", "--strict", "-o", "b.exr"});
    EXPECT_EQ(result.exit_code, 6);
    EXPECT_TRUE(contains(result.errors, "the uvs of mesh 'wide' leave the unit square")) << result.errors;
}

TEST_F(Warnings, of_a_scene_file_name_its_keys) {
    const auto render_scene = [&](const std::string& said) {
        write("scene.json", R"({"camera": {"from": [0, 0, 5], "to": [0, 0, 0]}, "environment": {},
            "displacements": {"m": {"file": "swapped.exr")" +
                                said + R"(}},
            "meshes": {"p": {"file": "plane.obj"}}, "objects": [{"mesh": "p", "displacement": "m"}]})");
        return run(
            {"render", "scene.json", "--size", "8x8", "--spp", "1", "-o", "b.exr", "--stats", "s.json"});
    };
    const CommandResult result = render_scene("");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(contains(result.errors, R"(displacement 'm': axes t,b,n are assumed)")) << result.errors;
    EXPECT_TRUE(contains(result.errors, R"(set "axes" to an order with G along n)")) << result.errors;
    EXPECT_EQ(nlohmann::json::parse(read("s.json"))["warnings"].size(), 1u);
    EXPECT_EQ(render_scene(R"(, "axes": "t,n,b", "midlevel": 0, "space": "tangent")").errors, "");
}

TEST_F(Warnings, come_before_the_picture_and_only_once) {
    const CommandResult result = render({"--vdm", "swapped.exr", "--progress", "json"});
    const size_t first = result.errors.find("warning");
    EXPECT_LT(first, result.errors.find("percent")) << result.errors;
    EXPECT_EQ(result.errors.find("warning", first + 1), std::string::npos) << result.errors;
}

} // namespace
} // namespace relief::cli
