#include "engine/cpu/lights.h"

#include <algorithm>

namespace relief::cpu {

LightSet::LightSet(const Tracer& tracer) : tracer_(tracer), emitters_(make_emitter_table(tracer.scene())) {
    const PreparedScene& scene = tracer.scene();
    if (scene.environment) environment_.emplace(*scene.environment);
    sources_ = make_light_sources(scene, environment_ ? environment_->mean_luminance() : 0.0f, emitters_);
}

float LightSet::total_irradiance(const Vec3f& position) const {
    float total = 0;
    for (const scalar::LightSourceData& source : sources_)
        total += scalar::estimate_irradiance(source, position);
    return total;
}

std::optional<LightSample> LightSet::draw(const Receiver& at, const RandomNumbers& random) const {
    const Vec3f& position = at.position;
    const float total = total_irradiance(position);
    if (!(total > 0)) return std::nullopt;
    const float target = random.u_light * total;
    size_t picked = 0;
    float estimate = scalar::estimate_irradiance(sources_[0], position);
    for (float running = estimate; running <= target && picked + 1 < sources_.size(); running += estimate)
        estimate = scalar::estimate_irradiance(sources_[++picked], position);
    const scalar::LightSourceData& source = sources_[picked];
    LightSample result;
    if (source.kind == scalar::kSourceEnvironment) {
        const std::optional<LightSample> drawn = draw_environment(at, random.u);
        if (!drawn) return std::nullopt;
        result = *drawn;
    } else if (source.kind == scalar::kSourceSun) {
        result = {scalar::draw_sun(source, random.u), std::nullopt};
    } else if (source.kind == scalar::kSourcePoint) {
        result = {scalar::draw_point_light(source, position, random.u), std::nullopt};
    } else {
        result = draw_emitter(at, random.u_emitter, random.u);
    }
    if (!(result.pdf > 0) || dot(result.direction, at.normal) <= 0) return std::nullopt;
    const float probability = estimate / total;
    result.pdf *= probability;
    result.weight *= 1 / probability;
    return result;
}

std::optional<LightSample> LightSet::draw_environment(const Receiver& at, const Vec2f& u) const {
    const auto drawn = environment_->draw_direction(u);
    // Half of the directions lead into the surface: the image, far too large for a cache, is not read for
    // them.
    if (!(drawn.pdf > 0) || dot(drawn.direction, at.normal) <= 0) return std::nullopt;
    const Vec3f weight = environment_->radiance(drawn) * (1 / drawn.pdf);
    return LightSample{{drawn.direction, scalar::make_infinity(), weight, drawn.pdf}, std::nullopt};
}

LightSample LightSet::draw_emitter(const Receiver& at, float u_emitter, const Vec2f& u) const {
    const auto above =
        std::upper_bound(emitters_.cumulative.begin() + 1, emitters_.cumulative.end() - 1, double(u_emitter));
    const uint32_t emitter = uint32_t(above - emitters_.cumulative.begin()) - 1;
    const auto after =
        std::upper_bound(emitters_.ranges.begin(), emitters_.ranges.end(), emitter,
                         [](uint32_t e, const EmitterTable::Range& range) { return e < range.first; });
    const EmitterTable::Range& range = *(after - 1);
    const PreparedScene& scene = tracer_.scene();
    const Instance& instance = scene.instances[range.instance];
    const uint32_t quad = emitter - range.first;
    const bool is_triangle = scene.surfaces[instance.surface].quads[quad].is_triangle();
    const Vec2f uv = is_triangle ? scalar::square_to_triangle(u) : u;
    const SurfacePoint point = tracer_.evaluate_point(range.instance, quad, uv, at.bias);
    const float pdf = emitter_density(emitter, at.position, point);
    return {
        scalar::draw_emitter(scene.materials[instance.material].emission, point.position - at.position, pdf),
        point};
}

float LightSet::emitter_density(uint32_t emitter, const Vec3f& origin, const SurfacePoint& point) const {
    return scalar::emitter_density(emitters_.probability(emitter), point.area_per_uv, point.geometric_normal,
                                   point.position - origin);
}

float LightSet::emitter_pdf(const Vec3f& origin, const SurfacePoint& point) const {
    const uint32_t first = emitters_.first_of_instance[point.instance];
    if (first == kNoIndex || sources_.empty() || sources_.back().kind != scalar::kSourceEmitters) return 0;
    const float probability = scalar::estimate_irradiance(sources_.back(), origin) / total_irradiance(origin);
    return probability * emitter_density(first + point.patch, origin, point);
}

Vec3f LightSet::environment_radiance(const Vec3f& direction) const {
    return environment_ ? environment_->radiance(direction) : Vec3f{};
}

Vec3f LightSet::gather(const Vec3f& origin, const Vec3f& direction, float distance, float bsdf_pdf) const {
    Vec3f sum{};
    const float total = total_irradiance(origin);
    for (const scalar::LightSourceData& source : sources_) {
        scalar::LightSeen seen = scalar::meet_light(source, origin, direction, distance);
        if (source.kind == scalar::kSourceEnvironment && distance == scalar::make_infinity()) {
            const EnvironmentLight::Lookup found = environment_->look_up(direction);
            seen = {found.radiance, found.pdf};
        }
        if (seen.radiance == Vec3f{}) continue;
        const float share = total > 0 ? scalar::estimate_irradiance(source, origin) / total : 0.0f;
        sum += seen.radiance * scalar::power_heuristic(bsdf_pdf, seen.pdf * share);
    }
    return sum;
}

size_t LightSet::byte_count() const {
    return (environment_ ? environment_->byte_count() : 0) +
           sources_.size() * sizeof(scalar::LightSourceData) + emitters_.cumulative.size() * sizeof(double) +
           emitters_.ranges.size() * sizeof(EmitterTable::Range) +
           emitters_.first_of_instance.size() * sizeof(uint32_t);
}

} // namespace relief::cpu
