// Extensions of glTF that change meshes: applied, refused or warned of.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

#if __has_include(<draco/compression/encode.h>)
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#endif
#if __has_include(<meshoptimizer.h>)
#include <meshoptimizer.h>
#endif

#include "io/gltf_document.h"
#include "io/mesh/gltf_compression.h"
#include "io/test_files.h"
#include "math/box.h"

namespace relief {

namespace {

Mesh parse_with_warnings(const GltfDocument& document, std::vector<std::string>& warnings) {
    return parse_gltf(document.make_glb(), "m.glb", refuse, {}, &warnings);
}

Box find_bounds(const Mesh& mesh) {
    Box box;
    for (const Vec3f& p : mesh.positions) box.extend(p);
    return box;
}

/// The square on one node, with this extension of the node.
GltfDocument make_node_square(const std::string& extension, const GltfJson& value) {
    GltfDocument document = make_gltf_square();
    document.json["nodes"] = {{{"mesh", 0}, {"extensions", {{extension, value}}}}};
    return document;
}

/// The square with uvs and a material whose textures are these.
GltfDocument make_textured_square(const GltfJson& material) {
    GltfDocument document = make_gltf_square();
    primitive_of(document)["attributes"]["TEXCOORD_0"] =
        document.add_floats("VEC2", {0, 0, 1, 0, 1, 1, 0, 1});
    primitive_of(document)["material"] = 0;
    document.json["materials"] = GltfJson::array({material});
    return document;
}

GltfJson make_texture(const GltfJson& transform, int set = 0) {
    return {{"index", 0}, {"texCoord", set}, {"extensions", {{"KHR_texture_transform", transform}}}};
}

} // namespace

using GltfExtensions = FileTest;

TEST_F(GltfExtensions, required_ones_are_known_or_refused_by_name) {
    const auto require = [](const std::string& name) {
        GltfDocument document = make_gltf_square();
        document.json["extensionsRequired"] = {name};
        return parse_document(document);
    };
    for (const char* name : {"KHR_mesh_quantization", "KHR_texture_transform", "EXT_mesh_gpu_instancing",
                             "KHR_materials_unlit", "KHR_texture_basisu", "KHR_lights_punctual"})
        EXPECT_EQ(require(name).face_sizes.size(), 2u) << name;
    for (const char* name : {"EXT_unheard_of", "KHR_gaussian_splatting", "khr_materials_unlit", ""})
        EXPECT_HAS(message_of([&] { require(name); }), std::string("needs the extension ") + name);
}

TEST_F(GltfExtensions, parts_of_the_file_with_unknown_ones_are_warned_of) {
    GltfDocument document = make_node_square("ACME_bend", {{"angle", 1}});
    document.json["extensionsUsed"] = {"ACME_bend", "ACME_grow", "KHR_animation_pointer"};
    primitive_of(document)["extensions"] = {{"ACME_grow", GltfJson::object()},
                                            {"KHR_materials_variants", GltfJson::object()}};
    std::vector<std::string> warnings;
    EXPECT_EQ(parse_with_warnings(document, warnings).face_sizes.size(), 2u);
    ASSERT_EQ(warnings.size(), 3u);
    EXPECT_HAS(warnings[0],
               "does not read KHR_animation_pointer, so the properties that it animates keep their");
    EXPECT_HAS(warnings[1], "ACME_bend of 1 parts");
    EXPECT_HAS(warnings[1], "so their shape may differ; the first is nodes[0]");
    EXPECT_HAS(warnings[2], "ACME_grow of 1 parts");
}

TEST_F(GltfExtensions, instances_are_copies_of_the_mesh) {
    GltfDocument document = make_node_square("EXT_mesh_gpu_instancing", {});
    const float half = std::sqrt(0.5f);
    const int places = document.add_floats("VEC3", {0, 0, 0, 5, 0, 0, 10, 0, 0});
    const int turns = document.add_floats("VEC4", {0, 0, 0, 1, 0, 0, half, half, 0, 0, 0, 1});
    const int sizes = document.add_floats("VEC3", {1, 1, 1, 1, 1, 1, 2, 1, 1});
    document.json["nodes"][0]["translation"] = {0, 0, 3};
    GltfJson& attributes = document.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes = {{"TRANSLATION", places}, {"ROTATION", turns}, {"SCALE", sizes}};
    std::vector<std::string> warnings;
    const Mesh mesh = parse_with_warnings(document, warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(mesh.face_sizes.size(), 6u);
    const Box box = find_bounds(mesh);
    EXPECT_EQ(box.upper, (Vec3f{12, 1, 3}));
    EXPECT_EQ(box.lower.z, 3);
    EXPECT_TRUE(std::ranges::any_of(mesh.positions, [](const Vec3f& p) {
        return length(p - Vec3f{4, 1, 3}) < 1e-6f; // (1, 1) turned by a quarter about (5, 0)
    }));
    attributes.erase("SCALE"), attributes.erase("ROTATION");
    EXPECT_EQ(find_bounds(parse_document(document)).upper, (Vec3f{11, 1, 3}));
    attributes["SCALE"] = document.add_floats("VEC3", {1, 1, 1});
    EXPECT_HAS(message_of([&] { parse_document(document); }), "for 3 instances");
    attributes = GltfJson::object();
    EXPECT_HAS(message_of([&] { parse_document(document); }), "none of TRANSLATION");
}

TEST_F(GltfExtensions, hidden_nodes_hide_all_below_them) {
    GltfDocument document = make_node_square("KHR_node_visibility", {{"visible", false}});
    document.json["nodes"][0]["children"] = {1};
    document.json["nodes"].push_back({{"mesh", 0}});
    document.json["nodes"].push_back({{"mesh", 0}, {"translation", {7, 0, 0}}});
    EXPECT_EQ(find_bounds(parse_document(document)).lower.x, 7);
    document.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = true;
    EXPECT_EQ(find_bounds(parse_document(document)).lower.x, 0);
}

TEST_F(GltfExtensions, uvs_follow_the_transform_that_all_textures_have) {
    const GltfJson transform = {{"offset", {0.25, 0.5}}, {"scale", {2, 4}}};
    const GltfJson material = {
        {"pbrMetallicRoughness", {{"baseColorTexture", make_texture(transform)}}},
        {"normalTexture", make_texture(transform)},
        {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatTexture", make_texture(transform)}}}}}};
    std::vector<std::string> warnings;
    const Mesh mesh = parse_with_warnings(make_textured_square(material), warnings);
    EXPECT_TRUE(warnings.empty());
    ASSERT_EQ(mesh.uv_indices.size(), 6u);
    EXPECT_EQ(mesh.uvs[mesh.uv_indices[0]], (Vec2f{0.25f, 1 - 0.5f}));
    EXPECT_EQ(mesh.uvs[mesh.uv_indices[2]], (Vec2f{2.25f, 1 - 4.5f}));
    // Counter-clockwise as the picture is seen: v runs downwards.
    const Mesh turned = parse_document(make_textured_square(
        {{"normalTexture", make_texture({{"rotation", std::acos(0.0)}, {"scale", {1, 1}}})}}));
    const Vec2f right = turned.uvs[turned.uv_indices[1]];
    EXPECT_NEAR(right.x, 0, 1e-6f);
    EXPECT_NEAR(right.y, 1 - -1.0f, 1e-6f);
}

TEST_F(GltfExtensions, textures_of_other_transforms_leave_the_uvs_with_a_warning) {
    const GltfJson first = make_texture({{"scale", {2, 2}}}), second = make_texture({{"scale", {3, 3}}});
    std::vector<std::string> warnings;
    const Mesh mesh = parse_with_warnings(
        make_textured_square({{"normalTexture", first}, {"emissiveTexture", second}}), warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "different KHR_texture_transform");
    EXPECT_EQ(mesh.uvs[mesh.uv_indices[2]], (Vec2f{1, 0}));
    warnings.clear();
    parse_with_warnings(make_textured_square({{"normalTexture", first}, {"emissiveTexture", {{"index", 0}}}}),
                        warnings);
    EXPECT_EQ(warnings.size(), 1u) << "one has no transform";
    warnings.clear();
    const Mesh apart =
        parse_with_warnings(make_textured_square({{"normalTexture", first},
                                                  {"emissiveTexture", make_texture(GltfJson::object(), 1)}}),
                            warnings);
    EXPECT_TRUE(warnings.empty()) << "the other one is of another set";
    EXPECT_EQ(apart.uvs[apart.uv_indices[2]], (Vec2f{2, -1}));
}

TEST_F(GltfExtensions, materials_of_different_transforms_are_counted) {
    const GltfJson mixed = {{"normalTexture", make_texture({{"scale", {2, 2}}})},
                            {"emissiveTexture", make_texture({{"scale", {3, 3}}})}};
    GltfDocument document = make_textured_square(mixed);
    auto& primitives = document.json["meshes"][0]["primitives"];
    document.json["materials"] = GltfJson::array();
    for (int k = 0; k < 3; ++k) document.json["materials"].push_back(mixed);
    const GltfJson part = primitives[0];
    primitives = GltfJson::array();
    for (const int material : {1, 2, 1, 2, 2}) {
        primitives.push_back(part);
        primitives.back()["material"] = material;
    }
    std::vector<std::string> warnings;
    parse_with_warnings(document, warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "textures of 2 materials have different KHR_texture_transform");
    EXPECT_HAS(warnings[0], "the uvs of set 0; the first is materials[1]: export");
}

TEST_F(GltfExtensions, quantized_uvs_become_parts_of_one_by_the_transform) {
    GltfDocument document = make_gltf_square();
    primitive_of(document)["attributes"]["POSITION"] =
        document.add<int16_t>("VEC3", 5122, {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0});
    primitive_of(document)["attributes"]["TEXCOORD_0"] =
        document.add<uint16_t>("VEC2", 5123, {0, 0, 4095, 0, 4095, 4095, 0, 4095});
    primitive_of(document)["material"] = 0;
    document.json["materials"] = {{{"normalTexture", make_texture({{"scale", {1.0 / 4095, 1.0 / 4095}}})}}};
    document.json["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_texture_transform"};
    document.json["nodes"] = {{{"mesh", 0}, {"scale", {0.25, 0.25, 0.25}}}};
    const Mesh mesh = parse_document(document);
    EXPECT_EQ(find_bounds(mesh).upper, (Vec3f{1, 1, 0}));
    EXPECT_NEAR(mesh.uvs[mesh.uv_indices[2]].x, 1, 1e-6f);
    EXPECT_NEAR(mesh.uvs[mesh.uv_indices[2]].y, 0, 1e-6f);
    primitive_of(document).erase("material");
    std::vector<std::string> warnings;
    parse_with_warnings(document, warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "uvs of set 0 are whole numbers");
}

#if __has_include(<meshoptimizer.h>)
TEST_F(GltfExtensions, meshopt_is_decompressed) {
    if (!can_decompress_gltf("EXT_meshopt_compression")) return; // a build without the library refuses it
    GltfDocument document = make_gltf_square();
    const auto compress = [&](int view, const std::vector<unsigned char>& bytes, const GltfJson& said) {
        GltfJson extension = said;
        extension["buffer"] = 0, extension["byteOffset"] = document.buffer.size();
        extension["byteLength"] = bytes.size();
        document.buffer.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        document.buffer.resize((document.buffer.size() + 3) / 4 * 4);
        document.json["bufferViews"][size_t(view)]["extensions"] = {{"EXT_meshopt_compression", extension}};
    };
    std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(4, 12));
    std::vector<float> moved = kGltfSquare;
    for (float& value : moved) value += 2;
    vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), moved.data(), 4, 12));
    compress(0, vertices, {{"byteStride", 12}, {"count", 4}, {"mode", "ATTRIBUTES"}});
    const std::vector<uint32_t> corners = {0, 1, 2, 0, 2, 3};
    std::vector<unsigned char> indices(meshopt_encodeIndexBufferBound(6, 4));
    indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), corners.data(), 6));
    compress(1, indices, {{"byteStride", 2}, {"count", 6}, {"mode", "TRIANGLES"}});
    document.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    const Mesh mesh = parse_document(document);
    EXPECT_EQ(mesh.face_sizes.size(), 2u);
    EXPECT_EQ(find_bounds(mesh).lower, (Vec3f{2, 2, 2}));
    EXPECT_EQ(find_bounds(mesh).upper, (Vec3f{3, 3, 2}));
    const auto damage = [&](const char* key, const GltfJson& value) {
        GltfDocument damaged = document;
        damaged.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
        return message_of([&] { parse_document(damaged); });
    };
    EXPECT_HAS(damage("byteLength", 3), "cannot be decompressed");
    EXPECT_HAS(damage("count", 1u << 31), "bytes cannot hold");
    EXPECT_HAS(damage("mode", "OTHER"), "has mode OTHER");
    EXPECT_HAS(damage("byteStride", 10), "has mode ATTRIBUTES");
    EXPECT_HAS(damage("filter", "OCTAHEDRAL"), "has filter OCTAHEDRAL for values of 12 bytes");
    EXPECT_HAS(damage("byteOffset", 1 << 30), "goes to byte");
}
#endif

