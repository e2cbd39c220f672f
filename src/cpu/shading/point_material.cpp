#include "cpu/shading/point_material.h"

#include <algorithm>

#include "cpu/shading/textures.h"
#include "formulas/path.h"

namespace relief::cpu {

PointMaterial make_point_material(const PreparedScene& scene, uint32_t instance, const Vec2f& uv) {
    const uint32_t index = scene.instances[instance].material;
    const Material& material = scene.materials[index];
    PointMaterial m{material.base_color,
                    material.emission,
                    material.roughness,
                    find_metallic(material, uv),
                    material.ior,
                    scene.layers.empty() ? kNoIndex : scene.layers.record_of_material[index],
                    scene.glass.empty() ? kNoIndex : scene.glass.record_of_material[index],
                    kNoIndex};
    m.glass_numbers = m.glass;
    if (material.base_color_texture)
        m.base_color =
            m.base_color * fetch_texture(*material.base_color_texture, material.base_color_filter, uv);
    if (material.roughness_texture)
        m.roughness *= fetch_texture(*material.roughness_texture, material.roughness_filter, uv).x;
    m.base_color = scalar::limit_color(m.base_color);
    m.roughness = std::clamp(m.roughness, 0.0f, 1.0f);
    return m;
}

float find_opacity(const Material& material, const Vec2f& uv) {
    const float factor = material.opacity_texture
                             ? fetch_texture(*material.opacity_texture, material.opacity_filter, uv).x
                             : 1.0f;
    return std::clamp(material.opacity * factor, 0.0f, 1.0f);
}

float find_metallic(const Material& material, const Vec2f& uv) {
    const float factor = material.metallic_texture
                             ? fetch_texture(*material.metallic_texture, material.metallic_filter, uv).x
                             : 1.0f;
    return std::clamp(material.metallic * factor, 0.0f, 1.0f);
}

} // namespace relief::cpu
