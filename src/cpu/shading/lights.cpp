#include "cpu/shading/lights.h"
#include "cpu/shading/input_look_up.h"
#include "cpu/shading/kinds.h"
#include "cpu/shading/shading_kernels.h"
#include "formulas/constants.h"
#include "formulas/glass.h"
#include "formulas/light.h"
#include "formulas/light_source.h"
#include "formulas/warp.h"

#include <algorithm>
#include <array>

namespace relief::cpu {

namespace {

constexpr size_t kBlock = 64; ///< points that lights are drawn for together

} // namespace

LightSet::LightSet(const Tracer& tracer) : tracer_(tracer) {
    const PreparedScene& scene = tracer.scene();
    if (scene.environment) environment_.emplace(*scene.environment);
    find_sources();
}

void LightSet::follow_surfaces() {
    if (has_emitters()) find_sources();
}

void LightSet::follow_scene() {
    const std::optional<Environment>& environment = tracer_.scene().environment;
    if (!environment)
        environment_.reset();
    else if (!environment_ || !(environment_->environment() == *environment))
        environment_.emplace(*environment);
    find_sources();
}

void LightSet::find_sources() {
    emitters_ = make_emitter_table(tracer_.scene());
    choice_ = LightChoice(
        make_light_tables(tracer_.scene(), environment_ ? environment_->mean_luminance() : 0.0f, emitters_));
    has_analytic_lights_ = std::ranges::any_of(choice_.sources(), [](const scalar::LightSourceData& source) {
        const bool is_sphere = source.kind == scalar::kSourcePoint || source.kind == scalar::kSourceSpot;
        return scalar::is_flat(source) || (is_sphere && source.radius > 0);
    });
    has_visible_lights_ = std::ranges::any_of(
        choice_.sources(), [](const scalar::LightSourceData& source) { return source.is_visible != 0; });
}

void LightSet::draw_listed(const scalar::LightSourceData& source, const Receiver& at, const Vec2f& u,
                           LightSample& drawn) const {
    static_cast<scalar::LightDraw&>(drawn) = scalar::draw_listed_light(source, at.position, u);
    if (source.texture != kNoIndex && drawn.pdf > 0)
        drawn.weight = drawn.weight * choice_.fetch_color(source, at.position, drawn.direction);
}

/// Not from the environment.
void LightSet::draw_from(const LightChoice::Pick& pick, const Receiver& at, const RandomNumbers& random,
                         LightSample& drawn) const {
    if (!pick.source)
        draw_emitter(at, pick.emitter, random.u, drawn);
    else if (pick.source->kind == scalar::kSourceEmitters)
        draw_emitter(at, find_emitter(random.u_emitter), random.u, drawn);
    else
        draw_listed(*pick.source, at, random.u, drawn);
    drawn.pdf *= pick.probability;
    drawn.weight *= 1 / pick.probability;
}

void LightSet::draw(std::span<const Receiver> at, std::span<const RandomNumbers> random,
                    std::span<LightSample> drawn) const {
    for (size_t first = 0; first < at.size(); first += kBlock) {
        const size_t count = std::min(kBlock, at.size() - first);
        draw_block(at.subspan(first, count), random.subspan(first, count), drawn.subspan(first, count));
    }
}

/// Points of a block whose directions are drawn for many at once.
struct LightSet::SharedDraws {
    struct List {
        std::array<uint32_t, kBlock> points;
        std::array<LightChoice::Pick, kBlock> picks;
        std::array<Vec2f, kBlock> u;
        size_t count = 0;

