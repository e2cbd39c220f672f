// The key "subdivision" of a mesh: what is read, what is refused, what is written again.
#include "io/scene/scene_reader.h"
#include "io/test_files.h"
#include "relief/io.h"

namespace relief {

class Subdivisions : public FileTest {
  protected:
    Subdivisions() { write("plane.obj", kQuadObj); }

    Scene parse(const std::string& subdivision) const {
        return parse_scene(R"({"meshes": {"plane": {"file": "plane.obj", "subdivision": )" + subdivision +
                               R"(}}, "objects": [{"mesh": "plane"}]})",
                           folder_, "s.json");
    }
    std::string error_of(const std::string& subdivision) const {
        return message_of([&] { parse(subdivision); });
    }
};

TEST_F(Subdivisions, every_field_is_read) {
    const Mesh mesh = parse(R"({"scheme": "catmark", "level": 3, "uv": "linear", "boundary": "edge-only",
                                "creases": [[0, 1, 2.5], [2, 2, 10], [0, 1, 2.5]]})")
                          .meshes.at(0);
    EXPECT_EQ(mesh.subdivision, (Subdivision{SubdivisionScheme::catmark, 3, UvRule::linear,
                                             BoundaryRule::edge_only, CreaseRule::obey}));
    EXPECT_EQ(mesh.creases, (std::vector<Crease>{{0, 1, 2.5f}, {2, 2, 10}}));
    Subdivision defaults;
    defaults.scheme = SubdivisionScheme::bilinear;
    EXPECT_EQ(parse(R"({"scheme": "bilinear", "creases": true})").meshes.at(0).subdivision, defaults);
    defaults.creases = CreaseRule::ignore;
    EXPECT_EQ(parse(R"({"scheme": "bilinear", "creases": false})").meshes.at(0).subdivision, defaults);
}

TEST_F(Subdivisions, levels_are_automatic_unless_a_number_is_given) {
    EXPECT_EQ(parse(R"({"scheme": "catmark"})").meshes.at(0).subdivision.level, kAutoSubdivisionLevel);
    EXPECT_EQ(parse(R"({"scheme": "catmark", "level": "auto"})").meshes.at(0).subdivision.level,
              kAutoSubdivisionLevel);
    EXPECT_EQ(parse(R"({"scheme": "catmark", "level": 0})").meshes.at(0).subdivision.level, 0);
    EXPECT_HAS(error_of(R"({"scheme": "catmark", "level": "fine"})"), "meshes.plane.subdivision.level");
    EXPECT_HAS(error_of(R"({"scheme": "catmark", "level": "fine"})"),
               "write \"auto\", or a level from 0 to 8");
    EXPECT_HAS(error_of(R"({"scheme": "catmark", "level": -1})"), "meshes.plane.subdivision.level");
}

TEST_F(Subdivisions, wrong_values_are_named_with_their_path) {
    EXPECT_HAS(error_of(R"({"scheme": "catmrk"})"), "catmark");
    EXPECT_HAS(error_of(R"({"level": 2})"), "scheme");
    EXPECT_HAS(error_of(R"({"scheme": "catmark", "level": 9})"), "meshes.plane.subdivision.level");
    EXPECT_HAS(error_of(R"({"scheme": "catmark", "uv": "smoth"})"), "smooth");
    EXPECT_HAS(error_of(R"({"scheme": "catmark", "boundary": "corner"})"), "edge-and-corner");
    EXPECT_HAS(error_of(R"({"scheme": "catmark", "creases": [[0, 1]]})"), "two points and a sharpness");
    EXPECT_HAS(error_of(R"({"scheme": "catmark", "creases": [[0, 4, 1]]})"), "creases");
    EXPECT_HAS(error_of(R"({"scheme": "catmark", "creases": [[0, 1, -1]]})"), "creases");
    EXPECT_HAS(error_of(R"({"scheme": "catmark", "sharp": true})"), "unknown key");
    EXPECT_HAS(error_of(R"("bilinear")"), R"(must be an object, not a string)");
    EXPECT_HAS(error_of(R"("bilinear")"), R"({"scheme": "bilinear"})");
    EXPECT_HAS(error_of(R"("catmul")"), R"({"scheme": "catmark"})");
}

TEST_F(Subdivisions, a_saved_scene_loads_as_the_same_scene) {
    for (const char* text : {R"({"scheme": "catmark", "level": "auto"})",
                             R"({"scheme": "catmark", "level": 0, "creases": [[0, 1, 0.1], [3, 3, 10]]})",
                             R"({"scheme": "bilinear", "uv": "linear", "creases": false})",
                             R"({"scheme": "none", "creases": [[1, 2, 3]]})"}) {
        const Scene scene = parse(text);
        save_scene(scene, folder_ / "out");
        const Mesh read = load_scene(folder_ / "out" / "scene.json").meshes.at(0);
        EXPECT_EQ(read.subdivision, scene.meshes[0].subdivision) << text;
        EXPECT_EQ(read.creases, scene.meshes[0].creases) << text;
    }
}

TEST_F(Subdivisions, the_hash_follows_the_base) {
    MeshSceneOptions options;
    const uint64_t plain = load_mesh_scene(folder_ / "plane.obj", options).hash;
    options.subdivision = "catmark";
    const uint64_t smooth = load_mesh_scene(folder_ / "plane.obj", options).hash;
    options.subdivision_level = 4;
    const Scene finer = load_mesh_scene(folder_ / "plane.obj", options);
    EXPECT_NE(smooth, plain);
    EXPECT_NE(finer.hash, smooth);
    EXPECT_EQ(finer.meshes[0].subdivision.level, 4);
    options.subdivision = "loop";
    EXPECT_HAS(message_of([&] { load_mesh_scene(folder_ / "plane.obj", options); }),
               "unknown subdivision scheme");
}

} // namespace relief
