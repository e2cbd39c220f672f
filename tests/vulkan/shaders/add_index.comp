// values[i] = values[i] * factor + i.
#include "vulkan/shaders/kernel.glsl"
layout(binding = kBindFilm) buffer Values { uint values[]; };
layout(push_constant) uniform Push { uint count, factor; };

void main() {
    uint i = invocation_index();
    if (i >= count) return;
    values[i] = values[i] * factor + i;
}
