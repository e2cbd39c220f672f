#include "lab/vulkan/lbvh_builder.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "base/check.h"
#include "formulas/tree.h"
#include "lab/vulkan/lab_shaders.h"
#include "relief/error.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_trees.h"
#include "vulkan/radix_sort.h"

namespace relief::vulkan {
namespace {

using Part = BuildReport::Part;

constexpr uint32_t kLbvhGroupSize = 256;

/// Mesa's CPU device (22.3) runs a group as fibres of four or eight lanes and joins all of them at memory
/// barriers. In a loop that some fibres leave early the rest is lost, unless there is only one.
uint32_t choose_refit_group_size(const Device& device) { return device.is_cpu() ? 4 : kLbvhGroupSize; }

constexpr std::array<Stage, BuildReport::kPartCount> kStages = {
    Stage::tree_boxes, Stage::tree_codes, Stage::sort, Stage::tree_hierarchy, Stage::tree_refit};

constexpr uint32_t kMostPrimitives = 1u << 30;
constexpr const char* kTooManyHint = "build it on the host as another tree, or split the mesh";

/// Kernels that read codes, for one width of them.
struct CodeKernels {
    CodeKernels(const Device& device, uint32_t code_bits)
        : codes(lab::make_kernel(device, "lbvh_codes", {kLbvhGroupSize, code_bits})),
          cuts(lab::make_kernel(device, "lbvh_cuts", {scalar::kBuildGroupSize, code_bits})),
          hierarchy(lab::make_kernel(device, "lbvh_hierarchy", {kLbvhGroupSize, code_bits})),
          split(lab::make_kernel(device, "heap_split", {kLbvhGroupSize, code_bits})) {}

    Kernel codes, cuts, hierarchy, split;
};

struct Kernels {
    explicit Kernels(const Device& device)
        : boxes(lab::make_kernel(device, "lbvh_boxes", {kLbvhGroupSize})),
          order(lab::make_kernel(device, "lbvh_order", {kLbvhGroupSize})),
          sums(lab::make_kernel(device, "lbvh_sums", {scalar::kBuildGroupSize})),
          numbers(lab::make_kernel(device, "lbvh_numbers", {scalar::kBuildGroupSize})),
          refit(lab::make_kernel(device, "lbvh_refit", {choose_refit_group_size(device)})),
          heap_refit(lab::make_kernel(device, "heap_refit", {kLbvhGroupSize})),
          sort(device),
          of_30_bits(device, 30),
          of_63_bits(device, 63) {}

    const CodeKernels& find(int code_bits) const { return code_bits == 30 ? of_30_bits : of_63_bits; }

    Kernel boxes, order, sums, numbers, refit, heap_refit;
    RadixSort sort;
    CodeKernels of_30_bits, of_63_bits;
};

/// What only a build needs, with room for `capacity` primitives.
struct Scratch {
    Scratch(const Device& device, uint64_t capacity, uint64_t histogram_words) : capacity(capacity) {
        const auto add = [&](uint32_t binding, const char* name, uint64_t bytes) {
            buffers.emplace(binding, Buffer(device, {name, bytes}));
        };
        add(scalar::kBindBuildBoxes, "primitive boxes", capacity * 24);
        add(scalar::kBindBuildCodes, "codes", capacity * 8);
        add(scalar::kBindPairs, "code pairs", capacity * 8);
        add(scalar::kBindSortedPairs, "sorted code pairs", capacity * 8);
        add(scalar::kBindHistogram, "code histogram", histogram_words * 4);
        add(scalar::kBindBuildNumbers, "cut numbers", (capacity + 1) * 4);
        add(scalar::kBindBuildSums, "cut sums", (capacity / scalar::kBuildTileSize + 1) * 4);
        add(scalar::kBindBuildArrivals, "arrivals", capacity * 4);
        add(scalar::kBindBuildHeights, "heights", capacity * 4);
        add(scalar::kBindBuildState, "build state", sizeof(scalar::BuildState));
    }

    const Buffer& state() const { return buffers.at(scalar::kBindBuildState); }

    uint64_t capacity;
    std::map<uint32_t, Buffer> buffers; ///< by their bindings
};

void bind_tree(BindingTable& bindings, const DeviceTree& tree) {
    bindings.clear(); // buffers of the last build may be gone
    bindings.bind(scalar::kBindBuildNodes, tree.nodes);
    bindings.bind(scalar::kBindBuildIds, tree.primitive_ids);
    bindings.bind(scalar::kBindBuildParents, tree.parents);
    bindings.bind(scalar::kBindBuildSkips, tree.skips);
}

} // namespace

double BuildReport::total_seconds() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }

