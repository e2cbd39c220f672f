#include "lab/vulkan/tree_tracer.h"

#include <fmt/format.h>

#include "base/check.h"
#include "formulas/tree.h"
#include "lab/vulkan/lab_shaders.h"
#include "lab/walks/trail.h"
#include "relief/error.h"
#include "vulkan/layout/device_trees.h"

namespace relief::vulkan {
namespace {

constexpr uint32_t kWalkGroupSize = 64;

bool is_heap(const DeviceTree& tree) {
    return tree.form == TreeForm::dense_heap || tree.form == TreeForm::succinct_heap;
}

void check_query(const DeviceTree& tree, const TreeQuery& query, WalkStart start) {
    const auto refuse = [](const char* message, const char* hint) {
        throw Error(ErrorKind::usage, {message, "tree traversal", hint});
    };
    if (!can_walk(query.traversal, tree))
        refuse("the traversal does not walk trees of this form", "choose another tree or traversal");
    if (start == WalkStart::last_leaf && !is_heap(tree))
        refuse("only walks of heaps start at a leaf", "choose a heap and one of its trails");
    const bool is_trail = query.traversal == TraversalKind::restart_trail || is_heap(tree);
    if (is_trail && tree.depth > int(scalar::kTrailLevels64))
        refuse("the tree is too deep for a trail of 64 bits", "give the builder a smaller greatest depth");
    if (query.traversal == TraversalKind::stack && tree.depth >= int(scalar::kTreeStackSize))
        refuse("the tree is too deep for the stack", "give the builder a smaller greatest depth");
}

scalar::WalkPush make_push(const DeviceTree& tree, uint32_t ray_count, const TreeQuery& query,
                           WalkStart start) {
    scalar::WalkPush push{};
    push.ray_count = ray_count;
    const bool is_empty = tree.node_count == 0;
    push.root = is_heap(tree) ? (is_empty ? 0u : 1u) : (is_empty ? scalar::kNoNode : 0u);
    push.is_any = query.kind == HitKind::any;
    push.has_start_keys = push.has_leaf_keys = start == WalkStart::last_leaf;
    push.flat_levels = tree.heap_form.flat_levels;
    push.flat_pairs = tree.heap_form.flat_pairs;
    push.cell_lower = tree.bounds.lower;
    push.cell_upper = tree.bounds.upper;
    return push;
}

} // namespace

TreeRays::TreeRays(const Device& device, uint32_t capacity)
    : capacity(capacity),
      rays(device, {"tree rays", capacity * sizeof(scalar::TreeRay)}),
      hits(device, {"tree hits", capacity * sizeof(scalar::TreeHit)}),
      start_keys(device, {"start keys", capacity * sizeof(scalar::HeapKey)}),
      leaf_keys(device, {"leaf keys", capacity * sizeof(scalar::HeapKey)}),
      counts(device, {"ray counts", capacity * sizeof(scalar::RayCounts)}) {}

TreeTracer::TreeTracer(const Device& device)
    : device_(device),
      bindings_(device),
      commands_(device, bindings_),
      state_(device, {.name = "walk state", .bytes = sizeof(scalar::WalkState), .is_host_visible = true}) {}

const Kernel& TreeTracer::find_kernel(const DeviceTree& tree, const TreeQuery& query) {
    const uint32_t is_counting = query.counting == Counting::on;
    const uint32_t is_succinct = tree.form == TreeForm::succinct_heap;
    const std::string shader = name_walk("tree_walk", query.traversal, tree.depth);
    const std::string name = fmt::format("{} {} {}", shader, is_counting, is_succinct);
    const auto found = kernels_.find(name);
    if (found != kernels_.end()) return found->second;
    return kernels_
        .emplace(name, lab::make_kernel(device_, shader, {kWalkGroupSize, is_counting, is_succinct}))
        .first->second;
}

void TreeTracer::bind(const DeviceTree& tree, const DeviceMesh& mesh, const TreeRays& rays) {
    using namespace scalar;
    bindings_.clear(); // buffers of the last trace may be gone
    bindings_.bind(kBindTreeRays, rays.rays);
    bindings_.bind(kBindTreeHits, rays.hits);
    bindings_.bind(kBindStartKeys, rays.start_keys);
    bindings_.bind(kBindLeafKeys, rays.leaf_keys);
    bindings_.bind(kBindWalkCounts, rays.counts);
    bindings_.bind(kBindWalkState, state_);
    bindings_.bind(kBindHeapBlocks, tree.blocks);
    bindings_.bind(kBindHeapBricks, tree.bricks);
    bindings_.bind(tree.form == TreeForm::kd ? kBindKdNodes : kBindTreeNodes, tree.nodes);
    bindings_.bind(kBindTreeParents, tree.parents);
    bindings_.bind(kBindTreeSkips, tree.skips);
    bindings_.bind(kBindKdBoxes, tree.cells);
    bindings_.bind(kBindTreeIds, tree.primitive_ids);
    bindings_.bind(kBindMeshTriangles, mesh.triangles);
    bindings_.bind(kBindMeshPositions, mesh.positions);
}

void TreeTracer::trace(const DeviceTree& tree, const DeviceMesh& mesh, TreeRays& rays, uint32_t ray_count,
                       const TreeQuery& query, WalkStart start) {
    DCHECK(ray_count <= rays.capacity);
    check_query(tree, query, start);
    bind(tree, mesh, rays);
    const Kernel& kernel = find_kernel(tree, query);
    commands_.begin_stage(Stage::tree_walk);
    commands_.fill(state_, 0, sizeof(scalar::WalkState), 0);
    const double before = commands_.stage_seconds()[size_t(Stage::tree_walk)];
    commands_.dispatch(kernel, ray_count, make_push(tree, ray_count, query, start));
    commands_.run();
    seconds_ = commands_.stage_seconds()[size_t(Stage::tree_walk)] - before;
    const uint32_t lost = static_cast<const scalar::WalkState*>(state_.mapped())->rays_lost;
    if (lost > 0)
        throw Error(ErrorKind::failed,
                    {fmt::format("the device ended the walks of {} of {} rays early", lost, ray_count),
                     device_.description().name, "choose another traversal, or a tree of smaller leaves"});
}

} // namespace relief::vulkan
