// Counts of nodes and blocks visited by the CPU engine: detects accidental extra work on any machine, however
// busy. Update a count when a change lowers it; a change that raises one must give the reason in its commit
// message.
#include <gtest/gtest.h>

#include <string>

#include "lab/scenes/peer_scenes.h"
#include "relief/render.h"
#include "relief/samples.h"
#include "support/isas.h"

namespace relief {
namespace {

constexpr double kMostRise = 1.1;

struct Visits {
    uint64_t upper_nodes, patch_nodes, blocks, trees;
    friend bool operator==(const Visits&, const Visits&) = default;
};

/// Camera, shadow and bounce rays.
RenderSettings make_guard_settings() {
    RenderSettings settings;
    settings.image.width = 192, settings.image.height = 108;
    settings.image.spp = 2, settings.image.bounces = 2;
    settings.device.threads = 1;
    return settings;
}

/// `trees` is how many were built: with several threads some are built twice.
Visits count(const Scene& scene, const RenderSettings& settings) {
    const Statistics s = render(scene, settings).statistics;
    EXPECT_GT(s.shadow_rays, 0u);
    EXPECT_GT(s.bounce_rays, 0u);
    return {s.upper_nodes, s.patch_nodes, s.blocks, s.bottom_built};
}

void expect_no_rise(uint64_t found, uint64_t kept, const std::string& what) {
    EXPECT_LE(double(found), kMostRise * double(kept)) << what;
    EXPECT_GT(found, 0u) << what;
}

void check(const Scene& scene, RenderSettings settings, const Visits& kept) {
    const Visits found = count(scene, settings);
    expect_no_rise(found.upper_nodes, kept.upper_nodes, "nodes above patches");
    expect_no_rise(found.patch_nodes, kept.patch_nodes, "nodes within patches");
    expect_no_rise(found.blocks, kept.blocks, "blocks of triangles");
    expect_no_rise(found.trees, kept.trees, "trees built");
    settings.device.threads = 2;
    Visits again = count(scene, settings);
    again.trees = found.trees;
    EXPECT_EQ(again, found) << "with two threads";
}

TEST(VisitGuard, rock_at_a_fixed_level) {
    RenderSettings settings = make_guard_settings();
    settings.surface.level = 4;
    check(make_peer_scene("rock", 1, PeerWorld::sky), settings, {179444, 149929, 376729, 394});
}

TEST(VisitGuard, close_up_of_bark) {
    RenderSettings settings = make_guard_settings();
    settings.image.width *= 8, settings.image.height *= 8;
    settings.image.crop = {640, 360, 832, 468};
    check(make_sample_scene("bark", Instancing::none), settings, {604226, 392362, 513946, 714});
}

TEST(VisitGuard, ear) {
    check(make_sample_scene("ear", Instancing::none), make_guard_settings(), {58497, 275380, 221043, 17});
}

/// A part of the picture does, since the kernels without SIMD are slow.
TEST(VisitGuard, counts_are_those_of_every_instruction_set) {
    RenderSettings settings = make_guard_settings();
    settings.image.crop = {64, 32, 128, 64};
    const Scene scene = make_peer_scene("rock", 1, PeerWorld::sky);
    const Visits best = count(scene, settings);
    for (const Isa isa : test::machine_isas()) {
        settings.device.isa = isa;
        EXPECT_EQ(count(scene, settings), best) << int(isa);
    }
}

} // namespace
} // namespace relief
