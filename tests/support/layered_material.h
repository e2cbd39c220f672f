// A layered material with the tables that the engines read.
#pragma once

#include "formulas/hemisphere.h"
#include "formulas/layered_bsdf.h"
#include "prepare/material_layers.h"
#include "support/net_points.h"

namespace relief {

class Layered {
  public:
    explicit Layered(const Material& material)
        : layers_(make_material_layers({material})),
          surface_{material.base_color * material.base_weight, material.roughness, layers_.records.at(0)},
          table_{layers_.entries.data()} {}

    scalar::LayeredBsdf make(const Vec3f& wo) const {
        return scalar::make_layered_bsdf(surface_, table_, wo);
    }
    scalar::BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi) const {
        return scalar::evaluate_layered_bsdf(make(wo), table_, wo, wi);
    }
    scalar::BsdfSample sample(const scalar::LayeredBsdf& bsdf, const Vec3f& wo, float lobe,
                              const Vec2f& u) const {
        return scalar::sample_layered_bsdf(bsdf, table_, wo, lobe, u);
    }
    /// Mean of the sample weights: the directional albedo. `count`: a power of two.
    Vec3f estimate_albedo(float cosine, uint32_t count = 1u << 14, float azimuth = 0.3f) const {
        const Vec3f wo = direction(cosine, azimuth);
        const scalar::LayeredBsdf bsdf = make(wo);
        Vec3<double> sum{};
        for (uint32_t k = 0; k < count; ++k) {
            const test::NetPoint u = test::find_net_point(k, count);
            const Vec3f w = sample(bsdf, wo, u.x, u.yz).weight;
            sum.x += double(w.x), sum.y += double(w.y), sum.z += double(w.z);
        }
        return {float(sum.x / count), float(sum.y / count), float(sum.z / count)};
    }

  private:
    MaterialLayers layers_;
    scalar::LayeredSurface surface_;
    scalar::LayerTable table_;
};

} // namespace relief
