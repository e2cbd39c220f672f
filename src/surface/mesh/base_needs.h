// What the base of a subdivided mesh is made for: how near it has to be, and how it is displaced.
#pragma once

#include "surface/map/displacement_change.h"
#include "surface/mesh/base_tolerance.h"

namespace relief {

class SubdivisionMesh;

enum class BasePatches { bilinear, bicubic };

struct BaseNeeds {
    BasePatches patches = BasePatches::bicubic;
    BaseTolerance tolerance;                    ///< of automatic subdivision levels
    const DisplacementChange* change = nullptr; ///< null: nothing is displaced
    bool has_relative_lengths = false;          ///< lengths of displacements are in units of dP/du, dP/dv
    const SubdivisionMesh* limit = nullptr;     ///< of the mesh, if it is there already
};

} // namespace relief
