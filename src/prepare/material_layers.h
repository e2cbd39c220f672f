// Materials with more than a diffuse base or metal under one clear surface, as both engines read them:
// numbers of their layers, and the albedo table that these are coupled by (formulas/layered_bsdf.h).
#pragma once

#include <vector>

#include "formulas/layer_parameters.h"
#include "math/vec.h"
#include "relief/scene.h"

namespace relief {

struct MaterialLayers {
    std::vector<scalar::LayerParameters> records;
    std::vector<Vec2f> entries;               ///< blocks of the records (formulas/layer_table.h)
    std::vector<uint32_t> record_of_material; ///< kNoIndex: without layers

    bool empty() const { return records.empty(); }
};

/// Whether some number of the material is beyond what formulas/bsdf.h has.
bool is_layered(const Material& material);

/// In parallel; the table is measured by sampling, with the same bits whatever the number of threads.
MaterialLayers make_material_layers(const std::vector<Material>& materials);

} // namespace relief
