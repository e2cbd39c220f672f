// Codes of 63 bits are sorted by their low words, then by their high ones (step 0); step 1 lays them out in order.
#include "vulkan/shaders/kernel.glsl"
#include "lab/vulkan/shaders/lbvh.glsl"

layout(set = 0, binding = kBindBuildCodes) readonly buffer Codes { uvec2 codes[]; };

void main() {
    uint entry = invocation_index();
    if (entry >= push.primitive_count) return;
    uint primitive = pairs[entry].y;
    if (push.step == 0u)
        pairs[entry].x = codes[primitive].y;
    else
        sorted_codes[entry] = codes[primitive];
}
