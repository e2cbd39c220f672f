// Animations and morph targets of glTF files.
#include <cmath>
#include <string>

#include "io/gltf_document.h"
#include "io/scene_files.h"
#include "relief/shot.h"

namespace relief {

namespace {

class GltfAnimations : public SceneFiles {
  protected:
    /// A square on a node below another, which an animation "go" moves.
    GltfAnimations() : document_(make_gltf_square()) {
        document_.json["nodes"] = {{{"children", {1}}, {"translation", {5, 0, 0}}}, {{"mesh", 0}}};
        document_.json["animations"] = {
            {{"name", "go"}, {"samplers", GltfJson::array()}, {"channels", GltfJson::array()}}};
    }

    void add_channel(int node, const std::string& path, int input, int output,
                     const std::string& interpolation = "LINEAR") {
        GltfJson& animation = document_.json["animations"][0];
        animation["samplers"].push_back(
            {{"input", input}, {"output", output}, {"interpolation", interpolation}});
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
    }
    int add_times(const std::vector<float>& times) { return document_.add_floats("SCALAR", times); }
    Mesh parse_at(double seconds, const std::string& animation = "go") const {
        MeshReadOptions options;
        options.animation = animation, options.time = seconds;
        return parse_document(document_, options);
    }
    void add_target(std::vector<float> moves) {
        primitive_of(document_)["targets"].push_back({{"POSITION", document_.add_floats("VEC3", moves)}});
    }

