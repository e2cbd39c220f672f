// Damage to what a mesh does not need makes no file unreadable.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "io/gltf_document.h"
#include "io/mesh/mend_mesh.h"
#include "io/test_files.h"
#include "relief/inspect.h"
#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

namespace {

constexpr const char* kPoints = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

class MendedMeshes : public FileTest {
  protected:
    /// The mesh of a file with these bytes, which is sound.
    Mesh load(const std::string& name, const std::string& bytes) {
        warnings_.clear();
        const Mesh mesh = load_mesh(write(name, bytes), {}, warnings_);
        validate_mesh(mesh);
        for (const Finding& finding : inspect_mesh(mesh).findings)
            EXPECT_NE(finding.severity, Severity::error) << finding.text;
        return mesh;
    }
    void expect_warning(const std::string& part) const {
        ASSERT_EQ(warnings_.size(), 1u) << part;
        EXPECT_HAS(warnings_[0], part);
    }
    std::vector<std::string> warnings_;
};

} // namespace

TEST_F(MendedMeshes, obj_without_the_normals_or_uvs_that_it_names) {
    const Mesh without = load("a.obj", std::string(kPoints) + "f 1//1 2//1 3//1 4//1\n");
    EXPECT_TRUE(without.normal_indices.empty());
    expect_warning("a.obj: 4 corners have normal indices that are out of range");
    expect_warning("the first is '1' in line 5");
    EXPECT_TRUE(load("a.obj", std::string(kPoints) + "f 1/1 2/2 3/3 4/4\n").uv_indices.empty());
    expect_warning(
        "4 corners have uv indices that are out of range: their faces have no uvs, export the mesh again");
    load("a.obj", std::string(kPoints) + "f 1//-1 2//-1 3//-1 4//-9999999999999999999999\n");
    expect_warning("normal indices that are out of range");
    EXPECT_TRUE(load("a.obj", std::string(kPoints) + "vn 0 0 1\nf 1//0 2//0 3//0 4//0\n").normals.empty());
    expect_warning("the first is '0' in line 6");
    EXPECT_HAS(message_of([&] { load("a.obj", std::string(kPoints) + "f 0 1 2\n"); }), "position index 0");
    EXPECT_HAS(message_of([&] { load("a.obj", std::string(kPoints) + "f 1//x 1 2\n"); }), "no whole number");
}

