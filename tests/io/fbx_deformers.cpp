// FBX: blend shapes, skins and creases of meshes.
#include <algorithm>

#include "io/test_files.h"
#include "relief/io.h"
#include "relief/scene.h"
#include "support/fbx_scene.h"

namespace relief {

namespace {

/// A shape of geometry 10 that moves point 3, (1, 1, 1), by `move`.
std::string make_shape(int id, const std::string& move, bool has_normals = true) {
    return "\tGeometry: " + std::to_string(id) + ", \"Geometry::s\", \"Shape\" {\n\t\tVersion: 100\n" +
           make_fbx_array("Indexes", "3", 1) + make_fbx_array("Vertices", move, 3) +
           (has_normals ? make_fbx_array("Normals", "0,0,0", 3) : "") + "\t}\n";
}

/// Blend shape 60 with channel 61 of `shapes`.
FbxScene make_blended(double percent, const std::string& full_weights, size_t count,
                      const std::vector<std::string>& shapes) {
    FbxScene scene;
    scene.add_object("\tDeformer: 60, \"Deformer::b\", \"BlendShape\" {\n\t\tVersion: 100\n\t}\n"
                     "\tDeformer: 61, \"SubDeformer::c\", \"BlendShapeChannel\" {\n\t\tVersion: 100\n"
                     "\t\tDeformPercent: " +
                     std::to_string(percent) + "\n" + make_fbx_array("FullWeights", full_weights, count) +
                     "\t}\n");
    scene.connect(60, 10).connect(61, 60);
    for (size_t k = 0; k < shapes.size(); ++k) {
        scene.add_object(shapes[k]);
        scene.connect(int(70 + k), 61);
    }
    return scene;
}

constexpr const char* kIdentity = "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1";

/// Skin 60 of geometry 10; bone 63 has points 1 and 3 with all their weight.
FbxScene make_skinned(const std::string& skinning) {
    FbxScene scene;
    scene.add_object("\tDeformer: 60, \"Deformer::s\", \"Skin\" {\n\t\tVersion: 101\n" + skinning +
                     "\t}\n"
                     "\tDeformer: 62, \"SubDeformer::c\", \"Cluster\" {\n\t\tVersion: 100\n" +
                     make_fbx_array("Indexes", "1,3", 2) + make_fbx_array("Weights", "1,0.5", 2) +
                     make_fbx_array("Transform", kIdentity, 16) +
                     make_fbx_array("TransformLink", kIdentity, 16) + "\t}\n");
    scene.add_model(63, "bone", "LimbNode");
    scene.connect(60, 10).connect(62, 60).connect(63, 62).connect(63, 0);
    scene.add_properties("Model: 63,", {R"("Lcl Translation", "Lcl Translation", "", "A",0,0,5)"});
    scene.add_properties("Model: 20,", {R"("Lcl Translation", "Lcl Translation", "", "A",9,0,0)"});
    return scene;
}

} // namespace

class FbxDeformers : public FileTest {
  protected:
    Mesh load(const FbxScene& scene) {
        warnings_.clear();
        return load_mesh(write("a.fbx", scene.text()), {}, warnings_);
    }
    Vec3f load_corner(const FbxScene& scene) { return corner(load(scene), 2); }
    static Vec3f corner(const Mesh& mesh, size_t k) { return mesh.positions[mesh.position_indices[k]]; }
    std::vector<std::string> warnings_;
};

TEST_F(FbxDeformers, shapes_are_blended_by_their_weights) {
    EXPECT_EQ(load_corner(make_blended(50, "100", 1, {make_shape(70, "0,0,4")})), (Vec3f{1, 1, 3}));
    EXPECT_EQ(load_corner(make_blended(-25, "100", 1, {make_shape(70, "0,0,4")})), (Vec3f{1, 1, 0}));
    EXPECT_EQ(load_corner(make_blended(0, "100", 1, {make_shape(70, "0,0,4")})), (Vec3f{1, 1, 1}));
    EXPECT_EQ(load_corner(make_blended(100, "100", 1, {make_shape(70, "0,0,4", false)})), (Vec3f{1, 1, 5}))
        << "without normals";
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(FbxDeformers, shapes_in_between_share_the_weight) {
    const std::vector<std::string> shapes = {make_shape(70, "0,0,8"), make_shape(71, "4,0,0")};
    EXPECT_EQ(load_corner(make_blended(25, "50,100", 2, shapes)), (Vec3f{1, 1, 5}));
    EXPECT_EQ(load_corner(make_blended(75, "50,100", 2, shapes)), (Vec3f{3, 1, 5}));
    EXPECT_EQ(load_corner(make_blended(150, "50,100", 2, shapes)), (Vec3f{9, 1, -7}));
    EXPECT_EQ(load_corner(make_blended(-50, "50,100", 2, shapes)), (Vec3f{1, 1, -7}));
    EXPECT_EQ(load_corner(make_blended(-50, "-100,100", 2, shapes)), (Vec3f{1, 1, 5}));
}

TEST_F(FbxDeformers, shapes_with_a_weight_of_each_point_move_points_by_it) {
    const std::string shape = "\tGeometry: 70, \"Geometry::s\", \"Shape\" {\n\t\tVersion: 100\n" +
                              make_fbx_array("Indexes", "1,3", 2) +
                              make_fbx_array("Vertices", "0,0,4,0,0,4", 6) +
                              make_fbx_array("Normals", "0,0,0,0,0,0", 6) + "\t}\n";
    const Mesh mesh = load(make_blended(100, "100,25", 2, {shape}));
    EXPECT_EQ(corner(mesh, 1), (Vec3f{1, 0, 4}));
    EXPECT_EQ(corner(mesh, 2), (Vec3f{1, 1, 2}));
}

TEST_F(FbxDeformers, shapes_of_an_old_kind_are_warned_of) {
    load(FbxScene().add("Geometry: 10,", "\t\tShape: \"old\" {\n\t\t\tVersion: 100\n\t\t}\n"));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_HAS(warnings_[0], "a.fbx: node 'grid' has blend shapes of an old kind");
}

TEST_F(FbxDeformers, skins_bend_a_mesh_as_its_bones_lie) {
    const Mesh mesh = load(make_skinned(""));
    EXPECT_EQ(corner(mesh, 0), (Vec3f{9, 0, 0})) << "of no bone: as the node of the mesh lies";
    EXPECT_EQ(corner(mesh, 1), (Vec3f{1, 0, 5}));
    EXPECT_EQ(corner(mesh, 2), (Vec3f{1, 1, 6})) << "weights are made to add up to 1";
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(FbxDeformers, that_are_read_differently_or_not_at_all_are_warned_of) {
    load(make_skinned("\t\tSkinningType: \"DualQuaternion\"\n"));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_HAS(warnings_[0], "a.fbx: node 'grid' is bent by a skin of the type 'DualQuaternion'");
    load(make_skinned("\t\tSkinningType: \"Blend\"\n"));
    EXPECT_TRUE(warnings_.empty()) << "is linear without weights";
    load(make_skinned("\t\tSkinningType: \"Blend\"\n" + make_fbx_array("BlendWeights", "0,1", 2)));
    EXPECT_EQ(warnings_.size(), 1u);
    FbxScene cached;
    cached.add_object("\tDeformer: 60, \"Deformer::s\", \"VertexCacheDeformer\" {\n\t\tVersion: 100\n\t}\n");
    load(cached.connect(60, 10));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_HAS(warnings_[0], "a.fbx: node 'grid' would be moved by a cache of points");
}

TEST_F(FbxDeformers, creases_of_edges_and_points_are_read) {
    const auto make_layer = [](const std::string& kind, const std::string& values, size_t count) {
        return "\t\tLayerElement" + kind + ": 0 {\n\t\t\tVersion: 101\n" +
               make_fbx_array(kind.c_str(), values, count) + "\t\t}\n";
    };
    FbxScene scene;
    scene.add("Geometry: 10,", make_fbx_array("Edges", "0,2,3,99", 4) +
                                   make_layer("EdgeCrease", "0.25,0,1,1", 4) +
                                   make_layer("VertexCrease", "0,0,0,0.5", 4));
    scene.add_properties("Model: 20,", {R"("Lcl Translation", "Lcl Translation", "", "A",0,0.1,0)"});
    const Mesh mesh = load(scene);
    ASSERT_EQ(mesh.creases.size(), 3u) << "an edge that is not there is left out";
    const std::vector<uint32_t>& corners = mesh.position_indices;
    EXPECT_EQ(mesh.creases[0], (Crease{corners[2], corners[2], 5}));
    EXPECT_EQ(mesh.creases[1], (Crease{corners[0], corners[1], 2.5f}));
    EXPECT_EQ(mesh.creases[2], (Crease{corners[3], corners[0], kInfiniteSharpness}));
    EXPECT_TRUE(load(FbxScene()).creases.empty());
}

} // namespace relief
