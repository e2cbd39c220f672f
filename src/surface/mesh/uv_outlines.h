// Outlines of the faces of a mesh in the uv plane, as surfaces made from it have them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "surface/mesh/subdivision_mesh.h"

namespace relief {

struct UvOutlines {
    std::vector<size_t> starts{0}; ///< place of each face in `uvs`, and the end of the last one
    std::vector<Vec2f> uvs;

    size_t face_count() const { return starts.size() - 1; }
    std::span<const Vec2f> face(size_t k) const {
        return {uvs.data() + starts[k], starts[k + 1] - starts[k]};
    }
    void end_face() { starts.push_back(uvs.size()); }
};

/// Whether patches of the mesh have limit uvs and are cut by the view, so that their outlines have to be
/// those of the limit itself.
bool has_curved_outlines(const Mesh& mesh);

/// Corners of the faces, or of the patches at the level of a mesh that is subdivided with smooth uvs. Faces
/// with indices out of range are left out. Throws as make_surface() where subdivision fails.
UvOutlines make_uv_outlines(const Mesh& mesh);

/// Outlines of a mesh that is not refined, from the limit of its own uv set: corners of faces, and points
/// between them on sides that are no side of another face with the same uvs.
UvOutlines make_uv_outlines(const SubdivisionMesh& mesh);

} // namespace relief
