// Sums of the layers that share out the light of a picture, and of guides (image/light_layers.h). They lie in
// the film's buffer behind its other sums, path by path: a colour for each kind and each group that the
// picture has layers of, then two guides. What paths keep for them lies behind. Nothing is left of all this where it has none.
#ifndef RELIEF_LIGHT_SUMS_GLSL
#define RELIEF_LIGHT_SUMS_GLSL

#include "vulkan/shaders/scene.glsl"
#include "formulas/light_kinds.h"
#include "vulkan/layout/device_paths.h"

layout(constant_id = kLightKindsConstant) const uint kLightKinds = 0u;
layout(constant_id = kLightGroupsConstant) const uint kLightGroups = 0u;
layout(constant_id = kDefaultGroupConstant) const uint kDefaultGroup = 0u; ///< only with groups; so is the next
layout(constant_id = kEnvironmentGroupConstant) const uint kEnvironmentGroup = 0u;
layout(constant_id = kGuidesConstant) const uint kHasGuides = 0u;
layout(scalar, set = 0, binding = kBindFilm) buffer LightSums { uint light_words[]; };

/// Of a path.
uint count_colors() { return kLightKinds + kLightGroups + (kHasGuides != 0u ? 2u : 0u); }

vec3 load_light_words(const uint first) {
    return uintBitsToFloat(uvec3(light_words[first], light_words[first + 1u], light_words[first + 2u]));
}

void store_light_words(const uint first, const vec3 v) {
    uvec3 bits = floatBitsToUint(v);
    light_words[first] = bits.x;
    light_words[first + 1u] = bits.y;
    light_words[first + 2u] = bits.z;
}

/// `layer`: a kind, behind all kinds a group, behind all groups a guide.
void add_to_layer(const uint capacity, const uint path_index, const uint layer, const vec3 light) {
    uint first = capacity * kFilmSumsWords + 3u * (path_index * count_colors() + layer);
    store_light_words(first, load_light_words(first) + light);
}

void add_to_kind(const uint capacity, const uint path_index, const uint kind, const vec3 light) {
    if (kLightKinds != 0u) add_to_layer(capacity, path_index, kind, light);
}

/// kNone: of a group without a layer.
void add_to_group(const uint capacity, const uint path_index, const uint group, const vec3 light) {
    if (kLightGroups != 0u && group != kNone) add_to_layer(capacity, path_index, kLightKinds + group, light);
}

/// First word of what a path keeps.
uint find_path_light(const uint capacity, const uint path_index) {
    return capacity * (kFilmSumsWords + 3u * count_colors()) + path_index * kPathLightWords;
}

void store_shares(const uint first, const LightShares shares) {
    store_light_words(first, shares.diffuse);
    light_words[first + 3u] = shares.rest;
}

LightShares load_shares(const uint first) {
    LightShares shares = {load_light_words(first), light_words[first + 3u]};
    return shares;
}

void store_light_shares(const uint capacity, const uint path_index, const LightShares shares) {
    store_shares(find_path_light(capacity, path_index), shares);
}

void store_bounce_shares(const uint capacity, const uint path_index, const LightShares shares) {
    store_shares(find_path_light(capacity, path_index) + 4u, shares);
}

void store_light_group(const uint capacity, const uint path_index, const uint group) {
    if (kLightGroups != 0u) light_words[find_path_light(capacity, path_index) + 8u] = group;
}

/// Whether the vertex after `depth` bounces may be the one that the path's guides are of.
bool looks_for_guides(const uint capacity, const uint path_index, const uint depth) {
    return kHasGuides != 0u && (depth == 0u || light_words[find_path_light(capacity, path_index) + 9u] == 0u);
}

/// Behind looks_for_guides() of each vertex.
void note_guided(const uint capacity, const uint path_index, const bool is_guided) {
    light_words[find_path_light(capacity, path_index) + 9u] = is_guided ? 1u : 0u;
}

void add_guides(const uint capacity, const uint path_index, const vec3 albedo, const vec3 normal) {
    add_to_layer(capacity, path_index, kLightKinds + kLightGroups, albedo);
    add_to_layer(capacity, path_index, kLightKinds + kLightGroups + 1u, normal);
}

void add_split(const uint capacity, const uint path_index, const vec3 light, const LightShares shares,
               const uint bounces) {
    vec3 diffuse = light * shares.diffuse;
    add_to_layer(capacity, path_index, find_light_kind(kLobeDiffuse, bounces), diffuse);
    add_to_layer(capacity, path_index, find_light_kind(shares.rest, bounces), light - diffuse);
}

/// Light that the first vertex scatters; `bounces`: those between it and the light.
void add_scattered(const uint capacity, const uint path_index, const vec3 light, const uint bounces) {
    if (kLightKinds == 0u) return;
    add_split(capacity, path_index, light, load_shares(find_path_light(capacity, path_index) + 4u), bounces);
}

/// What a shadow ray brings to the vertex after `depth` bounces.
void add_shadow_light(const uint capacity, const uint path_index, const vec3 light, const uint depth) {
    uint kept = find_path_light(capacity, path_index);
    if (kLightKinds != 0u)
        add_split(capacity, path_index, light, load_shares(kept + (depth == 0u ? 0u : 4u)), depth);
    if (kLightGroups != 0u) add_to_group(capacity, path_index, light_words[kept + 8u], light);
}

#endif
