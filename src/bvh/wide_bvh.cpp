#include "bvh/wide_bvh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"

namespace relief {

namespace {

/// Largest code that decodes to `value` or less; the origin itself is never above it.
uint8_t encode_lower(float value, float origin, float scale) {
    const double code = std::floor((double(value) - origin) / scale);
    int result = int(std::clamp(code, 0.0, 255.0));
    while (result > 0 && WideNode::decode(origin, scale, uint8_t(result)) > value) --result;
    return uint8_t(result);
}

/// Smallest code that decodes to `value` or more; find_exponent ensures that 255 does.
uint8_t encode_upper(float value, float origin, float scale) {
    const double code = std::ceil((double(value) - origin) / scale);
    int result = int(std::clamp(code, 0.0, 255.0));
    while (result < 255 && WideNode::decode(origin, scale, uint8_t(result)) < value) ++result;
    return uint8_t(result);
}

/// Smallest exponent whose code 255 reaches `upper` and lies above `origin`, so that unused slots stay empty.
int find_exponent(float origin, float upper) {
    const double step = (double(upper) - origin) / 255;
    int exponent = step > 0 ? std::clamp(std::ilogb(step), -126, 127) : -126;
    // 255 steps of 2^-33 times the origin are below half a unit in its last place: smaller ones do nothing.
    if (origin != 0) exponent = std::max(exponent, std::ilogb(origin) - 33);
    const auto reach = [&] { return WideNode::decode(origin, WideNode::decode_scale(exponent), 255); };
    while (exponent < 127 && !(reach() >= upper && reach() > origin)) ++exponent;
    return exponent;
}

/// `bounds` holds the first `node.child_count` boxes; sets origin, exponents and codes, rounded outward.
void encode_boxes(WideNode& node, const Box& bounds, const std::array<Box, 8>& boxes) {
    for (int axis = 0; axis < 3; ++axis) {
        const float origin = get_component(bounds.lower, axis);
        const int exponent = find_exponent(origin, get_component(bounds.upper, axis));
        const float scale = WideNode::decode_scale(exponent);
        node.origin[axis] = origin;
        node.exponent[axis] = int8_t(exponent);
        for (int k = 0; k < WideNode::kMaxChildCount; ++k) {
            const bool is_used = k < node.child_count;
            node.planes[axis][k] =
                is_used ? encode_lower(get_component(boxes[k].lower, axis), origin, scale) : 255;
            node.planes[3 + axis][k] =
                is_used ? encode_upper(get_component(boxes[k].upper, axis), origin, scale) : 0;
        }
    }
}

WideNode encode_node(const WideNodeParts& parts) {
    WideNode node{};
    node.child_count = uint8_t(parts.count);
    std::copy(parts.child.begin(), parts.child.end(), node.child);
    encode_boxes(node, parts.bounds, parts.boxes);
    return node;
}

bool has_moved_leaf(const WideBvh& tree, const WideNode& node, std::span<const uint8_t> is_moved) {
    for (int k = 0; k < node.child_count; ++k)
        if (WideNode::is_leaf(node.child[k]) &&
            is_moved[tree.primitive_at(WideNode::leaf_first(node.child[k]))])
            return true;
    return false;
}

Box join_children(const WideNode& node) {
    Box box;
    for (int k = 0; k < node.child_count; ++k) box.extend(node.child_box(k));
    return box;
}

/// New boxes of a node's leaves: of all, since codes rounded over and over would grow.
std::array<Box, 8> find_leaf_boxes(const WideBvh& tree, const WideNode& node,
                                   const std::function<Box(uint32_t)>& find_box) {
    std::array<Box, 8> boxes;
    for (int k = 0; k < node.child_count; ++k)
        if (WideNode::is_leaf(node.child[k]))
            boxes[k] = find_box(tree.primitive_at(WideNode::leaf_first(node.child[k])));
    return boxes;
}

} // namespace

WideBvh make_wide_bvh(const Bvh& bvh) {
    if (bvh.nodes.empty()) return {};
    check_primitive_count(
        bvh.primitive_ids.size(), uint64_t(WideNode::kMaxLeafFirst) + 1, "wide BVH",
        "choose a traversal that walks the binary tree, or split the scene into instances of several meshes");
    WideBvh wide;
    wide.bounds = bvh.nodes[0].box();
    const bool has_single_leaves = std::all_of(bvh.nodes.begin(), bvh.nodes.end(),
                                               [](const BvhNode& node) { return node.primitive_count <= 1; });
    if (!has_single_leaves) wide.primitive_ids = bvh.primitive_ids;
    const auto make_leaf = [&](const BvhNode& leaf) {
        const uint32_t first = has_single_leaves ? bvh.primitive_ids[leaf.first] : leaf.first;
        return WideNode::make_leaf(first, leaf.primitive_count);
    };
    make_wide_nodes(bvh, WideCollapse(bvh), wide.nodes, make_leaf, encode_node);
    return wide;
}

void refit_wide_bvh(WideBvh& tree, std::span<const uint8_t> is_moved,
                    const std::function<Box(uint32_t primitive)>& find_box) {
    // Children lie behind their parents, so that going backwards meets them first.
    std::vector<uint8_t> has_changed(tree.nodes.size());
    std::vector<uint32_t> changed;
    for (size_t index = tree.nodes.size(); index-- > 0;) {
        const WideNode& node = tree.nodes[index];
        has_changed[index] = has_moved_leaf(tree, node, is_moved);
        for (int k = 0; k < node.child_count; ++k) {
            DCHECK(WideNode::is_leaf(node.child[k]) || node.child[k] > index);
            if (!WideNode::is_leaf(node.child[k])) has_changed[index] |= has_changed[node.child[k]];
        }
        if (has_changed[index]) changed.push_back(uint32_t(index));
    }
    std::vector<std::array<Box, 8>> boxes(changed.size());
    parallel_for("boxes of a refit", changed.size(), 4, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k)
            boxes[k] = find_leaf_boxes(tree, tree.nodes[changed[k]], find_box);
    });
    Box bounds = tree.bounds;
    for (size_t at = 0; at < changed.size(); ++at) {
        WideNode& node = tree.nodes[changed[at]];
        bounds = {};
        for (int k = 0; k < node.child_count; ++k) {
            if (!WideNode::is_leaf(node.child[k])) boxes[at][k] = join_children(tree.nodes[node.child[k]]);
            bounds.extend(boxes[at][k]);
        }
        encode_boxes(node, bounds, boxes[at]);
    }
    tree.bounds = bounds; // the root is the last one
}

} // namespace relief
