// What textures make of the numbers of a material at one point: the numbers as words, so that a table of
// textures can name its targets, and what follows from them for layers and glass.
#ifndef RELIEF_INPUT_NUMBERS_H
#define RELIEF_INPUT_NUMBERS_H
#include "formulas/glass_parameters.h"
#include "formulas/layer_parameters.h"
#include "formulas/power.h"

#include "formulas/begin.h"

// Places of the numbers; a colour takes three.
const uint kInputBaseColor = 0u;
const uint kInputRoughness = 3u;
const uint kInputMetallic = 4u;
const uint kInputOpacity = 5u;
const uint kInputDiffuseRoughness = 6u;
const uint kInputSpecularWeight = 7u;
const uint kInputSpecularColor = 8u;
const uint kInputCoatWeight = 11u;
const uint kInputCoatColor = 12u;
const uint kInputCoatRoughness = 15u;
const uint kInputCoatDarkening = 16u;
const uint kInputFuzzWeight = 17u;
const uint kInputFuzzColor = 18u;
const uint kInputFuzzRoughness = 21u;
const uint kInputTransmissionWeight = 22u;
const uint kInputTransmissionColor = 23u;
const uint kInputEmission = 26u; ///< the numbers before end at 1
const uint kInputNormal = 29u;   ///< a texel, in place of a factor
const uint kInputWords = 32u;

// Sets of places, a bit each; a colour is the bit of its first word.
const uint kColorPlace = 1u << kInputBaseColor;
const uint kOpacityPlace = 1u << kInputOpacity;
const uint kEmissionPlace = 1u << kInputEmission;
const uint kNormalPlace = 1u << kInputNormal;
// A point stores these numbers itself, and its opacity and normal. A texture of any other number gives it
// InputNumbers.
const uint kPointPlaces = kColorPlace | 1u << kInputRoughness | 1u << kInputMetallic;
// These numbers decide how much light goes straight through a clear wall.
const uint kWallPlaces = kOpacityPlace | 1u << kInputMetallic | 1u << kInputSpecularColor |
                         1u << kInputTransmissionWeight | 1u << kInputTransmissionColor;

struct InputNumbers {
    float word[kInputWords];
};

FN bool has_place(const uint places, const uint place) { return (places >> place & 1u) != 0u; }

/// What does not change over the surface.
struct InputConstants {
    float ior;
    float coat_ior;
    uint is_absorbing; ///< a body of glass that its transmission_color belongs to, not to its surface
};

FN Vec3 get_input_color(InputNumbers numbers, const uint place) {
    Vec3 color = {numbers.word[place], numbers.word[place + 1u], numbers.word[place + 2u]};
    return color;
}

/// Limits a number to [0, 1], or an emission to values from 0 on.
FN float limit_input(const uint place, const float value) {
    return place < kInputEmission ? clamp(value, 0.0f, 1.0f) : max(value, 0.0f);
}

/// Multiplies `count` words from `place` on by the value of a texture, and limits each to its range. A normal
/// is replaced, not multiplied.
FN InputNumbers apply_input(InputNumbers numbers, const uint place, const uint count, const Vec3 value) {
    if (place == kInputNormal) {
        numbers.word[kInputNormal] = value.x;
        numbers.word[kInputNormal + 1u] = value.y;
        numbers.word[kInputNormal + 2u] = value.z;
        return numbers;
    }
    numbers.word[place] = limit_input(place, numbers.word[place] * value.x);
    if (count == 1u) return numbers;
    numbers.word[place + 1u] = limit_input(place, numbers.word[place + 1u] * value.y);
    numbers.word[place + 2u] = limit_input(place, numbers.word[place + 2u] * value.z);
    return numbers;
}

/// Limits all numbers to their ranges. A normal stays as it is.
FN InputNumbers limit_inputs(InputNumbers numbers) {
    for (uint k = 0u; k < kInputNormal; ++k) numbers.word[k] = limit_input(k, numbers.word[k]);
    return numbers;
}

/// Fresnel's reflection at normal incidence between two indices of refraction.
FN float find_normal_reflection(const float ratio) {
    float root = (ratio - 1.0f) / (ratio + 1.0f);
    return root * root;
}

/// As in make_general_bsdf: the surface fades out together with its reflection at normal incidence.
FN float find_grazing_reflection(const float f0) { return min(1.0f, 50.0f * f0); }

/// -log2 of what a length of 1 / `share` leaves over of a colour.
FN Vec3 find_color_depth(const Vec3 color, const float share) {
    Vec3 depth = {-share * find_logarithm(max(color.x, 1e-12f)),
                  -share * find_logarithm(max(color.y, 1e-12f)),
                  -share * find_logarithm(max(color.z, 1e-12f))};
    return depth;
}

/// All but what belongs to the albedo table, and fuzz_scale. A coat under which the light comes from its
/// medium: OpenPBR 1.1, "Coat": refraction.
FN LayerParameters set_layer_inputs(LayerParameters l, const InputNumbers numbers,
                                    const InputConstants constants) {
    l.specular_color = get_input_color(numbers, kInputSpecularColor);
    l.specular_weight = numbers.word[kInputSpecularWeight];
    l.metallic = numbers.word[kInputMetallic];
    l.coat_weight = numbers.word[kInputCoatWeight];
    float medium = 1.0f + l.coat_weight * (constants.coat_ior - 1.0f);
    l.dielectric_f0 = l.specular_weight * find_normal_reflection(constants.ior / medium);
    l.dielectric_f90 = find_grazing_reflection(l.dielectric_f0);
    l.diffuse_roughness = numbers.word[kInputDiffuseRoughness];
    l.coat_roughness = numbers.word[kInputCoatRoughness];
    l.coat_depth = find_color_depth(get_input_color(numbers, kInputCoatColor), 0.5f);
    l.coat_darkening = numbers.word[kInputCoatDarkening];
    l.fuzz_color = get_input_color(numbers, kInputFuzzColor);
    l.fuzz_weight = numbers.word[kInputFuzzWeight];
    l.fuzz_exponent = 1.0f / max(numbers.word[kInputFuzzRoughness], 0.07f);
    return l;
}

FN GlassParameters set_glass_inputs(GlassParameters g, const InputNumbers numbers,
                                    const InputConstants constants) {
    g.weight = numbers.word[kInputTransmissionWeight];
    g.specular_color = get_input_color(numbers, kInputSpecularColor);
    Vec3 color = get_input_color(numbers, kInputTransmissionColor);
    if (constants.is_absorbing != 0u) return g;
    if (g.kind == kSolidGlass)
        g.tint = color;
    else
        g.depth = find_color_depth(color, 1.0f);
    return g;
}

#include "formulas/end.h"
#endif