#if __has_include(<draco/compression/encode.h>)
namespace {

/// A square compressed by Draco, with the numbers of its attributes.
struct DracoSquare {
    std::vector<uint8_t> bytes;
    uint32_t positions = 0, uvs = 0;
};

/// Compresses kGltfSquare, moved by two units along each axis.
DracoSquare compress_square() {
    draco::Mesh square;
    square.set_num_points(4);
    const auto add = [&](draco::GeometryAttribute::Type type, int8_t width,
                         const std::vector<float>& values) {
        draco::GeometryAttribute attribute;
        attribute.Init(type, nullptr, width, draco::DT_FLOAT32, false, width * int64_t(sizeof(float)), 0);
        const int id = square.AddAttribute(attribute, true, 4);
        for (uint32_t k = 0; k < 4; ++k)
            square.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(k),
                                                    &values[size_t(width) * k]);
        return square.attribute(id)->unique_id();
    };
    std::vector<float> moved = kGltfSquare;
    for (float& value : moved) value += 2;
    DracoSquare result;
    result.positions = add(draco::GeometryAttribute::POSITION, 3, moved);
    result.uvs = add(draco::GeometryAttribute::TEX_COORD, 2, {0, 0, 1, 0, 1, 1, 0, 1});
    for (const auto& [a, b, c] : {std::tuple(0, 1, 2), std::tuple(0, 2, 3)})
        square.AddFace(
            {draco::PointIndex(uint32_t(a)), draco::PointIndex(uint32_t(b)), draco::PointIndex(uint32_t(c))});
    draco::EncoderBuffer bytes;
    EXPECT_TRUE(draco::Encoder().EncodeMeshToBuffer(square, &bytes).ok());
    result.bytes.assign(bytes.data(), bytes.data() + bytes.size());
    return result;
}

