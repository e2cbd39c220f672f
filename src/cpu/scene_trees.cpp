#include "cpu/scene_trees.h"

#include <algorithm>
#include <new>

#include "prepare/scene_trees.h"

namespace relief::cpu {

namespace {

/// A vertex takes some 10 ns, smaller boxes spare a ray some 40: it pays from a quarter of a ray a vertex.
/// Eight times that, so that pictures of a sample or two do not pay for what they have little of.
constexpr int64_t kRaysPerVertex = 2;

/// Of a refitted tree to the one that was built: above it, it is built anew.
constexpr double kMostGrowth = 1.5;

/// Of all nodes: rays visit a node as often as its area says (Goldsmith and Salmon 1987).
double sum_areas(const WideBvh& tree) {
    double sum = 0;
    for (const WideNode& node : tree.nodes)
        for (int k = 0; k < node.child_count; ++k)
            if (!WideNode::is_leaf(node.child[k])) sum += double(node.child_box(k).half_area());
    return sum;
}

} // namespace

size_t SceneTrees::byte_count() const {
    size_t count = instances.byte_count();
    for (const WideBvh& tree : surfaces) count += tree.byte_count();
    return count;
}

SceneTreeHolder::SceneTreeHolder(const PreparedScene& scene, const Kernels& kernels,
                                 std::span<const PolygonTree> polygon_trees)
    : scene_(scene), kernels_(kernels), polygon_trees_(polygon_trees) {
    start();
}

void SceneTreeHolder::start() {
    rays_to_come_ =
        kRaysPerVertex * int64_t(PatchBoxes(scene_, kernels_, BoxSource::vertices).count_vertices());
    is_improved_ = rays_to_come_ == 0;
    trees_ = make_trees(BoxSource::bounds);
}

void SceneTreeHolder::follow_levels() {
    if (trees_->source != BoxSource::vertices) return;
    const auto is_same = [&](const Instance& instance, const std::shared_ptr<const LevelField>& levels) {
        return instance.levels == levels || *instance.levels == *levels;
    };
    if (!std::ranges::equal(scene_.instances, trees_->levels, is_same)) start();
}

bool SceneTreeHolder::is_mostly_changed(std::span<const SurfaceChange> changes) const {
    size_t all = 0, changed = 0;
    for (const Surface& surface : scene_.surfaces)
        if (surface.has_displacement) all += surface.patch_count();
    for (const SurfaceChange& change : changes)
        changed += change.is_replaced ? scene_.surfaces[change.surface].patch_count()
                                      : size_t(std::ranges::count(change.is_changed, 1));
    return 2 * changed > all;
}

void SceneTreeHolder::change_scene(std::span<const SurfaceChange> changes) {
    follow_levels();
    // Boxes of vertices take as long as building what is inside; perhaps few rays come before the next
    // change.
    if (trees_->source == BoxSource::vertices && is_mostly_changed(changes)) return start();
    const PatchBoxes boxes(scene_, kernels_, trees_->source);
    for (const SurfaceChange& change : changes) {
        if (!scene_.surfaces[change.surface].has_displacement) continue;
        WideBvh& tree = trees_->surfaces[change.surface];
        if (!change.is_replaced)
            refit_wide_bvh(tree, change.is_changed,
                           [&](uint32_t patch) { return boxes.find(change.surface, patch); });
        if (change.is_replaced || sum_areas(tree) > kMostGrowth * trees_->areas[change.surface]) {
            tree = make_surface_tree(change.surface, boxes);
            trees_->areas[change.surface] = sum_areas(tree);
        }
    }
    trees_->instances = make_instance_tree(trees_->surfaces);
}

WideBvh SceneTreeHolder::make_surface_tree(uint32_t surface, const PatchBoxes& boxes) const {
    if (!scene_.surfaces[surface].has_displacement) return {};
    return make_wide_bvh(build_surface_bvh(scene_.surfaces[surface], boxes.find_all(surface)));
}

std::shared_ptr<const SceneTrees> SceneTreeHolder::current() const {
    const std::lock_guard lock(mutex_);
    return trees_;
}

void SceneTreeHolder::rebuild_if_worthwhile() {
    if (rays_to_come_.load(std::memory_order_relaxed) > 0 || is_improved_.exchange(true)) return;
    std::shared_ptr<SceneTrees> trees;
    try {
        trees = make_trees(BoxSource::vertices);
    } catch (const std::bad_alloc&) {
        return; // the trees that there are serve as well
    }
    const std::lock_guard lock(mutex_);
    trees_.swap(trees);
}

void SceneTreeHolder::apply_changes(std::span<const SurfaceChange> changes, std::vector<Box>& places) {
    const PatchBoxes boxes(scene_, kernels_, trees_->source);
    for (const SurfaceChange& change : changes) {
        WideBvh& tree = trees_->surfaces[change.surface];
        add_places(change, tree, places);
        refit_wide_bvh(tree, change.is_changed,
                       [&](uint32_t patch) { return boxes.find(change.surface, patch); });
        add_places(change, tree, places);
    }
    trees_->instances = make_instance_tree(trees_->surfaces);
}

std::shared_ptr<SceneTrees> SceneTreeHolder::make_trees(BoxSource source) const {
    auto trees = std::make_shared<SceneTrees>();
    trees->source = source;
    const PatchBoxes boxes(scene_, kernels_, source);
    for (uint32_t k = 0; k < scene_.surfaces.size(); ++k) {
        trees->surfaces.push_back(make_surface_tree(k, boxes));
        trees->areas.push_back(sum_areas(trees->surfaces.back()));
    }
    for (const Instance& instance : scene_.instances) trees->levels.push_back(instance.levels);
    trees->instances = make_instance_tree(trees->surfaces);
    return trees;
}

WideBvh SceneTreeHolder::make_instance_tree(std::span<const WideBvh> surfaces) const {
    std::vector<Box> boxes;
    for (size_t k = 0; k < scene_.surfaces.size(); ++k)
        boxes.push_back(scene_.surfaces[k].has_displacement ? surfaces[k].bounds : polygon_trees_[k].bounds);
    return make_wide_bvh(build_instance_bvh(scene_, boxes));
}

/// Boxes of what looks different, in all its instances.
void SceneTreeHolder::add_places(const SurfaceChange& change, const WideBvh& tree,
                                 std::vector<Box>& places) const {
    for (const WideNode& node : tree.nodes)
        for (int k = 0; k < node.child_count; ++k) {
            if (!WideNode::is_leaf(node.child[k])) continue;
            if (!change.looks_different[tree.primitive_at(WideNode::leaf_first(node.child[k]))]) continue;
            for (const Instance& instance : scene_.instances)
                if (instance.surface == change.surface)
                    places.push_back(transform_box(instance.world_from_object, node.child_box(k)));
        }
}

} // namespace relief::cpu
