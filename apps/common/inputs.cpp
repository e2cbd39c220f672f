#include "common/inputs.h"

#include <algorithm>
#include <memory>
#include <system_error>

#include "common/values.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::cli {

FileKind get_kind(const std::filesystem::path& file) {
    if (is_mesh_file(file)) return FileKind::mesh;
    return get_lower_extension(file) == ".json" ? FileKind::scene : FileKind::map;
}

std::vector<std::string> list_files(const Scene& scene) {
    std::vector<std::string> files = {scene.source};
    const auto add = [&](const std::shared_ptr<const Texture>& texture) {
        if (texture) files.push_back(split_picture_name(texture->file).file);
    };
    for (const Mesh& mesh : scene.meshes) files.push_back(mesh.source);
    for (const Displacement& displacement : scene.displacements)
        for (const auto& tile : displacement.tiles) add(tile.texture);
    for (const Material& material : scene.materials)
        visit_textures(material, [&](const char*, const auto& texture, MapFilter) { add(texture); });
    if (scene.environment) add(scene.environment->texture);
    for (const Light& light : scene.lights) add(light.color_texture);
    return files;
}

void refuse_empty_scene(const Scene& scene, const std::filesystem::path& file) {
    if (!scene.objects.empty() || scene.environment) return;
    if (std::ranges::any_of(scene.lights, &Light::is_visible_to_camera)) return;
    throw Error(ErrorKind::bad_input,
                {"the scene has no objects, no environment and no light that the camera sees", file.string(),
                 "add 'objects', each with a mesh of 'meshes'; relief scene ear writes a scene to look at"});
}

void refuse_link_loop(const std::filesystem::path& file, ErrorKind kind) {
    std::error_code code;
    [[maybe_unused]] const std::filesystem::file_status status = std::filesystem::status(file, code);
    if (code == std::errc::too_many_symbolic_link_levels)
        throw Error(kind, {"is a symbolic link, or in one, that leads back to itself", file.string(),
                           "readlink -f shows where links end"});
}

std::filesystem::path find_place(const std::filesystem::path& file) {
    std::error_code ignored;
    const std::filesystem::path end = find_link_end(file); // outputs go where links lead
    const std::filesystem::path folder = end.has_parent_path() ? end.parent_path() : ".";
    return std::filesystem::weakly_canonical(folder, ignored) / end.filename();
}

void refuse_output(const std::filesystem::path& output) {
    throw Error(ErrorKind::usage,
                {"a file that is read would be written over", output.string(), "name another one to write"});
}

void keep_files(const std::vector<std::string>& files, const std::filesystem::path& output) {
    if (output.empty()) return;
    const std::filesystem::path place = find_place(output);
    for (const std::string& file : files) {
        std::error_code ignored; // names that are not files
        if (file.empty() || file == "-") continue;
        const std::filesystem::path read = split_picture_name(file).file;
        if (find_place(read) == place || std::filesystem::equivalent(read, output, ignored))
            refuse_output(output);
    }
}

} // namespace relief::cli
