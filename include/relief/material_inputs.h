// The inputs of materials, one row each: every reader, writer, check and page takes them from here.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

#include "relief/scene.h"

namespace relief {

/// Upper limit of an input that has none.
inline constexpr float kUnboundedInput = std::numeric_limits<float>::max();

/// The `input` of a row that takes no texture.
inline constexpr MaterialInput kUntextured = MaterialInput(kMaterialInputCount);

/// One input of materials. At most one of `number`, `color` and `flag` is set; the normal map has none, and
/// emission_color and emission_luminance share Material::emission, which is their product.
struct MaterialInputKind {
    const char* name;            ///< key in scene files, which is OpenPBR's name
    const char* alias = nullptr; ///< shorter key that means the same; null: none
    float Material::*number = nullptr;
    Vec3f Material::*color = nullptr;
    bool Material::*flag = nullptr;
    float low = 0, high = 1;           ///< limits of the number, or of each part of the colour; inclusive
    MaterialInput input = kUntextured; ///< what textures of it name
    const char* texture_key = nullptr; ///< further key of its texture alone; null: none
    const char* texture_hint =
        nullptr;                  ///< why it takes no texture, or what to texture instead; null: it takes one
    bool is_layered = false;      ///< a number that the albedo table of layers depends on
    bool is_always_saved = false; ///< in scene files also where it has its default
    const char* unit = "";        ///< of the number; empty: none
    const char* meaning = "";     ///< what it does, in one or two sentences of Markdown without links

    bool is_color() const { return color != nullptr && input != MaterialInput::emission_luminance; }
    bool is_emission() const { return color == &Material::emission; }
    const char* short_name() const { return alias ? alias : name; }
};

/// Returns one row per input, in the order of the documentation. May be called from any thread.
std::span<const MaterialInputKind> list_material_fields();

/// Returns the rows that take textures, in the order of MaterialInput. May be called from any thread.
std::span<const MaterialInputKind, kMaterialInputCount> list_material_inputs();

/// Returns the row of an input that takes textures.
inline const MaterialInputKind& get_input_kind(MaterialInput input) {
    return list_material_inputs()[size_t(input)];
}

/// Returns all keys of a material in a scene file: names, aliases, keys of textures and "light_group".
std::span<const std::string_view> list_material_keys();

} // namespace relief
