// Trees of given shapes whose boxes a ray meets or misses as wanted, and the recursive walks that all others
// are compared with.
#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "bvh/tree_links.h"
#include "formulas/object_ray.h"
#include "formulas/tree.h"
#include "lab/trees/heap_tree.h"
#include "lab/walks/walks.h"

namespace relief::test {

/// A binary tree: children of node k are children[k] and children[k] + 1, 0: leaf.
struct Shape {
    std::vector<uint32_t> children{0};

    uint32_t split(uint32_t node) {
        children[node] = uint32_t(children.size());
        children.resize(children.size() + 2, 0);
        return children[node];
    }
};

/// All shapes of at most `depth` levels below the root: 1, 2, 5, 26, 677 of them.
inline std::vector<Shape> make_all_shapes(int depth) {
    std::vector<Shape> shapes{Shape{}};
    if (depth == 0) return shapes;
    const std::vector<Shape> parts = make_all_shapes(depth - 1);
    const auto graft = [](Shape& shape, uint32_t place, const Shape& part) {
        std::vector<std::pair<uint32_t, uint32_t>> pending{{place, 0}};
        while (!pending.empty()) {
            const auto [to, from] = pending.back();
            pending.pop_back();
            if (part.children[from] == 0) continue;
            const uint32_t first = shape.split(to);
            pending.push_back({first, part.children[from]});
            pending.push_back({first + 1, part.children[from] + 1});
        }
    };
    for (const Shape& left : parts)
        for (const Shape& right : parts) {
            Shape shape;
            shape.split(0);
            graft(shape, 1, left);
            graft(shape, 2, right);
            shapes.push_back(std::move(shape));
        }
    return shapes;
}

/// Splits leaves above `depth` with the given probability, at most about `count` nodes; from the last of them
/// a chain reaches down to `depth`.
inline Shape make_random_shape(std::mt19937& random, int depth, double probability, size_t count) {
    Shape shape;
    std::vector<std::pair<uint32_t, int>> pending{{0, 0}};
    std::uniform_real_distribution<double> unit(0, 1);
    for (size_t k = 0; k < pending.size(); ++k) {
        const auto [node, level] = pending[k];
        if (level == depth || shape.children.size() >= count || unit(random) > probability) continue;
        const uint32_t first = shape.split(node);
        pending.push_back({first, level + 1});
        pending.push_back({first + 1, level + 1});
    }
    auto [node, level] = pending.back();
    for (; level < depth; ++level) node = shape.split(node) + random() % 2;
    return shape;
}

/// Every inner node has a leaf and an inner child, down to `depth`; bit k of `sides` says which on level k.
inline Shape make_chain(int depth, uint64_t sides) {
    Shape shape;
    uint32_t node = 0;
    for (int level = 0; level < depth; ++level) node = shape.split(node) + ((sides >> level) & 1u);
    return shape;
}

/// The ray goes along x, and a little along y and z, so that each axis has a sign.
struct SyntheticRay {
    Vec3f direction;
    BoxRay ray() const { return {{0, 0, 0}, direction}; }
};

inline SyntheticRay make_synthetic_ray(uint32_t signs) {
    return {{signs & 1u ? -1.0f : 1.0f, signs & 2u ? -1e-6f : 1e-6f, signs & 4u ? -1e-6f : 1e-6f}};
}

/// The ray enters the box of a node at a random whole distance, not before that of its parent, or misses it.
inline Bvh make_synthetic_bvh(const Shape& shape, std::mt19937& random, const SyntheticRay& ray,
                              double miss_probability) {
    Bvh bvh;
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<float> entries(shape.children.size(), 1);
    for (size_t k = 0; k < shape.children.size(); ++k) {
        const uint32_t first = shape.children[k];
        const float side = unit(random) < miss_probability ? 100.0f : 0.0f;
        const float from = ray.direction.x * entries[k], to = ray.direction.x * 300;
        BvhNode node;
        node.lower = {std::min(from, to), side - 1, -1};
        node.upper = {std::max(from, to), side + 1, 1};
        if (first > 0) entries[first] = entries[k] + float(random() % 3);
        if (first > 0) entries[first + 1] = entries[k] + float(random() % 3);
        if (first > 0) {
            node.first = first;
        } else {
            node.first = uint32_t(bvh.primitive_ids.size());
            node.primitive_count = 1;
            bvh.primitive_ids.push_back(node.first);
        }
        bvh.nodes.push_back(node);
    }
    return bvh;
}

inline std::vector<uint8_t> make_random_axes(const Bvh& bvh, std::mt19937& random) {
    std::vector<uint8_t> axes;
    for (const BvhNode& node : bvh.nodes) axes.push_back(node.is_leaf() ? 0 : uint8_t(random() % 3));
    return axes;
}

/// How a walk orders the children of a node.
enum class Order { distance, axis, left };

/// The leaves of a tree in the order of recursion. A leaf may shorten the ray: `limits` has a new t_max for
/// each primitive, which counts if it is less.
class RecursiveWalk {
  public:
    RecursiveWalk(const LinkedBvh& tree, const BoxRay& ray, const std::vector<float>& limits, Order order)
        : tree_(tree),
          ray_(ray),
          object_ray_(scalar::make_object_ray(ray.origin, ray.direction)),
          limits_(limits),
          order_(order) {}

    std::vector<uint32_t> run() {
        if (!tree_.nodes.empty()) visit(0);
        return leaves_;
    }

  private:
    float enter(uint32_t node) const {
        return scalar::cross_node(object_ray_, tree_.nodes[node], ray_.t_min, ray_.t_max);
    }

    void visit(uint32_t index) {
        const TreeNode& node = tree_.nodes[index];
        if (enter(index) == std::numeric_limits<float>::infinity()) return;
        if (scalar::is_leaf_word(node.word)) {
            const uint32_t id = tree_.primitive_ids[node.first];
            leaves_.push_back(id);
            ray_.t_max = std::min(ray_.t_max, limits_[id]);
            return;
        }
        bool is_right_first = false;
        if (order_ == Order::distance) is_right_first = enter(node.first + 1) < enter(node.first);
        if (order_ == Order::axis)
            is_right_first = get_component(ray_.direction, int(scalar::get_word_axis(node.word))) < 0;
        visit(node.first + (is_right_first ? 1 : 0));
        visit(node.first + (is_right_first ? 0 : 1));
    }

    const LinkedBvh& tree_;
    BoxRay ray_;
    scalar::ObjectRay object_ray_;
    const std::vector<float>& limits_;
    Order order_;
    std::vector<uint32_t> leaves_;
};

} // namespace relief::test
