#include "prepare/light_sources.h"

#include <cmath>
#include <numbers>

#include "formulas/basis.h"
#include "formulas/bsdf.h"
#include "formulas/light_source.h"
#include "math/affine.h"

namespace relief {

namespace {

float world_area(const Surface& surface, const Instance& instance, const Quad& quad) {
    Vec3f p[4];
    for (int k = 0; k < 4; ++k)
        p[k] = transform_point(instance.world_from_object, surface.position(quad.vertex[size_t(k)]));
    return 0.5f * (length(cross(p[1] - p[0], p[2] - p[0])) + length(cross(p[2] - p[0], p[3] - p[0])));
}

scalar::LightSourceData make_source(uint32_t kind, float power) {
    scalar::LightSourceData source{};
    source.kind = kind;
    source.power = power;
    return source;
}

scalar::LightSourceData make_light_source(const Light& light, float power) {
    const bool is_sun = light.type == LightType::sun;
    scalar::LightSourceData source = make_source(is_sun ? scalar::kSourceSun : scalar::kSourcePoint, power);
    source.color = light.color;
    source.strength = light.strength;
    if (is_sun) {
        const double half_angle = light.angle_degrees * std::numbers::pi / 360;
        const double half_sine = std::sin(half_angle / 2);
        source.basis = scalar::make_basis(normalize(-light.direction));
        source.cone = float(2 * half_sine * half_sine);
    } else {
        source.center = light.position;
        source.radius = light.radius;
        source.radius2 = light.radius * light.radius;
    }
    return source;
}

} // namespace

EmitterTable make_emitter_table(const PreparedScene& scene) {
    EmitterTable table;
    table.first_of_instance.assign(scene.instances.size(), kNoIndex);
    table.cumulative.assign(1, 0.0);
    Box box;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const float brightness = scalar::luminance(scene.materials[instance.material].emission);
        if (!(brightness > 0)) continue;
        const Surface& surface = scene.surfaces[instance.surface];
        table.first_of_instance[i] = table.size();
        table.ranges.push_back({i, table.first_of_instance[i]});
        for (const Quad quad : surface.quads) {
            for (uint32_t vertex : quad.vertex)
                box.extend(transform_point(instance.world_from_object, surface.position(vertex)));
            table.power += double(brightness) * world_area(surface, instance, quad);
            table.cumulative.push_back(table.power);
        }
    }
    if (!(table.power > 0)) return table;
    for (double& value : table.cumulative) value /= table.power;
    table.center = box.center();
    table.radius2 = 0.25f * dot(box.extent(), box.extent());
    return table;
}

std::vector<scalar::LightSourceData>
make_light_sources(const PreparedScene& scene, float environment_luminance, const EmitterTable& emitters) {
    std::vector<scalar::LightSourceData> sources;
    if (environment_luminance > 0)
        sources.push_back(
            make_source(scalar::kSourceEnvironment, std::numbers::pi_v<float> * environment_luminance));
    for (const Light& light : scene.lights) {
        const float power = scalar::luminance(light.color) * light.strength;
        if (power > 0) sources.push_back(make_light_source(light, power));
    }
    if (emitters.power > 0) {
        scalar::LightSourceData source = make_source(scalar::kSourceEmitters, float(emitters.power));
        source.center = emitters.center;
        source.radius2 = emitters.radius2;
        sources.push_back(source);
    }
    return sources;
}

} // namespace relief
