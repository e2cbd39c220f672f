#include "samples/materials.h"

#include <array>

#include "samples/stage.h"

namespace relief::samples {

namespace {

Material make_base(const char* name, const Vec3f& color, float roughness) {
    Material m;
    m.name = name;
    m.base_color = color, m.roughness = roughness;
    return m;
}

Material make_clay() {
    Material m = make_base("clay", {0.72f, 0.50f, 0.38f}, 1);
    m.base_diffuse_roughness = 1, m.ior = 1;
    return m;
}

Material make_metal(const char* name, const Vec3f& color, const Vec3f& edge, float roughness) {
    Material m = make_base(name, color, roughness);
    m.metallic = 1, m.specular_color = edge;
    return m;
}

Material add_coat(Material m, const Vec3f& color, float weight, float roughness) {
    m.coat_weight = weight, m.coat_color = color, m.coat_roughness = roughness;
    return m;
}

Material make_porcelain() {
    Material m = add_coat(make_base("porcelain", {0.86f, 0.84f, 0.80f}, 0.35f), {1, 1, 1}, 1, 0.02f);
    m.coat_darkening = 0.3f;
    return m;
}

Material make_car_paint() {
    Material m = add_coat(make_base("car_paint", {0.75f, 0.03f, 0.03f}, 0.45f), {1, 0.8f, 0.75f}, 1, 0.03f);
    m.metallic = 0.65f;
    return m;
}

Material make_cloth(const char* name, const Vec3f& color, const Vec3f& fuzz, float fuzz_roughness) {
    Material m = make_base(name, color, 0.8f);
    m.base_diffuse_roughness = 0.9f, m.specular_weight = 0.25f;
    m.fuzz_weight = 1, m.fuzz_color = fuzz, m.fuzz_roughness = fuzz_roughness;
    return m;
}

Material make_rubber() {
    Material m = make_base("rubber", {0.035f, 0.035f, 0.04f}, 0.55f);
    m.specular_weight = 0.7f;
    return m;
}

/// The squash itself, waxed and dusty.
Material make_dusty(Material m) {
    m.name = "dusty";
    m = add_coat(m, {1, 1, 1}, 0.35f, 0.25f);
    m.fuzz_weight = 0.25f, m.fuzz_color = {0.9f, 0.95f, 1.0f};
    return m;
}

/// Four in a row, the farthest row first.
std::array<Material, 12> make_materials(const Material& squash) {
    const Vec3f white{1, 1, 1};
    return {make_clay(),
            make_porcelain(),
            add_coat(make_base("cobalt", {0.05f, 0.12f, 0.62f}, 0.3f), white, 1, 0.05f),
            make_metal("gold", {1.0f, 0.71f, 0.29f}, {1, 0.92f, 0.75f}, 0.18f),
            make_metal("copper", {0.93f, 0.48f, 0.33f}, {1, 0.85f, 0.7f}, 0.42f),
            add_coat(make_metal("blue_steel", {0.56f, 0.57f, 0.58f}, {0.35f, 0.5f, 1.0f}, 0.3f),
                     {0.55f, 0.65f, 0.95f}, 0.5f, 0.1f),
            make_car_paint(),
            make_cloth("velvet", {0.12f, 0.015f, 0.09f}, {0.9f, 0.45f, 0.75f}, 0.3f),
            make_cloth("moss", {0.10f, 0.16f, 0.04f}, {0.65f, 0.8f, 0.3f}, 0.6f),
            add_coat(make_base("amber", {0.80f, 0.50f, 0.20f}, 0.4f), {0.95f, 0.50f, 0.12f}, 1, 0.08f),
            make_rubber(),
            make_dusty(squash)};
}

} // namespace

Scene make_materials_scene(Instancing instancing, const ProgressFunction& on_progress) {
    Stage stage(instancing);
    const Model squash = make_pumpkin(on_progress);
    const uint32_t model = stage.add_model(squash);
    int count = 0;
    for (const Material& material : make_materials(squash.material)) {
        const int row = count / 4, column = count % 4;
        const Vec3f position{(float(column) - 1.5f) * 2.6f + (row == 1 ? 0.65f : 0.0f), 0.84f,
                             float(row - 1) * 2.6f};
        stage.add_displaced(model, material.name, place(position, 1, 25 + 37 * float(count)),
                            make_variation(40 + uint32_t(count), 0.03f));
        stage.paint_last(material);
        ++count;
    }
    stage.add_ground(0, 40, {0.30f, 0.29f, 0.28f});
    stage.light({-118, 38, {1.0f, 0.86f, 0.70f}, 3.4f});
    return stage.finish({0.25f, 6.6f, 11.4f}, {0.25f, 0.35f, 0.15f}, 31.5f);
}

} // namespace relief::samples
