// Interpolated look-up of what a layered material's lobes leave over, and of what its fuzz reflects.
#if !defined(RELIEF_LAYER_ALBEDO_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_LAYER_ALBEDO_H
#include "formulas/facets.h"
#include "formulas/layer_parameters.h"
#include "formulas/layer_table.h"
#endif
#include "formulas/begin.h"

/// Between two entries side by side. Loops here and below leave shaders with one copy of the look-up.
FN Vec2 blend_layer_pair(const LayerTable table, const Uint i, const Float f) {
    Vec2 sum = {Float(0.0f), Float(0.0f)};
    for (int k = 0; k < 2; ++k)
        sum = sum + read_layer_entry(table, i + Uint(k)) * (k == 0 ? Float(1.0f) - f : f);
    return sum;
}

/// Of one row: kLayerColumns entries over the square root of the cosine.
FN Vec2 blend_layer_entries(const LayerTable table, const Uint row, const Float cos_theta) {
    Float x = sqrt(clamp(cos_theta, Float(0.0f), Float(1.0f))) * Float(kLayerColumns - 1.0f);
    Float column = min(floor(x), Float(kLayerColumns - 2.0f));
    Uint i = row + Uint(column);
    return blend_layer_pair(table, i, x - column);
}

FN Float find_layer_row(const LayerParameters layers, const Float roughness) {
    return clamp(roughness, Float(0.0f), Float(1.0f)) * layers.row_scale;
}

/// Between two rows, the second of which comes right behind.
FN Vec2 blend_layer_rows_at(const LayerTable table, const Uint first, const Float fraction,
                            const Float cos_theta) {
    Vec2 sum = {Float(0.0f), Float(0.0f)};
    for (int k = 0; k < 2; ++k)
        sum = sum + blend_layer_entries(table, first + Uint(k) * Uint(kLayerColumnCount), cos_theta) *
                        (k == 0 ? Float(1.0f) - fraction : fraction);
    return sum;
}

/// Azimuths lie close together across the tangent, where narrow facets change most.
FN Float find_azimuth_row(const Float azimuth) { return sqrt(sqrt(azimuth)); }

/// The part of the light from a direction that all lobes scattered once leave in a material that absorbs
/// nothing: x of a dielectric, y of a metal.
FN Vec2 lookup_layer_rest(const LayerTable table, const LayerParameters layers, const Float roughness,
                          const Vec3 w) {
    Float y = find_layer_row(layers, roughness);
    Float row = min(floor(y), max(layers.row_scale - Float(1.0f), Float(0.0f)));
    Uint first = layers.first_entry + Uint(row * Float(kLayerColumns));
    Float azimuth = Float(0.0f);
    Float between = Float(0.0f);
    Bool has_azimuths = layers.azimuth_scale > Float(0.0f);
    bool is_blended = is_any(has_azimuths);
    if (is_blended) {
        Float z = find_azimuth_row(find_azimuth(w)) * layers.azimuth_scale;
        azimuth = min(floor(z), max(layers.azimuth_scale - Float(1.0f), Float(0.0f)));
        between = select(has_azimuths, z - azimuth, Float(0.0f));
    }
    Float stride = select(has_azimuths, (layers.row_scale + Float(1.0f)) * Float(kLayerColumns), Float(0.0f));
    Vec2 rest = {Float(0.0f), Float(0.0f)};
    for (int k = 0; k < (is_blended ? 2 : 1); ++k)
        rest = rest +
               blend_layer_rows_at(table, first + Uint((azimuth + Float(float(k))) * stride), y - row, w.z) *
                   (k == 0 ? Float(1.0f) - between : between);
    return rest;
}

/// Of all azimuths and roughnesses of a block.
FN Float count_layer_rows(const LayerParameters layers) {
    return (layers.azimuth_scale + Float(1.0f)) * (layers.row_scale + Float(1.0f));
}

/// Its cosine-weighted mean over the hemisphere.
FN Vec2 lookup_layer_average(const LayerTable table, const LayerParameters layers, const Float roughness) {
    Float y = find_layer_row(layers, roughness);
    Float row = min(floor(y), max(layers.row_scale - Float(1.0f), Float(0.0f)));
    Float first = count_layer_rows(layers) * Float(kLayerColumns) + row;
    Uint i = layers.first_entry + Uint(first);
    return blend_layer_pair(table, i, y - row);
}

/// Directional albedo of the fuzz of weight 1.
FN Float lookup_fuzz_albedo(const LayerTable table, const LayerParameters layers, const Float cos_theta) {
    Float first = count_layer_rows(layers) * Float(kLayerColumns) + layers.row_scale + Float(1.0f);
    return blend_layer_entries(table, layers.first_entry + Uint(first), cos_theta).x;
}

#include "formulas/end.h"
#endif
