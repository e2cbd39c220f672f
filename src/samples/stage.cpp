#include "samples/stage.h"

#include <algorithm>
#include <cmath>

#include "math/affine.h"
#include "samples/noise.h"

namespace relief::samples {

uint32_t Stage::add_material(const Material& material) {
    scene_.materials.push_back(material);
    return uint32_t(scene_.materials.size() - 1);
}

uint32_t Stage::add_mesh(Mesh mesh, const std::string& name) {
    mesh.name = name;
    scene_.meshes.push_back(std::move(mesh));
    return uint32_t(scene_.meshes.size() - 1);
}

uint32_t Stage::add_model(const Model& model) {
    Entry entry;
    entry.model = model;
    entry.displacement = uint32_t(scene_.displacements.size());
    scene_.displacements.push_back(model.displacement);
    entry.material = add_material(model.material);
    models_.push_back(std::move(entry));
    return uint32_t(models_.size() - 1);
}

void Stage::add_displaced(uint32_t model, const std::string& name, const Affine& world_from_object,
                          const Deformation& deform) {
    Entry& entry = models_[model];
    if (instancing_ == Instancing::none || entry.mesh == kNoIndex) {
        const bool is_shared = instancing_ == Instancing::shared;
        entry.mesh = add_mesh(entry.model.make_mesh(is_shared ? make_variation(0, 0) : deform),
                              is_shared ? entry.model.displacement.name : name);
    }
    scene_.objects.push_back({name, entry.mesh, entry.displacement, entry.material, world_from_object});
}

void Stage::tint_last(uint32_t model, const std::string& name, const Vec3f& tint) {
    const auto known = std::find_if(scene_.materials.begin(), scene_.materials.end(),
                                    [&](const Material& material) { return material.name == name; });
    if (known != scene_.materials.end()) {
        scene_.objects.back().material = uint32_t(known - scene_.materials.begin());
        return;
    }
    Material material = models_[model].model.material;
    material.name = name;
    material.base_color = tint;
    scene_.objects.back().material = add_material(material);
}

void Stage::paint_last(const Material& material) { scene_.objects.back().material = add_material(material); }

void Stage::add_plain(Mesh mesh, const std::string& name, const Material& material,
                      const Affine& world_from_object) {
    const uint32_t index = add_mesh(std::move(mesh), name);
    scene_.objects.push_back({name, index, kNoIndex, add_material(material), world_from_object});
}

void Stage::repeat_plain(const std::string& name, const Affine& world_from_object) {
    scene_.objects.push_back({name, uint32_t(scene_.meshes.size() - 1), kNoIndex,
                              uint32_t(scene_.materials.size() - 1), world_from_object});
}

void Stage::light(const Sun& sun) {
    const Vec3f to_sun = sky_direction(sun.azimuth_degrees, sun.height_degrees);
    Light light;
    light.direction = -to_sun;
    light.angle_degrees = 1.5f;
    light.color = sun.color;
    light.strength = sun.strength;
    scene_.lights.push_back(light);
    Environment environment;
    environment.texture = make_sky(to_sun, sun.color);
    scene_.environment = environment;
}

void Stage::add_ground(float y, float half_size, const Vec3f& color) {
    Material material;
    material.name = "ground";
    material.base_color = color;
    material.roughness = 0.9f;
    add_plain(make_plane(half_size, 16), "ground", material, make_translation({0, y, 0}));
}

Scene Stage::finish(const Vec3f& from, const Vec3f& to, float fov_degrees) {
    scene_.camera.from = from, scene_.camera.to = to, scene_.camera.fov_degrees = fov_degrees;
    scene_.camera.focus_distance = length(to - from); // for whoever opens the aperture
    scene_.picture.width = 1280, scene_.picture.height = 720;
    scene_.picture.spp = 64, scene_.picture.bounces = 4;
    return std::move(scene_);
}

Deformation make_variation(uint32_t seed, float amount) {
    if (seed == 0) return [](const Vec3f& p) { return p; };
    Random random(seed);
    const Vec3f stretch{1 + random.range(-amount, amount), 1 + 1.5f * random.range(-amount, amount),
                        1 + random.range(-amount, amount)};
    const Vec2f lean{random.range(-amount, amount), random.range(-amount, amount)};
    const float phase = random.range(0, 6), wave = random.range(0.3f, 1.0f) * amount;
    return [=](const Vec3f& p) {
        const float swell = 1 + wave * std::sin(2.2f * p.y + phase);
        return Vec3f{stretch.x * swell * p.x + lean.x * p.y, stretch.y * p.y,
                     stretch.z * swell * p.z + lean.y * p.y};
    };
}

Affine place(const Vec3f& position, float scale, float turn_degrees, float tilt_degrees) {
    const Affine turned =
        compose(make_rotation_degrees({tilt_degrees, 0, 0}), make_rotation_degrees({0, turn_degrees, 0}));
    return compose(make_translation(position), compose(turned, make_scale({scale, scale, scale})));
}

} // namespace relief::samples
