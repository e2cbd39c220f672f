#include "engine/cpu/lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "math/affine.h"

namespace relief::cpu {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kPi = std::numbers::pi_v<float>;

float luminance(const Vec3f& c) { return scalar::luminance(c); }

float world_area(const Surface& surface, const Instance& instance, const Quad& quad) {
    Vec3f p[4];
    for (int k = 0; k < 4; ++k)
        p[k] = transform_point(instance.world_from_object, surface.positions[quad.vertex[size_t(k)]]);
    return 0.5f * (length(cross(p[1] - p[0], p[2] - p[0])) + length(cross(p[2] - p[0], p[3] - p[0])));
}

/// Radiance of a light that has a shape: a sun's disc, or the sphere of a point light.
Vec3f shape_radiance(const Light& light, float cone) {
    // A disc of half angle a has the projected solid angle pi sin(a)^2, and sin^2 = h (2 - h) with h = 1 -
    // cos.
    const float measure =
        light.type == LightType::sun ? kPi * cone * (2 - cone) : kPi * light.radius * light.radius;
    return light.color * (light.strength / measure);
}

} // namespace

LightSet::LightSet(const Tracer& tracer) : tracer_(tracer) {
    if (tracer.scene().environment) {
        environment_.emplace(*tracer.scene().environment);
        if (environment_->mean_luminance() > 0)
            sources_.push_back({Kind::environment, 0, kPi * environment_->mean_luminance(), {}, 0});
    }
    add_lights();
    add_emitters();
}

void LightSet::add_lights() {
    const std::vector<Light>& lights = tracer_.scene().lights;
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        const float power = luminance(light.color) * light.strength;
        if (!(power > 0)) continue;
        if (light.type == LightType::point) {
            sources_.push_back({Kind::point, i, power, {}, 0});
            continue;
        }
        const double half_angle = light.angle_degrees * std::numbers::pi / 360;
        const double half_sine = std::sin(half_angle / 2);
        sources_.push_back({Kind::sun, i, power, scalar::make_basis(normalize(-light.direction)),
                            float(2 * half_sine * half_sine)});
    }
}

void LightSet::add_emitters() {
    const PreparedScene& scene = tracer_.scene();
    first_of_instance_.assign(scene.instances.size(), kNoIndex);
    emitter_cumulative_.assign(1, 0.0);
    Box box;
    double power = 0;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const float brightness = luminance(scene.materials[instance.material].emission);
        if (!(brightness > 0)) continue;
        const Surface& surface = scene.surfaces[instance.surface];
        first_of_instance_[i] = uint32_t(emitter_cumulative_.size() - 1);
        emitter_ranges_.push_back({i, first_of_instance_[i]});
        for (const Quad& quad : surface.quads) {
            for (uint32_t vertex : quad.vertex)
                box.extend(transform_point(instance.world_from_object, surface.positions[vertex]));
            power += double(brightness) * world_area(surface, instance, quad);
            emitter_cumulative_.push_back(power);
        }
    }
    if (!(power > 0)) return;
    for (double& value : emitter_cumulative_) value /= power;
    emitter_center_ = box.center();
    emitter_radius2_ = 0.25f * dot(box.extent(), box.extent());
    sources_.push_back({Kind::emitters, 0, float(power), {}, 0});
}

float LightSet::estimate_irradiance(const Source& source, const Vec3f& position) const {
    if (source.kind == Kind::point) {
        const Light& light = tracer_.scene().lights[source.light];
        const Vec3f to = light.position - position;
        return source.power / std::max({dot(to, to), light.radius * light.radius, 1e-30f});
    }
    if (source.kind == Kind::emitters) {
        const Vec3f to = emitter_center_ - position;
        return source.power / std::max(dot(to, to) + emitter_radius2_, 1e-30f);
    }
    return source.power;
}

