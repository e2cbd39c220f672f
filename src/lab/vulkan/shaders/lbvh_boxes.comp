// The box of each triangle, and the union of all.
#include "vulkan/shaders/kernel.glsl"
#include "lab/vulkan/shaders/lbvh.glsl"

layout(set = 0, binding = kBindMeshTriangles) uniform usamplerBuffer mesh_triangles;
layout(set = 0, binding = kBindMeshPositions) uniform samplerBuffer mesh_positions;

shared uint group_lower[3];
shared uint group_upper[3];

NodeBox find_triangle_box(const uint triangle) {
    uvec4 corners = texelFetch(mesh_triangles, int(triangle));
    vec3 a = texelFetch(mesh_positions, int(corners.x)).xyz;
    vec3 b = texelFetch(mesh_positions, int(corners.y)).xyz;
    vec3 c = texelFetch(mesh_positions, int(corners.z)).xyz;
    return join_boxes(join_boxes(NodeBox(a, a), NodeBox(b, b)), NodeBox(c, c));
}

void store_primitive_box(const uint primitive, const NodeBox box) {
    for (uint axis = 0u; axis < 3u; ++axis) {
        boxes[6u * primitive + axis] = select_axis(box.lower, axis);
        boxes[6u * primitive + 3u + axis] = select_axis(box.upper, axis);
    }
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    if (lane < 3u) {
        group_lower[lane] = 0xffffffffu;
        group_upper[lane] = 0u;
    }
    barrier();
    uint primitive = invocation_index();
    if (primitive < push.primitive_count) {
        NodeBox box = find_triangle_box(primitive);
        store_primitive_box(primitive, box);
        for (uint axis = 0u; axis < 3u; ++axis) {
            atomicMin(group_lower[axis], order_float(select_axis(box.lower, axis)));
            atomicMax(group_upper[axis], order_float(select_axis(box.upper, axis)));
        }
    }
    barrier();
    if (lane < 3u) {
        atomicMin(state.lower[lane], group_lower[lane]);
        atomicMax(state.upper[lane], group_upper[lane]);
    }
}
