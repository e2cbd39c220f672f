// Points of the surface as shading sees them, with and without the cache of unpacked patches.
#include <gtest/gtest.h>

#include "engine/cpu/tracer.h"
#include "support/bodies.h"

namespace relief {
namespace {

TEST(SurfacePoints, are_the_same_by_way_of_a_cache_of_any_size) {
    RenderSettings settings;
    settings.level = 4;
    const Scene scene = test::make_body_scene(
        test::make_cube_sphere(3),
        test::make_displacement(test::make_random_map(64, 48, 0.15f, 3), DisplacementSpace::tangent));
    const std::shared_ptr<const PreparedScene> prepared = prepare_scene(scene, settings);
    const cpu::Tracer tracer(prepared, settings);
    PatchSamplesCache one(1), few(8);
    const uint32_t patch_count = prepared->surfaces[0].patch_count();
    for (uint32_t k = 0; k < 400; ++k) {
        cpu::TraceHit hit;
        hit.instance = 0, hit.patch = k * 7 % patch_count;
        hit.i = uint16_t(k % 16), hit.j = uint16_t(k / 16 % 16);
        hit.levels = pack_levels(prepared->instances[0].levels->at(hit.patch));
        hit.u = (float(hit.i) + 0.6f) / 16, hit.v = (float(hit.j) + 0.3f) / 16;
        const cpu::SurfacePoint expected = tracer.make_surface_point(hit);
        for (PatchSamplesCache* cache : {&one, &few}) {
            const cpu::SurfacePoint point = tracer.make_surface_point(hit, *cache);
            ASSERT_EQ(point.position, expected.position) << k;
            ASSERT_EQ(point.shading_normal, expected.shading_normal) << k;
            const cpu::SurfacePoint found = tracer.evaluate_point(0, hit.patch, {hit.u, hit.v}, 0, *cache);
            ASSERT_EQ(found.position, expected.position) << k;
            ASSERT_EQ(found.geometric_normal, expected.geometric_normal) << k;
        }
    }
}

} // namespace
} // namespace relief
