// Files of other programs that are not read.
#include <nlohmann/json.hpp>

#include "io/foreign_files.h"
#include "io/mesh/gltf_compression.h"
#include "io/mesh/mesh_gltf.h"
#include "io/test_files.h"
#include "relief/io.h"

namespace relief {
namespace {

using ForeignFiles = FileTest;

TEST_F(ForeignFiles, meshes_name_the_way_out_of_their_program) {
    const std::pair<const char*, const char*> kinds[] = {
        {"a.blend", "File > Export > Wavefront (.obj)"},
        {"a.USD", "Blender: File > Import > Universal Scene Description"},
        {"a.usda", "USD"},
        {"a.usdc", "USD"},
        {"a.usdz", "relief-usd FILE -o FOLDER/scene.json"},
        {"a.abc", "Alembic"},
        {"a.stl", "no uvs"},
        {"a.ma", "Maya: File > Export All, Files of type: OBJexport"},
        {"a.mb", "Maya: File > Export All"},
        {"a.ztl", "ZBrush: Tool > Export"},
        {"a.mud", "Mudbox: File > Export Selection"},
        {"a.max", "3ds Max: File > Export > Export"},
        {"a.c4d", "Cinema 4D: File > Export > Wavefront OBJ"},
        {"a.3ds", "3D Studio"},
        {"a.dae", "MeshLab: File > Import Mesh"},
        {"a.bgeo.sc", "Houdini: right-click the surface node > Save Geometry"}};
    for (const auto& [name, way] : kinds) {
        const auto file = write(name, "x");
        for (const std::function<void()>& read : {std::function<void()>([&] { load_mesh(file); }),
                                                  std::function<void()>([&] { load_scene(file); }),
                                                  std::function<void()>([&] { read_image(file); }),
                                                  std::function<void()>([&] { read_texture(file); })}) {
            const std::string message = message_of(read);
            EXPECT_HAS(message, "is not read: export OBJ, PLY or glTF");
            EXPECT_HAS(message, way);
            EXPECT_HAS(message, name);
        }
    }
}

TEST_F(ForeignFiles, pictures_name_another_kind) {
    EXPECT_HAS(message_of([&] { read_texture(write("a.psd", "x")); }),
               "a Photoshop file is not read: export EXR, TIFF or PNG");
    EXPECT_HAS(message_of([&] { read_texture(write("a.ptx", "x")); }), "over the mesh's uvs");
    EXPECT_HAS(message_of([&] { read_texture(write("a.ptex", "x")); }), "Ptex");
    EXPECT_HAS(message_of([&] { read_image(write("a.tga", "x")); }), "Targa");
}

TEST_F(ForeignFiles, as_meshes_and_maps_of_a_scene_name_their_place_in_it) {
    write("ear.abc", "x"), write("skin.ptx", "x"), write("quad.obj", kQuadObj);
    const auto scene = write("scene.json", R"({"meshes": {"ear": {"file": "ear.abc"}}})");
    const std::string mesh = message_of([&] { load_scene(scene); });
    EXPECT_HAS(mesh, "meshes.ear.file");
    EXPECT_HAS(mesh, "an Alembic file is not read");
    const auto other = write("other.json", R"({"displacements": {"skin": {"file": "skin.ptx"}}})");
    EXPECT_HAS(message_of([&] { load_scene(other); }), "a Ptex file is not read");
}

TEST_F(ForeignFiles, meshes_compressed_in_gltf_name_the_box_to_untick) {
    const auto refuse = [](const char* extension) {
        const ForeignFile foreign = find_foreign_gltf(extension).value();
        if (can_decompress_gltf(extension)) return foreign.message + " (" + foreign.hint + ")";
        const nlohmann::json document = {{"asset", {{"version", "2.0"}}},
                                         {"extensionsRequired", {extension}},
                                         {"extensionsUsed", {extension}}};
        return message_of([&] { parse_gltf(document.dump(), "a.gltf", {}, {}); });
    };
    EXPECT_HAS(refuse("KHR_draco_mesh_compression"),
               "Draco (KHR_draco_mesh_compression) is not read: export OBJ");
    EXPECT_HAS(refuse("KHR_draco_mesh_compression"), "untick Data > Compression");
    EXPECT_HAS(refuse("EXT_meshopt_compression"), "gltfpack");
}

TEST_F(ForeignFiles, loops_of_links_are_called_so) {
    std::filesystem::create_symlink("b.exr", folder_ / "a.exr");
    std::filesystem::create_symlink("a.exr", folder_ / "b.exr");
    std::filesystem::create_symlink("loop", folder_ / "loop");
    const char* const kLoop = "leads back to itself";
    EXPECT_HAS(message_of([&] { read_texture(folder_ / "a.exr"); }), kLoop);
    EXPECT_HAS(message_of([&] { load_scene(folder_ / "loop" / "scene.json"); }), kLoop);
    EXPECT_HAS(message_of([&] { load_mesh(folder_ / "loop" / "a.obj"); }), kLoop);
    EXPECT_HAS(message_of([&] { check_writable(folder_ / "a.exr"); }, ErrorKind::failed), kLoop);
    EXPECT_HAS(message_of([&] { check_text_writable(folder_ / "loop" / "a.json"); }, ErrorKind::failed),
               kLoop);
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "a.exr"));
}

} // namespace
} // namespace relief
