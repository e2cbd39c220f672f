// What each surface of a scene was made of, so that a view that comes closer can have it made again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/affine.h"
#include "relief/scene.h"
#include "surface/map/displacement_map.h"
#include "surface/mesh/base_tolerance.h"
#include "surface/patch/level_field.h"

namespace relief {

struct SurfaceRecipe {
    uint32_t mesh = kNoIndex, displacement = kNoIndex;
    Affine object_from_world;   ///< of the first object that has the surface
    std::vector<int> uv_sets;   ///< as SurfaceContext::uv_sets
    std::vector<Affine> places; ///< per object that has the surface: from the mesh to the world
    double reach = 0;           ///< length that the map displaces by at most
    BaseTolerance tolerance;    ///< that it was made with
};

/// Whether a mesh is subdivided as finely as the view asks for.
inline bool is_subdivided_by_view(const Mesh& mesh) {
    return mesh.subdivision.scheme == SubdivisionScheme::catmark &&
           mesh.subdivision.level == kAutoSubdivisionLevel;
}

/// Chooses the tolerance of a mesh so that it is at most a tenth of the size aimed at for cells (a pixel by
/// default), where the nearest of its places is. Objects that the camera is close to get one per face.
/// `config` has the camera in the space that `places` lead to.
BaseTolerance choose_base_tolerance(const Mesh& mesh, std::span<const Affine> places, double reach,
                                    const LevelFieldConfig& config);

} // namespace relief
