// The probe that measurements take the CPU engine apart with: the rays and vertices that the engine has.
#include "lab/tracer_probe.h"

#include <gtest/gtest.h>

#include "lab/scenes/peer_scenes.h"
#include "lab/scenes/structure_scenes.h"
#include "math/affine.h"
#include "prepare/prepared_scene.h"
#include "relief/error.h"
#include "relief/samples.h"
#include "support/isas.h"

namespace relief {
namespace {

RenderSettings make_settings(int level) {
    RenderSettings settings;
    settings.image.width = 70, settings.image.height = 41; // no multiples of a tile
    settings.surface.level = level;
    settings.device.threads = 2;
    return settings;
}

/// Made once: its map takes a while.
const Scene& make_rock() {
    static const Scene kRock = make_peer_scene("rock", 1, PeerWorld::constant);
    return kRock;
}

void expect_same(const std::vector<ProbeHit>& a, const std::vector<ProbeHit>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t k = 0; k < a.size(); ++k) {
        EXPECT_EQ(a[k].t, b[k].t) << k;
        EXPECT_EQ(a[k].patch, b[k].patch) << k;
    }
}

TEST(TracerProbe, the_camera_and_its_rays_meet_the_same) {
    TracerProbe probe(make_rock(), make_settings(4));
    const std::vector<Ray> rays = probe.make_camera_rays(make_rock().camera);
    ASSERT_EQ(rays.size(), 70u * 41u);
    const ProbeRun camera = probe.trace_camera();
    EXPECT_GT(camera.hit_count, rays.size() / 8);
    EXPECT_GT(camera.seconds, 0);
    const ProbeRun traced = probe.trace(rays, HitKind::closest, RayGrouping::packets);
    expect_same(camera.hits, traced.hits);
    probe.empty_cache();
    EXPECT_EQ(probe.count().trees_built, 0u);
    expect_same(probe.trace_camera().hits, traced.hits);
    EXPECT_EQ(probe.trace(rays, HitKind::any, RayGrouping::packets).hit_count, traced.hit_count);
}

TEST(TracerProbe, patches_have_the_vertices_of_the_surface_with_every_isa) {
    for (const Isa isa : test::machine_isas()) {
        RenderSettings settings = make_settings(6); // more than one tile a patch
        settings.device.isa = isa;
        Scene scene = make_rock();
        scene.objects[0].world_from_object = make_translation({1, 2, 3});
        const std::shared_ptr<const PreparedScene> prepared = prepare_scene(scene, settings);
        const TracerProbe probe(scene, settings);
        ASSERT_EQ(probe.patch_count(), 600u);
        for (const uint32_t patch : {0u, 17u, 599u}) {
            ASSERT_EQ(probe.patch_level(patch), 6);
            std::vector<Vec3f> vertices(65 * 65);
            probe.evaluate_patch(patch, vertices);
            const PatchLevels levels = prepared->instances[0].levels->at(patch);
            for (uint32_t j = 0; j <= 64; ++j)
                for (uint32_t i = 0; i <= 64; ++i)
                    ASSERT_EQ(vertices[j * 65 + i],
                              transform_point(scene.objects[0].world_from_object,
                                              evaluate_vertex(prepared->surfaces[0], patch, levels, i, j)));
        }
    }
}

TEST(TracerProbe, rays_that_leave_a_hit_do_not_meet_its_triangle) {
    const TracerProbe probe(make_rock(), make_settings(4));
    const std::vector<Ray> rays = probe.make_camera_rays(make_rock().camera);
    const std::vector<ProbeHit> hits = probe.trace_camera().hits;
    std::vector<Ray> leaving;
    std::vector<ProbeHit> left;
    for (const ProbeHit& hit : hits)
        if (hit.is_hit())
            leaving.push_back(probe.leave(probe.find_point(hit), probe.find_point(hit).normal)),
                left.push_back(hit);
    const std::vector<ProbeHit> next = probe.trace(leaving, HitKind::closest, RayGrouping::packets).hits;
    for (size_t k = 0; k < next.size(); ++k)
        EXPECT_FALSE(next[k].is_hit() && next[k].patch == left[k].patch && next[k].i == left[k].i &&
                     next[k].j == left[k].j && next[k].is_upper == left[k].is_upper);
}

TEST(TracerProbe, counts_what_was_built) {
    const TracerProbe probe(make_rock(), make_settings(3));
    probe.trace_camera();
    const ProbeCounts counts = probe.count();
    EXPECT_EQ(counts.patches, 600u);
    EXPECT_EQ(counts.micro_quads, 600u * 64u);
    EXPECT_GT(counts.trees_built, 0u);
    EXPECT_EQ(counts.built_quads, counts.trees_built * 64);
    EXPECT_GT(counts.built_bytes, counts.built_quads);
    EXPECT_GT(probe.preparation().seconds(), 0);
}

TEST(TracerProbe, a_displaced_patch_takes_at_most_64_bytes) {
    for (const char* name : {"rock", "pumpkin", "bark"}) {
        const Scene scene =
            std::string(name) == "rock" ? make_rock() : make_sample_scene(name, Instancing::none);
        const ProbeCounts counts = TracerProbe(scene, make_settings(3)).count();
        EXPECT_EQ(counts.plain_bytes > 0, counts.triangles > 0) << name;
        const uint64_t bytes = counts.geometry_bytes + counts.structures_bytes - counts.plain_bytes;
        EXPECT_LE(bytes, 64 * counts.patches) << name;
        EXPECT_GE(bytes, 30 * counts.patches) << name;
    }
}

TEST(TracerProbe, surfaces_without_displacement_are_triangles) {
    const Scene body = make_structure_scene("body", MeshDetail::reduced);
    const TracerProbe probe(body, make_settings(kAutoLevel));
    EXPECT_EQ(probe.patch_count(), 0u);
    EXPECT_EQ(probe.list_plain_triangles().size(), body.meshes[0].face_sizes.size());
    EXPECT_EQ(probe.count().triangles, body.meshes[0].face_sizes.size());
    const std::vector<Ray> rays = probe.make_camera_rays(body.camera);
    expect_same(probe.trace(rays, HitKind::closest, RayGrouping::single).hits,
                probe.trace(rays, HitKind::closest, RayGrouping::packets).hits);
}

TEST(TracerProbe, refuses_what_it_cannot_do) {
    RenderSettings vulkan = make_settings(3);
    vulkan.device.engine = EngineKind::vulkan;
    EXPECT_THROW(TracerProbe(make_rock(), vulkan), Error);
    const TracerProbe probe(make_rock(), make_settings(3));
    EXPECT_THROW(
        probe.trace(probe.make_camera_rays(make_rock().camera), HitKind::closest, RayGrouping::single),
        Error);
    std::vector<Vec3f> room(3);
    EXPECT_THROW(probe.evaluate_patch(0, room), Error);
}

} // namespace
} // namespace relief
