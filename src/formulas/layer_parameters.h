// The numbers of a layered material that do not change over the surface, as prepare/material_layers.h finds
// them: of OpenPBR 1.1, without what textures multiply. One struct for lanes, records and device memory.
#if !defined(RELIEF_LAYER_PARAMETERS_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_LAYER_PARAMETERS_H
#endif
#include "formulas/begin.h"

struct LayerParameters {
    Vec3 specular_color;   ///< of a dielectric a factor; of a metal its tint at 82 degrees
    Float specular_weight; ///< of a metal; dielectric_f0 has it already
    Float metallic;        ///< [0, 1]
    Float dielectric_f0;   ///< under the coat
    Float dielectric_f90;
    Float diffuse_roughness; ///< [0, 1]
    Float coat_weight;       ///< [0, 1]; 0: no coat
    Float coat_roughness;    ///< [0, 1]
    Float coat_f0, coat_f90;
    Float coat_inverse_ior2; ///< 1 / ior^2: refracts the way through the coat
    Vec3 coat_depth;         ///< -log2 of what is left after a way of its thickness
    Float coat_darkening;    ///< [0, 1]
    Float coat_inside;       ///< what the coat reflects of diffuse light from below
    Vec3 fuzz_color;
    Float fuzz_weight;                          ///< [0, 1]; 0: no fuzz
    Float fuzz_exponent;                        ///< of the sine of the half vector
    Float fuzz_scale;                           ///< of the lobe, so that it reflects all light at most
    Float specular_anisotropy, coat_anisotropy; ///< [0, 1]; 0: alike in all directions
    Float azimuth_scale; ///< of find_azimuth_row(); 0: the albedo table has one azimuth
    Float row_scale;     ///< roughness to rows of each azimuth; 0: it has one row
    Uint first_entry;    ///< of the material's block of the table
};

#include "formulas/end.h"
#endif
