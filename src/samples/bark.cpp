// Bark: tall plates with deep cracks between; edges curl over the cracks, and flakes cover the plates.
#include <cmath>

#include "math/vec.h"
#include "samples/angles.h"
#include "samples/bake.h"
#include "samples/lathe_model.h"
#include "samples/models.h"
#include "samples/noise.h"
#include "samples/plates.h"
#include "samples/profile.h"

namespace relief::samples {

namespace {

constexpr float kCrackWidth = 0.0185f, kPlateHeight = 0.025f;
constexpr float kFlakeWidth = 0.0055f, kFlakeHeight = 0.0036f;

class BarkSculptor {
  public:
    MapSample sculpt(const Vec2f& uv) const {
        const Vec2f warped = warp(uv);
        const PlateHit plate = plates_.find(warped);
        const float q = std::fmin(plate.distance / kCrackWidth, 1.0f);
        const Vec2f shape = crack_.at(q);
        const float rise = 0.75f + 0.5f * to_unit(plate.seed * 0x9e3779b1u);
        const float face = smooth_step(0.75f, 1.05f, shape.y);
        MapSample sample;
        sample.displacement = {plate.inward.x * (shape.x - q) * kCrackWidth,
                               plate.inward.y * (shape.x - q) * kCrackWidth,
                               (shape.y - 0.7f) * kPlateHeight * rise};
        sample.color = lerp(Vec3f{0.045f, 0.022f, 0.013f}, Vec3f{0.20f, 0.135f, 0.095f},
                            smooth_step(0.0f, 0.9f, shape.y));
        add_flakes(uv, warped, face, sample);
        add_grain(uv, face, sample);
        add_moss(uv, shape.y, sample);
        return sample;
    }

  private:
    static Vec2f warp(const Vec2f& uv) {
        const float coarse_x = tile_noise({uv.x * 7, uv.y * 5}, 7, 5, 161);
        const float coarse_y = tile_noise({uv.x * 9, uv.y * 6}, 9, 6, 162);
        const float fine = fractal_tile_noise({uv.x * 40, uv.y * 32}, 40, 32, 3, 163);
        return {uv.x + 0.016f * coarse_x + 0.0032f * fine, uv.y + 0.02f * coarse_y + 0.004f * fine};
    }

    void add_flakes(const Vec2f& uv, const Vec2f& warped, float face, MapSample& sample) const {
        const float ragged = fractal_tile_noise({uv.x * 64, uv.y * 64}, 64, 64, 2, 171);
        const PlateHit flake = flakes_.find({warped.x + 0.0025f * ragged, warped.y + 0.004f * ragged});
        const float q = std::fmin(flake.distance / kFlakeWidth, 1.0f);
        const Vec2f shape = crack_.at(q);
        const float lift = face * (0.35f + 1.1f * to_unit(flake.seed * 0x85ebca77u));
        sample.displacement.x += flake.inward.x * (shape.x - q) * kFlakeWidth * face;
        sample.displacement.y += flake.inward.y * (shape.x - q) * kFlakeWidth * face;
        sample.displacement.z += (shape.y - 0.5f) * kFlakeHeight * lift;
        const Vec3f tint = lerp(Vec3f{0.72f, 0.66f, 0.62f}, Vec3f{1.30f, 1.30f, 1.32f}, to_unit(flake.seed));
        sample.color = sample.color * lerp(Vec3f{1, 1, 1}, tint, face);
        sample.color *= lerp(1.0f, lerp(0.45f, 1.05f, smooth_step(0.0f, 0.8f, shape.y)), face);
    }

    static void add_grain(const Vec2f& uv, float face, MapSample& sample) {
        const float sway = 0.004f * tile_noise({uv.x * 12, uv.y * 9}, 12, 9, 183);
        const float fibres = ridged_tile_noise({(uv.x + sway) * 80, uv.y * 11}, 80, 11, 4, 181);
        const float lumps = fractal_tile_noise({uv.x * 22, uv.y * 12}, 22, 12, 5, 182);
        sample.displacement.z += 0.0052f * (fibres - 0.5f) * (0.4f + 0.6f * face) + 0.0042f * lumps;
        sample.displacement.y += 0.0012f * lumps;
        sample.color *= 0.70f + 0.55f * fibres;
    }

