#include "cpu/shading/point_material.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cpu/shading/kinds.h"
#include "cpu/shading/textures.h"
#include "formulas/path.h"

namespace relief::cpu {

namespace {

/// With its textures of numbers, but not that of base_color.
PointMaterial make_plain_material(const PreparedScene& scene, uint32_t index, const Vec2f& uv) {
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
    if (material.roughness_texture)
        m.roughness *= fetch_texture(*material.roughness_texture, material.roughness_filter, uv).x;
    m.roughness = std::clamp(m.roughness, 0.0f, 1.0f);
    return m;
}

/// Looks up textures of colours for the points that wait, those of one texture together.
class ColorLookUps {
  public:
    static constexpr size_t kMost = 64; ///< points that may wait

    void add(size_t point, const Texture& texture, const Vec2f& uv) {
        textures_[count_] = &texture, uvs_[count_] = uv, points_[count_++] = uint32_t(point);
    }

    /// Calls use(point, color) for all of them.
    template <class Use> void finish(const ShadingKernels& kernels, const Use& use) const {
        const auto look_up = [&](std::span<const uint32_t> members) {
            std::array<Vec2f, kMost> uvs;
            std::array<Vec3f, kMost> colors;
            for (size_t n = 0; n < members.size(); ++n) uvs[n] = uvs_[members[n]];
            kernels.fetch_texture(*textures_[members[0]], uvs.data(), members.size(), colors.data());
            for (size_t n = 0; n < members.size(); ++n) use(points_[members[n]], colors[n]);
        };
        visit_kinds<kMost>(
            count_, [&](size_t k) { return textures_[k]; }, look_up);
    }

  private:
    std::array<const Texture*, kMost> textures_;
    std::array<Vec2f, kMost> uvs_;
    std::array<uint32_t, kMost> points_;
    size_t count_ = 0;
};

void make_block(const PreparedScene& scene, const ShadingKernels& kernels, std::span<const TraceHit> hits,
                std::span<const SurfacePoint> points, std::span<PointMaterial> materials,
                BaseColor base_color) {
    ColorLookUps colors;
    uint32_t last = kNoIndex; // material whose numbers are `numbers` at any point
    PointMaterial numbers;
    for (size_t k = 0; k < hits.size(); ++k) {
        const uint32_t index = scene.instances[hits[k].instance].material;
        const Material& material = scene.materials[index];
        const Vec2f& uv = points[k].uv;
        if (index != last) {
            numbers = make_plain_material(scene, index, uv);
            last = material.metallic_texture || material.roughness_texture ? kNoIndex : index;
        }
        materials[k] = numbers;
        if (!material.base_color_texture || base_color == BaseColor::factor_alone) continue;
        if (is_smooth(material.base_color_filter) || !std::isfinite(uv.x) || !std::isfinite(uv.y))
            materials[k].base_color = materials[k].base_color * fetch_texture(*material.base_color_texture,
                                                                              material.base_color_filter, uv);
        else
            colors.add(k, *material.base_color_texture, uv);
    }
    colors.finish(kernels, [&](size_t k, const Vec3f& color) {
        materials[k].base_color = materials[k].base_color * color;
    });
    for (PointMaterial& m : materials) m.base_color = scalar::limit_color(m.base_color);
}

} // namespace

void make_point_materials(const PreparedScene& scene, const ShadingKernels& kernels,
                          std::span<const TraceHit> hits, std::span<const SurfacePoint> points,
                          std::span<PointMaterial> materials, BaseColor base_color) {
    for (size_t first = 0; first < hits.size(); first += ColorLookUps::kMost) {
        const size_t count = std::min(ColorLookUps::kMost, hits.size() - first);
        make_block(scene, kernels, hits.subspan(first, count), points.subspan(first, count),
                   materials.subspan(first, count), base_color);
    }
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
