#include "prepare/space_warnings.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "analysis/map_convention.h"

namespace relief {

namespace {

constexpr size_t kMostEdges = 512;
constexpr double kLeastGap = 0.3; ///< of seams that are torn

/// Twice the area of a patch in uv.
double measure_uv_area(const Surface& surface, const Quad& quad) {
    double area = 0;
    for (size_t k = 0; k < 4; ++k) {
        const Vec2f &a = surface.uvs[quad.vertex[k]], &b = surface.uvs[quad.vertex[(k + 1) % 4]];
        area += double(a.x) * double(b.y) - double(b.x) * double(a.y);
    }
    return std::fabs(area);
}

/// Vectors that are no signed permutations of what was read, heights, and maps that are laid over a mesh more
/// than once, whose sides agree because they are the same texels, tell nothing.
bool can_be_told(const Surface& surface) {
    if (!surface.derivatives.empty()) return false;
    for (const Vec3f& row : surface.map.matrix)
        if (row == Vec3f{}) return false;
    double area = 0;
    for (const Quad quad : surface.quads) area += measure_uv_area(surface, quad) / 2;
    constexpr double kOverlap = 1.05;
    return area <= kOverlap * double(surface.map.tiles.size());
}

} // namespace

std::vector<std::string> find_space_warnings(const PreparedScene& scene) {
    std::vector<std::string> warnings;
    for (const Surface& surface : scene.surfaces) {
        if (!surface.has_displacement || !surface.map.is_tangent || !can_be_told(surface)) continue;
        const std::vector<SeamSample> seams = sample_seams(surface, kMostEdges);
        if (measure_tangent_gap(seams, AxisMap{}) < kLeastGap) continue;
        const std::optional<Guess<DisplacementSpace>> guess = guess_space_by_seams(seams);
        if (!guess || guess->value != DisplacementSpace::object) continue;
        warnings.push_back(
            fmt::format("the displacement of mesh '{}' is read as tangent space and looks like "
                        "object space: {}; write displacement.space = object, or inspect the map",
                        surface.name, guess->reason));
    }
    return warnings;
}

} // namespace relief
