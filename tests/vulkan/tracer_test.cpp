// Casts on the device against the CPU engine, ray for ray: levels, LOD biases, spaces, leaves, forms of the
// patch tree kernels, with and without cache, cut into chunks, rounds and waves as small as they go.
#include <ostream>

#include "cast_fixture.h"

namespace relief::vulkan::tests {

namespace {

struct TracerCase {
    const char* name;
    DisplacementSpace space = DisplacementSpace::object;
    int level = 4;
    LeafKind leaf = LeafKind::exact;
    BottomForm bottom = BottomForm::split;
    size_t cache_bytes = size_t(64) << 20;
    uint32_t pair_capacity = 1u << 16;
    uint32_t slots = 4;
    uint32_t collected = 0;
    bool builds_as_gpu = false;
    uint32_t rays = 1500;
    uint32_t restart_units = 1u << 31;
    LodRule lod = LodRule::field;
    SubdivisionScheme scheme = SubdivisionScheme::none;
    FrameKind frame = FrameKind::mikk;
    FrameLengths lengths = FrameLengths::absolute;
    MapFilter filter = MapFilter::none;
    bool has_tiles = false; ///< of two sizes, with faces across both and into one that is missing
};

void PrintTo(const TracerCase& c, std::ostream* stream) { *stream << c.name; }

class VulkanTracerTest : public GpuTest, public testing::WithParamInterface<TracerCase> {};

TEST_P(VulkanTracerTest, gives_the_hits_of_the_cpu_engine) {
    const TracerCase& c = GetParam();
    RenderSettings settings;
    settings.surface.level = c.level;
    settings.image.height = 60;
    settings.surface.leaf = c.leaf;
    settings.experiment.bottom = c.bottom;
    settings.surface.lod = c.lod;
    settings.surface.cache_bytes = c.cache_bytes;
    Scene source = test::make_scene(c.space);
    source.meshes[0].subdivision.scheme = c.scheme;
    source.meshes[0].subdivision.level = 1;
    source.displacements[0].filter = c.filter;
    if (c.has_tiles) {
        for (Vec2f& uv : source.meshes[0].uvs) uv = {2 * uv.x + 0.05f, uv.y + 0.03f};
        source.displacements[0].is_udim = true;
        source.displacements[0].tiles.push_back({1002, test::make_random_map(50, 70, 0.1f, 8)});
    }
    test::set_frames(source, c.frame, c.lengths);
    const std::shared_ptr<const PreparedScene> scene = prepare_scene(std::move(source), settings);
    const std::vector<cpu::TraceRay> rays = make_rays(c.rays, 7);
    TracerConfig config;
    config.pair_capacity = c.pair_capacity;
    config.slots = c.slots;
    config.collected = c.collected;
    config.builds_as_gpu = c.builds_as_gpu;
    config.pool_restart_units = c.restart_units;
    expect_same(cast_on_device(device(), *scene, settings, rays, config), cast_on_cpu(scene, settings, rays),
                rays);
}

INSTANTIATE_TEST_SUITE_P(
    everything, VulkanTracerTest,
    testing::Values(
        TracerCase{.name = "room_for_one_ray", .pair_capacity = 4, .rays = 24},
        TracerCase{.name = "places_numbered_afresh", .level = 5, .pair_capacity = 1024, .restart_units = 1},
        TracerCase{.name = "level_0", .level = 0}, TracerCase{.name = "level_2", .level = 2},
        TracerCase{.name = "level_3", .level = 3}, TracerCase{.name = "level_5", .level = 5},
        TracerCase{.name = "tiles", .level = 6}, TracerCase{.name = "auto_level", .level = kAutoLevel},
        TracerCase{.name = "tangent_space", .space = DisplacementSpace::tangent},
        TracerCase{.name = "tangent_auto", .space = DisplacementSpace::tangent, .level = kAutoLevel},
        TracerCase{.name = "frames_of_the_file",
                   .space = DisplacementSpace::tangent,
                   .level = kAutoLevel,
                   .frame = FrameKind::file},
        TracerCase{.name = "relative_lengths",
                   .space = DisplacementSpace::tangent,
                   .level = kAutoLevel,
                   .lengths = FrameLengths::relative},
        TracerCase{.name = "relative_lengths_of_dpdu_smooth",
                   .space = DisplacementSpace::tangent,
                   .scheme = SubdivisionScheme::catmark,
                   .frame = FrameKind::dpdu,
                   .lengths = FrameLengths::relative},
        TracerCase{.name = "smooth_base", .scheme = SubdivisionScheme::catmark},
        TracerCase{.name = "smooth_base_tangent_auto",
                   .space = DisplacementSpace::tangent,
                   .level = kAutoLevel,
                   .scheme = SubdivisionScheme::catmark},
        TracerCase{.name = "smooth_base_tiles_fused",
                   .level = 6,
                   .bottom = BottomForm::fused,
                   .scheme = SubdivisionScheme::catmark},
        TracerCase{.name = "filtered_level_2", .level = 2, .filter = MapFilter::mip},
        TracerCase{.name = "filtered_tangent_auto",
                   .space = DisplacementSpace::tangent,
                   .level = kAutoLevel,
                   .filter = MapFilter::mip},
        TracerCase{.name = "cubic_level_3", .level = 3, .filter = MapFilter::cubic},
        TracerCase{.name = "cubic_tangent_auto_fused",
                   .space = DisplacementSpace::tangent,
                   .level = kAutoLevel,
                   .bottom = BottomForm::fused,
                   .filter = MapFilter::cubic},
        TracerCase{.name = "bspline_tiles_on_smooth_base",
                   .level = 6,
                   .scheme = SubdivisionScheme::catmark,
                   .filter = MapFilter::bspline},
        TracerCase{.name = "faces_across_tiles", .has_tiles = true},
        TracerCase{.name = "faces_across_tiles_cubic_auto",
                   .space = DisplacementSpace::tangent,
                   .level = kAutoLevel,
                   .filter = MapFilter::cubic,
                   .has_tiles = true},
        TracerCase{
            .name = "faces_across_tiles_filtered", .level = 2, .filter = MapFilter::mip, .has_tiles = true},
        TracerCase{.name = "box_leaves", .leaf = LeafKind::box},
        TracerCase{.name = "box_auto", .level = kAutoLevel, .leaf = LeafKind::box},
        TracerCase{.name = "fused", .bottom = BottomForm::fused},
        TracerCase{.name = "fused_tiles_box", .level = 6, .leaf = LeafKind::box, .bottom = BottomForm::fused},
        TracerCase{.name = "no_cache", .cache_bytes = 0},
        TracerCase{.name = "fused_without_cache",
                   .level = kAutoLevel,
                   .bottom = BottomForm::fused,
                   .cache_bytes = 0},
        TracerCase{.name = "one_patch_a_round", .pair_capacity = 64, .slots = 1},
        TracerCase{.name = "many_chunks", .level = 3, .pair_capacity = 512, .slots = 8},
        TracerCase{.name = "all_left_collected", .pair_capacity = 1u << 18, .slots = 1, .collected = 128},
        TracerCase{
            .name = "tiles_collected", .level = 6, .pair_capacity = 1u << 18, .slots = 1, .collected = 128},
        TracerCase{.name = "too_many_to_collect", .pair_capacity = 3000, .slots = 1, .collected = 2},
        TracerCase{.name = "trees_of_large_groups", .level = kAutoLevel, .builds_as_gpu = true},
        TracerCase{.name = "leaves_of_large_groups", .level = 0, .builds_as_gpu = true},
        TracerCase{.name = "small_trees_of_large_groups", .level = 1, .builds_as_gpu = true},
        TracerCase{.name = "tiles_of_large_groups", .level = 6, .builds_as_gpu = true},
        TracerCase{.name = "level_a_ray", .level = kAutoLevel, .lod = LodRule::ray},
        TracerCase{.name = "many_waves", .level = 6, .cache_bytes = 1}),
    [](const auto& info) { return std::string(info.param.name); });

} // namespace

} // namespace relief::vulkan::tests
