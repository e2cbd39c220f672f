// Writes the fields of the crossing structs one by one, by name.
#extension GL_EXT_scalar_block_layout : require
#include "all_formulas.glsl"
#include "device_fields-inl.h"
layout(local_size_x_id = 0) in;
layout(scalar, binding = kBindRays) readonly buffer Structs { AllStructs structs[]; };
layout(scalar, binding = kBindFilm) writeonly buffer Words { uint words[]; };

uint next_word = 0u;
void put(uint value) { words[next_word++] = value; }
void put(float value) { put(floatBitsToUint(value)); }

void main() {
    if (gl_GlobalInvocationID.x > 0u) return;
    // The second one, so that the stride counts too.
#define FIELD(path) put(path);
    ALL_FIELDS(structs[1])
}
