// Faces of a mesh that have no uvs while others have: their entries of Mesh::uv_indices are kNoIndex.
#pragma once

#include <cstddef>

#include "relief/scene.h"

namespace relief {

struct FacesWithoutUvs {
    size_t count = 0;
    size_t first = 0; ///< index of the first, from 0, where there is one
};

/// None of a mesh that has no uvs at all. Entries of uv_indices beyond its end count as missing.
FacesWithoutUvs find_faces_without_uvs(const Mesh& mesh);

/// The same mesh without these faces; indices must be in range, and a face with uvs must be there.
Mesh drop_faces_without_uvs(const Mesh& mesh);

} // namespace relief
