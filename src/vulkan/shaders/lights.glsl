// All light sources, for next-event estimation and for rays that hit a light.
#ifndef RELIEF_LIGHTS_GLSL
#define RELIEF_LIGHTS_GLSL

#include "vulkan/shaders/scene.glsl"
#include "formulas/warp.h"
#include "formulas/light.h"
#include "formulas/light_source.h"
#include "vulkan/layout/device_paths.h"

layout(scalar, set = 0, binding = kBindSources) readonly buffer Sources { LightSourceData sources[]; };
/// EmitterData, then a range (first emitter, instance) for each emissive instance.
layout(set = 0, binding = kBindEmitters) uniform usamplerBuffer emitter_table;

float total_irradiance(uint source_count, vec3 position) {
    float total = 0.0;
    for (uint k = 0u; k < source_count; ++k) total += estimate_irradiance(sources[k], position);
    return total;
}

float load_emitter_probability(uint emitter) { return uintBitsToFloat(texelFetch(emitter_table, int(emitter)).y); }

/// Emissive patch selected by a random number.
uint find_emitter(uint emitter_count, float u) {
    uint part = uint(u * kEmitterParts);
    uint low = 0u;
    uint high = emitter_count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (texelFetch(emitter_table, int(middle)).x > part)
            high = middle;
        else
            low = middle + 1u;
    }
    return low;
}

/// Last range whose component (0: first emitter, 1: instance) is at most `value`. Both increase over the ranges.
uvec2 find_emitter_range(uint emitter_count, uint range_count, uint component, uint value) {
    uint low = 0u;
    uint high = range_count - 1u;
    while (low < high) {
        uint middle = (low + high + 1u) / 2u;
        if (texelFetch(emitter_table, int(emitter_count + middle))[component] > value)
            high = middle - 1u;
        else
            low = middle;
    }
    return texelFetch(emitter_table, int(emitter_count + low)).xy;
}

#endif
