// What is refused before any work is done, and how it is said.
#include <algorithm>

#include "command.h"

namespace relief::cli {
namespace {

class Usage : public CommandTest {
  protected:
    /// Expects a usage error whose message holds `part`, and nothing on stdout.
    void expect_refused(const std::vector<std::string>& arguments, const std::string& part,
                        int exit_code = 2) {
        const CommandResult result = run(arguments);
        EXPECT_EQ(result.exit_code, exit_code) << result.errors;
        EXPECT_TRUE(contains(result.errors, "relief: error: ")) << result.errors;
        EXPECT_TRUE(contains(result.errors, part)) << result.errors;
        EXPECT_EQ(result.output, "");
    }
};

TEST_F(Usage, an_unknown_verb_names_the_nearest_one) { expect_refused({"rendr", "plane.obj"}, "'render'"); }

TEST_F(Usage, an_unknown_option_names_the_nearest_one) {
    expect_refused({"render", "plane.obj", "--sise", "8x8"}, "--size");
    expect_refused({"compare", "a.exr", "b.exr", "--treshold=1"}, "--threshold");
}

TEST_F(Usage, no_verb_and_no_input_are_usage_errors) {
    expect_refused({}, "no command");
    expect_refused({"render"}, "no scene");
    expect_refused({"render", "plane.obj", "other.obj"}, "unexpected argument 'other.obj'");
}

TEST_F(Usage, a_folder_is_no_input_and_no_output) {
    std::filesystem::create_directory(folder_ / "ear");
    expect_refused({"render", "ear"}, "relief: error: ear: is a folder, neither a scene file nor a mesh", 3);
    write("ear/scene.json", "{}");
    expect_refused({"render", "ear/"}, "hint: relief render ear/scene.json", 3);
    expect_refused({"render", "plane.obj", "-o", "ear/"}, "ear/: is a folder, not a file");
    expect_refused({"render", "plane.obj", "-o", "ear"}, "ear: is a folder, not a file");
}

TEST_F(Usage, the_picture_and_its_statistics_are_two_files) {
    expect_refused({"render", "plane.obj", "-o", "a.exr", "--stats", "./a.exr"},
                   "./a.exr: the picture and its statistics cannot be one file");
}

TEST_F(Usage, a_saved_scene_is_a_file_of_its_own) {
    expect_refused({"render", "plane.obj", "--save-scene", "s.json", "--stats", "s.json"}, "another output");
    expect_refused({"render", "plane.obj", "--save-scene", "./s.json", "--stats", "s.json"},
                   "another output");
}

TEST_F(Usage, sizes_and_samples_outside_the_range_tell_the_range) {
    expect_refused({"render", "plane.obj", "--size", "0x0"}, "from 1 to 65536");
    expect_refused({"render", "plane.obj", "--size", "1000000x4"}, "from 1 to 65536");
    expect_refused({"render", "plane.obj", "--size", "800"}, "'800' is not WIDTHxHEIGHT");
    expect_refused({"render", "plane.obj", "--size", "800"}, "hint: --size 800x450");
    expect_refused({"render", "plane.obj", "--size", "800,600"}, "hint: --size 800x600");
    expect_refused({"render", "plane.obj", "--size", "big"}, "hint: --size 1280x720");
    expect_refused({"render", "plane.obj", "--size", "99999999999999999999"}, "hint: --size 1280x720");
    expect_refused({"render", "plane.obj", "--spp", "-4"}, "from 1 to 1048576");
    expect_refused({"render", "plane.obj", "--spp", "4x"}, "--spp");
    expect_refused({"render", "plane.obj", "--level", "13"}, "from 0 to 12");
    expect_refused({"render", "plane.obj", "--level", "fine"}, "'auto'");
    expect_refused({"render", "plane.obj", "--pixel-error", "nan"}, "--pixel-error");
    expect_refused({"render", "plane.obj", "--seed", "-1"}, "--seed");
}

TEST_F(Usage, numbers_outside_the_range_have_a_hint) {
    expect_refused({"render", "plane.obj", "--bounces", "-1"}, "hint: the least is 0");
    expect_refused({"render", "plane.obj", "--spp", "-3"}, "hint: the least is 1");
    expect_refused({"render", "plane.obj", "--level", "13"}, "hint: auto: fine enough");
    expect_refused({"render", "plane.obj", "--spp", "9999999"}, "hint: the most is 1048576");
    expect_refused({"render", "plane.obj", "--spp", "64samples"}, "hint: digits alone: 64");
    expect_refused({"render", "plane.obj", "--spp", "2.5"}, "hint: a whole number");
    expect_refused({"render", "plane.obj", "--spp", "many"}, "hint: digits alone");
    expect_refused({"render", "plane.obj", "--zoom", "0"}, "hint: the least is 0.01");
    expect_refused({"render", "plane.obj", "--fov", "4,5"}, "hint: a point in place of the comma: 4.5");
    expect_refused({"render", "plane.obj", "--noise", "0,02"}, "hint: a point in place of the comma: 0.02");
    expect_refused({"render", "plane.obj", "--vdm", "bump.exr", "--midlevel", "0,5"},
                   "hint: a point in place of the comma: 0.5");
    expect_refused({"render", "plane.obj", "--noise", "-o", "a.exr"}, "hint: the value is missing");
    expect_refused({"render", "plane.obj", "--spp", "--size", "8x8"}, "hint: the value is missing");
    expect_refused({"render", "plane.obj", "--fov", "45deg"}, "hint: digits alone, with a point: 45");
    expect_refused({"render", "plane.obj", "--fov", "45,deg"}, "hint: digits alone, with a point\n");
    expect_refused({"render", "plane.obj", "--bounces", "3,5"}, "hint: digits alone\n");
}

TEST_F(Usage, words_that_no_list_has_get_a_hint) {
    expect_refused({"render", "plane.obj", "--layers", "bogus"}, "hint: known: depth, N, N_camera");
    expect_refused({"render", "plane.obj", "--isa", "bogus"}, "hint: relief devices lists those");
    expect_refused({"render", "plane.obj", "--lod", "bogus"}, "hint: --help-all tells what they mean");
}

TEST_F(Usage, an_option_given_twice_is_named_with_its_values) {
    expect_refused({"render", "plane.obj", "--spp", "4", "--spp", "8"},
                   "--spp: given twice: '4', '8'\nhint: keep one of them: --spp 8\n");
    expect_refused({"render", "plane.obj", "-o", "a.exr", "-o", "b.exr", "-o", "c.exr"},
                   "-o: given 3 times: 'a.exr', 'b.exr', 'c.exr'");
    expect_refused({"convert", "bump.exr", "-o", "a.exr", "--preset", "mudbox", "--from", "maya"},
                   "given twice: 'mudbox', 'maya'");
    expect_refused({"render", "plane.obj", "--layers", "depth", "--layers", "N"},
                   "hint: one list holds them all: --layers depth,N");
    expect_refused({"render", "plane.obj", "--strict", "--strict", "--sp"}, "'--sp'"); // twice is once
}

TEST_F(Usage, an_option_without_its_value_says_what_is_missing) {
    expect_refused({"render", "plane.obj", "--fov"}, "--fov: its value is missing\nhint: --fov D\n");
    expect_refused({"merge", "a.exr", "b.exr", "-o"}, "-o: its value is missing\nhint: -o FILE\n");
    expect_refused({"render", "plane.obj", "--vdm", "--size", "8x8"},
                   "--vdm: its value is missing before --size\nhint: --vdm MAP\n");
    expect_refused({"render", "plane.obj", "--vdm", "--denoise"},
                   "--vdm: its value is missing before --denoise");
    expect_refused({"render", "plane.obj", "--vdm", "-o", "x.png"}, "--vdm: its value is missing before -o");
}

TEST_F(Usage, an_unknown_preset_is_wrong_usage_on_a_command_line_and_bad_input_in_a_file) {
    expect_refused({"render", "plane.obj", "--vdm", "bump.exr", "--preset", "bogus"}, "preset 'bogus'");
    expect_refused({"inspect", "bump.exr", "--preset", "bogus"}, "preset 'bogus'");
    expect_refused({"convert", "bump.exr", "-o", "b.exr", "--from", "bogus"}, "preset 'bogus'");
    expect_refused({"convert", "bump.exr", "-o", "b.exr", "--to", "bogus"}, "preset 'bogus'");
    expect_refused({"convert", "plane.obj", "--vdm", "bump.exr", "-o", "b.ply", "--from", "bogus"},
                   "'bogus'");
    write("scene.json", R"({"displacements": {"d": {"file": "bump.exr", "preset": "bogus"}}})");
    expect_refused({"render", "scene.json"}, "preset 'bogus'", 3);
    expect_refused({"convert", "scene.json", "-o", "b.ply"}, "preset 'bogus'", 3);
}

TEST_F(Usage, the_folder_of_a_sample_scene_is_made_before_the_scene) {
    write("file", "kept");
    expect_refused({"scene", "rock", "-o", "file"}, "error: file: is a file, not a folder\nhint: a scene is");
    expect_refused({"scene", "rock", "-o", "file/a/b"}, "error: file: is a file, not a folder");
    expect_refused({"scene", "rock", "-o", "/proc/relief/a"},
                   "error: /proc/relief/a: the folder cannot be made");
    std::filesystem::create_directory(folder_ / "half");
    write("half/maps", "kept");
    expect_refused({"scene", "rock", "-o", "half"}, "half/maps");
    expect_refused({"scene", "rokc", "-o", "new"}, "hint: did you mean 'rock'?");
    EXPECT_FALSE(exists("new"));
    EXPECT_EQ(read("file"), "kept");
}

TEST_F(Usage, a_scene_with_nothing_to_see_is_bad_input) {
    for (const char* text : {"{}", R"({"lights": [{"type": "sun"}]})"}) {
        write("empty.json", text);
        expect_refused({"render", "empty.json"}, "no objects, no environment", 3);
        expect_refused({"render", "empty.json", "--ground"}, "no objects, no environment", 3);
        expect_refused({"render", "empty.json", "--pixel", "0,0"}, "hint: add 'objects'", 3);
        expect_refused({"inspect", "empty.json"}, "no objects, no environment", 3);
    }
    write("sky.json", R"({"environment": {"color": [1, 1, 1]}})");
    EXPECT_EQ(run({"render", "sky.json", "--size", "4x4", "--spp", "1", "-o", "sky.exr"}).exit_code, 0);
    EXPECT_EQ(run({"inspect", "sky.json"}).exit_code, 0);
}

TEST_F(Usage, parts_of_the_picture_must_lie_in_it) {
    expect_refused({"render", "plane.obj", "--size", "8x8", "--crop", "0,0,9,8"}, "8x8");
    expect_refused({"render", "plane.obj", "--crop", "4,0,4,8"}, "x0 < x1");
    expect_refused({"render", "plane.obj", "--tile", "2/2"}, "i from 0");
    expect_refused({"render", "plane.obj", "--size", "8x2", "--tile", "0/3"}, "2 rows");
    expect_refused({"render", "plane.obj", "--samples", "4:4"}, "A < B");
    expect_refused({"render", "plane.obj", "--vdm", "bump.exr", "--axes", "t,n"}, "no order of axes");
    expect_refused({"inspect", "bump.exr", "--space", "tangnt"}, "did you mean 'tangent'");
    expect_refused({"render", "plane.obj", "--spp", "4", "--samples", "2:6"}, "4 samples");
    expect_refused({"render", "plane.obj", "--samples", "2:6", "--spp", "4"}, "leave out --spp");
    expect_refused({"render", "plane.obj", "--size", "8x8", "--pixel", "8,0"}, "8x8");
}

TEST_F(Usage, only_what_exists_can_be_chosen) {
    expect_refused({"render", "plane.obj", "--engine", "opencl"}, "one of: cpu, vulkan");
    expect_refused({"render", "plane.obj", "--engine", "vulkan", "--bottom", "fuse"}, "'fused'");
    expect_refused({"render", "plane.obj", "--structure", "octree"}, "one of: bvh, lbvh, kdtree");
    expect_refused({"render", "plane.obj", "--traversal", "narrow"}, "one of: auto, wide, stack");
    expect_refused({"render", "plane.obj", "--structure", "kdtree", "--traversal", "trail"},
                   "valid there: push-down, restart, backtrack");
    expect_refused(
        {"render", "plane.obj", "--engine", "vulkan", "--structure", "lbvh", "--traversal", "wide"},
        "valid there: trail");
    expect_refused({"render", "plane.obj", "--engine", "vulkan", "--method", "raster"},
                   "one of: compute, fragment, hybrid");
    expect_refused({"render", "plane.obj", "--frames", "0"}, "frames are those of a scene file");
    expect_refused({"render", "plane.obj", "--shutter", "0,0.5"}, "--shutter");
    expect_refused({"render", "plane.obj", "--surface", "tesselated"}, "'tessellated'");
    expect_refused({"render", "plane.obj", "--layers", "depth,Normal"}, "unknown layer 'Normal'");
    expect_refused({"render", "plane.obj", "--layers", "diffuse-direct"}, "did you mean 'diffuse_direct'");
    expect_refused({"render", "plane.obj", "--layers", "light_a.b"}, "'a.b' is no name of a light group");
    expect_refused({"render", "plane.obj", "--layers", "light_key"},
                   "no light of the scene is in the group 'key'");
    expect_refused({"render", "plane.obj", "-o", "a.png", "--layers", "depth"}, ".exr");
}

TEST_F(Usage, options_that_say_how_a_map_is_read_need_one) {
    expect_refused({"render", "plane.obj", "--autobump"}, "--autobump says nothing without a map");
    expect_refused({"render", "plane.obj", "--no-dilate"}, "--no-dilate says nothing without a map");
    expect_refused({"render", "plane.obj", "--filter", "mip"}, "--filter says nothing without a map");
    expect_refused({"render", "plane.obj", "--vdm", "bump.exr", "--filter", "mipp"}, "did you mean 'mip'");
    expect_refused({"render", "plane.obj", "--dequantize"}, "--dequantize says nothing without a map");
    expect_refused({"render", "plane.obj", "--vdm", "bump.exr", "--dequantize"},
                   "dequantize needs a smooth filter", 3);
    expect_refused({"render", "plane.obj", "--preset", "nonsense"}, "--preset says nothing without a map");
    for (const char* option : {"--type", "--space", "--axes", "--frame", "--lengths", "--encoding", "--wrap"})
        expect_refused({"render", "plane.obj", option, "x"}, std::string(option) + " says nothing");
    expect_refused({"render", "plane.obj", "--midlevel", "0.5"}, "--midlevel says nothing without a map");
    expect_refused({"render", "plane.obj", "--vdm-scale", "2"}, "--vdm-scale says nothing without a map");
    expect_refused({"render", "plane.obj", "--flip-v"}, "--flip-v says nothing without a map");
}

TEST_F(Usage, files_that_are_read_are_not_written_over) {
    const std::string message = "would be written over";
    std::filesystem::copy_file(folder_ / "bump.exr",
                               folder_ / "plane.exr"); // as a picture without -o is called
    const std::string mesh = read("plane.obj"), map = read("plane.exr");
    expect_refused({"render", "plane.obj", "--vdm", "plane.exr"}, message);
    expect_refused({"render", "plane.obj", "--vdm", "plane.exr", "-o", "./plane.exr"}, message);
    expect_refused({"render", "plane.obj", "--env", "plane.exr"}, message);
    expect_refused({"render", "plane.obj", "-o", "x.exr", "--stats", "plane.obj"}, message);
    expect_refused({"inspect", "plane.exr", "-o", "plane.exr"}, message);
    expect_refused({"merge", "plane.exr", "-o", "plane.exr"}, message);
    expect_refused({"convert", "plane.exr", "-o", "plane.exr"}, message);
    expect_refused({"convert", "plane.obj", "--vdm", "plane.exr", "-o", "plane.obj"}, message);
    expect_refused({"convert", "m.<UDIM>.exr", "-o", "./m.<UDIM>.exr"}, message);
    EXPECT_EQ(read("plane.obj"), mesh);
    EXPECT_EQ(read("plane.exr"), map);

    ASSERT_EQ(run({"scene", "rock", "-o", "rock"}).exit_code, 0);
    for (const char* file : {"rock/scene.json", "rock/maps/rock.exr", "rock/maps/environment.exr"})
        expect_refused({"render", "rock/scene.json", "-o", "x.exr", "--stats", file}, message);
    expect_refused({"convert", "rock/scene.json", "-o", "rock/meshes/rock.obj"}, message);
}

TEST_F(Usage, options_of_one_engine_do_not_go_with_the_other) {
    for (const std::string verb : {"render", "bench"}) {
        const std::string input = verb == "render" ? "plane.obj" : "paper1";
        expect_refused({verb, input, "--device", "0"}, "--engine vulkan");
        expect_refused({verb, input, "--bottom", "auto"}, "--engine vulkan");
        expect_refused({verb, input, "--engine", "vulkan", "--isa", "best"}, "leave out --engine vulkan");
    }
}

TEST_F(Usage, mesh_options_do_not_go_with_a_scene_file) {
    write("scene.json", "{}");
    expect_refused({"render", "scene.json", "--vdm", "bump.exr"}, "--vdm");
}

TEST_F(Usage, a_subdivision_level_needs_a_scheme) {
    expect_refused({"render", "plane.obj", "--subdivision-level", "2"}, "needs a subdivision scheme");
    expect_refused({"render", "plane.obj", "--subdivision", "catmark", "--subdivision-level", "9"},
                   "from 0 to 8");
}

TEST_F(Usage, subdivision_options_list_what_they_take) {
    expect_refused({"render", "plane.obj", "--subdivision", "catmarc", "-o", "a.exr"},
                   "hint: did you mean 'catmark'?");
    expect_refused(
        {"render", "plane.obj", "--subdivision", "catmark", "--subdivision-level", "99", "-o", "a.exr"},
        "'auto' or an integer from 0 to 8");
}

TEST_F(Usage, a_missing_file_is_bad_input_with_its_name) {
    expect_refused({"render", "plane.obj.bak", "--subdivision", "catmark", "-o", "a.exr"}, "plane.obj.bak",
                   3);
    expect_refused({"render", "nothing.obj", "--size", "8x8"}, "nothing.obj", 3);
    expect_refused({"inspect", "nothing.exr"}, "nothing.exr", 3);
    expect_refused({"compare", "nothing.exr", "bump.exr"}, "nothing.exr", 3);
}

TEST_F(Usage, the_hint_of_a_missing_file_says_its_kind_or_the_name_of_one_like_it) {
    expect_refused({"render", "plan.obj"}, "hint: did you mean 'plane.obj'?", 3);
    expect_refused({"inspect", "bumpy.exr"}, "hint: did you mean 'bump.exr'?", 3);
    expect_refused({"render", "plane.obj", "--vdm", "bmp.exr"}, "hint: did you mean 'bump.exr'?", 3);
    expect_refused({"convert", "other.ply", "-o", "a.obj"},
                   "check the name: no mesh of a similar name is in the folder '.'", 3);
    expect_refused({"inspect", "nothing.exr"},
                   "check the name: no map or picture of a similar name is in the folder '.'", 3);
    expect_refused({"render", "nothing.json"},
                   "check the name: no scene file of a similar name is in the folder '.'", 3);
    expect_refused({"inspect", "gone/nothing.exr"}, "hint: the folder 'gone' does not exist", 3);
}

TEST_F(Usage, empty_names_are_refused) {
    const std::string message = "-o: an empty text names no";
    expect_refused({"render", "plane.obj", "-o", ""}, message);
    expect_refused({"inspect", "plane.obj", "-o", ""}, message);
    expect_refused({"convert", "bump.exr", "-o", ""}, message);
    expect_refused({"scene", "rock", "-o", ""}, message);
    expect_refused({"merge", "bump.exr", "-o", ""}, message);
    expect_refused({"bench", "paper1", "-o", ""}, message);
    expect_refused({"render", "plane.obj", "--vdm", ""}, "--vdm: an empty text names no file");
    expect_refused({"render", "plane.obj", "--stats", ""}, "--stats");
}

TEST_F(Usage, loops_of_links_are_called_so) {
    const std::string message = "leads back to itself";
    for (const char* name : {"loop.exr", "in.obj", "in.json", "loop"})
        std::filesystem::create_symlink(name, folder_ / name);
    for (const char* input : {"in.obj", "in.json"}) {
        expect_refused({"render", input}, message, 3);
        expect_refused({"inspect", input}, message, 3);
    }
    expect_refused({"inspect", "loop.exr"}, message, 3);
    expect_refused({"convert", "in.obj", "-o", "a.ply"}, message, 3);
    expect_refused({"render", "plane.obj", "--vdm", "loop.exr"}, message, 3);
    expect_refused({"render", "plane.obj", "--env", "loop.exr"}, message, 3);
    expect_refused({"render", "plane.obj", "--edits", "loop"}, message, 3);
    expect_refused({"merge", "loop.exr", "-o", "a.exr"}, message, 3);
    expect_refused({"render", "plane.obj", "-o", "loop.exr"}, message, 1);
    expect_refused({"render", "plane.obj", "-o", "loop/a.exr"}, message, 1);
    expect_refused({"render", "plane.obj", "--stats", "in.json"}, message, 1);
    expect_refused({"scene", "rock", "-o", "loop"}, message, 1);
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "loop.exr"));
}

