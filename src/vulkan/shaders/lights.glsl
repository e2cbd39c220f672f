// All light sources, for next-event estimation and for rays that hit a light.
#ifndef RELIEF_LIGHTS_GLSL
#define RELIEF_LIGHTS_GLSL

#include "vulkan/shaders/scene.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/textures.glsl"
#include "formulas/warp.h"
#include "formulas/light.h"
#include "formulas/light_source.h"
#include "formulas/light_tree.h"
#include "vulkan/layout/device_paths.h"

layout(scalar, set = 0, binding = kBindSources) readonly buffer Sources { LightSourceData sources[]; };
layout(scalar, set = 0, binding = kBindSources) readonly buffer LightNodes { LightNodeData light_nodes[]; };
/// Sets of instances, LightSourceData::link.
layout(scalar, set = 0, binding = kBindSources) readonly buffer LinkWords { uint link_words[]; };
/// EmitterData, then a range (first emitter, instance) for each emissive instance.
layout(set = 0, binding = kBindEmitters) uniform usamplerBuffer emitter_table;

/// Whether a light of the scene's list lights the object that the point is on.
bool is_lit(const LightSourceData source, const LitPoint at) {
    if (kHasLightLinks == 0u || source.link == kNone) return true;
    return is_in_set(link_words[source.link + at.instance / 32u], at.instance);
}

bool has_texture(const LightSourceData source) { return kHasLightTextures != 0u && source.texture != kNone; }

/// What the texture of a light adds to its colour where a ray meets it.
vec3 find_light_color(const LightSourceData source, const vec3 origin, const vec3 direction) {
    TextureData data = textures[source.texture];
    vec2 uv = find_face_uv(source, origin, direction, vec2(data.width, data.height));
    return max(fetch_bilinear(data, locate_texture_uv(uv, vec2(data.width, data.height)), kWrapRepeat), vec3(0.0));
}

/// Light of the scene's list that a ray meets, with its texture.
LightSeen meet_source(const LightSourceData source, const vec3 origin, const vec3 direction, const float distance) {
    LightSeen seen = meet_light(source, origin, direction, distance);
    if (has_texture(source) && seen.pdf > 0.0) seen.radiance *= find_light_color(source, origin, direction);
    return seen;
}

// The functions that path/light_choice.h calls.
LightSourceData load_light_source(const uint k) { return sources[k]; }
LightNodeData load_light_node(const uint k) { return light_nodes[k]; }
bool has_light_tree() { return kHasLightTree != 0u; }
float estimate_source(const LightSourceData source, const LitPoint at) {
    return is_lit(source, at) ? estimate_irradiance(source, at.position) : 0.0;
}

#include "path/light_choice.h"

float load_emitter_probability(const uint emitter) {
    return uintBitsToFloat(texelFetch(emitter_table, int(emitter)).y);
}

/// A tree has chosen the emissive patch itself.
float load_probability(const uint emitter) { return kHasLightTree != 0u ? 1.0 : load_emitter_probability(emitter); }

/// Emissive patch selected by a random number.
uint find_emitter(const uint emitter_count, const float u) {
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
uvec2 find_emitter_range(const uint emitter_count, const uint range_count, const uint component, const uint value) {
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
