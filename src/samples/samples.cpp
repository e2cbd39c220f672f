#include "relief/samples.h"

#include <cmath>
#include <utility>

#include "relief/error.h"
#include "samples/materials.h"
#include "samples/noise.h"
#include "samples/party.h"
#include "samples/shot.h"
#include "samples/stage.h"

namespace relief {

namespace {

using namespace samples;

/// Roots spread at the foot of a trunk, and the stem narrows and leans a little further up.
Deformation make_trunk_growth(uint32_t seed, float height) {
    Random random(seed);
    const float phase = random.range(0, 6), spread = random.range(0.35f, 0.7f),
                narrowing = random.range(0.15f, 0.3f);
    const Vec2f lean{random.range(-0.05f, 0.05f), random.range(-0.05f, 0.05f)};
    return [=](const Vec3f& p) {
        const float angle = std::atan2(p.z, p.x), up = std::fmax(p.y, 0.0f);
        const float foot = std::exp(-up / 0.9f);
        const float lobes = 1 + 0.45f * std::cos(5 * angle + phase) + 0.2f * std::cos(3 * angle + 2 * phase);
        const float knots =
            0.05f * std::sin(1.3f * p.y + phase + 2 * angle) + 0.04f * std::sin(2.9f * p.y - angle);
        const float swell = 1 + spread * foot * lobes + knots - narrowing * up / height;
        return Vec3f{p.x * swell + lean.x * p.y * p.y / height * 4, p.y,
                     p.z * swell + lean.y * p.y * p.y / height * 4};
    };
}

Scene make_pumpkin_scene(Instancing instancing, const ProgressFunction& on_progress) {
    Stage stage(instancing);
    stage.add_displaced(stage.add_model(make_pumpkin(on_progress)), "pumpkin", place({0, 0.84f, 0}, 1, 25),
                        make_variation(3, 0.03f));
    stage.add_ground(0, 40, {0.42f, 0.37f, 0.31f});
    stage.light({-118, 34, {1.0f, 0.84f, 0.64f}, 3.6f});
    return stage.finish({1.35f, 2.25f, 3.9f}, {0.03f, 0.92f, 0}, 27);
}

Scene make_bark_scene(Instancing instancing, const ProgressFunction& on_progress) {
    Stage stage(instancing);
    const TrunkShape shape;
    const uint32_t bark = stage.add_model(make_trunk(shape, on_progress));
    stage.add_displaced(bark, "trunk", place({0, -0.4f, 0}, 1, 200), make_trunk_growth(4, shape.height));
    stage.add_ground(0, 40, {0.20f, 0.17f, 0.12f});
    stage.light({-128, 30, {1.0f, 0.82f, 0.60f}, 4.2f});
    return stage.finish({0.7f, 1.9f, 3.4f}, {0.02f, 1.5f, 0}, 42);
}

Scene make_barks_scene(Instancing instancing, const ProgressFunction& on_progress) {
    Stage stage(instancing);
    TrunkShape shape;
    shape.rows = 74;
    const uint32_t bark = stage.add_model(make_trunk(shape, on_progress));
    struct Tree {
        Vec3f position;
        float scale, turn;
    };
    const Tree trees[] = {{{-2.3f, 0, 0.6f}, 1.0f, 10},  {{2.5f, 0, -0.6f}, 1.15f, 140},
                          {{0.2f, 0, -3.6f}, 0.9f, 250}, {{-5.2f, 0, -4.6f}, 1.1f, 75},
                          {{5.9f, 0, -6.0f}, 1.2f, 310}, {{-1.9f, 0, -9.5f}, 1.0f, 30},
                          {{2.9f, 0, -11.5f}, 1.1f, 190}};
    uint32_t count = 0;
    for (const Tree& tree : trees) {
        ++count;
        stage.add_displaced(bark, "trunk_" + std::to_string(count),
                            place(tree.position - Vec3f{0, 0.4f * tree.scale, 0}, tree.scale, tree.turn),
                            make_trunk_growth(20 + count, shape.height));
    }
    stage.add_ground(0, 60, {0.19f, 0.17f, 0.11f});
    stage.light({-132, 32, {1.0f, 0.80f, 0.56f}, 4.6f});
    return stage.finish({0.3f, 2.3f, 8.2f}, {0.15f, 2.1f, -1}, 38);
}

Scene make_ear_scene(Instancing instancing, const ProgressFunction& on_progress) {
    Stage stage(instancing);
    stage.add_displaced(stage.add_model(make_ear(on_progress)), "ear", Affine{},
                        [](const Vec3f& p) { return p; });
    stage.light({-125, 42, {1.0f, 0.90f, 0.78f}, 3.2f});
    return stage.finish({1.15f, 0.45f, 3.6f}, {0.02f, 0.03f, 0.12f}, 32);
}

using Maker = Scene (*)(Instancing, const ProgressFunction&);

constexpr std::pair<const char*, Maker> kScenes[] = {
    {"pumpkin", make_pumpkin_scene}, {"bark", make_bark_scene}, {"barks", make_barks_scene},
    {"party", make_party_scene},     {"ear", make_ear_scene},   {"materials", make_materials_scene},
    {"shot", make_shot_scene}};

} // namespace

std::vector<std::string> sample_scene_names() {
    std::vector<std::string> names;
    for (const auto& [name, maker] : kScenes) names.emplace_back(name);
    return names;
}

namespace {

Maker find_maker(const std::string& name) {
    std::string known;
    for (const auto& [candidate, maker] : kScenes) {
        if (name == candidate) return maker;
        known += (known.empty() ? "" : ", ") + std::string(candidate);
    }
    throw Error(ErrorKind::usage, {"there is no sample scene of this name", name, "known are " + known});
}

} // namespace

Scene make_sample_scene(const std::string& name, Instancing instancing, const ProgressFunction& on_progress) {
    return find_maker(name)(instancing, on_progress);
}

SceneMotion make_sample_motion(const std::string& name, const ProgressFunction& on_progress) {
    return find_maker(name) == make_shot_scene ? make_shot_motion(on_progress) : SceneMotion{};
}

} // namespace relief
