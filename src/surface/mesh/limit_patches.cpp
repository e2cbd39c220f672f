#include "surface/mesh/limit_patches.h"

#include <algorithm>

#include "base/parallel.h"
#include "surface/mesh/patch_fit.h"

namespace relief {

namespace {

/// Lowest quad at each point, which says where the point is.
std::vector<uint32_t> find_first_quads(const RefinedMesh& refined) {
    std::vector<uint32_t> first(refined.point_count, kNoIndex);
    for (uint32_t quad = refined.quad_count(); quad-- > 0;)
        for (const uint32_t point : refined.points[quad]) first[point] = quad;
    return first;
}

/// Gives the sides of a quad to all others that share them.
void share_edges(const RefinedMesh& refined, std::vector<InnerControls>& controls) {
    for (uint32_t quad = 0; quad < refined.quad_count(); ++quad)
        for (size_t k = 0; k < 4; ++k) {
            if (refined.first_quads[refined.edges[quad][k]] == quad) continue;
            const auto [owner, other, is_same_way] = find_owner_side(refined, quad, k);
            controls[quad][2 * k] = controls[owner][2 * other + (is_same_way ? 0 : 1)];
            controls[quad][2 * k + 1] = controls[owner][2 * other + (is_same_way ? 1 : 0)];
        }
}

} // namespace

OwnerSide find_owner_side(const RefinedMesh& refined, uint32_t quad, size_t side) {
    const uint32_t edge = refined.edges[quad][side], owner = refined.first_quads[edge];
    const std::array<uint32_t, 4>& edges = refined.edges[owner];
    const auto other = size_t(std::ranges::find(edges, edge) - edges.begin());
    return {owner, other, refined.points[owner][other] == refined.points[quad][side]};
}

std::vector<uint32_t> find_face_runs(const RefinedMesh& refined) {
    std::vector<uint32_t> starts;
    for (uint32_t quad = 0; quad < refined.quad_count(); ++quad)
        if (quad == 0 || refined.places[quad].face != refined.places[quad - 1].face) starts.push_back(quad);
    starts.push_back(refined.quad_count());
    return starts;
}

LimitPatches make_limit_patches(const SubdivisionMesh& mesh, const RefinedMesh& refined, bool has_controls) {
    LimitPatches patches;
    patches.positions.resize(refined.point_count);
    if (has_controls) patches.controls.resize(refined.quad_count());
    patches.corner_normals.resize(refined.quad_count());
    const std::vector<uint32_t> first_quads = find_first_quads(refined);
    const std::vector<uint32_t> starts = find_face_runs(refined);
    parallel_for("limit patches", starts.size() - 1, 16, [&](size_t begin, size_t end) {
        for (size_t run = begin; run < end; ++run) {
            const LimitFace face = mesh.make_face(refined.places[starts[run]].face);
            for (uint32_t quad = starts[run]; quad < starts[run + 1]; ++quad) {
                PatchFit patch(face, refined, quad);
                for (size_t k = 0; k < 4; ++k) {
                    const uint32_t point = refined.points[quad][k];
                    if (first_quads[point] == quad) patches.positions[point] = to_float(patch.corner(k));
                    patches.corner_normals[quad][k] = to_float(patch.normal(k));
                }
                if (!has_controls) continue;
                if (!refined.fits.empty() && refined.fits[quad] != kNoIndex)
                    patch.take(refined.fitted[refined.fits[quad]]);
                else
                    patch.fit();
                for (size_t k = 0; k < 12; ++k) patches.controls[quad][k] = to_float(patch.controls()[k]);
            }
        }
    });
    if (has_controls) share_edges(refined, patches.controls);
    return patches;
}

} // namespace relief
