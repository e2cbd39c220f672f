// Images of a scene as engines read them: dilated, with their smaller copies, smooth ones as coefficients.
#pragma once

#include <vector>

#include "prepare/mesh_limits.h"
#include "prepare/scene_parts.h"

namespace relief {

/// Textures of materials with a smooth filter become coefficients.
void prepare_textures(std::vector<Material>& materials);

/// Lists the maps and their smaller copies, dilated, smooth ones as coefficients: in copies, since textures
/// of the scene may be shared. Those that are the same are taken over from `before`. `limits` are those of
/// the scene's meshes.
void prepare_maps(Scene& scene, const SameParts& same, const SceneParts* before, MeshLimits& limits,
                  EditableScene& prepared);

/// Hands the copies of maps to the surfaces of their displacements.
void share_mips(const Scene& scene, const SurfaceNumbers& surfaces, PreparedScene& prepared);

} // namespace relief
