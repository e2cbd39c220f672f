// Surfaces of a scene, mesh by mesh, so that polygons can be freed; those that are as before are taken over.
#pragma once

#include <vector>

#include "prepare/mesh_limits.h"
#include "prepare/scene_parts.h"

namespace relief {

/// One surface a key, in the order of first use.
struct SurfaceList {
    SurfaceNumbers numbers;
    std::vector<uint32_t> first_object;    ///< of each surface
    std::vector<std::vector<int>> uv_sets; ///< of each, as make_surface() takes them
};

/// Also makes the instances, without places and levels. The last one of `materials` is that of objects that
/// name none.
SurfaceList list_surfaces(const Scene& scene, const std::vector<Material>& materials,
                          std::vector<Instance>& instances);

/// Makes the surfaces and recipes of `parts`, whose taken_off and view are known. What surfaces are made of
/// is moved out of `before`; the result tells what of each differs from it, patches of other mips aside.
/// `limits` are those of the scene's meshes, and are released.
std::vector<SurfaceChange> make_surfaces(Scene& scene, const SurfaceList& list, const SameParts& same,
                                         SceneParts* before, Polygonal polygons, MeshLimits& limits,
                                         SceneParts& parts);

/// Makes those surfaces anew that the view of `config` needs finer or coarser; meshes, displacements and
/// recipes are those of `parts`. Returns their numbers.
std::vector<uint32_t> follow_view(SceneParts& parts, const LevelFieldConfig& config);

} // namespace relief
