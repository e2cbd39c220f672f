// load_mesh: the kind of file decides who reads it.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/suggest.h"
#include "io/file_system.h"
#include "io/mesh/child_reader.h"
#include "io/mesh/mend_mesh.h"
#include "io/mesh/mesh_assimp.h"
#include "io/mesh/mesh_gltf.h"
#include "io/mesh/mesh_obj.h"
#include "io/mesh/mesh_ply.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

constexpr std::array<std::string_view, 5> kMeshExtensions = {".obj", ".ply", ".gltf", ".glb", ".fbx"};

Mesh read_mesh(const std::filesystem::path& file, const MeshReadOptions& options,
               std::vector<std::string>& warnings) {
    const std::string extension = get_lower_extension(file), name = file.string();
    const bool is_gltf = extension == ".gltf" || extension == ".glb";
    if (!options.animation.empty() && !is_gltf)
        throw Error(ErrorKind::bad_input,
                    {"only animations of glTF files are read", name,
                     "export it as glTF, or write a file for each frame and name them with ####"});
    if (extension == ".fbx")
        return options.reader.program.empty() ? read_assimp_mesh(file, options, warnings)
                                              : read_mesh_in_child(file, options, warnings);
    if (is_gltf) {
        const auto read_beside = [&file](const std::string& path) {
            const std::filesystem::path other = find_with_slashes(file.parent_path() / path);
            require_file(other);
            return read_file_bytes(other);
        };
        return parse_gltf(read_file_bytes(file), name, read_beside, options, &warnings);
    }
    if (options.uv_set != 0)
        throw Error(ErrorKind::bad_input, {fmt::format("has no uv set {}", options.uv_set), name,
                                           fmt::format("a file '{}' has one set, number 0", extension)});
    return extension == ".obj" ? parse_obj(read_file_bytes(file), name, &warnings)
                               : parse_ply(read_file_bytes(file), name, &warnings);
}

} // namespace

bool is_mesh_file(const std::filesystem::path& file) {
    const std::string extension = get_lower_extension(file);
    return std::find(kMeshExtensions.begin(), kMeshExtensions.end(), extension) != kMeshExtensions.end();
}

Mesh load_mesh(const std::filesystem::path& file, const MeshReadOptions& options) {
    std::vector<std::string> untold; // the caller asks for the mesh alone
    return load_mesh(file, options, untold);
}

Mesh load_mesh(const std::filesystem::path& file, const MeshReadOptions& options,
               std::vector<std::string>& warnings) {
    require_file(file);
    refuse_foreign_file(file);
    if (!is_mesh_file(file)) {
        const std::string extension = get_lower_extension(file);
        throw Error(ErrorKind::bad_input, {fmt::format("unknown kind of mesh '{}'", extension), file.string(),
                                           suggest_word(extension, kMeshExtensions)});
    }
    Mesh mesh = read_mesh(file, options, warnings);
    mesh.name = file.stem().string();
    mesh.source = file.string();
    if (mesh.face_sizes.empty())
        throw Error(ErrorKind::bad_input,
                    {"the mesh has no faces", file.string(), "export the polygons as well"});
    mend_mesh(mesh, file.string(), warnings);
    return mesh;
}

} // namespace relief
