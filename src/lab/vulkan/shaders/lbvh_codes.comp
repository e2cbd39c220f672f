// The Morton code of each box, beside the number of its primitive: what is sorted.
#include "vulkan/shaders/kernel.glsl"
#include "lab/vulkan/shaders/lbvh.glsl"

layout(set = 0, binding = kBindBuildCodes) writeonly buffer Codes { uvec2 codes[]; };

void main() {
    uint primitive = invocation_index();
    if (primitive >= push.primitive_count) return;
    vec3 lower = vec3(unorder_float(state.lower[0]), unorder_float(state.lower[1]), unorder_float(state.lower[2]));
    vec3 upper = vec3(unorder_float(state.upper[0]), unorder_float(state.upper[1]), unorder_float(state.upper[2]));
    NodeBox box = load_primitive_box(primitive);
    vec3 centre = centre_of_box(box.lower, box.upper);
    MortonCode code;
    if (kCodeBits == 30u) {
        code = make_morton30(centre, lower, upper);
    } else {
        code = make_morton63(centre, lower, upper);
        codes[primitive] = uvec2(code.low, code.high);
    }
    pairs[primitive] = uvec2(code.low, primitive);
}
