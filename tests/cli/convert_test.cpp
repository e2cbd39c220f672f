// The convert verb: files in, files out, and what it says of them.
#include <algorithm>
#include <cmath>

#include "command.h"
#include "relief/inspect.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class Convert : public CommandTest {
  protected:
    /// Largest difference of two maps' values.
    double compare(const std::string& a, const std::string& b) {
        const Image first = read_image(folder_ / a), second = read_image(folder_ / b);
        EXPECT_EQ(first.pixels.size(), second.pixels.size());
        double largest = 0;
        for (size_t k = 0; k < std::min(first.pixels.size(), second.pixels.size()); ++k)
            largest = std::max(largest, std::fabs(double(first.pixels[k]) - second.pixels[k]));
        return largest;
    }
    void expect_refused(const std::vector<std::string>& arguments, const std::string& part) {
        const CommandResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 2) << result.errors;
        EXPECT_TRUE(contains(result.errors, part)) << result.errors;
    }
};

TEST_F(Convert, a_map_goes_to_another_program_and_back) {
    const CommandResult there =
        run({"convert", "bump.exr", "--from", "genvdm", "--to", "mudbox", "-o", "m.exr"});
    ASSERT_EQ(there.exit_code, 0) << there.errors;
    EXPECT_EQ(there.output, "wrote m.exr: --space tangent --axes t,n,b --midlevel 0 --vdm-scale 1\n");
    EXPECT_GT(compare("m.exr", "bump.exr"), 0.1);
    ASSERT_EQ(run({"convert", "m.exr", "--from", "mudbox", "--to", "genvdm", "-o", "b.exr"}).exit_code, 0);
    EXPECT_EQ(compare("b.exr", "bump.exr"), 0);
}

TEST_F(Convert, warns_of_tiles_as_render_and_inspect_do) {
    write("far.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 10 0\nvt 11 0\nvt 11 1\nvt 10 1\n"
                     "f 1/1 2/2 3/3 4/4\n");
    write("across.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt .5 0\nvt 1.5 0\nvt 1.5 1\nvt .5 1\n"
                        "f 1/1 2/2 3/3 4/4\n");
    write("missing.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 5 0\nvt 6 0\nvt 6 1\nvt 5 1\n"
                         "f 1/1 2/2 3/3 4/4\n");
    for (const int udim : {1001, 1002})
        std::filesystem::copy(folder_ / "bump.exr", folder_ / ("t." + std::to_string(udim) + ".exr"));
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"far.obj", "outside of all tiles"},
        {"across.obj", "across two tiles"},
        {"missing.obj", "no file for tile(s) 1006"}};
    for (const auto& [mesh, part] : cases) {
        const std::vector<std::string> map = {"--vdm", "t.<UDIM>.exr", "--preset", "genvdm"};
        const auto with_map = [&](std::vector<std::string> arguments, const std::vector<std::string>& more) {
            arguments.insert(arguments.end(), map.begin(), map.end());
            arguments.insert(arguments.end(), more.begin(), more.end());
            return run(arguments);
        };
        const CommandResult converted = with_map({"convert", mesh}, {"--level", "1", "-o", "o.ply"});
        EXPECT_EQ(converted.exit_code, 0) << converted.errors;
        EXPECT_TRUE(contains(converted.errors, part)) << converted.errors;
        const CommandResult inspected = with_map({"inspect", mesh}, {"--strict"});
        EXPECT_EQ(inspected.exit_code, 6) << inspected.errors;
        EXPECT_TRUE(contains(inspected.output, part)) << inspected.output;
        EXPECT_FALSE(contains(inspected.output, "the map needs <UDIM>")) << inspected.output;
        const CommandResult rendered =
            with_map({"render", mesh}, {"--size", "8x8", "--spp", "1", "--strict", "-o", "o.png"});
        EXPECT_EQ(rendered.exit_code, 6) << rendered.errors;
        EXPECT_TRUE(contains(rendered.errors, part)) << rendered.errors;
    }
}

TEST_F(Convert, integers_take_a_scale_that_fits_and_say_it) {
    const CommandResult there = run({"convert", "bump.exr", "--from", "genvdm", "-o", "w.png"});
    ASSERT_EQ(there.exit_code, 0) << there.errors;
    // The bump is 0.6 high but for the texel in its middle.
    EXPECT_TRUE(contains(there.output, "--axes t,b,n --midlevel 0.5 --vdm-scale 1.2")) << there.output;
    EXPECT_EQ(read_texture(folder_ / "w.png").source_type, SampleType::uint16);
    EXPECT_EQ(read_texture(folder_ / "w.png").colour_tag, "");
    const CommandResult back = run({"convert", "w.png", "--from", "genvdm", "--midlevel", "0.5",
                                    "--vdm-scale", "1.2", "--to-encoding", "float", "-o", "b.exr"});
    ASSERT_EQ(back.exit_code, 0) << back.errors;
    EXPECT_LT(compare("b.exr", "bump.exr"), 1.2 / 65535);
    const CommandResult small = run({"convert", "bump.exr", "--to-scale", "0.5", "-o", "s.png"});
    EXPECT_EQ(small.exit_code, 3);
    EXPECT_TRUE(contains(small.errors, "does not fit")) << small.errors;
    EXPECT_FALSE(exists("s.png"));
}