TEST_F(Usage, files_of_other_programs_name_the_way_out_of_them) {
    const std::string message = "is not read: export OBJ, PLY or glTF";
    for (const char* name :
         {"a.blend", "a.usd", "a.abc", "a.stl", "a.ma", "a.ztl", "a.max", "a.c4d", "a.dae"}) {
        write(name, "x");
        for (const std::vector<std::string>& line : {std::vector<std::string>{"render", name},
                                                     {"render", name, "--vdm", "bump.exr"},
                                                     {"render", "plane.obj", "--vdm", name},
                                                     {"inspect", name},
                                                     {"inspect", name, "--vdm", "bump.exr"},
                                                     {"inspect", "bump.exr", "--mesh", name},
                                                     {"convert", name, "-o", "out.ply"},
                                                     {"convert", name, "-o", "out.exr"}})
            expect_refused(line, message, 3);
        write("scene.json", std::string(R"({"meshes": {"m": {"file": ")") + name + R"("}}})");
        expect_refused({"render", "scene.json"}, message, 3);
    }
    write("a.gltf", R"({"asset": {"version": "2.0"}, "extensionsRequired": ["EXT_unheard_of"]})");
    expect_refused({"render", "a.gltf"}, "needs the extension EXT_unheard_of", 3);
    write("notes.txt", "x");
    expect_refused({"render", "notes.txt"}, "a scene file is JSON; meshes are .obj", 3);
    write("a.psd", "x");
    expect_refused({"render", "plane.obj", "--vdm", "a.psd"}, "a Photoshop file is not read", 3);
}

TEST_F(Usage, an_output_that_cannot_be_written_is_refused_before_the_render) {
    // So many samples that the test would time out if the render started.
    for (const std::string output : {"no/such/folder/a.exr", "a.jpeg2", "."}) {
        const CommandResult result =
            run({"render", "plane.obj", "--size", "4096x4096", "--spp", "1048576", "-o", output});
        EXPECT_TRUE(result.exit_code == 1 || result.exit_code == 2 || result.exit_code == 3)
            << result.exit_code;
        EXPECT_TRUE(contains(result.errors, "relief: error: ")) << result.errors;
    }
    for (const std::string statistics : {"no/folder/s.json", "."})
        EXPECT_EQ(run({"render", "plane.obj", "--spp", "1048576", "--stats", statistics}).exit_code, 1);
}

TEST_F(Usage, every_help_fits_on_a_screen_and_goes_to_stdout) {
    for (const std::string verb :
         {"render", "inspect", "scene", "compare", "merge", "bench", "devices", "farm"}) {
        const CommandResult result = run({verb, "--help"});
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.errors, "");
        EXPECT_LT(std::count(result.output.begin(), result.output.end(), '\n'), 60) << verb;
    }
    EXPECT_FALSE(contains(run({"render", "--help"}).output, "--traversal"));
    EXPECT_TRUE(contains(run({"render", "--help-all"}).output, "--traversal"));
    EXPECT_TRUE(contains(run({"--help"}).output, "render"));
    EXPECT_TRUE(contains(run({"--version"}).output, "relief "));
}

