// Interpolated look-up of what a layered material's lobes leave over, and of what its fuzz reflects.
#if !defined(RELIEF_LAYER_ALBEDO_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_LAYER_ALBEDO_H
#include "formulas/facets.h"
#include "formulas/layer_parameters.h"
#include "formulas/layer_table.h"
#endif
#include "formulas/begin.h"

/// Of one row: kLayerColumns entries over the square root of the cosine.
FN Vec2 blend_layer_entries(LayerTable table, Uint row, Float cos_theta) {
    Float x = sqrt(clamp(cos_theta, Float(0.0f), Float(1.0f))) * Float(kLayerColumns - 1.0f);
    Float column = min(floor(x), Float(kLayerColumns - 2.0f));
    Uint i = row + Uint(column);
    Float f = x - column;
    return read_layer_entry(table, i) * (Float(1.0f) - f) + read_layer_entry(table, i + Uint(1u)) * f;
}

FN Float find_layer_row(LayerParameters layers, Float roughness) {
    return clamp(roughness, Float(0.0f), Float(1.0f)) * layers.row_scale;
}

/// Between two rows, the second of which comes right behind.
FN Vec2 blend_layer_rows_at(LayerTable table, Uint first, Float fraction, Float cos_theta) {
    Vec2 above = blend_layer_entries(table, first, cos_theta);
    Vec2 below = blend_layer_entries(table, first + Uint(kLayerColumnCount), cos_theta);
    return above * (Float(1.0f) - fraction) + below * fraction;
}

/// Azimuths lie close together across the tangent, where narrow facets change most.
FN Float find_azimuth_row(Float azimuth) { return sqrt(sqrt(azimuth)); }

/// The part of the light from a direction that all lobes scattered once leave in a material that absorbs
/// nothing: x of a dielectric, y of a metal.
FN Vec2 lookup_layer_rest(LayerTable table, LayerParameters layers, Float roughness, Vec3 w) {
    Float y = find_layer_row(layers, roughness);
    Float row = min(floor(y), max(layers.row_scale - Float(1.0f), Float(0.0f)));
    Uint first = layers.first_entry + Uint(row * Float(kLayerColumns));
    Vec2 rest = blend_layer_rows_at(table, first, y - row, w.z);
    Bool has_azimuths = layers.azimuth_scale > Float(0.0f);
    if (is_any(has_azimuths)) {
        Float z = find_azimuth_row(find_azimuth(w)) * layers.azimuth_scale;
        Float azimuth = min(floor(z), max(layers.azimuth_scale - Float(1.0f), Float(0.0f)));
        Float stride = (layers.row_scale + Float(1.0f)) * Float(kLayerColumns);
        Uint near = first + Uint(azimuth * stride);
        Vec2 there = blend_layer_rows_at(table, near, y - row, w.z) * (Float(1.0f) - (z - azimuth)) +
                     blend_layer_rows_at(table, near + Uint(stride), y - row, w.z) * (z - azimuth);
        rest = select(has_azimuths, there, rest);
    }
    return rest;
}

/// Of all azimuths and roughnesses of a block.
FN Float count_layer_rows(LayerParameters layers) {
    return (layers.azimuth_scale + Float(1.0f)) * (layers.row_scale + Float(1.0f));
}

/// Its cosine-weighted mean over the hemisphere.
FN Vec2 lookup_layer_average(LayerTable table, LayerParameters layers, Float roughness) {
    Float y = find_layer_row(layers, roughness);
    Float row = min(floor(y), max(layers.row_scale - Float(1.0f), Float(0.0f)));
    Float first = count_layer_rows(layers) * Float(kLayerColumns) + row;
    Uint i = layers.first_entry + Uint(first);
    return read_layer_entry(table, i) * (Float(1.0f) - (y - row)) +
           read_layer_entry(table, i + Uint(1u)) * (y - row);
}

/// Directional albedo of the fuzz of weight 1.
FN Float lookup_fuzz_albedo(LayerTable table, LayerParameters layers, Float cos_theta) {
    Float first = count_layer_rows(layers) * Float(kLayerColumns) + layers.row_scale + Float(1.0f);
    return blend_layer_entries(table, layers.first_entry + Uint(first), cos_theta).x;
}

#include "formulas/end.h"
#endif