double compute_least_build_bytes(const BuildReport& report) {
    const uint64_t code_bytes = report.code_bits == 63 ? 8 : 4, passes = code_bytes;
    const uint64_t box_bytes = 18, pair_bytes = code_bytes + 4;
    uint64_t bytes = box_bytes + (box_bytes + pair_bytes) + (passes * 2 * pair_bytes + code_bytes);
    bytes += report.heap_slots > 0 ? 32 + code_bytes : (20 + code_bytes) + 68 + 88;
    return double(report.primitive_count) * double(bytes) +
           double(report.heap_slots) * double(2 * sizeof(TreeNode));
}

double compute_bound_share(const BuildReport& report, double bandwidth) {
    return compute_least_build_bytes(report) / report.total_seconds() / bandwidth;
}

double measure_copy_bandwidth(const Device& device, uint64_t bytes) {
    constexpr int kRuns = 5;
    const Buffer from(device, {"copied from", bytes}), to(device, {"copied to", bytes});
    const BindingTable bindings(device);
    Commands commands(device, bindings);
    commands.begin_stage(Stage::copy);
    commands.fill(from, 0, bytes, 1);
    commands.run();
    double best = std::numeric_limits<double>::infinity();
    for (int run = 0; run < kRuns; ++run) {
        const double before = commands.stage_seconds()[size_t(Stage::copy)];
        commands.copy(from, 0, to, 0, bytes);
        commands.run();
        best = std::min(best, commands.stage_seconds()[size_t(Stage::copy)] - before);
    }
    return 2 * double(bytes) / best;
}

struct DeviceLbvhBuilder::Implementation {
    explicit Implementation(const Device& device)
        : device(device), kernels(device), bindings(device), commands(device, bindings) {}

    void begin(Part part) { commands.begin_stage(kStages[size_t(part)]); }
    void count_bytes(Part part, uint64_t bytes) { report.bytes[size_t(part)] += bytes; }
    void order_primitives(const DeviceMesh& mesh, int code_bits);
    void sort_codes(uint32_t count, int code_bits);
    void build_hierarchy(const scalar::BuildPush& push, const CodeKernels& of_codes);
    scalar::BuildState finish();

    const Device& device;
    Kernels kernels;
    BindingTable bindings;
    Commands commands;
    std::unique_ptr<Scratch> scratch = nullptr;
    BuildReport report = {};
    std::array<double, kStageCount> seconds_before = {};
};

/// Boxes, codes and their order.
void DeviceLbvhBuilder::Implementation::order_primitives(const DeviceMesh& mesh, int code_bits) {
    DCHECK(code_bits == 30 || code_bits == 63);
    const uint32_t count = mesh.triangle_count;
    if (!scratch || scratch->capacity < count)
        scratch = std::make_unique<Scratch>(device, count, kernels.sort.histogram_words(count));
    for (const auto& [binding, buffer] : scratch->buffers) bindings.bind(binding, buffer);
    bindings.bind(scalar::kBindMeshTriangles, mesh.triangles);
    bindings.bind(scalar::kBindMeshPositions, mesh.positions);
    report = {.primitive_count = count, .code_bits = code_bits};
    seconds_before = commands.stage_seconds();
    begin(Part::boxes);
    commands.fill(scratch->state(), 0, sizeof(scalar::BuildState), 0);
    commands.fill(scratch->state(), scalar::kBuildCountWord * 4, 4, count);
    commands.fill(scratch->state(), offsetof(scalar::BuildState, lower), 12, 0xffffffffu);
    const scalar::BuildPush push{count, 0, 0, 0};
    commands.dispatch(kernels.boxes, count, push);
    // A triangle is 64 bytes with its corners.
    count_bytes(Part::boxes, count * uint64_t(64 + 24));
    begin(Part::codes);
    commands.dispatch(kernels.find(code_bits).codes, count, push);
    count_bytes(Part::codes, count * uint64_t(code_bits == 63 ? 40 : 32));
    begin(Part::sort);
    sort_codes(count, code_bits);
}

void DeviceLbvhBuilder::Implementation::sort_codes(uint32_t count, int code_bits) {
    const auto sort = [&](uint32_t key_bits) {
        kernels.sort.record(commands, count, key_bits, scalar::kBuildCountWord);
        count_bytes(Part::sort, uint64_t(count) * 24 * RadixSort::count_passes(key_bits));
    };
    sort(code_bits == 63 ? 32 : 30);
    if (code_bits == 30) return;
    commands.dispatch(kernels.order, count, scalar::BuildPush{count, 0, 0, 0});
    sort(31);
    commands.dispatch(kernels.order, count, scalar::BuildPush{count, 0, 0, 1});
    count_bytes(Part::sort, uint64_t(count) * (20 + 20));
}

void DeviceLbvhBuilder::Implementation::build_hierarchy(const scalar::BuildPush& push,
                                                        const CodeKernels& of_codes) {
    const uint64_t count = push.primitive_count;
    const uint64_t in_tiles =
        (count + scalar::kBuildTileSize - 1) / scalar::kBuildTileSize * scalar::kBuildGroupSize;
    begin(Part::hierarchy);
    commands.dispatch(of_codes.cuts, in_tiles, push);
    commands.dispatch(kernels.sums, scalar::kBuildGroupSize, push);
    commands.dispatch(kernels.numbers, in_tiles, push);
    commands.dispatch(of_codes.hierarchy, count, push);
    begin(Part::refit);
    commands.fill(scratch->buffers.at(scalar::kBindBuildArrivals), 0, count * 4, 0);
    commands.dispatch(kernels.refit, count, push);
}

