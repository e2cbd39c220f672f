#include <utility>

#include "prepare/prepared_scene.h"
#include "prepare/space_warnings.h"
#include "relief/inspect.h"
#include "relief/render.h"

namespace relief {

std::vector<std::string> find_seam_warnings(const Scene& scene) {
    RenderSettings settings;
    settings.surface.level = 0; // seams are the same at every level, and on one patch per quad
    Scene coarse = scene;
    for (Mesh& mesh : coarse.meshes)
        if (mesh.subdivision.scheme != SubdivisionScheme::none) mesh.subdivision.level = 0;
    return find_space_warnings(*prepare_scene(std::move(coarse), settings));
}

} // namespace relief
