// The diffuse part of what surfaces scatter.
#include <gtest/gtest.h>

#include "formulas/hemisphere.h"
#include "formulas/lobe_shares.h"
#include "formulas/sobol.h"
#include "formulas/warp.h"
#include "prepare/material_layers.h"

namespace relief {
namespace {

/// Directions on both sides of the horizon.
Vec3f draw_direction(uint32_t k, uint32_t pair) {
    return scalar::square_to_cone(scalar::sobol_pair(5, k, pair), 1.1f);
}

void expect_close(const Vec3f& a, const Vec3f& b) {
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(get_component(a, axis), get_component(b, axis), 1e-5f * (1 + get_component(b, axis)));
}

TEST(DiffusePart, is_what_is_left_of_a_surface_without_its_facets) {
    for (uint32_t k = 0; k < 4000; ++k) {
        const Vec2f a = scalar::sobol_pair(7, k, 2), b = scalar::sobol_pair(7, k, 3);
        const scalar::BsdfParameters p{{a.x, a.y, 0.5f}, b.x, k % 3 == 0 ? 0 : b.y, k % 5 == 0 ? 1 : 1 + a.x};
        const Vec3f wo = direction(0.05f + 0.9f * a.x, 1), wi = draw_direction(k, 1);
        scalar::Bsdf bsdf = scalar::make_bsdf(p, wo.z);
        const Vec3f diffuse = scalar::evaluate_diffuse(bsdf, wo, wi);
        const Vec3f whole = scalar::evaluate_bsdf(bsdf, wo, wi).value;
        bsdf.f0 = bsdf.multiple = {};
        if (!scalar::is_diffuse(bsdf)) bsdf.f90 = 1e-30f; // still a surface with facets
        expect_close(diffuse, scalar::evaluate_bsdf(bsdf, wo, wi).value);
        const Vec3f shares = scalar::find_shares(diffuse, whole);
        for (const float share : {shares.x, shares.y, shares.z}) {
            EXPECT_GE(share, 0);
            EXPECT_LE(share, 1);
        }
        if (p.metallic == 0 && p.ior == 1 && wi.z > 0) EXPECT_EQ(shares, (Vec3f{1, 1, 1}));
    }
}

TEST(DiffusePart, of_metal_is_nothing) {
    const scalar::Bsdf metal = scalar::make_bsdf({{0.9f, 0.5f, 0.1f}, 0.4f, 1, 1.5f}, 0.7f);
    for (uint32_t k = 0; k < 100; ++k)
        EXPECT_EQ(scalar::evaluate_diffuse(metal, direction(0.7f, 1), draw_direction(k, 1)), Vec3f{});
}

/// A material with its tables.
struct Layered {
    MaterialLayers layers;
    scalar::LayeredSurface surface;
    scalar::LayerTable table;

    explicit Layered(const Material& material)
        : layers(make_material_layers({material})),
          surface{material.base_color, material.roughness, layers.records.at(0)},
          table{layers.entries.data()} {}
};

TEST(DiffusePart, of_layers_is_that_of_the_dielectric_base_and_the_fuzz) {
    Material material;
    material.base_color = {0.8f, 0.4f, 0.1f}, material.roughness = 0.4f;
    material.coat_weight = 0.6f, material.coat_color = {0.9f, 0.6f, 0.3f}, material.coat_roughness = 0.2f;
    material.fuzz_weight = 0.5f, material.base_diffuse_roughness = 0.3f, material.metallic = 0.4f;
    const Layered layered(material);
    for (uint32_t k = 0; k < 2000; ++k) {
        const Vec3f wo = direction(0.05f + 0.9f * scalar::sobol_pair(3, k, 0).x, 1),
                    wi = draw_direction(k, 1);
        scalar::LayeredBsdf bsdf = scalar::make_layered_bsdf(layered.surface, layered.table, wo);
        const Vec3f diffuse = scalar::evaluate_layered_diffuse(bsdf, layered.table, wo, wi);
        const Vec3f whole = scalar::evaluate_layered_bsdf(bsdf, layered.table, wo, wi).value;
        // Without the facets of the base and what metal leaves over, the rest is what the coat reflects.
        bsdf.metal_f0 = bsdf.metal_edge = bsdf.dielectric_color = bsdf.rests.metal = {};
        bsdf.metal_f90 = 0;
        const Vec3f rest = scalar::evaluate_layered_bsdf(bsdf, layered.table, wo, wi).value - diffuse;
        EXPECT_NEAR(rest.x, rest.y, 1e-5f * (1 + whole.x)) << "white";
        EXPECT_NEAR(rest.x, rest.z, 1e-5f * (1 + whole.x));
        EXPECT_GE(rest.x, -1e-6f);
        if (wi.z <= 0) EXPECT_EQ(diffuse, Vec3f{});
    }
}

TEST(DiffusePart, of_layers_without_coat_and_metal_is_all_but_the_facets) {
    Material material;
    material.base_color = {0.8f, 0.4f, 0.1f}, material.base_diffuse_roughness = 0.5f;
    material.fuzz_weight = 0.7f, material.ior = 1;
    const Layered layered(material);
    for (uint32_t k = 0; k < 500; ++k) {
        const Vec3f wo = direction(0.3f, 1), wi = draw_direction(k, 1);
        const scalar::LayeredBsdf bsdf = scalar::make_layered_bsdf(layered.surface, layered.table, wo);
        expect_close(scalar::evaluate_layered_diffuse(bsdf, layered.table, wo, wi),
                     scalar::evaluate_layered_bsdf(bsdf, layered.table, wo, wi).value);
    }
}

} // namespace
} // namespace relief
