// glTF 2.0 and GLB to polygons: triangles, strips and fans; n-gons where they were encoded as such.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/mesh/gltf_file.h"
#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// All meshes of the file's scene as one, node transforms applied, equal positions welded, v turned upwards.
/// Normals and tangents are kept where all parts have them. Morph targets are added by their weights. Lines,
/// points and skins are left out, the latter with a warning. FB_ngon_encoding is undone: consecutive
/// triangles that share their first index are one polygon. `name` is for messages. Throws bad_input with the
/// path inside of the file.
Mesh parse_gltf(std::string_view bytes, const std::string& name, const ReadBeside& read_beside,
                const MeshReadOptions& options, std::vector<std::string>* warnings = nullptr);

} // namespace relief
