// load_mesh: the kind of file decides who reads it.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "io/file_system.h"
#include "io/mesh_assimp.h"
#include "io/mesh_obj.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/suggest.h"

namespace relief {

namespace {

constexpr std::array<std::string_view, 5> kMeshExtensions = {".obj", ".ply", ".gltf", ".glb", ".fbx"};

} // namespace

bool is_mesh_file(const std::filesystem::path& file) {
    const std::string extension = get_extension(file);
    return std::find(kMeshExtensions.begin(), kMeshExtensions.end(), extension) != kMeshExtensions.end();
}

Mesh load_mesh(const std::filesystem::path& file) {
    require_file(file);
    if (!is_mesh_file(file)) {
        const std::string extension = get_extension(file);
        throw Error(ErrorKind::bad_input, {fmt::format("unknown kind of mesh '{}'", extension), file.string(),
                                           suggest_word(extension, kMeshExtensions)});
    }
    Mesh mesh = get_extension(file) == ".obj" ? parse_obj(read_file_bytes(file), file.string())
                                              : read_assimp_mesh(file);
    mesh.name = file.stem().string();
    mesh.source = file.string();
    if (mesh.face_sizes.empty())
        throw Error(ErrorKind::bad_input,
                    {"the mesh has no faces", file.string(), "export the polygons as well"});
    return mesh;
}

} // namespace relief
