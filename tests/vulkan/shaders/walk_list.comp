// Steps from entry i to the end of its list.
#include "formulas/constants.h"
#include "vulkan/shaders/kernel.glsl"
layout(binding = kBindFilm) readonly buffer Next { uint next[]; };
layout(binding = kBindPaths) writeonly buffer Steps { uint steps[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = invocation_index();
    if (i >= count) return;
    uint step_count = 0u;
    for (uint at = i; next[at] != kNone; at = next[at]) ++step_count;
    steps[i] = step_count;
}
