// Uvs of a mesh, face by face. Faces may have none while others do: their uv_indices are kNoIndex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>

#include "relief/scene.h"

namespace relief {

struct FacesWithoutUvs {
    size_t count = 0;
    size_t first = 0; ///< index of the first, from 0, where there is one
};

/// None of a mesh that has no uvs at all. Entries of uv_indices beyond its end count as missing.
FacesWithoutUvs find_faces_without_uvs(const Mesh& mesh);
/// The same of one set of uvs of faces of these sizes.
FacesWithoutUvs find_faces_without_uvs(const std::vector<uint32_t>& face_sizes,
                                       const std::vector<uint32_t>& uv_indices);

/// Signed area of the face whose `size` corners begin at `first`; 0 where it has no uvs.
double compute_uv_area(const Mesh& mesh, size_t first, uint32_t size);

/// UDIM numbers of the middles of faces; uv indices out of range are left out.
std::set<int> list_tiles(const Mesh& mesh);

/// The same mesh without these faces; indices must be in range, and a face with uvs must be there.
Mesh drop_faces_without_uvs(const Mesh& mesh);

} // namespace relief
