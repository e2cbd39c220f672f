#include "vulkan/cast_kernels.h"
#include "formulas/patch_tree.h"
#include "vulkan/layout/bindings.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>
#include <vector>

namespace relief::vulkan {

namespace {

constexpr uint32_t kAll = std::numeric_limits<uint32_t>::max();
constexpr uint32_t kGroup = 64; ///< invocations of kernels without barriers

/// lavapipe silently ends loops after 65535 iterations of an invocation; 32 rays of 1365 nodes stay below.
constexpr uint32_t kSafePairsPerLane = 32;

/// How trees of a bin are built.
struct BuildShape {
    uint32_t group; ///< invocations
    uint32_t lanes; ///< of them, per tree
};

/// Few lanes on software devices, which save a group's state at each barrier. On others shared memory bounds
/// the groups of large trees, so that each has many.
std::array<BuildShape, scalar::kBuildBinCount> choose_shapes(bool is_cpu) {
    if (is_cpu) return {{{8, 4}, {8, 8}, {8, 8}}};
    return {{{64, 8}, {64, 64}, {128, 128}}};
}

/// Granularity of stack sizes, so that scenes of similar depth share a kernel: from 288 and 320 bytes on, as
/// RADV keeps arrays of up to 256 in registers.
constexpr uint32_t kStackStep = 24, kTileStackStep = 40;

uint32_t round_up(uint32_t size, uint32_t step) { return (size + step - 1) / step * step; }

/// Of a kernel that walks the scene trees. Stacks of one entry are none.
std::vector<uint32_t> make_walk_constants(const DeviceScene& scene, uint32_t tile_stack_size,
                                          const RenderSettings& settings) {
    const uint32_t stack_size = scene.stack_size() > 1 ? round_up(scene.stack_size(), kStackStep) : 1;
    std::vector<uint32_t> constants = scene.add_contents({kGroup, stack_size}, settings.surface.lod);
    if (tile_stack_size > 0) {
        constants.resize(std::max<size_t>(constants.size(), scalar::kTileStackConstant + 1));
        constants[scalar::kTileStackConstant] = round_up(tile_stack_size, kTileStackStep);
    }
    return constants;
}

/// Maximum tree level of each bin.
constexpr std::array<uint32_t, scalar::kBuildBinCount> kDeepest = {1, 3, scalar::kTreeLevels};

/// Whether the scene has trees in a bin; `is_coarser`: coarser trees of the same patches count as well.
bool has_trees(uint32_t tree_levels, bool is_coarser, uint32_t bin) {
    if (is_coarser && tree_levels != 0) tree_levels = 2 * std::bit_floor(tree_levels) - 1;
    const uint32_t first = bin == 0 ? 0 : kDeepest[bin - 1] + 1;
    return tree_levels >> first & ((2u << (kDeepest[bin] - first)) - 1);
}

/// A traversal kernel: a compute shader or a full-screen fragment shader.
Kernel make_walk(const Device& device, RenderMethod method, const TraversalKernel& kernel,
                 std::vector<uint32_t> constants) {
    if (method != RenderMethod::fragment)
        return Kernel(device, {kernel.shader, std::move(constants), kernel.compute});
    return Kernel(device, {kernel.shader + "_fragment", std::move(constants), kernel.fragment, kFullScreen});
}

} // namespace

CastKernels::CastKernels(const Device& device, const DeviceScene& scene, const RenderSettings& settings,
                         const TracerConfig& config, uint32_t tile_stack_size) {
    const bool is_cpu = device.is_cpu();
    const uint32_t is_box = settings.surface.leaf == LeafKind::box;
    // Measured: docs/decisions/bottom-form.md.
    is_fused = settings.experiment.bottom == BottomForm::fused;
    std::vector<uint32_t> constants = make_walk_constants(scene, tile_stack_size, settings);
    scene_traversal = make_walk(device, settings.experiment.method, scene.traversal_kernel(), constants);
    if (config.collected > 0)
        collecting_traversal = make_walk(device, settings.experiment.method, scene.traversal_kernel(),
                                         DeviceScene::add_collecting(std::move(constants)));
    find_jobs = Kernel(device, {"find_jobs", scene.add_contents({kGroup}, settings.surface.lod)});
    prepare_arguments = Kernel(device, {"prepare_arguments", {1}});
    bottom_cache = Kernel(device, {"bottom_cache", {kGroup}});
    commit_round = Kernel(device, {"commit_round", {kGroup}});
    finish_hits = Kernel(device, {"finish_hits", scene.add_filter({kGroup, is_box})});

    const std::array<BuildShape, scalar::kBuildBinCount> shapes =
        choose_shapes(is_cpu && !config.builds_as_gpu);
    arguments_push.group_size = kGroup;
    const bool is_coarser = config.may_see_coarser || settings.surface.lod == LodRule::ray;
    for (uint32_t bin = 0; bin < scalar::kBuildBinCount; ++bin) {
        if (!is_fused && has_trees(scene.tree_levels(), is_coarser, bin))
            bottom_build[bin].emplace(
                device, KernelConfig{"bottom_build", scene.add_filter({shapes[bin].group, shapes[bin].lanes,
                                                                       kDeepest[bin], bin})});
        arguments_push.builds_per_group[bin] = shapes[bin].group / shapes[bin].lanes;
    }
    if (!is_fused) {
        patch_traversal = make_walk(device, settings.experiment.method, {"patch_traversal", {}, {}},
                                    {kGroup, 0, 0, 0, is_box, 0});
        return;
    }
    const uint32_t most_pairs = is_cpu ? kGroup * kSafePairsPerLane : kAll;
    fused_jobs_per_group = config.fused_jobs_per_group > 0 ? config.fused_jobs_per_group : is_cpu ? 1 : kAll;
    fused_group_count = config.fused_group_count > 0 ? config.fused_group_count
                        : is_cpu                     ? kAll
                                                     : device.resident_group_count() * 256 / kGroup;
    bottom_fused =
        Kernel(device, {"bottom_fused", scene.add_filter({kGroup, kGroup, scalar::kTreeLevels, 0, is_box,
                                                          most_pairs, fused_jobs_per_group})});
    has_leftover = most_pairs != kAll;
    if (has_leftover) leftover = Kernel(device, {"patch_traversal", {kGroup, 0, 0, 0, is_box, most_pairs}});
}

} // namespace relief::vulkan
