// Trees over one mesh on a device: linear ones are built there, all others on the host and uploaded.
#include "lab/tree_workshop.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "base/timer.h"
#include "formulas/tree.h"
#include "lab/vulkan/lbvh_builder.h"
#include "lab/vulkan/tree_tracer.h"
#include "lab/walks/trail.h"
#include "vulkan/layout/device_trees.h"

namespace relief::vulkan {

namespace {

static_assert(sizeof(Ray) == sizeof(scalar::TreeRay) && sizeof(uint64_t) == sizeof(scalar::HeapKey));
static_assert(std::endian::native == std::endian::little, "keys cross as their low word, then the high one");

constexpr const char* kPartNames[BuildReport::kPartCount] = {"boxes", "codes", "sort", "hierarchy", "refit"};

std::vector<bool> find_used_slots(const DeviceTree& tree) {
    const std::vector<TreeNode> slots = tree.nodes.download<TreeNode>(tree.node_count);
    std::vector<bool> used(slots.size());
    for (size_t k = 0; k < slots.size(); ++k) used[k] = slots[k].word != scalar::kEmptySlot;
    return used;
}

class VulkanTreeWorkshop final : public TreeWorkshop {
  public:
    VulkanTreeWorkshop(TriangleSoup soup, const Device::Config& config)
        : TreeWorkshop(std::move(soup)),
          device_(config),
          mesh_(upload_mesh(device_, soup_.positions, soup_.indices)),
          builder_(device_),
          tracer_(device_),
          boxes_(compute_triangle_boxes(soup_)) {
        device_name_ = device_.description().name;
        copy_bandwidth_ = measure_copy_bandwidth(device_);
    }

    TreeBuild build(TreeKind kind, int heap_levels) override {
        tree_.reset(); // makes room
        used_slots_ = {}, directory_ = {};
        if (kind == TreeKind::lbvh30 || kind == TreeKind::lbvh63) {
            LbvhBuilder::Config config;
            config.code_bits = kind == TreeKind::lbvh63 ? 63 : 30;
            tree_ = builder_.build(mesh_, config);
            return describe();
        }
        if (kind == TreeKind::heap) {
            tree_ = builder_.build_heap(mesh_, {30, heap_levels});
            used_slots_ = find_used_slots(*tree_);
            return describe();
        }
        BuiltTree built = build_host_tree(boxes_, kind, heap_levels);
        tree_ = std::visit([this](const auto& tree) { return upload_tree(device_, tree); }, built.tree);
        if (SuccinctHeap* heap = std::get_if<SuccinctHeap>(&built.tree)) {
            directory_ = std::move(*heap);
            directory_.nodes = {}, directory_.primitive_ids = {};
        }
        return built.report;
    }

    bool contains_key(uint64_t key) const override {
        if (tree_->form == TreeForm::succinct_heap) return relief::contains_key(directory_, key);
        return key < used_slots_.size() && used_slots_[key];
    }

    TreeCast cast(const TreeQuery& query, const TreeCastData& data) override {
        const uint32_t count = uint32_t(data.rays.size());
        if (!rays_ || rays_->capacity < count) rays_.emplace(device_, std::max(count, 1u));
        rays_->rays.upload(std::as_bytes(data.rays));
        const bool has_keys = !data.keys.empty();
        if (has_keys) rays_->start_keys.upload(std::as_bytes(data.keys));
        tracer_.trace(*tree_, mesh_, *rays_, count, query, has_keys ? WalkStart::last_leaf : WalkStart::root);
        TreeCast result;
        result.seconds = tracer_.seconds();
        if (query.counting == Counting::on) add_counts(count, result);
        fetch(count, data);
        return result;
    }

  private:
    /// Of the tree that the device has built.
    TreeBuild describe() const {
        const BuildReport& built = builder_.report();
        TreeBuild report;
        report.is_on_device = true;
        report.seconds = built.total_seconds();
        const bool is_heap = tree_->form == TreeForm::dense_heap;
        report.bytes = tree_->nodes.byte_count() + tree_->primitive_ids.byte_count();
        report.link_bytes = tree_->parents.byte_count();
        report.slots = tree_->nodes.byte_count() / sizeof(TreeNode),
        report.used = is_heap ? uint64_t(std::ranges::count(used_slots_, true)) : tree_->node_count;
        report.entries = built.primitive_count;
        report.depth = tree_->depth;
        for (size_t part = 0; part < BuildReport::kPartCount; ++part)
            report.parts.push_back({kPartNames[part], built.seconds[part], built.bytes[part]});
        report.bound_share = compute_bound_share(built, copy_bandwidth_);
        return report;
    }

    void add_counts(uint32_t count, TreeCast& sums) const {
        for (const scalar::RayCounts& ray : rays_->counts.download<scalar::RayCounts>(count)) {
            sums.box_tests += ray.box_tests, sums.triangle_tests += ray.primitive_tests;
            sums.restarts += ray.restarts, sums.bytes += ray.bytes;
        }
    }

    void fetch(uint32_t count, const TreeCastData& data) const {
        const std::vector<scalar::TreeHit> hits = rays_->hits.download<scalar::TreeHit>(count);
        for (uint32_t k = 0; k < count; ++k) data.hits[k] = {hits[k].t, hits[k].primitive};
        if (!data.keys.empty()) rays_->leaf_keys.download(std::as_writable_bytes(data.keys));
    }

    Device device_;
    DeviceMesh mesh_;
    DeviceLbvhBuilder builder_;
    TreeTracer tracer_;
    std::vector<Box> boxes_;
    std::optional<DeviceTree> tree_;
    std::vector<bool> used_slots_; ///< of a heap with empty slots
    SuccinctHeap directory_;       ///< of a succinct heap: what it finds nodes by
    std::optional<TreeRays> rays_;
};

} // namespace

} // namespace relief::vulkan

namespace relief {

std::unique_ptr<TreeWorkshop> make_vulkan_tree_workshop(TriangleSoup soup, const RenderSettings& settings) {
    vulkan::Device::Config config;
    config.index = settings.device.index;
    config.pipeline_cache = settings.device.pipeline_cache;
    return std::make_unique<vulkan::VulkanTreeWorkshop>(std::move(soup), config);
}

} // namespace relief