float LightSet::total_irradiance(const Vec3f& position) const {
    float total = 0;
    for (const Source& source : sources_) total += estimate_irradiance(source, position);
    return total;
}

std::optional<LightSample> LightSet::draw(const Receiver& at, const RandomNumbers& random) const {
    const Vec3f& position = at.position;
    const float total = total_irradiance(position);
    if (!(total > 0)) return std::nullopt;
    const float target = random.u_light * total;
    size_t picked = 0;
    float estimate = estimate_irradiance(sources_[0], position);
    for (float running = estimate; running <= target && picked + 1 < sources_.size(); running += estimate)
        estimate = estimate_irradiance(sources_[++picked], position);
    const Source& source = sources_[picked];
    LightSample result;
    switch (source.kind) {
    case Kind::environment: {
        const auto drawn = environment_->draw_direction(random.u);
        // Half of the directions lead into the surface: the image, far too large for a cache, is not read for them.
        if (!(drawn.pdf > 0) || dot(drawn.direction, at.normal) <= 0) return std::nullopt;
        result = {drawn.direction, kInfinity, environment_->radiance(drawn) * (1 / drawn.pdf), drawn.pdf,
                  std::nullopt};
        break;
    }
    case Kind::sun:
        result = draw_sun(source, random.u);
        break;
    case Kind::point:
        result = draw_point(source, position, random.u);
        break;
    case Kind::emitters:
        result = draw_emitter(position, at.bias, random.u_emitter, random.u);
        break;
    }
    if (!(result.pdf > 0) || dot(result.direction, at.normal) <= 0) return std::nullopt;
    const float probability = estimate / total;
    result.pdf *= probability;
    result.weight *= 1 / probability;
    return result;
}

LightSample LightSet::draw_sun(const Source& source, const Vec2f& u) const {
    const Light& light = tracer_.scene().lights[source.light];
    if (source.cone == 0)
        return {source.basis.n, kInfinity, light.color * light.strength, kInfinity, std::nullopt};
    const float pdf = scalar::cone_pdf(source.cone);
    const Vec3f direction =
        normalize(scalar::from_local(source.basis, scalar::square_to_cone(u, source.cone)));
    return {direction, kInfinity, shape_radiance(light, source.cone) * (1 / pdf), pdf, std::nullopt};
}

LightSample LightSet::draw_point(const Source& source, const Vec3f& position, const Vec2f& u) const {
    const Light& light = tracer_.scene().lights[source.light];
    const Vec3f to = light.position - position;
    const float distance = length(to);
    if (!(distance > 0)) return {};
    const Vec3f axis = to / distance;
    if (light.radius == 0)
        return {axis, distance, light.color * (light.strength / (distance * distance)), kInfinity,
                std::nullopt};
    const float cone = scalar::sphere_cone_height(light.radius, distance);
    const float pdf = scalar::cone_pdf(cone);
    const Vec3f local = scalar::square_to_cone(u, cone);
    const Vec3f direction = normalize(scalar::from_local(scalar::make_basis(axis), local));
    // At the rim rounding may miss the sphere: it is as far away as its tangent then.
    float reach = scalar::sphere_distance(to, light.radius, direction);
    if (reach <= 0) reach = distance;
    return {direction, reach, shape_radiance(light, cone) * (1 / pdf), pdf, std::nullopt};
}

