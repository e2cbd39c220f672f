// Open edges that nearly lie on each other: joined by --weld, reported by inspect, warned of by render.
#include "command.h"

namespace relief::cli {
namespace {

/// Two squares beside each other, 1.5e-5 apart, each with uvs of its own.
constexpr const char* kPair = "v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\n"
                              "v 0.000015 0 0\nv 1 0 0\nv 1 1 0\nv 0.000015 1 0\n"
                              "vt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\nvt 1 0\nvt 1 1\n"
                              "f 1/1 2/2 3/3 4/4\nf 5/2 6/5 7/6 8/3\n";

/// The text of a fact, whatever the width of the column of names.
std::string find_fact(const std::string& output, const std::string& name) {
    const size_t start = ("\n" + output).find("\n" + name + " ");
    if (start == std::string::npos) return "no " + name;
    const std::string line = output.substr(start, output.find('\n', start) - start);
    return line.substr(line.find_first_not_of(' ', name.size()));
}

class Weld : public CommandTest {
  protected:
    void SetUp() override {
        CommandTest::SetUp();
        write("pair.obj", kPair);
    }
    static std::vector<std::string> with_map(const std::string& verb, const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {verb, "pair.obj", "--vdm", "bump.exr"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
};

TEST_F(Weld, inspect_reports_points_that_were_joined_and_edges_that_were_not) {
    const CommandResult apart = run({"inspect", "pair.obj", "--strict"});
    EXPECT_EQ(apart.exit_code, 6);
    EXPECT_EQ(find_fact(apart.output, "open_edges"), "8");
    EXPECT_TRUE(contains(apart.output, "warning: W-NEAR: 2 open edges are within 1.5e-05")) << apart.output;
    EXPECT_TRUE(contains(apart.output, "--weld 1.5e-05 joins them")) << apart.output;
    const CommandResult joined = run(with_map("inspect", {"--weld", "1.5e-05"}));
    EXPECT_EQ(find_fact(joined.output, "open_edges"), "6");
    EXPECT_TRUE(contains(find_fact(joined.output, "joined_points"), "2 on 2 edges")) << joined.output;
    EXPECT_FALSE(contains(joined.output, "W-NEAR")) << joined.output;
    const CommandResult meant = run({"inspect", "pair.obj", "--weld", "0", "--strict"});
    EXPECT_EQ(meant.exit_code, 0) << meant.output;
    const CommandResult of_map = run({"inspect", "bump.exr", "--mesh", "pair.obj", "--weld", "1.5e-05"});
    EXPECT_TRUE(contains(of_map.output, "mesh.joined_points  2 on 2 edges"))
        << of_map.output << of_map.errors;
}

TEST_F(Weld, render_warns_with_the_option_or_the_key_and_stops_when_strict) {
    const std::vector<std::string> small = {"--size",  "16x16",  "--spp", "1",          "--space",
                                            "tangent", "--axes", "t,b,n", "--midlevel", "0",
                                            "--wrap",  "clamp",  "-o",    "o.exr"};
    const CommandResult strict = run([&] {
        std::vector<std::string> arguments = with_map("render", small);
        arguments.emplace_back("--strict");
        return arguments;
    }());
    EXPECT_EQ(strict.exit_code, 6) << strict.errors;
    EXPECT_TRUE(contains(strict.errors, "--weld 1.5e-05 joins them, --weld 0 keeps them apart"))
        << strict.errors;
    for (const std::string weld : {"1.5e-05", "0"}) {
        std::vector<std::string> arguments = with_map("render", small);
        arguments.insert(arguments.end(), {"--strict", "--weld", weld});
        EXPECT_EQ(run(arguments).exit_code, 0) << weld;
    }
    write("scene.json", R"({"version": 1, "render": {"width": 8, "height": 8, "spp": 1},
        "camera": {"from": [0, 0, 4], "to": [0, 0, 0]}, "environment": {},
        "displacements": {"bump": {"file": "bump.exr", "space": "tangent"}},
        "meshes": {"pair": {"file": "pair.obj"}}, "objects": [{"mesh": "pair", "displacement": "bump"}]})");
    const CommandResult scene = run({"render", "scene.json", "-o", "s.exr"});
    EXPECT_TRUE(contains(scene.errors, R"("weld": 1.5e-05 joins them)")) << scene.errors;
    const CommandResult refused = run({"render", "scene.json", "--weld", "1", "-o", "s.exr"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(run(with_map("render", {"--weld", "-1", "-o", "o.exr"})).exit_code, 2);
}

TEST_F(Weld, convert_writes_the_joined_mesh) {
    EXPECT_EQ(run({"convert", "pair.obj", "--weld", "1.5e-05", "-o", "plain.obj"}).exit_code, 0);
    const CommandResult plain = run({"inspect", "plain.obj"});
    EXPECT_TRUE(find_fact(plain.output, "vertices") == "6") << plain.output;
    EXPECT_EQ(run(with_map("convert", {"--level", "1", "--weld", "1.5e-05", "-o", "bumpy.obj"})).exit_code,
              0);
    EXPECT_TRUE(find_fact(run({"inspect", "bumpy.obj"}).output, "vertices") == "15");
    EXPECT_EQ(run({"convert", "bump.exr", "--weld", "1", "-o", "o.exr"}).exit_code, 2);
    const CommandResult apart = run(with_map("convert", {"--level", "1", "-o", "apart.obj"}));
    EXPECT_TRUE(contains(apart.errors, "warning: mesh 'pair': 2 open edges")) << apart.errors;
    EXPECT_TRUE(contains(apart.errors, "--weld 1.5e-05")) << apart.errors;
}

} // namespace
} // namespace relief::cli
