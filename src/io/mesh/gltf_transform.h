// Reads the places of the nodes of a glTF file, and the copies of their meshes.
#pragma once

#include <vector>

#include "io/mesh/gltf_animation.h"
#include "io/mesh/gltf_file.h"
#include "relief/types.h"

namespace relief {

/// Returns the transform of a node as an animation moves it. Throws bad_input.
Affine read_gltf_transform(const JsonNode& node, const GltfPose& pose);

/// The copies of the mesh of a node in its own space, by EXT_mesh_gpu_instancing; without it one that stays
/// in place. Throws bad_input.
std::vector<Affine> read_gltf_instances(GltfFile& file, const JsonNode& node);

} // namespace relief