        void add(size_t point, const LightChoice::Pick& pick, const Vec2f& numbers) {
            points[count] = uint32_t(point), picks[count] = pick, u[count++] = numbers;
        }
    };
    List environment, suns;
};

void LightSet::draw_block(std::span<const Receiver> at, std::span<const RandomNumbers> random,
                          std::span<LightSample> drawn) const {
    SharedDraws shared;
    for (size_t k = 0; k < at.size(); ++k) {
        const LightChoice::Pick pick = choice_.pick({at[k].position, at[k].normal, at[k].instance},
                                                    random[k].u_light, random[k].u_emitter);
        drawn[k].lacks_radiance = false;
        drawn[k].emitter.reset();
        drawn[k].group = pick.source ? pick.source->group : kNoIndex;
        if (!pick.source && pick.emitter == kNoIndex)
            drawn[k].pdf = 0, drawn[k].direction = {};
        else if (pick.source && pick.source->kind == scalar::kSourceEnvironment)
            shared.environment.add(k, pick, random[k].u);
        else if (pick.source && pick.source->kind == scalar::kSourceSun && pick.source->cone > 0)
            shared.suns.add(k, pick, random[k].u);
        else
            draw_from(pick, at[k], random[k], drawn[k]);
    }
    draw_from_environment(shared, drawn);
    draw_from_suns(shared, drawn);
}

void LightSet::draw_from_environment(const SharedDraws& shared, std::span<LightSample> drawn) const {
    const SharedDraws::List& list = shared.environment;
    if (list.count == 0) return;
    std::array<DirectionSample, kBlock> directions;
    environment_->draw_directions(tracer_.shading_kernels(), {list.u.data(), list.count}, directions);
    for (size_t n = 0; n < list.count; ++n) {
        const DirectionSample& found = directions[n];
        const float density = found.pdf * list.picks[n].probability;
        const float weight = density > 0 ? 1 / density : 0.0f;
        LightSample& sample = drawn[list.points[n]];
        sample.direction = found.direction, sample.distance = scalar::make_infinity();
        sample.weight = {weight, weight, weight}, sample.pdf = density;
        sample.place = found.position, sample.lacks_radiance = true;
    }
}

/// Directions aside, what is drawn from a sun is the same for all points.
void LightSet::draw_from_suns(const SharedDraws& shared, std::span<LightSample> drawn) const {
    const SharedDraws::List& list = shared.suns;
    const auto draw_from_sun = [&](std::span<const uint32_t> members) {
        const scalar::LightSourceData& sun = *list.picks[members[0]].source;
        std::array<Vec2f, kBlock> u;
        std::array<Vec3f, kBlock> directions;
        for (size_t n = 0; n < members.size(); ++n) u[n] = list.u[members[n]];
        tracer_.shading_kernels().draw_cone(sun.basis, sun.cone, u.data(), members.size(), directions.data());
        const scalar::LightDraw common = scalar::draw_sun(sun, {});
        for (size_t n = 0; n < members.size(); ++n) {
            LightSample& sample = drawn[list.points[members[n]]];
            static_cast<scalar::LightDraw&>(sample) = common;
            sample.direction = directions[n];
            sample.pdf *= list.picks[members[n]].probability;
            sample.weight *= 1 / list.picks[members[n]].probability;
        }
    };
    visit_kinds<kBlock>(
        list.count, [&](size_t k) { return list.picks[k].source; }, draw_from_sun);
}

void LightSet::complete_weight(std::span<LightSample> drawn, std::span<const uint32_t> which) const {
    std::array<uint32_t, kBlock> samples;
    std::array<Vec2f, kBlock> places;
    std::array<Vec3f, kBlock> radiances;
    for (size_t first = 0; first < which.size(); first += kBlock) {
        size_t count = 0;
        for (const uint32_t k : which.subspan(first, std::min(kBlock, which.size() - first)))
            if (drawn[k].lacks_radiance) samples[count] = k, places[count++] = drawn[k].place;
        if (count == 0) continue;
        environment_->fetch_radiance(tracer_.shading_kernels(), {places.data(), count}, radiances);
        for (size_t n = 0; n < count; ++n) {
            LightSample& sample = drawn[samples[n]];
            sample.weight = sample.weight * radiances[n];
            sample.lacks_radiance = false;
        }
    }
}

uint32_t LightSet::find_emitter(float u_emitter) const {
    const auto above =
        std::upper_bound(emitters_.cumulative.begin() + 1, emitters_.cumulative.end() - 1, double(u_emitter));
    return uint32_t(above - emitters_.cumulative.begin()) - 1;
}

void LightSet::draw_emitter(const Receiver& at, uint32_t emitter, const Vec2f& u, LightSample& drawn) const {
    const auto after =
        std::upper_bound(emitters_.ranges.begin(), emitters_.ranges.end(), emitter,
                         [](uint32_t e, const EmitterTable::Range& range) { return e < range.first; });
    const EmitterTable::Range& range = *(after - 1);
    const PreparedScene& scene = tracer_.scene();
    const Instance& instance = scene.instances[range.instance];
    const uint32_t quad = emitter - range.first;
    const Surface& surface = scene.surfaces[instance.surface];
    const bool is_triangle = surface.quads[quad].is_triangle();
    const Vec2f uv = is_triangle ? scalar::square_to_triangle(u) : u;
    const SurfacePoint point = tracer_.evaluate_point(range.instance, quad, uv, at.lod_bias);
    const float pdf = emitter_density(emitter, at.position, point);
    static_cast<scalar::LightDraw&>(drawn) =
        scalar::draw_emitter(find_emission(scene, instance.material, {surface, quad, uv, point.uv}),
                             point.position - at.position, pdf);
    drawn.emitter = point;
    const std::vector<uint32_t>& groups = scene.light_groups.of_material;
    if (!groups.empty()) drawn.group = groups[instance.material];
}

float LightSet::emitter_density(uint32_t emitter, const Vec3f& origin, const SurfacePoint& point) const {
    // A tree has chosen the patch itself.
    const float probability = choice_.has_tree() ? 1.0f : emitters_.probability(emitter);
    return scalar::emitter_density(probability, point.area_per_uv, point.geometric_normal,
                                   point.position - origin);
}

float LightSet::emitter_pdf(const scalar::LitPoint& at, const SurfacePoint& point) const {
    const uint32_t first = emitters_.first_of_instance[point.instance];
    if (first == kNoIndex) return 0;
    const uint32_t emitter = first + point.patch;
    return choice_.find_emitter_probability(at, emitter) * emitter_density(emitter, at.position, point);
}

void LightSet::look_up_environment(std::span<const Vec3f> directions,
                                   std::span<EnvironmentLookup> found) const {
    if (environment_)
        environment_->look_up(tracer_.shading_kernels(), directions, found);
    else
        std::fill_n(found.begin(), directions.size(), EnvironmentLookup{});
}

Vec3f LightSet::evaluate_mis(const BounceRay& ray, const EnvironmentLookup& behind) const {
    Vec3f sum{};
    meet_each(ray, behind, [&](const scalar::LightSourceData&, const Vec3f& light) { sum += light; });
    return sum;
}

LightSet::Sight LightSet::see(const Vec3f& origin, const Vec3f& direction, float distance) const {
    Sight sight;
    see_each(origin, direction, distance, [&](const scalar::LightSourceData&, const Vec3f& light) {
        sight.is_met = true;
        sight.radiance += light;
    });
    return sight;
}

void LightSet::add_statistics(Statistics& statistics) const {
    if (environment_) statistics.displacement_bytes += environment_->byte_count();
    statistics.structures_bytes += choice_.byte_count() + emitters_.cumulative.size() * sizeof(double) +
                                   emitters_.ranges.size() * sizeof(EmitterTable::Range) +
                                   emitters_.first_of_instance.size() * sizeof(uint32_t);
}

} // namespace relief::cpu
