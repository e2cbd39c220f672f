#include "cpu/shading/normal_maps.h"

#include "cpu/shading/input_look_up.h"
#include "formulas/normal_map.h"
#include "surface/mesh/corner_tangents.h"

namespace relief::cpu {

namespace {

Vec3f find_tangent(const PreparedScene& scene, const Instance& instance, const TraceHit& hit,
                   const Vec3f& normal) {
    const Surface& surface = scene.surfaces[instance.surface];
    const Vec2f at{hit.u, hit.v};
    // Without displacement the shading normal is the one that the tangents were made for.
    const Vec3f base = surface.has_displacement
                           ? normalize(transform_normal(instance.object_space.from_origin,
                                                        blend_base_normals(surface, hit.patch, at)))
                           : normal;
    const Vec3f tangent =
        normalize(transform_vector(instance.world_from_object, blend_tangents(surface, hit.patch, at)));
    return scalar::turn_tangent(tangent, base, normal);
}

Vec3f map_shading_normal(const PreparedScene& scene, const Instance& instance, const TraceHit& hit,
                         const SurfacePoint& point) {
    const Surface& surface = scene.surfaces[instance.surface];
    const Material& material = scene.materials[instance.material];
    const Vec3f texel = find_normal_texel(scene, instance.material, place_hit(scene, hit, point.uv));
    const float scale = material.normal_scale;
    const Vec3f direction =
        scalar::decode_normal({texel.x, texel.y, texel.z}, {scale, material.normal_flip_y ? -scale : scale});
    const float handedness = find_handedness(surface, hit.patch) * (instance.is_mirrored ? -1.0f : 1.0f);
    const Vec3f tangent = find_tangent(scene, instance, hit, point.shading_normal);
    return scalar::map_normal(point.shading_normal, tangent, handedness, direction);
}

} // namespace

void map_shading_normals(const PreparedScene& scene, std::span<const TraceHit> hits,
                         std::span<SurfacePoint> points) {
    for (size_t k = 0; k < hits.size(); ++k) {
        const Instance& instance = scene.instances[hits[k].instance];
        if (!has_normal_map(scene.materials[instance.material])) continue;
        points[k].shading_normal = map_shading_normal(scene, instance, hits[k], points[k]);
    }
}

void find_tangents(const PreparedScene& scene, std::span<const TraceHit> hits,
                   std::span<const SurfacePoint> points, std::span<Vec3f> tangents) {
    for (size_t k = 0; k < hits.size(); ++k) {
        const Instance& instance = scene.instances[hits[k].instance];
        if (is_anisotropic(scene.materials[instance.material]))
            tangents[k] = find_tangent(scene, instance, hits[k], points[k].shading_normal);
    }
}

} // namespace relief::cpu
