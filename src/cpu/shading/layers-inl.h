// Layered materials at sixteen vertices: formulas/layered_bsdf.h in the lanes that have layers.
#pragma once

#include "cpu/shading/vertex_lanes-inl.h"
#include "formulas/layer_table.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace wide {

struct LayerTable {
    const float* entries; ///< pairs
    uint32_t count;
};

/// Of any index: what lies beyond the table is not read.
RELIEF_INLINE Vec2 read_layer_entry(const LayerTable& table, const Uint& index) {
    const Uint place = min(index, Uint(table.count - 1)) << 1;
    return {gather(table.entries, place), gather(table.entries + 1, place)};
}

RELIEF_INLINE Uint floatBitsToUint(const Float& a) {
    RELIEF_RETURN_PARTS(Uint, hn::BitCast(Uint::D(), a.part[p]));
}
RELIEF_INLINE Float uintBitsToFloat(const Uint& a) {
    RELIEF_RETURN_PARTS(Float, hn::BitCast(Float::D(), a.part[p]));
}

using scalar::kLayerColumnCount;
using scalar::kLayerColumns;
#define RELIEF_LANES
// clang-format off
#include "formulas/power.h"
#include "formulas/eon.h"
#include "formulas/layer_parameters.h"
#include "formulas/layer_albedo.h"
#include "formulas/layered_bsdf.h"
#include "formulas/lobe_shares.h"
// clang-format on
#undef RELIEF_LANES

/// Reads the members of records one after another.
class RecordReader {
  public:
    template <class Record>
    RecordReader(const Record* records, const Uint& index)
        : next_(reinterpret_cast<const float*>(records)),
          first_(index * Uint(sizeof(Record) / sizeof(float))) {}

    RELIEF_INLINE Float read() { return gather(next_++, first_); }
    RELIEF_INLINE Vec3 read_vector() {
        const Float x = read(), y = read();
        return {x, y, read()};
    }
    RELIEF_INLINE Uint read_integer() { return floatBitsToUint(read()); }

  private:
    const float* next_;
    Uint first_;
};

RELIEF_INLINE LayerParameters gather_layers(const scalar::LayerParameters* records, const Uint& index) {
    static_assert(sizeof(LayerParameters) == 16 * sizeof(scalar::LayerParameters));
    RecordReader from(records, index);
    LayerParameters l;
    l.specular_color = from.read_vector();
    for (Float* number :
         {&l.specular_weight, &l.metallic, &l.dielectric_f0, &l.dielectric_f90, &l.diffuse_roughness,
          &l.coat_weight, &l.coat_roughness, &l.coat_f0, &l.coat_f90, &l.coat_inverse_ior2})
        *number = from.read();
    l.coat_depth = from.read_vector();
    l.coat_darkening = from.read(), l.coat_inside = from.read();
    l.fuzz_color = from.read_vector();
    for (Float* number : {&l.fuzz_weight, &l.fuzz_exponent, &l.fuzz_scale, &l.specular_anisotropy,
                          &l.coat_anisotropy, &l.azimuth_scale, &l.row_scale})
        *number = from.read();
    l.first_entry = from.read_integer();
    return l;
}

/// What was found for lanes without layers stays.
struct LayeredLanes {
    Basis basis;
    Vec3 wo_local;
    LayeredBsdf bsdf;
    LayerTable table;
    Bool has_layers;
};

RELIEF_INLINE void reflect_light(const PointLanes& point, const LayeredLanes& layered, cpu::VertexLanes& v) {
    const Vec3 direction = load_vectors(v.light_direction);
    BsdfValue toward = evaluate_layered_bsdf(layered.bsdf, layered.table, layered.wo_local,
                                             to_local(layered.basis, direction));
    toward.value = select(layered.has_layers, toward.value, load_vectors(v.light_reflected));
    toward.pdf = select(layered.has_layers, toward.pdf, Float::load(v.light_bsdf_pdf));
    store_light(point, direction, toward, v);
}

RELIEF_INLINE void reflect_path(const PointLanes& point, const LayeredLanes& layered, const Float& u_lobe,
                                const Vec2& u, cpu::VertexLanes& v) {
    const BsdfSample drawn = sample_layered_bsdf(layered.bsdf, layered.table, layered.wo_local, u_lobe, u);
    const Vec3 direction = make_unit(from_local(layered.basis, drawn.direction));
    store_path(point, select(layered.has_layers, direction, load_vectors(v.bounce_direction)),
               select(layered.has_layers, drawn.weight, load_vectors(v.bounce_weight)),
               select(layered.has_layers, drawn.pdf, Float::load(v.bounce_pdf)), v);
}

RELIEF_INLINE LayeredLanes make_layered_lanes(const cpu::VertexBatch& batch, const Basis& basis,
                                              const Vec3& wo_local, const cpu::VertexLanes& v) {
    const LaneMask lanes = v.has_layers & first_lanes(batch.count);
    LayeredLanes layered{.basis = basis, .wo_local = wo_local};
    layered.table = {&batch.layers.entries->x, batch.layers.entry_count};
    layered.has_layers = from_mask(lanes);
    LayeredSurface surface{load_vectors(v.base_color), Float::load(v.roughness),
                           gather_layers(batch.layers.records, load_indices(v.layers, lanes))};
    surface.layers.metallic = Float::load(v.layered_metallic);
    const Bool has_tangent = surface.layers.azimuth_scale > Float(0.0f);
    if (is_any(has_tangent)) turn_frame(batch, v, has_tangent, layered.basis, layered.wo_local);
    layered.bsdf = make_layered_bsdf(surface, layered.table, layered.wo_local);
    return layered;
}

/// Out of line: vertices without layers keep their registers.
HWY_NOINLINE void reflect_layers(const cpu::VertexBatch& batch, const PointLanes& point, const Basis& basis,
                                 const Vec3& wo_local, cpu::VertexLanes& v) {
    const LayeredLanes layered = make_layered_lanes(batch, basis, wo_local, v);
    reflect_light(point, layered, v);
    if (batch.pick_pairs)
        reflect_path(point, layered, load_pairs(batch.pick_pairs, batch.count).y,
                     load_pairs(batch.bsdf_pairs, batch.count), v);
}

} // namespace wide
} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
