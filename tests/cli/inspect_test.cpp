// The inspect verb: files in, facts and findings out, exit codes.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include <nlohmann/json.hpp>

#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class Inspect : public CommandTest {
  protected:
    /// A copy of the bump under another name, changed.
    template <class Change> void write_bump(const std::string& name, const Change& change) {
        Image image = read_image(folder_ / "bump.exr");
        change(image);
        write_image(image, folder_ / name);
    }
};

TEST_F(Inspect, exit_codes_follow_the_findings) {
    EXPECT_EQ(run({"inspect", "bump.exr", "--strict"}).exit_code, 0);
    EXPECT_EQ(run({"inspect", "plane.obj", "--strict"}).exit_code, 0);
    write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    const CommandResult bare = run({"inspect", "bare.obj"});
    EXPECT_EQ(bare.exit_code, 0);
    EXPECT_TRUE(contains(bare.output, "warning: W-NOUV: "));
    EXPECT_EQ(run({"inspect", "bare.obj", "--strict"}).exit_code, 6);
    const CommandResult both = run({"inspect", "bump.exr", "--mesh", "bare.obj"});
    EXPECT_EQ(both.exit_code, 3);
    EXPECT_TRUE(contains(both.output, "error: E-NOUV: mesh: no uvs, and the map cannot be laid onto it"))
        << both.output;
    EXPECT_TRUE(contains(both.output, ": the mesh has no uvs, and the map cannot be laid onto it\n"))
        << both.output;
    EXPECT_FALSE(contains(both.output, "without a mesh")) << both.output;
    EXPECT_FALSE(contains(both.output, "I-FOLD")) << both.output;
}

TEST_F(Inspect, json_tells_what_cannot_be_read) {
    write("broken.json", R"({"version": 1, "objects": [{"mesh": "none"}]})");
    for (const char* file : {"broken.json", "missing.exr"}) {
        const CommandResult result = run({"inspect", file, "--json"});
        EXPECT_EQ(result.exit_code, 3);
        const nlohmann::json findings = nlohmann::json::parse(result.output)["findings"];
        ASSERT_EQ(findings.size(), 1u);
        EXPECT_EQ(findings[0]["code"], "E-READ");
        EXPECT_EQ(findings[0]["severity"], "error");
    }
}

TEST_F(Inspect, a_map_is_read_as_the_options_say) {
    write_bump("half.exr", [](Image& image) {
        for (float& value : image.pixels) value = 0.5f + 0.5f * value;
    });
    const CommandResult plain = run({"inspect", "half.exr"});
    EXPECT_EQ(plain.exit_code, 3);
    EXPECT_TRUE(contains(plain.output, "E-NONEG")) << plain.output;
    EXPECT_EQ(run({"inspect", "half.exr", "--encoding", "signed", "--strict"}).exit_code, 0);
    EXPECT_EQ(run({"inspect", "half.exr", "--midlevel", "0.5,0.5,0.5", "--strict"}).exit_code, 0);
    EXPECT_EQ(run({"inspect", "half.exr", "--midlevel", "0.5,0.5"}).exit_code, 2);
    const CommandResult zero = run({"inspect", "half.exr", "--midlevel", "0"});
    EXPECT_EQ(zero.exit_code, 0) << zero.output;
    EXPECT_TRUE(contains(zero.output, "note: I-NONEG")) << zero.output;
    for (const auto& [said, exit_code] : {std::pair("", 3), std::pair(R"(, "midlevel": 0)", 0)}) {
        write("scene.json", std::string(R"({"displacements": {"bump": {"file": "half.exr")") + said +
                                R"(}}, "meshes": {"plane": {"file": "plane.obj"}},
                "objects": [{"mesh": "plane", "displacement": "bump"}]})");
        const CommandResult scene = run({"inspect", "scene.json"});
        EXPECT_EQ(scene.exit_code, exit_code) << scene.output << scene.errors;
    }
}

TEST_F(Inspect, a_rendered_picture_is_no_map) {
    ASSERT_EQ(render_bump("picture.exr", {}).exit_code, 0);
    EXPECT_TRUE(contains(run({"inspect", "picture.exr"}).output, "W-PICTURE"));
    EXPECT_FALSE(contains(run({"inspect", "bump.exr"}).output, "W-PICTURE"));
    const CommandResult displaced =
        run({"render", "plane.obj", "--vdm", "picture.exr", "--strict", "-o", "b.exr"});
    EXPECT_EQ(displaced.exit_code, 6);
    EXPECT_TRUE(contains(displaced.errors, "a picture that Relief rendered")) << displaced.errors;
}

