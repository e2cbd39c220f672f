// Textures of the inputs of materials, as both engines read them.
#pragma once

#include <memory>
#include <vector>

#include "formulas/input_numbers.h"
#include "math/vec.h"
#include "relief/scene.h"

namespace relief {

/// Words of scalar::InputNumbers.
struct InputPlace {
    uint32_t first, count;
};
InputPlace find_input_place(MaterialInput input);

/// A texture and where its values go.
struct PlacedTexture {
    InputPlace place;
    std::vector<std::shared_ptr<const Texture>> tiles; ///< one; or by UDIM - 1001, null where there is none
    bool is_number;                                    ///< the first channel counts alone
    bool is_udim, is_smooth;
    WrapMode wrap;
    Vec2f uv_scale, uv_offset;
    int uv_set; ///< as InputTexture::uv_set; that of the mesh where a surface has no further uvs of the
                ///< number
};

struct TexturedMaterial {
    scalar::InputNumbers numbers; ///< that the textures multiply
    scalar::InputConstants constants;
    std::vector<PlacedTexture> textures; ///< first those of what a point has of itself
    size_t point_count = 0;              ///< of the latter
    uint32_t places = 0;                 ///< of `numbers` that they change, as scalar::kPointPlaces
    bool has_vertex_numbers = false;     ///< they change numbers that no point has of itself
};

struct TexturedMaterials {
    std::vector<TexturedMaterial> list;
    std::vector<uint32_t> of_material; ///< place in `list`; kNoIndex: without
    bool has_vertex_numbers = false;   ///< of some material

    bool empty() const { return list.empty(); }
    /// Null: of a material without.
    const TexturedMaterial* find(uint32_t material) const {
        const uint32_t place = empty() ? kNoIndex : of_material[material];
        return place == kNoIndex ? nullptr : &list[place];
    }
};

TexturedMaterials make_textured_materials(const std::vector<Material>& materials);

} // namespace relief
