#include "samples/party.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "math/vec_double.h"
#include "samples/noise.h"
#include "samples/stage.h"

namespace relief::samples {

namespace {

using Tints = std::vector<std::pair<std::string, Vec3f>>;

struct Kind {
    const char* name;
    uint32_t model;
    int count;
    float low_scale, high_scale;
    float footprint; ///< radius on the ground at scale 1
    float lift;      ///< height of the origin at scale 1
    float variation;
    Tints tints; ///< of the model's colours, taken in turn
};

struct Disc {
    float x, z, radius;
};

/// Where things may stand: a wedge before the camera, which looks along -z.
class Floor {
  public:
    explicit Floor(uint32_t seed) : random_(seed) {}

    /// A free place for a disc, the field growing until one is found.
    Disc find_place(float radius) {
        for (float reach = 9;; reach *= 1.02f)
            for (int i = 0; i < 60; ++i) {
                const float z = 4.2f - std::sqrt(random_.unit()) * 2 * reach;
                const float half_width = 3.1f + 0.5f * (4.5f - z);
                const Disc disc{random_.range(-half_width, half_width), z, radius};
                const bool is_free = std::none_of(discs_.begin(), discs_.end(), [&](const Disc& other) {
                    return compute_length(other.x - disc.x, other.z - disc.z) <
                           0.93f * (other.radius + radius);
                });
                if (!is_free) continue;
                discs_.push_back(disc);
                return disc;
            }
    }

    void block(const Disc& disc) { discs_.push_back(disc); }
    Random& random() { return random_; }

  private:
    Random random_;
    std::vector<Disc> discs_;
};

void add_displaced(Stage& stage, Floor& floor, const Kind& kind) {
    // Large ones first, so that small ones fill the gaps.
    std::vector<float> scales;
    for (int i = 0; i < kind.count; ++i) {
        const float f = floor.random().unit();
        scales.push_back(lerp(kind.low_scale, kind.high_scale, f * f));
    }
    std::sort(scales.rbegin(), scales.rend());
    for (size_t i = 0; i < scales.size(); ++i) {
        const float scale = scales[i];
        const Disc disc = floor.find_place(kind.footprint * scale);
        const float turn = floor.random().range(0, 360), tilt = floor.random().range(-8, 8);
        stage.add_displaced(kind.model, kind.name + ("_" + std::to_string(i + 1)),
                            place({disc.x, kind.lift * scale, disc.z}, scale, turn, tilt),
                            make_variation(hash(int(i), 1, 2, kind.model + 5), kind.variation));
        const auto& [tint_name, tint] = kind.tints[hash(int(i), 3, 4, 307) % kind.tints.size()];
        stage.tint_last(kind.model, tint_name, tint);
    }
}

Material make_material(const std::string& name, const Vec3f& color, float roughness, float metallic) {
    Material material;
    material.name = name;
    material.base_color = color;
    material.roughness = roughness;
    material.metallic = metallic;
    return material;
}

void scatter_plain(Stage& stage, Floor& floor, const Mesh& mesh, const Material& material, int count,
                   float lift) {
    for (int i = 0; i < count; ++i) {
        const float scale = floor.random().range(0.2f, 0.42f);
        const Disc disc = floor.find_place(0.6f * scale);
        const Affine transform =
            place({disc.x, lift * scale, disc.z}, scale, floor.random().range(0, 360), 0);
        const std::string name = material.name + "_" + std::to_string(i + 1);
        if (i == 0)
            stage.add_plain(mesh, name, material, transform);
        else
            stage.repeat_plain(name, transform);
    }
}

void add_plain_objects(Stage& stage, Floor& floor) {
    const Mesh gem = make_gem(8), ball = make_icosphere(2, Shading::smooth),
               stone = make_icosphere(1, Shading::faceted);
    scatter_plain(stage, floor, gem, make_material("ruby", {0.62f, 0.02f, 0.06f}, 0.06f, 0.35f), 14, 0.46f);
    scatter_plain(stage, floor, gem, make_material("sapphire", {0.02f, 0.08f, 0.55f}, 0.06f, 0.35f), 14,
                  0.46f);
    scatter_plain(stage, floor, ball, make_material("gold_ball", {0.95f, 0.66f, 0.25f}, 0.16f, 1), 10, 1);
    scatter_plain(stage, floor, ball, make_material("pearl", {0.86f, 0.82f, 0.78f}, 0.2f, 0), 10, 1);
    scatter_plain(stage, floor, stone, make_material("crystal", {0.45f, 0.75f, 0.70f}, 0.1f, 0.2f), 14, 0.9f);
}

} // namespace

Scene make_party_scene(Instancing instancing, const ProgressFunction& on_progress) {
    Stage stage(instancing);
    Floor floor(301);
    TrunkShape trunk;
    trunk.cap_cells = 6, trunk.rows = 36, trunk.height = 9;
    const auto part = [&](int k) { return make_part(on_progress, k / 5.0, (k + 1) / 5.0); };
    const uint32_t bark = stage.add_model(make_trunk(trunk, part(0)));
    const uint32_t pumpkin = stage.add_model(make_pumpkin(part(1)));
    const uint32_t mushroom = stage.add_model(make_mushroom(part(2)));
    const uint32_t coral = stage.add_model(make_coral(part(3)));
    const uint32_t ring = stage.add_model(make_scale_ring(part(4)));
    const Vec3f white{1, 1, 1};
    const Tints rings{{"scales", white}, {"scales_bronze", {1, 0.5f, 0.3f}}};
    const Tints pumpkins{{"pumpkin", white},
                         {"pumpkin_red", {0.85f, 0.48f, 0.45f}},
                         {"pumpkin_green", {0.40f, 0.78f, 0.8f}},
                         {"pumpkin", white}};
    const Tints corals{
        {"coral", white}, {"coral_violet", {0.55f, 0.6f, 1}}, {"coral_sand", {1, 0.9f, 0.55f}}};
    add_displaced(stage, floor, {"trunk", bark, 9, 0.55f, 0.95f, 1.15f, -0.2f, 0.04f, {{"bark", white}}});
    add_displaced(stage, floor, {"ring", ring, 16, 0.45f, 0.9f, 1.42f, 0.40f, 0.05f, rings});
    add_displaced(stage, floor, {"pumpkin", pumpkin, 52, 0.35f, 1.0f, 1.1f, 0.80f, 0.10f, pumpkins});
    add_displaced(stage, floor, {"coral", coral, 38, 0.25f, 0.7f, 1.2f, 0.95f, 0.08f, corals});
    const Tints mushrooms{{"mushroom", white}};
    add_displaced(stage, floor, {"mushroom", mushroom, 40, 0.5f, 1.3f, 0.72f, 0.0f, 0.07f, mushrooms});
    add_plain_objects(stage, floor);
    stage.add_ground(0, 90, {0.30f, 0.26f, 0.20f});
    stage.light({-122, 36, {1.0f, 0.84f, 0.64f}, 3.8f});
    return stage.finish({0.2f, 3.5f, 9.3f}, {0, 0.75f, 0}, 36);
}

} // namespace relief::samples
