// Materials with more than a diffuse base or metal under one clear surface, as both engines read them:
// numbers of their layers, and the albedo table that these are coupled by (formulas/layered_bsdf.h).
#pragma once

#include <vector>

#include "formulas/layer_grid.h"
#include "formulas/layer_parameters.h"
#include "formulas/layer_table.h"
#include "math/vec.h"
#include "prepare/textured_materials.h"
#include "relief/scene.h"

namespace relief {

struct MaterialLayers {
    std::vector<scalar::LayerParameters> records;
    std::vector<Vec2f> entries; ///< blocks of the records (formulas/layer_table.h)
    /// The grid of each record. It is used by records whose vertices have numbers of their own.
    std::vector<scalar::LayerGrid> grids;
    std::vector<uint32_t> record_of_material; ///< kNoIndex: without layers
    uint32_t vertex_entries = 0;              ///< of fill_vertex_block(), at most

    bool empty() const { return records.empty(); }
};

/// Whether some number of the material is beyond what formulas/bsdf.h has.
bool is_layered(const Material& material);

/// In parallel; the table is measured by sampling, with the same bits whatever the number of threads.
/// `textured`: what make_textured_materials makes of them.
MaterialLayers make_material_layers(const std::vector<Material>& materials,
                                    const TexturedMaterials& textured = {});

/// A block with one row an azimuth for one point of a material whose inputs have textures, from the table
/// that the numbers of `layers` refer to; they then have to refer to the block.
void fill_vertex_block(scalar::GridTable table, const scalar::LayerGrid& grid,
                       const scalar::InputNumbers& numbers, scalar::LayerParameters& layers, Vec2f* block);

} // namespace relief
