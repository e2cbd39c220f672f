#include "inputs.h"

#include <memory>
#include <system_error>

#include "relief/error.h"

namespace relief::cli {

std::vector<std::string> list_files(const Scene& scene) {
    std::vector<std::string> files = {scene.source};
    const auto add = [&](const std::shared_ptr<const Texture>& texture) {
        if (texture) files.push_back(texture->file);
    };
    for (const Mesh& mesh : scene.meshes) files.push_back(mesh.source);
    for (const Displacement& displacement : scene.displacements)
        for (const auto& tile : displacement.tiles) add(tile.texture);
    for (const Material& material : scene.materials)
        add(material.base_color_texture), add(material.roughness_texture);
    if (scene.environment) add(scene.environment->texture);
    return files;
}

void keep_files(const std::vector<std::string>& files, const std::filesystem::path& output) {
    for (const std::string& file : files) {
        std::error_code ignored; // of names that are no files
        if (output.empty() || (file != output && !std::filesystem::equivalent(file, output, ignored)))
            continue;
        throw Error(ErrorKind::usage, {"a file that is read would be written over", output.string(),
                                       "name another one to write"});
    }
}

} // namespace relief::cli