TEST_F(Usage, programs_that_are_not_there_have_their_help) {
    std::string expected[2];
    const char* const verbs[] = {"view", "bench"};
    for (int k = 0; k < 2; ++k) expected[k] = run({verbs[k], "--help-all"}).output;
    std::filesystem::copy_file(program_, folder_ / "relief");
    program_ = folder_ / "relief";
    for (int k = 0; k < 2; ++k) {
        const CommandResult help = run({verbs[k], "--help-all"});
        EXPECT_EQ(help.exit_code, 0) << help.errors;
        EXPECT_EQ(help.output, expected[k]);
        EXPECT_TRUE(contains(help.output, "--engine")) << help.output;
        EXPECT_EQ(run({verbs[k], "--version"}).exit_code, 0);
        const CommandResult missing = run({verbs[k], "x"});
        EXPECT_EQ(missing.exit_code, 1);
        EXPECT_TRUE(contains(missing.errors, "build the target relief-")) << missing.errors;
    }
}

TEST_F(Usage, every_verb_can_be_quiet) {
    const std::vector<std::vector<std::string>> verbs = {
        {"render"},         {"inspect"},      {"convert"},        {"scene"},         {"compare"},
        {"merge"},          {"view"},         {"bench"},          {"devices"},       {"farm", "plan"},
        {"farm", "submit"}, {"farm", "work"}, {"farm", "status"}, {"farm", "merge"}, {"farm", "retry"}};
    for (std::vector<std::string> verb : verbs) {
        verb.emplace_back("--help");
        EXPECT_TRUE(contains(run(verb).output, "\n  -q ")) << verb[0] << " " << verb[1];
    }
    ASSERT_EQ(run({"render", "plane.obj", "--size", "8x8", "--spp", "2", "-o", "a.exr", "-q"}).exit_code, 0);
    ASSERT_EQ(
        run({"render", "plane.obj", "--size", "8x8", "--spp", "2", "--tile", "0/2", "-o", "b.exr", "-q"})
            .exit_code,
        0);
    const CommandResult compared = run({"compare", "a.exr", "a.exr", "-q"});
    EXPECT_EQ(compared.exit_code, 0);
    EXPECT_EQ(compared.output, "");
    EXPECT_TRUE(contains(run({"merge", "b.exr", "-o", "c.exr", "--allow-gaps"}).errors, "warning"));
    EXPECT_EQ(run({"merge", "b.exr", "-o", "c.exr", "--allow-gaps", "-q"}).errors, "");
    EXPECT_FALSE(contains(run({"devices", "-q"}).output, "--traversal"));
}

} // namespace
} // namespace relief::cli
