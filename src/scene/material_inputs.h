// The inputs of materials that textures may have: one table for reader, writer, checks and engines.
#pragma once

#include <array>
#include <span>

#include "relief/scene.h"

namespace relief {

struct MaterialInputKind {
    MaterialInput input;
    const char* name;                  ///< key in scene files: OpenPBR's where it has two
    const char* alias;                 ///< the other key; null: none
    float Material::*number = nullptr; ///< what a texture multiplies: this or
    Vec3f Material::*color = nullptr;  ///< this; of a normal neither
    const char* own_texture = nullptr; ///< key of a texture that is a member; null: there is none
    bool is_layered = false;           ///< a number that the albedo table of layers depends on

    bool is_color() const { return color != nullptr && input != MaterialInput::emission_luminance; }
};

/// In the order of MaterialInput.
std::span<const MaterialInputKind, kMaterialInputCount> list_material_inputs();

inline const MaterialInputKind& get_input_kind(MaterialInput input) {
    return list_material_inputs()[size_t(input)];
}

/// Numbers of a material with layers that may have textures at once: the albedo table has an axis for each.
inline constexpr size_t kMaxLayerTextures = 4;
/// The same of a material whose roughness has a direction, which is one more axis.
inline constexpr size_t kMaxStretchedTextures = 2;

/// Least and greatest values that a texture multiplies a number by.
struct FactorRange {
    float lower = 1, upper = 1;
};
FactorRange find_factors(const InputTexture& texture);

} // namespace relief
