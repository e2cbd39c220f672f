#include "cpu/shading/point_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cpu/shading/input_look_up.h"
#include "cpu/shading/kinds.h"
#include "formulas/path.h"

namespace relief::cpu {

namespace {

/// Without its textures.
PointMaterial make_plain_material(const PreparedScene& scene, uint32_t index) {
    const Material& material = scene.materials[index];
    PointMaterial m{material.base_color,
                    material.emission,
                    material.roughness,
                    material.metallic,
                    material.ior,
                    scene.layers.empty() ? kNoIndex : scene.layers.record_of_material[index],
                    scene.glass.empty() ? kNoIndex : scene.glass.record_of_material[index],
                    kNoIndex};
    m.glass_numbers = m.glass;
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

bool is_repeated_bilinear(const PlacedTexture& texture) {
    return texture.wrap == WrapMode::repeat && !texture.is_smooth && !texture.is_udim;
}

/// Applies a texture of what a point has of itself. One of a colour may join those that wait.
void apply_texture(const PlacedTexture& texture, const TexturePlace& place, size_t point,
                   ColorLookUps& colors, PointMaterial& m) {
    const Vec2f uv = find_texture_uv(texture, place);
    const bool is_color = texture.place.first == scalar::kInputBaseColor;
    if (is_color && is_repeated_bilinear(texture) && std::isfinite(uv.x) && std::isfinite(uv.y))
        return colors.add(point, *texture.tiles[0], uv);
    const std::optional<Vec3f> value = fetch_placed(texture, uv);
    if (!value) return;
    if (is_color)
        m.base_color = m.base_color * *value;
    else if (texture.place.first == scalar::kInputRoughness)
        m.roughness = std::clamp(m.roughness * value->x, 0.0f, 1.0f);
    else
        m.metallic = std::clamp(m.metallic * value->x, 0.0f, 1.0f);
}

void make_block(const PreparedScene& scene, const ShadingKernels& kernels, std::span<const TraceHit> hits,
                std::span<const SurfacePoint> points, std::span<PointMaterial> materials,
                BaseColor base_color) {
    ColorLookUps colors;
    uint32_t last = kNoIndex; // material that `numbers` are of
    PointMaterial numbers;
    for (size_t k = 0; k < hits.size(); ++k) {
        const uint32_t index = scene.instances[hits[k].instance].material;
        if (index != last) numbers = make_plain_material(scene, index), last = index;
        materials[k] = numbers;
        const TexturedMaterial* textured = scene.textured.find(index);
        if (!textured) continue;
        for (const PlacedTexture& texture : std::span(textured->textures).first(textured->point_count))
            if (base_color == BaseColor::with_texture || texture.place.first != scalar::kInputBaseColor)
                apply_texture(texture, place_hit(scene, hits[k], points[k].uv), k, colors, materials[k]);
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

} // namespace relief::cpu