GltfDocument make_draco_document() {
    const DracoSquare square = compress_square();
    GltfDocument document = make_gltf_square();
    const int unused = document.add<uint8_t>("SCALAR", 5121, square.bytes);
    const GltfJson view = document.json["accessors"][size_t(unused)]["bufferView"];
    for (const size_t accessor : {0, 1}) document.json["accessors"][accessor].erase("bufferView");
    document.json["accessors"].push_back({{"componentType", 5126}, {"count", 4}, {"type", "VEC2"}});
    primitive_of(document)["attributes"]["TEXCOORD_0"] = document.json["accessors"].size() - 1;
    primitive_of(document)["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view}, {"attributes", {{"POSITION", square.positions}, {"TEXCOORD_0", square.uvs}}}};
    document.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return document;
}

} // namespace

TEST_F(GltfExtensions, draco_is_decompressed) {
    if (!can_decompress_gltf("KHR_draco_mesh_compression")) return; // a build without the library refuses it
    const GltfDocument document = make_draco_document();
    const Mesh mesh = parse_document(document);
    EXPECT_EQ(mesh.face_sizes.size(), 2u);
    EXPECT_EQ(find_bounds(mesh).lower, (Vec3f{2, 2, 2}));
    EXPECT_EQ(find_bounds(mesh).upper, (Vec3f{3, 3, 2}));
    ASSERT_EQ(mesh.uv_indices.size(), 6u);
    for (size_t k = 0; k < 6; ++k) {
        const Vec3f& p = mesh.positions[mesh.position_indices[k]];
        EXPECT_EQ(mesh.uvs[mesh.uv_indices[k]], (Vec2f{p.x - 2, 1 - (p.y - 2)}));
    }
    const auto damage = [&](const std::string& place, const GltfJson& value) {
        GltfDocument damaged = document;
        damaged.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]
                    [GltfJson::json_pointer(place)] = value;
        return message_of([&] { parse_document(damaged); });
    };
    EXPECT_HAS(damage("/attributes/POSITION", 77), "has no attribute 77");
    EXPECT_HAS(damage("/bufferView", 0), "cannot be decompressed");
}
#endif

} // namespace relief