TEST_F(Convert, a_height_map_stays_one_and_says_so) {
    Image heights;
    heights.width = heights.full_width = 2, heights.height = heights.full_height = 1;
    heights.channels = {"Y"}, heights.pixels = {0.2f, 0.8f};
    write_image(heights, folder_ / "h.exr");
    const CommandResult made =
        run({"convert", "h.exr", "--type", "height", "--midlevel", "0.5", "-o", "h.png"});
    ASSERT_EQ(made.exit_code, 0) << made.errors;
    EXPECT_EQ(made.output, "wrote h.png: --type height --midlevel 0.5 --vdm-scale 0.61\n");
    const Texture grey = read_texture(folder_ / "h.png");
    EXPECT_EQ(grey.channel_count, 1u);
    EXPECT_NEAR(grey.floats[0], 0.5 - 0.3 / 0.61, 1e-4);
    EXPECT_NEAR(grey.floats[1], 0.5 + 0.3 / 0.61, 1e-4);
}

TEST_F(Convert, steps_of_integers_are_smoothed_where_that_is_asked_for) {
    Image ramp = read_image(folder_ / "bump.exr");
    const size_t row = size_t(ramp.width) * ramp.channels.size();
    for (size_t k = 0; k < ramp.pixels.size(); ++k)
        ramp.pixels[k] = 0.5f + 0.2f * float(k % row) / 65535; // steps are three texels wide
    write_image(ramp, folder_ / "ramp.exr");
    ASSERT_EQ(run({"convert", "ramp.exr", "--to-midlevel", "0", "-o", "w.png"}).exit_code, 0);
    const std::vector<std::string> same = {"convert", "w.png", "--midlevel", "0.5", "--vdm-scale", "65535"};
    const auto write = [&](const std::string& file, std::vector<std::string> options) {
        options.insert(options.begin(), same.begin(), same.end());
        options.insert(options.end(), {"-o", file});
        return run(options);
    };
    ASSERT_EQ(write("stairs.exr", {}).exit_code, 0);
    ASSERT_EQ(write("smooth.exr", {"--dequantize"}).exit_code, 0);
    EXPECT_GT(compare("stairs.exr", "smooth.exr"), 0.1);
    EXPECT_LT(compare("stairs.exr", "smooth.exr"), 0.51) << "steps";
    const CommandResult floats = run({"convert", "bump.exr", "--dequantize", "-o", "f.exr"});
    EXPECT_EQ(floats.exit_code, 3);
    EXPECT_TRUE(contains(floats.errors, "maps of 8 or 16-bit integers")) << floats.errors;
    expect_refused({"convert", "bump.exr", "--filter", "cubic", "-o", "f.exr"},
                   "--filter goes with --vdm MAP");
}

TEST_F(Convert, samples_and_tiles_are_as_asked_for) {
    ASSERT_EQ(run({"convert", "bump.exr", "--samples", "half", "-o", "h.exr"}).exit_code, 0);
    EXPECT_EQ(read_texture(folder_ / "h.exr").source_type, SampleType::float16);
    std::filesystem::copy_file(folder_ / "bump.exr", folder_ / "t.1001.exr");
    std::filesystem::copy_file(folder_ / "bump.exr", folder_ / "t.1012.exr");
    ASSERT_EQ(run({"convert", "t.<UDIM>.exr", "--to", "cycles", "-o", "n_<UVTILE>.exr"}).exit_code, 0);
    EXPECT_TRUE(exists("n_u1_v1.exr"));
    EXPECT_TRUE(exists("n_u2_v2.exr"));
    expect_refused({"convert", "t.<UDIM>.exr", "-o", "n.exr"}, "the map has tiles");
    expect_refused({"convert", "bump.exr", "-o", "n.<UDIM>.exr"}, "no tiles");
    expect_refused({"convert", "bump.exr", "--samples", "half", "-o", "n.png"}, "do not go together");
}