    static void add_moss(const Vec2f& uv, float height, MapSample& sample) {
        const float place = fractal_tile_noise({uv.x * 4, uv.y * 3}, 4, 3, 5, 191);
        const float tuft = fractal_tile_noise({uv.x * 150, uv.y * 150}, 150, 150, 3, 192);
        const float moss = smooth_step(0.10f, 0.50f, place + 0.15f * tuft) * smooth_step(0.2f, 0.8f, height);
        sample.displacement.z += moss * (0.0025f + 0.0022f * tuft);
        sample.displacement.x += moss * 0.0010f * tuft;
        const Vec3f green =
            lerp(Vec3f{0.07f, 0.10f, 0.018f}, Vec3f{0.19f, 0.21f, 0.045f}, 0.5f + 0.6f * tuft);
        sample.color = lerp(sample.color, green, 0.9f * moss);
        const float lichen =
            smooth_step(0.22f, 0.40f, fractal_tile_noise({uv.x * 24, uv.y * 24}, 24, 24, 4, 193)) *
            smooth_step(0.7f, 1.0f, height) * (1 - moss);
        sample.color = lerp(sample.color, Vec3f{0.34f, 0.37f, 0.29f}, 0.7f * lichen);
    }

    PlateField plates_{{16, 5, 0.9f, 0.0030f, 201}}, flakes_{{52, 14, 0.95f, 0.0011f, 202}};
    // From the middle of a crack: its floor, under the plate, up, over the curled edge, onto the plate.
    MirroredCurve crack_{{0, 0},         {0.22f, 0.02f}, {0.42f, 0.10f}, {0.50f, 0.30f}, {0.40f, 0.55f},
                         {0.22f, 0.80f}, {0.20f, 1.02f}, {0.34f, 1.15f}, {0.60f, 1.08f}, {1, 1.0f}};
};

LatheShape make_trunk_profile(const TrunkShape& trunk) {
    LatheShape shape;
    constexpr float kRim = 0.3f, kStep = 0.1f;
    for (float r = 0; r < 1 - kRim; r += kStep) shape.profile.push_back({r, 0});
    for (float a = 0.125f; a < 1; a += 0.25f)
        shape.profile.push_back(
            {1 - kRim + kRim * std::sin(kPi / 2 * a), kRim - kRim * std::cos(kPi / 2 * a)});
    for (float y = kRim; y < trunk.height / 2; y += kStep) shape.profile.push_back({1, y});
    const size_t half = shape.profile.size();
    for (size_t i = half; i-- > 0;)
        shape.profile.push_back({shape.profile[i].x, trunk.height - shape.profile[i].y});
    const float total = trunk.height - 2 * kRim + 2 * (1 - kRim) + kPi * kRim;
    shape.cap_cells = trunk.cap_cells;
    shape.rows = trunk.rows;
    shape.cap_share = 0.75f / total;
    shape.tiles = (total - 1.5f) / (2 * kPi);
    return shape;
}

} // namespace

LatheBody make_trunk_body(const TrunkShape& shape) { return LatheBody(make_trunk_profile(shape)); }

Model make_trunk(const TrunkShape& shape, const ProgressFunction& on_progress) {
    const BarkSculptor sculptor;
    Model model = bake_model(
        "bark", DisplacementSpace::tangent, WrapMode::repeat, Texels::halves,
        [&](Vec2f uv) { return sculptor.sculpt(uv); }, on_progress);
    model.displacement.scale = Vec3f{1, 1, 1} * (2 * kPi);
    model.material.roughness = 0.85f;
    const LatheBody body = make_trunk_body(shape);
    model.make_mesh = [body](const Deformation& deform) { return body.make_mesh("trunk", deform); };
    return model;
}

} // namespace relief::samples