LightSample LightSet::draw_emitter(const Vec3f& position, uint32_t bias, float u_emitter,
                                   const Vec2f& u) const {
    const auto above =
        std::upper_bound(emitter_cumulative_.begin() + 1, emitter_cumulative_.end() - 1, double(u_emitter));
    const uint32_t emitter = uint32_t(above - emitter_cumulative_.begin()) - 1;
    const auto after =
        std::upper_bound(emitter_ranges_.begin(), emitter_ranges_.end(), emitter,
                         [](uint32_t e, const EmitterRange& range) { return e < range.first; });
    const EmitterRange& range = *(after - 1);
    const PreparedScene& scene = tracer_.scene();
    const Instance& instance = scene.instances[range.instance];
    const uint32_t quad = emitter - range.first;
    const bool is_triangle = scene.surfaces[instance.surface].quads[quad].is_triangle();
    const Vec2f uv = is_triangle ? scalar::square_to_triangle(u) : u;
    const SurfacePoint point = tracer_.evaluate_point(range.instance, quad, uv, bias);
    const Vec3f to = point.position - position;
    const float distance = length(to);
    const float pdf = emitter_density(emitter, position, point);
    if (!(distance > 0) || !(pdf > 0) || !std::isfinite(pdf)) return {};
    return {to / distance, distance, scene.materials[instance.material].emission * (1 / pdf), pdf, point};
}

float LightSet::emitter_density(uint32_t emitter, const Vec3f& origin, const SurfacePoint& point) const {
    const Vec3f to = point.position - origin;
    const float distance2 = dot(to, to);
    const float cosine = std::fabs(dot(point.geometric_normal, to)) / std::sqrt(distance2);
    if (!(cosine > 0) || !(point.area_per_uv > 0)) return 0;
    const float probability = float(emitter_cumulative_[emitter + 1] - emitter_cumulative_[emitter]);
    return probability / point.area_per_uv * (distance2 / cosine);
}

float LightSet::emitter_pdf(const Vec3f& origin, const SurfacePoint& point) const {
    const uint32_t first = first_of_instance_[point.instance];
    if (first == kNoIndex || sources_.empty() || sources_.back().kind != Kind::emitters) return 0;
    const float probability = estimate_irradiance(sources_.back(), origin) / total_irradiance(origin);
    return probability * emitter_density(first + point.patch, origin, point);
}

Vec3f LightSet::environment_radiance(const Vec3f& direction) const {
    return environment_ ? environment_->radiance(direction) : Vec3f{};
}

Vec3f LightSet::gather(const Vec3f& origin, const Vec3f& direction, float distance, float bsdf_pdf) const {
    Vec3f sum{};
    const float total = total_irradiance(origin);
    for (const Source& source : sources_) {
        Vec3f radiance{};
        float pdf = 0;
        if (source.kind == Kind::environment && distance == kInfinity) {
            const auto seen = environment_->look_up(direction);
            radiance = seen.radiance, pdf = seen.pdf;
        } else if (source.kind == Kind::sun && source.cone > 0 && distance == kInfinity) {
            // 1 - cos from the chord between the unit vectors, exact for small angles.
            const Vec3f chord = direction - source.basis.n;
            if (0.5f * dot(chord, chord) > source.cone) continue;
            radiance = shape_radiance(tracer_.scene().lights[source.light], source.cone);
            pdf = scalar::cone_pdf(source.cone);
        } else if (source.kind == Kind::point) {
            const Light& light = tracer_.scene().lights[source.light];
            if (light.radius == 0) continue;
            const Vec3f to = light.position - origin;
            const float t = scalar::sphere_distance(to, light.radius, direction);
            if (!(t > 0) || t >= distance) continue;
            const float cone = scalar::sphere_cone_height(light.radius, length(to));
            radiance = shape_radiance(light, cone);
            pdf = scalar::cone_pdf(cone);
        }
        if (radiance == Vec3f{}) continue;
        const float share = total > 0 ? estimate_irradiance(source, origin) / total : 0.0f;
        sum += radiance * scalar::power_heuristic(bsdf_pdf, pdf * share);
    }
    return sum;
}

size_t LightSet::byte_count() const {
    return (environment_ ? environment_->byte_count() : 0) + sources_.size() * sizeof(Source) +
           emitter_cumulative_.size() * sizeof(double) + emitter_ranges_.size() * sizeof(EmitterRange) +
           first_of_instance_.size() * sizeof(uint32_t);
}

} // namespace relief::cpu
