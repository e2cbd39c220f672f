// FBX: how nodes rotate, scale, bend and hide their meshes, and what is warned of.
#include <cmath>

#include "io/test_files.h"
#include "relief/io.h"
#include "relief/scene.h"
#include "support/fbx_scene.h"

namespace relief {

namespace {

std::string make_property(const std::string& name, const std::string& type, const std::string& value) {
    return '"' + name + "\", \"" + type + "\", \"\", \"\"," + value;
}
std::string make_vector(const std::string& name, const std::string& value) {
    return make_property(name, name.starts_with("Lcl ") ? name : "Vector3D", value);
}
std::string make_enum(const std::string& name, int value) {
    return make_property(name, "enum", std::to_string(value));
}
std::string make_bool(const std::string& name, bool value) {
    return make_property(name, "bool", value ? "1" : "0");
}

/// Turns v around x, y or z by degrees.
Vec3f turn(const Vec3f& v, char axis, double degrees) {
    const auto c = float(std::cos(degrees * M_PI / 180)), s = float(std::sin(degrees * M_PI / 180));
    if (axis == 'x') return {v.x, c * v.y - s * v.z, s * v.y + c * v.z};
    if (axis == 'y') return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
    return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

} // namespace

class FbxNodes : public FileTest {
  protected:
    Mesh load(const FbxScene& scene) {
        warnings_.clear();
        return load_mesh(write("a.fbx", scene.text()), {}, warnings_);
    }
    /// The grid's corners are (0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 0).
    static Vec3f corner(const Mesh& mesh, size_t k) { return mesh.positions[mesh.position_indices[k]]; }
    static void expect_near(const Vec3f& a, const Vec3f& b) {
        EXPECT_NEAR(a.x, b.x, 1e-5);
        EXPECT_NEAR(a.y, b.y, 1e-5);
        EXPECT_NEAR(a.z, b.z, 1e-5);
    }
    std::vector<std::string> warnings_;
};

TEST_F(FbxNodes, rotate_in_their_order_where_the_rotation_is_active) {
    const std::array<double, 3> angles = {30, 90, 45};
    constexpr std::array<const char*, 6> kOrders = {"xyz", "xzy", "yzx", "yxz", "zxy", "zyx"};
    for (const bool is_active : {true, false})
        for (int order = 0; order < 6; ++order) {
            const Mesh mesh = load(FbxScene().add_properties(
                "Model: 20,", {make_vector("Lcl Rotation", "30,90,45"), make_enum("RotationOrder", order),
                               make_bool("RotationActive", is_active)}));
            Vec3f expected{1, 1, 1};
            for (const char* axis = kOrders[is_active ? size_t(order) : 0]; *axis; ++axis)
                expected = turn(expected, *axis, angles[size_t(*axis - 'x')]);
            expect_near(corner(mesh, 2), expected);
        }
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(FbxNodes, have_rotations_before_and_behind_only_where_the_rotation_is_active) {
    const auto load_active = [&](const std::string& active, bool for_limits_only) {
        return corner(
            load(FbxScene().add_properties(
                "Model: 20,", {make_vector("PreRotation", "90,0,0"), make_vector("PostRotation", "0,0,90"),
                               active, make_bool("RotationSpaceForLimitOnly", for_limits_only)})),
            1);
    };
    expect_near(load_active(make_bool("RotationActive", true), false), {0, 0, -1});
    expect_near(load_active(make_bool("RotationActive", false), false), {1, 0, 0});
    expect_near(load_active(make_bool("RotationActive", true), true), {1, 0, 0});
    FbxScene with_template;
    with_template.replace("Objects:", "Definitions:  {\n\tObjectType: \"Model\" {\n\t\tPropertyTemplate: "
                                      "\"FbxNode\" {\n\t\tProperties70:  {\n\t\t\tP: " +
                                          make_bool("RotationActive", false) +
                                          "\n\t\t}\n\t\t}\n\t}\n}\nObjects:");
    with_template.add_properties("Model: 20,", {make_vector("PreRotation", "90,0,0")});
    expect_near(corner(load(with_template), 3), {0, 1, 0});
}

TEST_F(FbxNodes, turn_geometry_around_x_y_and_z_whatever_their_own_order) {
    const Mesh mesh = load(FbxScene().add_properties(
        "Model: 20,", {make_vector("GeometricRotation", "90,90,0"), make_enum("RotationOrder", 5),
                       make_bool("RotationActive", true)}));
    expect_near(corner(mesh, 3), turn(turn({0, 1, 0}, 'x', 90), 'y', 90));
}

TEST_F(FbxNodes, in_a_spheric_order_are_warned_of) {
    load(FbxScene().add_properties("Model: 20,", {make_enum("RotationOrder", 6)}));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_HAS(warnings_[0], "a.fbx: node 'grid' rotates in the order 'spheric XYZ'");
}

TEST_F(FbxNodes, inherit_the_scale_of_their_parent_as_they_say) {
    const auto load_inherit = [&](int type) {
        FbxScene scene;
        scene.add_properties("Model: 20,",
                             {make_enum("InheritType", type), make_vector("Lcl Translation", "1,0,0"),
                              make_vector("Lcl Rotation", "0,0,90")});
        scene.add_model(30, "above").connect(30, 0).replace("20,0", "20,30");
        scene.add_properties("Model: 30,", {make_vector("Lcl Scaling", "3,1,1")});
        return corner(load(scene), 1);
    };
    expect_near(load_inherit(1), {3, 1, 0}); // the x axis was turned to y, and y is not scaled
    expect_near(load_inherit(0), {3, 3, 0}); // x is scaled, then turned
    expect_near(load_inherit(2), {3, 1, 0}); // no scale, but of where it is
    const auto turned = [&](int type) {
        FbxScene scene;
        scene.add_properties("Model: 20,", {make_enum("InheritType", type)});
        scene.add_model(30, "above").connect(30, 0).replace("20,0", "20,30");
        scene.add_properties("Model: 30,", {make_vector("Lcl Scaling", "3,1,1")});
        return corner(load(scene), 1);
    };
    expect_near(turned(1), {3, 0, 0});
    expect_near(turned(2), {1, 0, 0});
}

TEST_F(FbxNodes, that_are_hidden_are_left_out_and_named) {
    FbxScene scene;
    scene.add_model(30, "hidden", "Mesh").add_model(40, "group").add_model(50, "child", "Mesh");
    scene.add_model(60, "independent", "Mesh");
    scene.connect(30, 0).connect(40, 0).connect(50, 40).connect(60, 40);
    for (const int model : {30, 50, 60}) scene.connect(10, model);
    EXPECT_EQ(load(scene).face_sizes.size(), 4u);
    EXPECT_TRUE(warnings_.empty());
    const std::string invisible = R"("Visibility", "Visibility", "", "A",0)";
    scene.add_properties("Model: 30,", {invisible}).add_properties("Model: 40,", {invisible});
    scene.add_properties("Model: 60,", {R"("Visibility Inheritance", "Visibility Inheritance", "", "",0)"});
    EXPECT_EQ(load(scene).face_sizes.size(), 2u);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_HAS(warnings_[0], "a.fbx: hidden nodes with meshes are left out, 2 of them: ");
    EXPECT_HAS(warnings_[0], "'hidden'");
    EXPECT_HAS(warnings_[0], "'child'");
    EXPECT_HAS(warnings_[0], "show them before the export");
}

TEST_F(FbxNodes, that_are_all_hidden_are_refused) {
    const FbxScene scene = FbxScene().add_properties("Model: 20,", {make_bool("Show", false)});
    const std::string message = message_of([&] { load(scene); });
    EXPECT_HAS(message, "a.fbx: all its nodes with meshes are hidden: 'grid'");
    EXPECT_HAS(message, "show them before the export");
}

TEST_F(FbxNodes, with_surfaces_that_are_no_polygons_are_warned_of) {
    FbxScene scene;
    scene.add_model(30, "dome", "NurbsSurface").connect(30, 0).connect(31, 30);
    scene.add_object("\tGeometry: 31, \"Geometry::dome\", \"NurbsSurface\" {\n\t\tVersion: 100\n\t}\n");
    EXPECT_EQ(load(scene).face_sizes.size(), 1u);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_HAS(warnings_[0], "(NURBS, patches) are not read, 1 of them: 'dome'; convert them to polygons");
    scene.replace("\"Geometry::grid\", \"Mesh\"", "\"Geometry::grid\", \"NurbsSurface\"");
    const std::string message = message_of([&] { load(scene); });
    EXPECT_HAS(message, "no faces, only surfaces that are no polygons: 'grid', 'dome'");
}

} // namespace relief
