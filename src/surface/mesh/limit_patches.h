// Bicubic patches of the limit surface: exact where it is bicubic, fitted beside irregular points and
// semi-sharp creases (docs/decisions/bicubic-base-patches.md).
#pragma once

#include <array>
#include <vector>

#include "surface/mesh/subdivision_mesh.h"
#include "surface/patch/surface.h"

namespace relief {

struct LimitPatches {
    std::vector<Vec3f> positions;                     ///< one a point: on the limit
    std::vector<InnerControls> controls;              ///< one a quad; equal bits on both sides of an edge
    std::vector<std::array<Vec3f, 4>> corner_normals; ///< one a quad: unit normals of its own corners
};

/// First quad of each run of quads on one face, and the end of the last run.
std::vector<uint32_t> find_face_runs(const RefinedMesh& refined);

/// A side as the lowest quad at its edge has it.
struct OwnerSide {
    uint32_t quad;
    size_t side;
    bool is_same_way; ///< both quads have its ends in the same order
};
OwnerSide find_owner_side(const RefinedMesh& refined, uint32_t quad, size_t side);

/// Makes the patches of `refined`, which is a refinement of `mesh`. Control points, which take most of the
/// time, are optional.
LimitPatches make_limit_patches(const SubdivisionMesh& mesh, const RefinedMesh& refined,
                                bool has_controls = true);

} // namespace relief