    GltfDocument document_;
};

void expect_near(const Vec3f& a, const Vec3f& b) {
    EXPECT_NEAR(a.x, b.x, 1e-6f);
    EXPECT_NEAR(a.y, b.y, 1e-6f);
    EXPECT_NEAR(a.z, b.z, 1e-6f);
}

TEST_F(GltfAnimations, move_nodes_between_their_keys_and_stand_still_outside) {
    add_channel(0, "translation", add_times({1, 3}), document_.add_floats("VEC3", {0, 0, 0, 0, 4, 0}));
    expect_near(parse_at(0).positions[0], {0, 0, 0});
    expect_near(parse_at(1.5).positions[0], {0, 1, 0});
    expect_near(parse_at(9, "0").positions[1], {1, 4, 0});
    expect_near(parse_document(document_).positions[0], {5, 0, 0});
}

TEST_F(GltfAnimations, turn_the_shorter_way_at_one_speed) {
    const auto half = float(std::sqrt(0.5));
    add_channel(1, "rotation", add_times({0, 1}),
                document_.add_floats("VEC4", {0, 0, 0, 1, 0, 0, -half, -half}));
    const double angle = std::acos(-1.0) / 2 * 0.25;
    expect_near(parse_at(0.25).positions[1], {float(5 + std::cos(angle)), float(std::sin(angle)), 0});
    expect_near(parse_at(1).positions[1], {5, 1, 0});
}

TEST_F(GltfAnimations, step_and_bend_as_their_samplers_say) {
    const int times = add_times({0, 2});
    add_channel(1, "scale", times, document_.add_floats("VEC3", {1, 1, 1, 3, 3, 3}), "STEP");
    // Flat at both ends, with slopes of tangents in the first number alone.
    add_channel(1, "translation", times,
                document_.add_floats("VEC3", {0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 4, 8, 0, 0, 0, 0}),
                "CUBICSPLINE");
    const Mesh mesh = parse_at(1);
    expect_near(mesh.positions[0], {5 + 2 + 2 * 2.0f / 8, 4, 0});
    expect_near(mesh.positions[1], {5 + 2 + 2 * 2.0f / 8 + 1, 4, 0});
    expect_near(parse_at(2).positions[1], {5 + 4 + 3, 8, 0});
}

TEST_F(GltfAnimations, add_morph_targets_by_their_weights) {
    add_target({0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    add_target({0, 0, 0, 0, 0, 10, 0, 0, 0, 0, 0, 0});
    EXPECT_EQ(parse_document(document_).positions[0].z, 0) << "no weights";
    document_.json["meshes"][0]["weights"] = {0.5, 0};
    EXPECT_EQ(parse_document(document_).positions[0].z, 0.5f);
    document_.json["nodes"][1]["weights"] = {0.25, 0.5};
    EXPECT_EQ(parse_document(document_).positions[0].z, 0.25f);
    EXPECT_EQ(parse_document(document_).positions[1].z, 5);
    add_channel(1, "weights", add_times({0, 1}), document_.add_floats("SCALAR", {0, 0, 1, 0.5f}));
    expect_near(parse_at(0.5).positions[0], {5, 0, 0.5f});
    expect_near(parse_at(0.5).positions[1], {6, 0, 2.5f});
    primitive_of(document_)["targets"][0]["POSITION"] = document_.add_floats("VEC3", {0, 0, 1});
    EXPECT_HAS(message_of([&] { parse_at(0.5); }), "1 values for 4 vertices");
}

TEST_F(GltfAnimations, take_sparse_targets) {
    add_target({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    document_.json["meshes"][0]["weights"] = {1};
    const int indices = document_.add<uint8_t>("SCALAR", 5121, {2});
    const int values = document_.add_floats("VEC3", {0, 0, 7});
    GltfJson& accessor =
        document_.json["accessors"][primitive_of(document_)["targets"][0]["POSITION"].get<size_t>()];
    const auto view = [&](int index) { return document_.json["accessors"][size_t(index)]["bufferView"]; };
    accessor["sparse"] = {{"count", 1},
                          {"indices", {{"bufferView", view(indices)}, {"componentType", 5121}}},
                          {"values", {{"bufferView", view(values)}}}};
    EXPECT_EQ(parse_document(document_).positions[2].z, 7);
    accessor.erase("bufferView");
    EXPECT_EQ(parse_document(document_).positions[2].z, 7);
    EXPECT_EQ(parse_document(document_).positions[1].z, 0);
    accessor["count"] = 2;
    EXPECT_HAS(message_of([&] { parse_document(document_); }), "index 0 is 2, out of range");
}

TEST_F(GltfAnimations, tell_what_is_wrong_with_them) {
    const int times = add_times({0, 1}), three = document_.add_floats("VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 0});
    add_channel(0, "translation", times, three);
    EXPECT_HAS(message_of([&] { parse_at(0); }), "3 values for 2 keys");
    EXPECT_HAS(message_of([&] { parse_at(0, "went"); }), "no animation 'went'");
    document_.json["animations"][0]["samplers"][0]["interpolation"] = "CURVE";
    EXPECT_HAS(message_of([&] { parse_at(0); }), "no interpolation 'CURVE'");
    document_.json["animations"][0]["samplers"][0] = {{"input", add_times({1, 1, 2})}, {"output", three}};
    EXPECT_HAS(message_of([&] { parse_at(0); }), "times do not rise");
}

TEST_F(GltfAnimations, warn_of_skins_which_are_not_read) {
    std::vector<std::string> warnings;
    const auto parse = [&] {
        const auto refuse = [](const std::string&) { return std::string(); };
        parse_gltf(document_.make_glb(), "walk.glb", refuse, {}, &warnings);
    };
    parse();
    EXPECT_TRUE(warnings.empty());
    document_.json["skins"] = {{{"joints", {0}}}};
    document_.json["nodes"][1]["skin"] = 0;
    parse();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "walk.glb: node 1 would be bent by a skin");
    document_.json["nodes"][1]["name"] = "body";
    add_channel(0, "translation", add_times({0, 1}), document_.add_floats("VEC3", {0, 0, 0, 8, 0, 0}));
    write("walk.glb", document_.make_glb());
    EXPECT_HAS(load_mesh_scene(folder_ / "walk.glb", {}).warnings.at(0),
               "node 'body' would be bent by a skin");
    warnings.clear();
    load_mesh(folder_ / "walk.glb", {}, warnings);
    EXPECT_EQ(warnings.size(), 1u);
    write("s.json", R"({"objects": [{"mesh": "a"}, {"mesh": "b"}], "meshes": {"b": {"file": "walk.glb"},
        "a": {"file": "walk.glb", "animation": "go", "time": {"keys": [[0, 0], [8, 1]]}}}})");
    Shot shot(folder_ / "s.json");
    EXPECT_EQ(shot.load(2).warnings.size(), 1u) << "once a file";
    EXPECT_EQ(shot.load(3).warnings.size(), 1u);
    EXPECT_EQ(shot.update(3.5).scene->warnings.size(), 1u) << "the same one";
}

TEST_F(GltfAnimations, warn_of_skins_in_each_frame_of_files_that_are_kept) {
    document_.json["skins"] = {{{"joints", {0}}}};
    document_.json["nodes"][1]["skin"] = 0;
    for (const char* name : {"body.01.glb", "body.02.glb"}) write(name, document_.make_glb());
    write("s.json", R"({"camera": {"shutter": [0, 0.5]}, "objects": [{"mesh": "a"}],
        "meshes": {"a": {"file": "body.##.glb"}}})");
    Shot shot(folder_ / "s.json");
    EXPECT_HAS(shot.load(1).warnings.at(0), "body.01.glb: node 1 would be bent by a skin");
    EXPECT_EQ(shot.update(1.5).scene->warnings.size(), 2u);
    const Scene second = shot.load(2);
    ASSERT_EQ(second.warnings.size(), 1u) << "of a file that the shutter of frame 1 saw";
    EXPECT_HAS(second.warnings[0], "body.02.glb: node 1 would be bent by a skin");
}

TEST_F(GltfAnimations, follow_the_keys_of_a_scene) {
    add_channel(0, "translation", add_times({0, 1}), document_.add_floats("VEC3", {0, 0, 0, 8, 0, 0}));
    write("walk.glb", document_.make_glb());
    const std::string scene = R"({"objects": [{"mesh": "body"}], "meshes": {"body": {"file": "walk.glb", )";
    write("s.json", scene + R"("animation": "go", "time": {"keys": [[0, 0], [8, 1]]}}}})");
    Shot shot(folder_ / "s.json");
    EXPECT_EQ(shot.load(2).meshes[0].positions[0].x, 2);
    EXPECT_EQ(shot.update(2.5).scene->meshes[0].positions[0].x, 2.5f);
    EXPECT_FALSE(shot.update(2.5).scene.has_value());
    EXPECT_HAS(error_of(scene + R"("time": 1}}})"), "none is named");
    EXPECT_HAS(error_of(R"({"meshes": {"plane": {"file": "plane.obj", "animation": 0}}})"),
               "only animations of glTF files");
}

} // namespace

} // namespace relief
