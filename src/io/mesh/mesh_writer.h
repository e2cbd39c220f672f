// Meshes as text and bytes: OBJ and binary PLY.
#pragma once

#include <string>

#include "relief/progress.h"
#include "relief/scene.h"

namespace relief {

/// Faces with their corners' indices, uvs and normals, and creases as tags. Names are left out.
std::string format_obj(const Mesh& mesh, const ProgressFunction& on_progress = {});

/// Binary, little endian; faces as `vertex_indices`. uvs stand at the vertices (s, t) where each vertex has
/// one only, else at the corners, as `texcoord` lists (MeshLab's way).
std::string format_ply(const Mesh& mesh, const ProgressFunction& on_progress = {});

} // namespace relief
