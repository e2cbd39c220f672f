#include "cpu/glass_paths.h"

#include <cmath>

#include "formulas/glass_vertex.h"

namespace relief::cpu {

Vec3f meet_glass(const MaterialGlass& glass, const GlassArrival& arrival, uint32_t& body,
                 PointMaterial& material, float& u) {
    const bool is_glass = material.glass != kNoIndex;
    if (is_glass && glass.records[material.glass].kind == scalar::kSolidGlass) {
        if (arrival.height > 0) body = material.glass;
        // Met from outside, whatever the path took for true: at a fold of the surface, say.
        if (arrival.height <= 0 && body == material.glass) body = kNoIndex;
    }
    Vec3f factor{1, 1, 1};
    if (body != kNoIndex) factor = scalar::absorb_along(glass.records[body].depth, arrival.distance);
    if (!is_glass) return factor;
    const scalar::GlassDraw drawn = scalar::draw_glass(arrival.numbers[material.glass_numbers],
                                                       material.metallic, std::fabs(arrival.height), u);
    material.metallic = drawn.metallic;
    u = drawn.u;
    if (!drawn.is_glass) material.glass = kNoIndex;
    return factor * drawn.weight;
}

uint32_t find_next_body(const MaterialGlass& glass, const GlassDeparture& departure) {
    if (departure.record == kNoIndex || !departure.is_through) return departure.body;
    if (glass.records[departure.record].kind != scalar::kSolidGlass) return departure.body;
    return departure.height < 0 ? departure.record : kNoIndex;
}

} // namespace relief::cpu