TEST_F(MendedMeshes, a_face_of_obj_whose_uv_is_not_there_has_none) {
    const Mesh mesh = load("a.obj", std::string(kPoints) + "v 3 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                                           "f 1/1 2/2 3/3 4/4\nf 2/2 5/9 3/3\n");
    EXPECT_EQ(mesh.uv_indices, (std::vector<uint32_t>{0, 1, 2, 3, kNoIndex, kNoIndex, kNoIndex}));
    expect_warning("1 corners have uv indices that are out of range");
    expect_warning("the first is '9' in line 11");
}

TEST_F(MendedMeshes, points_that_no_face_has_may_be_anything) {
    const Mesh mesh = load("a.obj", std::string(kPoints) + "v nan inf 1e30\nv 1e30 0 0\nf 1 2 3 4\n");
    expect_warning("2 points of no face are not finite or too far out");
    for (const Vec3f& p : mesh.positions) EXPECT_LE(std::fabs(p.x), 1);
    EXPECT_HAS(message_of([&] { load("a.obj", std::string(kPoints) + "v nan 0 0\nf 1 2 3 5\n"); }),
               "a.obj, line 5: 'nan' is not a number");
}

/// Two squares at a right angle, with normals of points.
std::string make_ply(const std::string& normal) {
    const std::string up = " 0 0 1\n";
    return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
           "property float nx\nproperty float ny\nproperty float nz\nelement face 2\n"
           "property list uchar int vertex_indices\nend_header\n"
           "0 0 0" +
           normal + "1 0 0" + normal + "1 1 0" + up + "0 1 0" + up + "1 0 1" + up + "0 0 1" + up +
           "4 0 1 2 3\n4 1 0 5 4\n";
}

TEST_F(MendedMeshes, normals_that_are_none_are_computed) {
    for (const std::string bad : {" nan 0 1\n", " 0 0 0\n", " inf 0 0\n"}) {
        const Mesh mesh = load("n.ply", make_ply(bad));
        expect_warning(
            "n.ply: 4 of 8 corners have normals that are not finite or have no length: Relief computes "
            "them from the faces");
        ASSERT_EQ(mesh.normal_indices.size(), 8u);
        const Vec3f mended = mesh.normals[mesh.normal_indices[0]];
        EXPECT_NEAR(mended.y, std::sqrt(0.5f), 1e-6f) << bad;
        EXPECT_NEAR(mended.z, std::sqrt(0.5f), 1e-6f) << bad;
        EXPECT_EQ(mesh.normals[mesh.normal_indices[2]], (Vec3f{0, 0, 1}));
    }
    load("n.ply", make_ply(" 0 0 1\n"));
    EXPECT_TRUE(warnings_.empty());
    EXPECT_TRUE(
        load("n.obj", std::string(kPoints) + "vn nan nan nan\nf 1//1 2//1 3//1 4//1\n").normals.empty());
    expect_warning("4 of 4 corners");
}

TEST_F(MendedMeshes, uvs_that_are_not_finite_are_none) {
    const Mesh mesh = load("u.obj", std::string(kPoints) + "v 3 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt nan 1\n"
                                                           "f 1/1 2/2 3/3 4/4\nf 2/2 5/1 3/3\n");
    EXPECT_EQ(mesh.uv_indices, (std::vector<uint32_t>{kNoIndex, kNoIndex, kNoIndex, kNoIndex, 1, 0, 2}));
    expect_warning("u.obj: 1 of 2 faces have uvs in set 0 that are not finite");
    Mesh other = mesh;
    other.uv_indices = {0, 1, 2, 3, 1, 0, 2};
    other.further_uvs = {{2, {{kNoNumber, 0}}, std::vector<uint32_t>(7, 0)}};
    std::vector<std::string> warnings;
    mend_mesh(other, "m", warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "2 of 2 faces have uvs in set 2");
    EXPECT_TRUE(other.further_uvs.empty());
}

TEST_F(MendedMeshes, a_ply_list_of_uvs_that_does_not_fit_is_left_out) {
    const Mesh mesh =
        load("l.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                      "property float z\nelement face 2\nproperty list uchar float texcoord\n"
                      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                      "4 0 0 1 0  3 0 1 2\n6 0 0 1 1 0 1  3 0 2 3\n");
    EXPECT_EQ(mesh.uv_indices, (std::vector<uint32_t>{kNoIndex, kNoIndex, kNoIndex, 0, 1, 2}));
    expect_warning("1 faces have other numbers of texture coordinates");
}

TEST_F(MendedMeshes, attributes_of_gltf_that_cannot_be_read_are_left_out) {
    const auto read = [&](const char* attribute, const std::function<int(GltfDocument&)>& add) {
        GltfDocument document = make_gltf_square();
        const int index = add(document);
        primitive_of(document)["attributes"][attribute] = index;
        return load("a.glb", document.make_glb());
    };
    const auto without_buffer = [](const char* type) {
        return [type](GltfDocument& d) {
            d.json["accessors"].push_back({{"componentType", 5126}, {"count", 4}, {"type", type}});
            return int(d.json["accessors"].size()) - 1;
        };
    };
    EXPECT_TRUE(read("NORMAL", without_buffer("VEC3")).normals.empty());
    expect_warning(
        "a.glb: NORMAL of 1 part cannot be read and is left out; the first is meshes[0].primitives[0] "
        "(accessors[2]: has no 'bufferView'): export it again");
    EXPECT_TRUE(read("TEXCOORD_0", without_buffer("VEC2")).uvs.empty());
    expect_warning("accessors[2]: has no 'bufferView'");
    read("TANGENT", without_buffer("VEC4"));
    expect_warning("accessors[2]: has no 'bufferView'");
    EXPECT_TRUE(read("NORMAL", [](GltfDocument& d) {
                    return d.add_floats("VEC3", {0, 0, 1});
                }).normals.empty());
    expect_warning("has 1 values for 4 vertices");
    EXPECT_TRUE(read("NORMAL", [](GltfDocument&) { return 77; }).normals.empty());
    expect_warning("there is no accessor 77");
    const std::vector<float> bad = {kNoNumber, 0, 1, kNoNumber, 0, 1, kNoNumber, 0, 1, kNoNumber, 0, 1};
    EXPECT_TRUE(read("NORMAL", [&](GltfDocument& d) { return d.add_floats("VEC3", bad); }).normals.empty());
    expect_warning("6 of 6 corners have normals");
    EXPECT_HAS(message_of([&] { read("POSITION", without_buffer("VEC3")); }), "has no 'bufferView'");
}

TEST_F(MendedMeshes, attributes_of_gltf_that_cannot_be_read_are_counted) {
    GltfDocument document = make_gltf_square();
    const GltfJson part = primitive_of(document);
    auto& primitives = document.json["meshes"][0]["primitives"];
    for (int k = 0; k < 20; ++k) {
        primitives.push_back(part);
        primitives.back()["attributes"]["NORMAL"] = 99 + k;
        if (k > 4) primitives.back()["attributes"]["TANGENT"] = 99;
    }
    load("a.glb", document.make_glb());
    ASSERT_EQ(warnings_.size(), 2u);
    EXPECT_HAS(warnings_[0], "NORMAL of 20 parts cannot be read and is left out; the first is "
                             "meshes[0].primitives[1] (");
    EXPECT_HAS(warnings_[0], "there is no accessor 99");
    EXPECT_HAS(warnings_[1], "TANGENT of 15 parts");
}

TEST_F(MendedMeshes, what_a_render_refuses_is_an_error_of_inspect) {
    const auto has_error = [](const Mesh& mesh, const std::string& code) {
        const Inspection inspection = inspect_mesh(mesh);
        return std::ranges::any_of(inspection.findings, [&](const Finding& finding) {
            return finding.severity == Severity::error && finding.code == code;
        });
    };
    const Mesh sound = load("s.obj", std::string(kPoints) + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\n");
    Mesh mesh = sound;
    mesh.normals[0].x = kNoNumber;
    EXPECT_TRUE(has_error(mesh, "E-NAN"));
    mesh = sound, mesh.uvs[0].x = 1e7f;
    EXPECT_TRUE(has_error(mesh, "E-SCENE"));
    mesh = sound, mesh.positions[0].x = 1e30f;
    EXPECT_TRUE(has_error(mesh, "E-SCENE"));
    mesh = sound;
    for (Vec3f& p : mesh.positions) p.y = 0;
    EXPECT_TRUE(has_error(mesh, "E-SCENE")) << "no face has an area";
    mesh = sound, mesh.tangents.assign(4, {kNoNumber, 0, 0, 1});
    EXPECT_TRUE(has_error(mesh, "E-SCENE"));
}

} // namespace relief
