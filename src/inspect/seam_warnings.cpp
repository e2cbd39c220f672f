#include "prepare/prepared_scene.h"
#include "prepare/space_warnings.h"
#include "relief/inspect.h"
#include "relief/render.h"

namespace relief {

std::vector<std::string> find_seam_warnings(const Scene& scene) {
    RenderSettings settings;
    settings.surface.level = 0; // seams are the same at every level
    return find_space_warnings(*prepare_scene(scene, settings));
}

} // namespace relief
