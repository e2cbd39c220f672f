// Hooks of formulas/tree.h for kd-trees. Included by tree_walk.glsl.
layout(set = 0, binding = kBindKdNodes) uniform usamplerBuffer kd_nodes;

KdNode load_kd_node(const uint node) {
    uvec2 data = texelFetch(kd_nodes, int(node)).xy;
    return KdNode(data.x, data.y);
}

layout(set = 0, binding = kBindKdBoxes) uniform usamplerBuffer kd_boxes;
KdBox load_kd_box(const uint node) {
    uvec4 low = texelFetch(kd_boxes, int(2u * node));
    uvec4 high = texelFetch(kd_boxes, int(2u * node + 1u));
    return KdBox(uintBitsToFloat(low.xyz), low.w, uintBitsToFloat(high.xyz), high.w);
}

KdRay enter_root_cell() {
    return make_kd_ray(walk_ray, push.cell_lower, push.cell_upper, walk_t_min, walk_best.t);
}