TEST_F(Convert, tangent_space_becomes_object_space_by_the_mesh) {
    expect_refused({"convert", "bump.exr", "--to-space", "object", "-o", "o.exr"}, "frames of a mesh");
    ASSERT_EQ(
        run({"convert", "bump.exr", "--mesh", "plane.obj", "--to-axes", "x,z,y", "-o", "o.exr"}).exit_code,
        0);
    const Image object = read_image(folder_ / "o.exr"), tangent = read_image(folder_ / "bump.exr");
    // The plane faces +z and u runs along +x.
    EXPECT_NEAR(object.at(8, 8, 0), tangent.at(8, 8, 0), 1e-4);
    EXPECT_NEAR(object.at(8, 8, 1), tangent.at(8, 8, 2), 1e-4);
}

TEST_F(Convert, meshes_keep_their_faces_and_uvs) {
    ASSERT_EQ(run({"convert", "plane.obj", "-o", "plane.ply"}).exit_code, 0);
    ASSERT_EQ(run({"convert", "plane.ply", "-o", "again.obj"}).exit_code, 0);
    const Mesh mesh = load_mesh(folder_ / "again.obj");
    EXPECT_EQ(mesh.face_sizes, (std::vector<uint32_t>{4}));
    const Mesh original = load_mesh(folder_ / "plane.obj");
    for (size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(mesh.positions[mesh.position_indices[k]], original.positions[original.position_indices[k]]);
        EXPECT_EQ(mesh.uvs[mesh.uv_indices[k]], original.uvs[original.uv_indices[k]]);
    }
}

TEST_F(Convert, a_displaced_surface_is_written_as_quads) {
    const CommandResult result = run({"convert", "plane.obj", "--vdm", "bump.exr", "--preset", "genvdm",
                                      "--level", "4", "-o", "bump.ply"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.output, "wrote bump.ply: 289 vertices, 256 faces\n");
    const Mesh mesh = load_mesh(folder_ / "bump.ply");
    EXPECT_EQ(mesh.face_sizes, std::vector<uint32_t>(256, 4));
    EXPECT_EQ(mesh.positions.size(), 289u);
    float top = 0;
    for (const Vec3f& p : mesh.positions) top = std::max(top, p.z);
    EXPECT_NEAR(top, 0.6f, 0.02f);
    write("scene.json",
          R"({"displacements": {"b": {"file": "bump.exr"}}, "meshes": {"p": {"file": "plane.obj"}},
                            "objects": [{"mesh": "p", "displacement": "b"}, {"mesh": "p"}]})");
    const CommandResult scene = run({"convert", "scene.json", "--level", "0", "-o", "scene.obj"});
    EXPECT_EQ(scene.output, "wrote scene.obj: 8 vertices, 2 faces\n") << scene.errors;
}

TEST_F(Convert, a_subdivided_mesh_is_written_smooth) {
    write("cube.obj", "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    ASSERT_EQ(
        run({"convert", "cube.obj", "--subdivision", "catmark", "--subdivision-level", "3", "-o", "ball.ply"})
            .exit_code,
        0);
    const Mesh ball = load_mesh(folder_ / "ball.ply");
    EXPECT_EQ(ball.face_sizes.size(), 6u * 64);
    for (const Vec3f& p : ball.positions) {
        const float radius = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
        EXPECT_GT(radius, 0.5f); // corners of the limit surface of a cube lie at half of its corners
        EXPECT_LT(radius, 1.0f);
    }
}

TEST_F(Convert, options_that_say_nothing_here_are_refused) {
    expect_refused({"convert", "bump.exr"}, "one file in and one file out");
    expect_refused({"convert", "bump.exr", "-o", "bump.ply"}, "a map alone is no surface");
    expect_refused({"convert", "bump.exr", "-o", "bump.hdr"}, "cannot write maps of kind '.hdr'");
    expect_refused({"convert", "bump.exr", "--level", "3", "-o", "m.exr"}, "--level");
    expect_refused({"convert", "plane.obj", "--level", "3", "-o", "m.obj"}, "--level goes with --vdm");
    expect_refused({"convert", "plane.obj", "--axes", "t,b,n", "-o", "m.obj"}, "--axes goes with --vdm");
    expect_refused({"convert", "plane.obj", "--to", "mudbox", "-o", "m.obj"}, "--to goes with a map");
    expect_refused({"convert", "plane.obj", "--samples", "half", "-o", "m.obj"}, "--samples goes with a map");
    expect_refused({"convert", "plane.obj", "--subdivision-level", "1", "-o", "m.obj"},
                   "needs a subdivision scheme");
    expect_refused({"convert", "plane.obj", "-o", "m.exr"}, "written as .obj or .ply");
    expect_refused({"convert", "bump.exr", "--to-scale", "0", "-o", "m.exr"}, "scale of 0");
}

} // namespace
} // namespace relief::cli
