// Reads the texel buffer of each format, as the kernels see them, into words.
#include "vulkan/layout/bindings.h"
layout(local_size_x_id = 0) in;
layout(binding = kBindNodes) uniform usamplerBuffer rgba32_uint;
layout(binding = kBindPositions) uniform samplerBuffer r32_float;
layout(binding = kBindUvs) uniform samplerBuffer rg32_float;
layout(binding = kBindFrames) uniform usamplerBuffer rg32_uint;
layout(binding = kBindDominants) uniform usamplerBuffer r32_uint;
layout(binding = kBindFloatTexels) uniform samplerBuffer rgba32_float;
layout(binding = kBindHalfTexels) uniform samplerBuffer rgba16_float;
layout(binding = kBindFilm) writeonly buffer Results { uvec4 results[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    int place = int(i);
    results[i * 7u] = texelFetch(rgba32_uint, place);
    results[i * 7u + 1u] = floatBitsToUint(texelFetch(r32_float, place));
    results[i * 7u + 2u] = floatBitsToUint(texelFetch(rg32_float, place));
    results[i * 7u + 3u] = texelFetch(rg32_uint, place);
    results[i * 7u + 4u] = texelFetch(r32_uint, place);
    results[i * 7u + 5u] = floatBitsToUint(texelFetch(rgba32_float, place));
    results[i * 7u + 6u] = floatBitsToUint(texelFetch(rgba16_float, place));
}
