// Meshes as text and bytes: OBJ and binary PLY.
#pragma once

#include <string>

#include "relief/scene.h"

namespace relief {

/// Faces with their corners' indices, uvs and normals, and creases as tags. Names are left out.
std::string format_obj(const Mesh& mesh);

/// Binary, little endian. uvs are stored at vertices (s, t) if unique there, else as `texcoord` lists.
std::string format_ply(const Mesh& mesh);

} // namespace relief