TEST_F(Inspect, a_map_that_no_render_takes_is_inspected) {
    write_bump("nan.exr", [](Image& image) { image.at(3, 2, 1) = std::numeric_limits<float>::quiet_NaN(); });
    const CommandResult result = run({"inspect", "nan.exr"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_TRUE(
        contains(result.output, "error: E-NAN: NaN or infinity in 1 texel(s), the first at column 3, row 2"))
        << result.output << result.errors;
    EXPECT_TRUE(contains(run({"inspect", "nan.exr", "-o", "check.png"}).errors, "no check picture"));
    EXPECT_FALSE(exists("check.png"));
}

TEST_F(Inspect, tiles_are_matched_with_the_mesh) {
    for (const char* name : {"t.1001.exr", "t.1003.exr"}) write_bump(name, [](Image&) {});
    write("tiles.obj",
          "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n"
          "vt 0 0\nvt 1 0\nvt 2 0\nvt 0 1\nvt 1 1\nvt 2 1\nf 1/1 2/2 5/5 4/4\nf 2/2 3/3 6/6 5/5\n");
    const CommandResult result = run({"inspect", "t.<UDIM>.exr", "--mesh", "tiles.obj"});
    EXPECT_EQ(result.exit_code, 0) << "a render draws the rest";
    EXPECT_EQ(run({"inspect", "t.<UDIM>.exr", "--mesh", "tiles.obj", "--strict"}).exit_code, 6);
    EXPECT_TRUE(contains(result.output, "W-GAP: mesh: no file for tile(s) 1002")) << result.output;
    const CommandResult one = run({"inspect", "t.1001.exr"});
    EXPECT_TRUE(contains(one.output, "W-TILE")) << one.output;
    EXPECT_TRUE(contains(one.output, "t.<UDIM>.exr")) << one.output;
}

TEST_F(Inspect, a_check_picture_shows_base_displaced_axes_and_folds) {
    ASSERT_EQ(run({"inspect", "bump.exr", "-o", "check.exr"}).exit_code, 0);
    const Image sheet = read_image(folder_ / "check.exr");
    ASSERT_EQ(sheet.width, 2 * 640);
    ASSERT_EQ(sheet.height, 2 * 480);
    const auto differ = [&](int x0, int y0, int x1, int y1) {
        int count = 0;
        for (int y = 0; y < 480; ++y)
            for (int x = 0; x < 640; ++x)
                count += std::fabs(sheet.at(x0 + x, y0 + y, 0) - sheet.at(x1 + x, y1 + y, 0)) > 0.05f;
        return count;
    };
    EXPECT_GT(differ(0, 0, 640, 0), 2000) << "the bump is in the second picture only";
    EXPECT_GT(differ(0, 480, 640, 480), 2000) << "colours are in the third only";
    // Whatever the values look like, the surface is that of a render.
    Image swapped = read_image(folder_ / "bump.exr");
    for (int y = 0; y < swapped.height; ++y)
        for (int x = 0; x < swapped.width; ++x) {
            if (x < swapped.width / 2) swapped.at(x, y, 0) = -swapped.at(x, y, 0);
            std::swap(swapped.at(x, y, 1), swapped.at(x, y, 2));
        }
    write_image(swapped, folder_ / "swapped.exr");
    const CommandResult guessed = run({"inspect", "swapped.exr", "-o", "guessed.exr"});
    EXPECT_TRUE(contains(guessed.output, "axes t,n,b")) << guessed.output;
    ASSERT_EQ(run({"inspect", "swapped.exr", "--axes", "t,b,n", "-o", "declared.exr"}).exit_code, 0);
    EXPECT_EQ(read_image(folder_ / "guessed.exr").pixels, read_image(folder_ / "declared.exr").pixels);
    const CommandResult checked = run({"inspect", "plane.obj", "-o", "plane.png"});
    EXPECT_EQ(checked.exit_code, 0);
    EXPECT_NE(checked.errors.find("wrote plane.png"), std::string::npos) << checked.errors;
    EXPECT_TRUE(exists("plane.png"));
    EXPECT_EQ(run({"inspect", "bump.exr", "-o", "check.txt"}).exit_code, 2);
}

TEST_F(Inspect, a_mesh_is_inspected_as_the_scene_that_a_render_would_make) {
    const CommandResult plain = run({"inspect", "plane.obj"});
    EXPECT_FALSE(contains(plain.output, "map.bump.")) << plain.output;
    const CommandResult displaced = run({"inspect", "plane.obj", "--vdm", "bump.exr", "--axes", "t,n,b"});
    EXPECT_EQ(displaced.exit_code, 0) << displaced.output << displaced.errors;
    EXPECT_TRUE(contains(displaced.output, "map.bump.axes")) << displaced.output;
    const auto patches = [&](const CommandResult& result) {
        const size_t at = result.output.find("\npatches ");
        return at == std::string::npos ? -1 : std::atoi(result.output.c_str() + at + 9);
    };
    EXPECT_EQ(patches(displaced), 1) << displaced.output;
    const CommandResult smooth = run({"inspect", "plane.obj", "--vdm", "bump.exr", "--subdivision", "catmark",
                                      "--subdivision-level", "2", "-o", "check.png"});
    EXPECT_EQ(patches(smooth), 16) << smooth.output << smooth.errors;
    EXPECT_TRUE(exists("check.png"));
    // What the mesh itself is comes first, with a map or without.
    const CommandResult bare = run({"inspect", "plane.obj", "--subdivision", "catmark"});
    for (const CommandResult* result : {&plain, &displaced, &smooth, &bare}) {
        EXPECT_TRUE(contains(result->output, "\nfaces ")) << result->output;
        EXPECT_TRUE(contains(result->output, "\nbase ")) << result->output;
    }
    EXPECT_TRUE(contains(bare.output, "catmark limit surface")) << bare.output;
}

TEST_F(Inspect, a_mesh_with_its_map_has_the_findings_of_that_map) {
    write("mirrored.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n"
                          "vt 0 0\nvt .4 0\nvt .4 1\nvt 0 1\nvt 1 0\nvt .6 0\nvt .6 1\nvt 1 1\n"
                          "f 1/1 2/2 5/3 4/4\nf 2/5 3/6 6/7 5/8\n");
    const auto inspect = [&](const std::string& space) {
        return run({"inspect", "mirrored.obj", "--vdm", "bump.exr", "--space", space}).output;
    };
    EXPECT_TRUE(contains(inspect("tangent"), "W-MIRROR")) << inspect("tangent");
    EXPECT_FALSE(contains(inspect("object"), "W-MIRROR")) << inspect("object");
}

TEST_F(Inspect, findings_of_a_mesh_and_its_scene_are_all_told_once) {
    std::filesystem::copy_file(folder_ / "bump.exr", folder_ / "tiles.1001.exr");
    write("two.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n"
                     "vt 0.1 0.1\nvt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9\n"
                     "vt 1.1 0.1\nvt 1.9 0.1\nvt 1.9 0.9\nvt 1.1 0.9\n"
                     "f 1/1 2/2 5/3 4/4\nf 2/5 3/6 6/7 5/8\nt crease 2/1/0 1 4 3.5\n");
    const CommandResult result = run({"inspect", "two.obj", "--vdm", "tiles.<UDIM>.exr", "--subdivision",
                                      "catmark", "--subdivision-level", "1"});
    EXPECT_TRUE(contains(result.output, "W-GAP: no file for tile(s) 1002")) << result.output;
    EXPECT_FALSE(contains(result.output, "W-SCENE: displacement")) << "once is enough: " << result.output;
    EXPECT_TRUE(contains(result.output, "W-SCENE: mesh 'two': creases")) << result.output;
}

TEST_F(Inspect, layers_of_a_picture_are_listed_and_one_that_nobody_chose_is_warned_of) {
    Image image;
    image.width = image.full_width = image.height = image.full_height = 4;
    image.channels = {"a.R", "a.G", "a.B", "vdm.R", "vdm.G", "vdm.B"};
    for (int k = 0; k < 16; ++k) image.pixels.insert(image.pixels.end(), {0, 0, 0, 0, 0, 0.25f});
    write_image(image, folder_ / "layers.exr");
    const CommandResult usual = run({"inspect", "layers.exr", "--strict"});
    EXPECT_EQ(usual.exit_code, 6) << usual.output;
    EXPECT_TRUE(contains(usual.output, "part.0")) << usual.output;
    EXPECT_TRUE(contains(usual.output, "layer 'a' R G B (float); layer 'vdm' R G B (float)")) << usual.output;
    EXPECT_TRUE(contains(usual.output, "W-READ: layers.exr: Relief reads layer 'a'")) << usual.output;
    const CommandResult chosen = run({"inspect", "layers.exr:vdm"});
    EXPECT_FALSE(contains(chosen.output, "W-READ")) << chosen.output;
    EXPECT_TRUE(contains(chosen.output, "B           0.25 to 0.25")) << chosen.output;
    const std::vector<std::string> render = {"render",   "plane.obj", "--vdm", "layers.exr", "--preset",
                                             "genvdm",   "--size",    "8x8",   "--spp",      "1",
                                             "--strict", "-o",        "o.png"};
    const CommandResult refused = run(render);
    EXPECT_EQ(refused.exit_code, 6) << refused.errors;
    EXPECT_TRUE(contains(refused.errors, "layers.exr:vdm")) << refused.errors;
    const CommandResult converted = run({"convert", "plane.obj", "--vdm", "layers.exr:vdm", "--preset",
                                         "genvdm", "--level", "1", "-o", "o.obj"});
    EXPECT_EQ(converted.exit_code, 0) << converted.errors;
    EXPECT_FALSE(contains(converted.errors, "leaves out")) << converted.errors;
    EXPECT_EQ(load_mesh(folder_ / "o.obj").positions[0].z, 0.25f);
}

TEST_F(Inspect, options_of_maps_are_refused_elsewhere) {
    const CommandResult result = run({"inspect", "plane.obj", "--axes", "t,b,n"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(contains(result.errors, "--axes goes with a map")) << result.errors;
    EXPECT_EQ(run({"inspect", "plane.obj", "--mesh", "plane.obj"}).exit_code, 2);
    const CommandResult map = run({"inspect", "bump.exr", "--subdivision", "catmark"});
    EXPECT_EQ(map.exit_code, 2);
    EXPECT_TRUE(contains(map.errors, "--subdivision goes with a mesh")) << map.errors;
    EXPECT_EQ(run({"inspect", "plane.obj", "--subdivision-level", "2"}).exit_code, 2);
}

TEST_F(Inspect, a_scene_tells_its_counts_and_costs) {
    write("scene.json", R"({"version": 1, "camera": {"from": [0, 0, 5], "to": [0, 0, 0]},
        "render": {"width": 64, "height": 48, "spp": 2},
        "displacements": {"bump": {"type": "vector", "file": "bump.exr", "preset": "blender-brush"}},
        "meshes": {"plane": {"file": "plane.obj"}},
        "objects": [{"name": "a", "mesh": "plane", "displacement": "bump"}, {"name": "b", "mesh": "plane"}]})");
    const CommandResult result = run({"inspect", "scene.json", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;
    const nlohmann::json facts = nlohmann::json::parse(result.output)["facts"];
    EXPECT_EQ(facts["objects"], "2, 1 displaced");
    EXPECT_EQ(facts["patches"], "1");
    EXPECT_EQ(facts["triangles"], "2");
    EXPECT_TRUE(contains(facts["time"], "for all 2 at 64x48"));
    for (const char* key : {"geometry", "structures", "map_texels", "tessellated", "finest_level",
                            "map.bump.size", "map.bump.looks_like"})
        EXPECT_TRUE(facts.contains(key)) << key;
}

TEST_F(Inspect, mistakes_of_a_scene_name_the_mesh_and_the_map) {
    write_bump("gray.exr", [](Image& image) {
        for (size_t i = 0; i < image.pixels.size(); i += 3)
            image.pixels[i] = image.pixels[i + 1] = image.pixels[i + 2];
    });
    write("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    write("scene.json", R"({"render": {"width": 32, "height": 24, "spp": 1},
        "displacements": {"m": {"type": "vector", "file": "gray.exr"}}, "meshes": {"t": {"file": "tri.obj"}},
        "objects": [{"name": "a", "mesh": "t", "displacement": "m"}]})");
    const CommandResult result = run({"inspect", "scene.json", "--strict"});
    EXPECT_EQ(result.exit_code, 6);
    EXPECT_TRUE(contains(result.output, "warning: W-GRAY: displacement 'm': ")) << result.output;
    EXPECT_TRUE(contains(result.output, "warning: W-TRI: mesh 't': ")) << result.output;
}

} // namespace
} // namespace relief::cli
