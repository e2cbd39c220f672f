// The boxes of nodes, and one ray against them.
#pragma once

#include "bvh/wide_bvh.h"
#include "cpu/traversal/ray-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

// The forms that nodes have their boxes in, lower x y z, upper x y z: floats, or bytes (WideNode) by the
// decoder that the builder checked with. load_plane gives a row of them, get_plane one number, mask_children
// the slots that rays may enter: empty boxes of floats they miss.

template <size_t W> RELIEF_INLINE Lanes<W> load_plane(const float (&bounds)[6][W], int plane, int) {
    return Lanes<W>::load(bounds[plane]);
}
template <size_t W> RELIEF_INLINE float get_plane(const float (&bounds)[6][W], int plane, int, uint32_t k) {
    return bounds[plane][k];
}
template <size_t W> RELIEF_INLINE LaneMask mask_children(const float (&)[6][W]) { return (1u << W) - 1; }

RELIEF_INLINE Lanes8 load_plane(const cpu::PolygonNode& node, int plane, int) {
    return Lanes8::load(node.bounds[plane]);
}
RELIEF_INLINE float get_plane(const cpu::PolygonNode& node, int plane, int, uint32_t k) {
    return node.bounds[plane][k];
}
RELIEF_INLINE LaneMask mask_children(const cpu::PolygonNode&) { return 0xff; }

RELIEF_INLINE Lanes8 load_plane(const WideNode& node, int plane, int axis) {
    return Lanes8::decode(node.planes[plane], node.origin[axis], WideNode::decode_scale(node.exponent[axis]));
}
RELIEF_INLINE float get_plane(const WideNode& node, int plane, int axis, uint32_t k) {
    return WideNode::decode(node.origin[axis], WideNode::decode_scale(node.exponent[axis]),
                            node.planes[plane][k]);
}
RELIEF_INLINE LaneMask mask_children(const WideNode& node) { return (1u << node.child_count) - 1; }

/// Entry distances and mask of a node's boxes met in [t_min, t_max]; near planes are known before loading.
template <class Node, size_t W>
RELIEF_INLINE LaneMask test_node(const Node& node, const RayState& ray, Lanes<W>& entry) {
    Lanes<W> near[3], far[3];
    for (int k = 0; k < 3; ++k) {
        const Lanes<W> reciprocal(ray.reciprocal[k]);
        near[k] = (load_plane(node, ray.near_plane[k], k) - Lanes<W>(ray.near_origin[k])) * reciprocal;
        far[k] = (load_plane(node, ray.far_plane[k], k) - Lanes<W>(ray.far_origin[k])) * reciprocal;
    }
    entry = max(max(near[0], near[1]), max(near[2], Lanes<W>(ray.t_min)));
    const Lanes<W> exit = min(min(far[0], far[1]), min(far[2], Lanes<W>(ray.t_max)));
    return less_equal(entry, exit * Lanes<W>(kBoxSlack)) & mask_children(node);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
