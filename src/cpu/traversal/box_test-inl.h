// One ray against the boxes of a node.
#if defined(RELIEF_BOX_TEST_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_BOX_TEST_INL_H
#undef RELIEF_BOX_TEST_INL_H
#else
#define RELIEF_BOX_TEST_INL_H
#endif

#include "cpu/traversal/ray-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Entry distances of W boxes and the mask of those met in [t_min, t_max]. load(plane, axis) gives a plane of
/// the boxes, 0 to 2 lower and 3 to 5 upper: which one is near is known before it is loaded.
template <size_t W, class Load>
HWY_INLINE LaneMask test_planes(Load load, const RayState& ray, Lanes<W>& entry) {
    Lanes<W> near[3], far[3];
    for (int k = 0; k < 3; ++k) {
        const Lanes<W> reciprocal(ray.reciprocal[k]);
        near[k] = (load(ray.near_plane[k], k) - Lanes<W>(ray.near_origin[k])) * reciprocal;
        far[k] = (load(ray.far_plane[k], k) - Lanes<W>(ray.far_origin[k])) * reciprocal;
    }
    entry = max(max(near[0], near[1]), max(near[2], Lanes<W>(ray.t_min)));
    const Lanes<W> exit = min(min(far[0], far[1]), min(far[2], Lanes<W>(ray.t_max)));
    return less_equal(entry, exit * Lanes<W>(kBoxSlack));
}

/// The boxes of a node, lower x y z, upper x y z.
template <size_t W>
HWY_INLINE LaneMask test_node(const float (&bounds)[6][W], const RayState& ray, Lanes<W>& entry) {
    return test_planes([&](int plane, int) { return Lanes<W>::load(bounds[plane]); }, ray, entry);
}

/// The children of a quantised node, by the decoder that the builder checked with.
HWY_INLINE LaneMask test_node(const WideNode& node, const RayState& ray, Lanes8& entry) {
    const auto load = [&](int plane, int axis) {
        return Lanes8::decode(node.planes[plane], node.origin[axis],
                              WideNode::decode_scale(node.exponent[axis]));
    };
    return test_planes(load, ray, entry) & ((1u << node.child_count) - 1);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
