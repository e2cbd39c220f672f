// Textures of materials on a uv set of their own in scene files: read, refused, told apart.
#include <string>

#include "io/gltf_document.h"
#include "io/scene_files.h"
#include "relief/io.h"

namespace relief {
namespace {

class UvSets : public SceneFiles {
  protected:
    UvSets() {
        write_pixels<float>("grey.exr", 1, 1, 1, OIIO::TypeDesc::FLOAT, {0.25f});
        GltfDocument document = make_gltf_square();
        nlohmann::json& attributes = primitive_of(document)["attributes"];
        attributes["TEXCOORD_0"] = document.add_floats("VEC2", {0, 1, 1, 1, 1, 0, 0, 0});
        attributes["TEXCOORD_1"] = document.add_floats("VEC2", {0, 0, 0.5f, 0, 0.5f, 0.5f, 0, 0.5f});
        attributes["TEXCOORD_2"] = document.add_floats("VEC2", {0, 0, 0.2f, 0, 0.2f, 0.2f, 0, 0.2f});
        write("m.glb", document.make_glb());
    }

    /// A mesh of that file, and a material with the texture.
    static std::string make_text(const std::string& mesh, const std::string& material) {
        return R"({"materials": {"m": {)" + material + R"(}}, "meshes": {"p": {)" + mesh +
               R"(}}, "objects": [{"name": "o", "mesh": "p", "material": "m"}]})";
    }
    static std::string put_on(int set) {
        return R"("coat_weight": {"file": "grey.exr", "uv_set": )" + std::to_string(set) + "}";
    }
};

TEST_F(UvSets, of_files_are_read_where_a_texture_names_them) {
    const Scene scene = parse(make_text(R"("file": "m.glb")", put_on(1)));
    ASSERT_EQ(scene.meshes.at(0).further_uvs.size(), 1u);
    EXPECT_EQ(scene.meshes[0].further_uvs[0].number, 1);
    EXPECT_EQ(scene.materials.at(0).textures.at(0).uv_set, 1);
    const Scene turned = parse(make_text(R"("file": "m.glb", "uv_set": 2)", put_on(0)));
    EXPECT_EQ(turned.meshes.at(0).uv_set, 2);
    ASSERT_EQ(turned.meshes[0].further_uvs.size(), 1u);
    EXPECT_EQ(turned.meshes[0].further_uvs[0].number, 0);
    const Scene usual = parse(make_text(R"("file": "m.glb")", R"("coat_weight": {"file": "grey.exr"})"));
    EXPECT_TRUE(usual.meshes.at(0).further_uvs.empty());
    EXPECT_EQ(usual.materials.at(0).textures.at(0).uv_set, kOwnUvSet);
    EXPECT_NE(scene.hash, usual.hash);
}

TEST_F(UvSets, that_are_those_of_the_mesh_need_no_other) {
    EXPECT_TRUE(parse(make_text(R"("file": "m.glb")", put_on(0))).meshes.at(0).further_uvs.empty());
    EXPECT_TRUE(parse(make_text(R"("file": "plane.obj")", put_on(0))).meshes.at(0).further_uvs.empty());
    EXPECT_TRUE(
        parse(make_text(R"("file": "m.glb", "uv_set": 1)", put_on(1))).meshes.at(0).further_uvs.empty());
}

TEST_F(UvSets, of_keys_that_end_in_texture_are_read) {
    for (const char* key :
         {"base_color_texture", "roughness_texture", "metallic_texture", "opacity_texture"}) {
        const Scene scene = parse(make_text(
            R"("file": "m.glb")",
            "\"" + std::string(key) + R"(": {"file": "grey.exr", "filter": "bspline", "uv_set": 2})"));
        ASSERT_EQ(scene.materials.at(0).textures.size(), 1u) << key;
        EXPECT_EQ(scene.materials[0].textures[0].uv_set, 2) << key;
        EXPECT_EQ(scene.materials[0].textures[0].filter, MapFilter::bspline) << key;
        EXPECT_EQ(scene.meshes.at(0).further_uvs.at(0).number, 2) << key;
    }
}

TEST_F(UvSets, that_a_mesh_lacks_are_refused_with_object_and_place) {
    const std::string message = error_of(make_text(R"("file": "m.glb")", put_on(3)));
    EXPECT_HAS(message, "s.json: object 'o'");
    EXPECT_HAS(message, "the coat_weight of its material 'm' lies on uv set 3, and mesh 'p'");
    EXPECT_HAS(message, "m.glb) has uv set 0 (sets count from 0, as TEXCOORD_0 of glTF does");
    EXPECT_HAS(error_of(make_text(R"("file": "plane.obj")", put_on(1))), "plane.obj) has uv set 0 (");
}

TEST_F(UvSets, cannot_be_saved_with_meshes_that_hold_one) {
    const Scene scene = parse(make_text(R"("file": "m.glb")", put_on(1)));
    EXPECT_HAS(message_of([&] { save_scene(scene, folder_ / "out"); }),
               "mesh 'p': the coat_weight of material 'm' lies on uv set 1");
    save_scene(parse(make_text(R"("file": "m.glb", "uv_set": 1)", put_on(1))), folder_ / "out");
    EXPECT_EQ(load_scene(folder_ / "out/scene.json").materials.at(0).textures.at(0).uv_set, kOwnUvSet);
}

} // namespace
} // namespace relief
