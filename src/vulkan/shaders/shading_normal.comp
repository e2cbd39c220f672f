// Shading normal and textured material at hits. First hits are added to the layers.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/textures.glsl"
#include "vulkan/shaders/texture_place.glsl"
#include "vulkan/shaders/input_look_up.glsl"
#include "vulkan/shaders/shading_normal.glsl"
#include "formulas/normal_map.h"

layout(scalar, push_constant) uniform Push { PathPush push; };

layout(constant_id = kNormalMapsConstant) const uint kHasNormalMaps = 0;

struct Appearance {
    vec3 shading_normal; ///< on the viewer's side
    vec2 uv;
    vec3 base_color;
    float roughness, metallic;
    vec3 normal_texel; ///< where the material has a normal map
    bool has_normal_texel;
    vec3 tangent; ///< of anisotropic materials
    bool has_tangent;
};

/// Numbers of the vertex are stored at once, so that they take no registers from here on.
void apply_textures(const MaterialData material, const TexturePlace place, const uint path_index,
                    inout Appearance appearance) {
    MaterialInputData inputs = material_inputs[material.inputs];
    InputNumbers numbers = find_inputs(inputs, ~kOpacityPlace, place);
    if (kHasVertexNumbers != 0u && material.has_vertex_numbers != 0u)
        point_numbers[find_point_numbers(push.capacity, path_index)] = numbers;
    appearance.base_color = get_input_color(numbers, kInputBaseColor);
    appearance.roughness = numbers.word[kInputRoughness];
    appearance.metallic = numbers.word[kInputMetallic];
    appearance.normal_texel = get_input_color(numbers, kInputNormal);
    appearance.has_normal_texel = has_place(inputs.places, kInputNormal);
}

void apply_material(const MaterialData material, const TexturePlace place, const uint path_index,
                    inout Appearance appearance) {
    appearance.base_color = material.base_color;
    appearance.roughness = material.roughness;
    appearance.metallic = material.metallic;
    appearance.has_normal_texel = false;
    if (material.inputs != kNone) apply_textures(material, place, path_index, appearance);
}

/// As cpu/shading/normal_maps.cpp; `normal` on the side of the winding.
vec3 find_tangent(const InstanceData instance, const HitData hit, const uvec4 quad, const vec3 normal) {
    SurfaceData s = surfaces[instance.surface];
    vec2 at = vec2(hit.u, hit.v);
    int first = int(s.first_tangent + 4u * hit.patch_index);
    vec3 tangents[4];
    for (int k = 0; k < 4; ++k) tangents[k] = unpack_tangent(texelFetch(override_bits, first + k).x);
    vec3 blended = is_triangle(quad) ? interpolate_triangle(tangents[0], tangents[1], tangents[2], at)
                                     : interpolate_quad(tangents[0], tangents[1], tangents[2], tangents[3], at);
    vec3 base = normal;
    if (s.map != kNone) base = make_unit(transform_normal(instance.object_from_origin, blend_normals(s, quad, at)));
    return turn_tangent(make_unit(transform_vector(instance.world_from_object, blended)), base, normal);
}

/// `tangent` is that of `normal`.
vec3 apply_normal_map(const MaterialData material, const InstanceData instance, const HitData hit, const vec3 tangent,
                      const vec3 texel, const vec3 normal) {
    int first = int(surfaces[instance.surface].first_tangent + 4u * hit.patch_index);
    bool is_turned = (texelFetch(override_bits, first).x & 1u) != 0u;
    bool is_mirrored = (instance.levels & kMirrored) != 0u;
    return map_normal(normal, tangent, is_turned != is_mirrored ? -1.0 : 1.0,
                      decode_normal(texel, material.normal_scale));
}

Appearance find_appearance(const uint path_index, const HitData hit, const vec3 geometric_normal,
                           const bool is_flipped) {
    InstanceData instance = instances[hit.instance];
    SurfaceData s = surfaces[instance.surface];
    uvec4 quad = load_quad(s, hit.patch_index);
    vec2 at = vec2(hit.u, hit.v);
    uint level = packed_patch_level(hit.levels);
    vec3 interpolated = compute_shading_normal(s, quad, hit.patch_index, level, at);
    vec3 normal = orient_shading_normal(transform_normal(instance.object_from_origin, interpolated), geometric_normal);
    Appearance appearance;
    appearance.uv = interpolate_uv(s, quad, at);
    MaterialData material = load_material_numbers(instance.material);
    TexturePlace place = TexturePlace(instance.surface, hit.patch_index, at, appearance.uv);
    apply_material(material, place, path_index, appearance);
    bool is_mapped = kHasNormalMaps != 0u && appearance.has_normal_texel;
    appearance.has_tangent = kHasAnisotropy != 0u && is_anisotropic(material);
    if (is_mapped || appearance.has_tangent)
        appearance.tangent = find_tangent(instance, hit, quad, normal);
    if (is_mapped)
        normal = apply_normal_map(material, instance, hit, appearance.tangent, appearance.normal_texel, normal);
    appearance.shading_normal = is_flipped ? -normal : normal;
    return appearance;
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = path_list[index];
    HitData hit = hits[path_index];
    if (!is_hit(hit)) return;
    vec3 geometric_normal = points[path_index].geometric_normal;
    bool is_flipped = points[path_index].is_flipped != 0u;
    Appearance appearance =
        find_appearance(path_index, hit, is_flipped ? -geometric_normal : geometric_normal, is_flipped);
    bool is_caught = is_catcher(hit, push.depth);
    if (is_caught) appearance.base_color = vec3(1.0), appearance.roughness = 1.0, appearance.metallic = 0.0;
    points[path_index].bent_normal =
        bend_normal(appearance.shading_normal, geometric_normal, -rays[path_index].direction);
    points[path_index].base_color = appearance.base_color;
    points[path_index].roughness = appearance.roughness;
    points[path_index].metallic = appearance.metallic;
    if (appearance.has_tangent) {
        uint first = find_point_tangent(push.capacity, path_index);
        for (uint k = 0u; k < 3u; ++k) point_tangents[first + k] = appearance.tangent[k];
    }
    if (push.depth > 0u || is_caught) return;
    film[path_index].shading_normal += appearance.shading_normal;
    film[path_index].albedo += appearance.base_color;
    film[path_index].uv += appearance.uv;
}
