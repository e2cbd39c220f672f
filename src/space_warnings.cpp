#include "space_warnings.h"

#include <optional>
#include <utility>

#include <fmt/format.h>

#include "map_convention.h"

namespace relief {

namespace {

constexpr size_t kMostEdges = 512;

} // namespace

std::vector<std::string> find_space_warnings(const PreparedScene& scene) {
    std::vector<std::string> warnings;
    for (const Surface& surface : scene.surfaces) {
        // Relative lengths are no signed permutation of what was read.
        if (!surface.has_displacement || !surface.map.is_tangent || !surface.derivatives.empty()) continue;
        const std::optional<Guess<DisplacementSpace>> guess =
            guess_space_by_seams(sample_seams(surface, kMostEdges));
        if (!guess || guess->value != DisplacementSpace::object) continue;
        warnings.push_back(
            fmt::format("the displacement of mesh '{}' is read as tangent space and looks like "
                        "object space: {}; say space object, or ask `relief inspect`",
                        surface.name, guess->reason));
    }
    return warnings;
}

std::shared_ptr<PreparedScene> prepare_with_warnings(Scene scene, const RenderSettings& settings) {
    std::shared_ptr<PreparedScene> prepared = prepare_scene(std::move(scene), settings);
    for (std::string& warning : find_space_warnings(*prepared))
        prepared->warnings.push_back(std::move(warning));
    return prepared;
}

} // namespace relief
