// Materials that let light through, as both engines read them.
#pragma once

#include <cstdint>
#include <vector>

#include "formulas/glass_parameters.h"
#include "relief/scene.h"

namespace relief {

struct MaterialGlass {
    std::vector<scalar::GlassParameters> records;
    std::vector<uint32_t> record_of_material; ///< kNoIndex: opaque

    bool empty() const { return records.empty(); }
    /// Null: of an opaque material.
    const scalar::GlassParameters* find(uint32_t material) const {
        const uint32_t record = empty() ? kNoIndex : record_of_material[material];
        return record == kNoIndex ? nullptr : &records[record];
    }
};

MaterialGlass make_material_glass(const std::vector<Material>& materials);

} // namespace relief
