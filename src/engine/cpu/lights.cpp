#include "engine/cpu/lights.h"

#include <algorithm>
#include <array>

namespace relief::cpu {

namespace {

constexpr size_t kBlock = 32; ///< points that lights are drawn for together

} // namespace

LightSet::LightSet(const Tracer& tracer) : tracer_(tracer) {
    const PreparedScene& scene = tracer.scene();
    if (scene.environment) environment_.emplace(*scene.environment);
    find_sources();
}

void LightSet::follow_surfaces() {
    if (has_emitters()) find_sources();
}

void LightSet::find_sources() {
    emitters_ = make_emitter_table(tracer_.scene());
    sources_ =
        make_light_sources(tracer_.scene(), environment_ ? environment_->mean_luminance() : 0.0f, emitters_);
}

float LightSet::total_irradiance(const Vec3f& position) const {
    float total = 0;
    for (const scalar::LightSourceData& source : sources_)
        total += scalar::estimate_irradiance(source, position);
    return total;
}

LightSet::Pick LightSet::pick_source(const Vec3f& position, float u_light) const {
    const float total = total_irradiance(position);
    if (!(total > 0)) return {nullptr, 0};
    const float target = u_light * total;
    size_t picked = 0;
    float estimate = scalar::estimate_irradiance(sources_[0], position);
    for (float running = estimate; running <= target && picked + 1 < sources_.size(); running += estimate)
        estimate = scalar::estimate_irradiance(sources_[++picked], position);
    return {&sources_[picked], estimate / total};
}

/// Not from the environment.
LightSample LightSet::draw_from(const Pick& pick, const Receiver& at, const RandomNumbers& random) const {
    if (pick.source->kind == scalar::kSourceSun)
        return {scalar::draw_sun(*pick.source, random.u), std::nullopt};
    if (pick.source->kind == scalar::kSourcePoint)
        return {scalar::draw_point_light(*pick.source, at.position, random.u), std::nullopt};
    return draw_emitter(at, random.u_emitter, random.u);
}

std::optional<LightSample> LightSet::draw(const Receiver& at, const RandomNumbers& random) const {
    std::optional<LightSample> drawn;
    draw_block({&at, 1}, {&random, 1}, {&drawn, 1});
    return drawn;
}

void LightSet::draw(std::span<const Receiver> at, std::span<const RandomNumbers> random,
                    std::span<std::optional<LightSample>> drawn) const {
    for (size_t first = 0; first < at.size(); first += kBlock) {
        const size_t count = std::min(kBlock, at.size() - first);
        draw_block(at.subspan(first, count), random.subspan(first, count), drawn.subspan(first, count));
    }
}

void LightSet::draw_block(std::span<const Receiver> at, std::span<const RandomNumbers> random,
                          std::span<std::optional<LightSample>> drawn) const {
    std::array<Pick, kBlock> picks;
    std::array<uint32_t, kBlock> receivers; // of light from the environment
    std::array<Vec2f, kBlock> u;
    std::array<EnvironmentLight::DirectionSample, kBlock> directions;
    size_t count = 0;
    const auto finish = [&](size_t k, const LightSample& sample) {
        drawn[k].reset();
        if (!(sample.pdf > 0) || dot(sample.direction, at[k].normal) <= 0) return;
        drawn[k] = sample;
        drawn[k]->pdf *= picks[k].probability;
        drawn[k]->weight *= 1 / picks[k].probability;
    };
    for (size_t k = 0; k < at.size(); ++k) {
        picks[k] = pick_source(at[k].position, random[k].u_light);
        if (!picks[k].source)
            drawn[k].reset();
        else if (picks[k].source->kind == scalar::kSourceEnvironment)
            receivers[count] = uint32_t(k), u[count++] = random[k].u;
        else
            finish(k, draw_from(picks[k], at[k], random[k]));
    }
    if (count == 0) return;
    environment_->draw_directions({u.data(), count}, {directions.data(), count});
    // Half of the directions lead into the surface: the image, far too large for a cache, is not read for
    // them.
    const auto is_lit = [&](size_t n) {
        return directions[n].pdf > 0 && dot(directions[n].direction, at[receivers[n]].normal) > 0;
    };
    for (size_t n = 0; n < count; ++n)
        if (is_lit(n)) environment_->prefetch_radiance(directions[n].position);
    for (size_t n = 0; n < count; ++n) {
        const EnvironmentLight::DirectionSample& found = directions[n];
        const Vec3f weight = is_lit(n) ? environment_->radiance(found) * (1 / found.pdf) : Vec3f{};
        finish(receivers[n], {{found.direction, scalar::make_infinity(), weight, found.pdf}, std::nullopt});
    }
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

Vec3f LightSet::environment_radiance(const Vec2f& position) const {
    return environment_ ? environment_->radiance(position) : Vec3f{};
}

Vec3f LightSet::gather(const BounceRay& ray, const Vec2f& position) const {
    Vec3f sum{};
    const float total = total_irradiance(ray.origin);
    for (const scalar::LightSourceData& source : sources_) {
        scalar::LightSeen seen = scalar::meet_light(source, ray.origin, ray.direction, ray.distance);
        if (source.kind == scalar::kSourceEnvironment && ray.distance == scalar::make_infinity()) {
            const EnvironmentLight::Lookup found = environment_->look_up(ray.direction, position);
            seen = {found.radiance, found.pdf};
        }
        if (seen.radiance == Vec3f{}) continue;
        const float share = total > 0 ? scalar::estimate_irradiance(source, ray.origin) / total : 0.0f;
        sum += seen.radiance * scalar::power_heuristic(ray.bsdf_pdf, seen.pdf * share);
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
