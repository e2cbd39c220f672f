#include "prepare/material_glass.h"

#include <algorithm>
#include <cmath>

#include "formulas/glass.h"

namespace relief {

namespace {

/// The ior whose reflection at normal incidence is `weight` times that of `ior` (OpenPBR 1.1, "Dielectric
/// base": modulated ior).
float weaken_ior(float ior, float weight) {
    const float root = std::sqrt(weight) * (ior - 1) / (ior + 1);
    return (1 + root) / (1 - root);
}

/// -log2 of what a length leaves over, for each of its parts of 1.
Vec3f find_depth(const Vec3f& color, float length) {
    const auto depth = [&](float c) { return std::min(-std::log2(std::max(c, 1e-12f)) / length, 1e30f); };
    return {depth(color.x), depth(color.y), depth(color.z)};
}

scalar::GlassParameters make_glass_record(const Material& material) {
    scalar::GlassParameters g{};
    g.weight = material.transmission_weight;
    g.ior = std::max(weaken_ior(material.ior, material.specular_weight), scalar::kLeastGlassIor);
    g.specular_color = material.specular_color;
    g.tint = {1, 1, 1};
    g.anisotropy = material.specular_roughness_anisotropy;
    g.kind = scalar::kSolidGlass;
    if (material.is_thin_walled) {
        g.kind = is_clear_wall(material) ? scalar::kClearWall : scalar::kRoughWall;
        g.depth = find_depth(material.transmission_color, 1);
    } else if (material.transmission_depth > 0) {
        g.depth = find_depth(material.transmission_color, material.transmission_depth);
    } else {
        g.tint = material.transmission_color;
    }
    return g;
}

} // namespace

MaterialGlass make_material_glass(const std::vector<Material>& materials) {
    MaterialGlass result;
    for (const Material& material : materials) {
        const bool is_glass = material.transmission_weight > 0;
        result.record_of_material.push_back(is_glass ? uint32_t(result.records.size()) : kNoIndex);
        if (is_glass) result.records.push_back(make_glass_record(material));
    }
    return result;
}

} // namespace relief
