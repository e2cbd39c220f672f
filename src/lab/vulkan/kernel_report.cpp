#include "lab/kernel_report.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "lab/scene_walks.h"
#include "lab/trees.h"
#include "lab/vulkan/kernel_cases.h"
#include "lab/vulkan/lbvh_builder.h"
#include "lab/vulkan/tree_tracer.h"
#include "lab/walks/trail.h"
#include "prepare/prepared_scene.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/path_tracer.h"
#include "vulkan/ray_batch.h"

namespace relief {

namespace vulkan {

namespace {

/// Depths of trees that take keys of 32 and of 64 bits.
constexpr int kDepths[] = {int(scalar::kTrailLevels32), int(scalar::kTrailLevels64)};

/// `collected`: as TracerConfig has it, as the engine of a GPU does.
TracerConfig make_tracer_config(uint32_t collected) {
    TracerConfig config;
    config.ray_capacity = 1u << 12, config.pair_capacity = 1u << 14;
    config.collected = collected;
    return config;
}

TreeForm find_form(TreeKind kind) {
    switch (kind) {
    case TreeKind::heap:
        return TreeForm::dense_heap;
    case TreeKind::succinct_lbvh:
    case TreeKind::succinct_sah:
        return TreeForm::succinct_heap;
    case TreeKind::kdtree:
        return TreeForm::kd;
    default:
        return TreeForm::linked;
    }
}

const std::map<uint32_t, std::string> kConstantNames = {
    {0, "group_size"},
    {scalar::kSmoothConstant, "smooth"},
    {scalar::kTileStackConstant, "tile_stack"},
    {scalar::kTileBordersConstant, "tile_borders"},
    {scalar::kLayersConstant, "layers"},
    {scalar::kNormalMapsConstant, "normal_maps"},
    {scalar::kLightTreeConstant, "light_tree"},
    {scalar::kLightLinksConstant, "light_links"},
    {scalar::kLightTexturesConstant, "light_textures"},
    {scalar::kLightKindsConstant, "light_kinds"},
    {scalar::kLightGroupsConstant, "light_groups"},
    {scalar::kDefaultGroupConstant, "default_group"},
    {scalar::kEnvironmentGroupConstant, "environment_group"},
    {scalar::kGlassConstant, "glass"},
    {scalar::kTerminatorsConstant, "terminators"},
    {scalar::kShadowCatchersConstant, "shadow_catchers"},
    {scalar::kVertexNumbersConstant, "vertex_numbers"},
    {scalar::kGuidesConstant, "guides"},
    {scalar::kAnisotropyConstant, "anisotropy"},
    {scalar::kBicubicConstant, "bicubic"},
    {scalar::kPolygonsConstant, "polygons"},
    {scalar::kTilesConstant, "tiles"},
    {scalar::kRayLodConstant, "ray_lod"},
    {scalar::kCollectsConstant, "collects"},
    {scalar::kUvSetsConstant, "uv_sets"},
    {scalar::kPlacedTexturesConstant, "placed_textures"}};

/// Makes the objects that make kernels, case by case, and lists what was compiled.
class KernelLister {
  public:
    KernelLister(const RenderSettings& settings, const std::function<void(const std::string&)>& on_case)
        : settings_(settings), on_case_(on_case) {}

    KernelReport run() {
        report_.constant_names = kConstantNames;
        {
            const Device device(make_config(RenderMethod::compute));
            report_.device = device.description().name, report_.driver = device.description().driver;
            list_scenes(device);
            list_walks(device);
            list_trees(device);
        }
        list_drawn(Device(make_config(RenderMethod::hybrid)));
        return std::move(report_);
    }

  private:
    Device::Config make_config(RenderMethod method) const {
        Device::Config config;
        config.index = settings_.device.index, config.method = method;
        config.is_shared = false, config.compiles_only = true;
        return config;
    }

    void list_scenes(const Device& device) {
        for (SceneCase& each : make_scene_cases(settings_)) {
            begin_case(each.name, each.meaning);
            const auto scene = prepare_scene(std::move(each.scene), each.settings, SceneOrigin::camera);
            const DeviceScene device_scene(device, *scene);
            Tracer tracer(device, *scene, device_scene, each.settings,
                          make_tracer_config(scalar::kMostCollected));
            const PathTracer paths(tracer, each.settings);
            const RayBatch rays(tracer);
            take(device);
        }
    }

    void list_walks(const Device& device) {
        for (SceneCase& each : make_walk_cases(settings_)) {
            begin_case(each.name, each.meaning);
            const auto scene = prepare_scene(std::move(each.scene), each.settings);
            SceneWalk walk = make_device_walk(*scene, each.settings).value();
            for (const int depth : kDepths) {
                walk.kernel = find_walk_kernel(each.settings.experiment.traversal, depth);
                const DeviceScene device_scene(device, *scene, &walk);
                const Tracer tracer(device, *scene, device_scene, each.settings, make_tracer_config(0));
            }
            take(device);
        }
    }

    void list_trees(const Device& device) {
        begin_case("trees", "trees over one mesh, built and walked on the device");
        const DeviceLbvhBuilder builder(device);
        TreeTracer tracer(device);
        for (const TreeKind kind : tree_kinds())
            for (const TraversalKind traversal : tree_traversals(kind))
                for (const int depth : kDepths) {
                    DeviceTree tree;
                    tree.form = find_form(kind), tree.depth = depth;
                    tracer.find_kernel(tree, {.traversal = traversal});
                }
        take(device);
    }

    /// What the methods fragment and hybrid have beside kernels of other cases.
    void list_drawn(const Device& device) {
        SceneCase plain = std::move(make_scene_cases(settings_).front());
        begin_case("drawn", "experiment.method = fragment or hybrid");
        const auto scene = prepare_scene(std::move(plain.scene), plain.settings);
        const DeviceScene device_scene(device, *scene);
        plain.settings.experiment.method = RenderMethod::fragment;
        Tracer tracer(device, *scene, device_scene, plain.settings, make_tracer_config(0));
        Buffer vertices(device, {"vertices", RasterBuffers::kLeastVertexBytes});
        Buffer items(device, {"items", RasterBuffers::kLeastItemBytes});
        const Rasteriser rasteriser(tracer, {.vertices = &vertices, .items = &items});
        take(device);
    }

    void begin_case(const std::string& name, const std::string& meaning) {
        on_case_(name);
        report_.cases.push_back({name, meaning});
    }

    void take(const Device& device) {
        const std::string& name = report_.cases.back().name;
        for (KernelStatistics& kernel : take_kernel_statistics(device)) {
            const auto [place, is_new] = places_.try_emplace(
                {kernel.shader, kernel.vertex_shader, kernel.constants}, report_.kernels.size());
            if (is_new) report_.kernels.push_back({std::move(kernel), {}});
            std::vector<std::string>& cases = report_.kernels[place->second].cases;
            if (cases.empty() || cases.back() != name) cases.push_back(name);
        }
    }

    const RenderSettings& settings_;
    const std::function<void(const std::string&)>& on_case_;
    KernelReport report_;
    std::map<std::tuple<std::string, std::string, std::vector<uint32_t>>, size_t> places_; ///< in the report
};

} // namespace

} // namespace vulkan

KernelReport report_kernels(const RenderSettings& settings,
                            const std::function<void(const std::string&)>& on_case) {
    return vulkan::KernelLister(settings, on_case).run();
}

} // namespace relief