/// Runs what was recorded.
scalar::BuildState DeviceLbvhBuilder::Implementation::finish() {
    commands.run();
    for (size_t part = 0; part < BuildReport::kPartCount; ++part) {
        const size_t stage = size_t(kStages[part]);
        report.seconds[part] = commands.stage_seconds()[stage] - seconds_before[stage];
    }
    const scalar::BuildState state = scratch->state().download<scalar::BuildState>(1).front();
    // A compact tree whose root was not reached has no depth.
    if (state.loops_ended > 0 || (state.cut_count > 0 && state.depth == 0))
        throw Error(ErrorKind::failed, {"the device ended a loop over the primitives of a leaf early",
                                        device.description().name, "build smaller leaves, or on the host"});
    return state;
}

DeviceLbvhBuilder::DeviceLbvhBuilder(const Device& device)
    : implementation_(std::make_unique<Implementation>(device)) {}
DeviceLbvhBuilder::~DeviceLbvhBuilder() = default;

DeviceTree DeviceLbvhBuilder::build(const DeviceMesh& mesh, const LbvhBuilder::Config& config) {
    DCHECK(config.max_leaf_size >= 1 && config.max_leaf_size <= scalar::kNodeCountMask);
    Implementation& own = *implementation_;
    check_primitive_count(mesh.triangle_count, kMostPrimitives, "linear BVH on the device", kTooManyHint);
    const uint64_t count = mesh.triangle_count, nodes = count > 0 ? 2 * count - 1 : 0;
    DeviceTree tree =
        make_device_tree(own.device, TreeForm::linked,
                         {.nodes = nodes, .primitive_ids = count, .parents = nodes, .skips = nodes});
    own.report = {};
    if (count == 0) return tree;
    bind_tree(own.bindings, tree);
    own.order_primitives(mesh, config.code_bits);
    own.build_hierarchy({mesh.triangle_count, config.max_leaf_size, 0, 0},
                        own.kernels.find(config.code_bits));
    const scalar::BuildState state = own.finish();
    tree.node_count = 1 + 2 * state.cut_count;
    tree.depth = int(state.depth);
    const uint64_t code_bytes = config.code_bits == 63 ? 8 : 4;
    own.count_bytes(Part::hierarchy, count * (2 * code_bytes + 4 + 4 * 4) + tree.node_count * uint64_t(40));
    own.count_bytes(Part::refit, count * (4 + 24 + 4) + tree.node_count * uint64_t(32 + 24 + 24 + 8));
    return tree;
}

DeviceTree DeviceLbvhBuilder::build_heap(const DeviceMesh& mesh, const LbvhBuilder::HeapConfig& config) {
    DCHECK(config.levels >= 0 && config.levels <= DenseHeap::kMaxLevels);
    Implementation& own = *implementation_;
    check_primitive_count(mesh.triangle_count, scalar::kNodeCountMask, "linear BVH as a heap on the device",
                          kTooManyHint);
    const uint32_t count = mesh.triangle_count;
    const int levels = config.levels > 0 ? config.levels : choose_heap_levels(count);
    const uint64_t slots = count > 0 ? uint64_t(1) << levels : 0;
    DeviceTree tree =
        make_device_tree(own.device, TreeForm::dense_heap, {.nodes = slots, .primitive_ids = count});
    own.report = {};
    if (count == 0) return tree;
    bind_tree(own.bindings, tree);
    own.order_primitives(mesh, config.code_bits);
    own.report.heap_slots = slots;
    own.begin(Part::hierarchy);
    const Kernel& split = own.kernels.find(config.code_bits).split;
    own.commands.dispatch(split, count, scalar::BuildPush{count, 0, 0, 0});
    for (uint32_t level = 1; level < uint32_t(levels); ++level)
        own.commands.dispatch(split, uint64_t(1) << (level - 1), scalar::BuildPush{count, 0, level, 0});
    own.begin(Part::refit);
    for (uint32_t level = uint32_t(levels); level-- > 0;)
        own.commands.dispatch(own.kernels.heap_refit, uint64_t(1) << level,
                              scalar::BuildPush{count, 0, level, 0});
    tree.depth = int(own.finish().depth);
    tree.node_count = uint32_t(slots);
    own.count_bytes(Part::hierarchy, count * uint64_t(16) + slots * (32 + 16));
    own.count_bytes(Part::refit, count * uint64_t(32) + slots * 16);
    return tree;
}

const BuildReport& DeviceLbvhBuilder::report() const { return implementation_->report; }

} // namespace relief::vulkan
