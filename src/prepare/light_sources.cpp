#include "prepare/light_sources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "formulas/basis.h"
#include "formulas/bsdf.h"
#include "formulas/light_source.h"
#include "formulas/texture.h"
#include "math/affine.h"
#include "prepare/light_tree.h"
#include "surface/map/displacement_map.h"
#include "surface/map/texels.h"

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
    source.texture = source.link = kNoIndex;
    source.group = kNoIndex;
    return source;
}

uint32_t find_kind(LightType type) {
    switch (type) {
    case LightType::sun:
        return scalar::kSourceSun;
    case LightType::point:
        return scalar::kSourcePoint;
    case LightType::rectangle:
        return scalar::kSourceRectangle;
    case LightType::disk:
        return scalar::kSourceDisk;
    case LightType::spot:
        return scalar::kSourceSpot;
    }
    return scalar::kSourcePoint;
}

/// 1 - cos of half of an angle.
float make_cone_height(double angle_degrees) {
    const double half_angle = angle_degrees * std::numbers::pi / 360;
    const double half_sine = std::sin(half_angle / 2);
    return float(2 * half_sine * half_sine);
}

/// Width, height and the way that the light faces. Where `up` says nothing, as +y of a light that looks
/// straight down, -z is up.
scalar::Basis make_face(const Light& light) {
    const Vec3f facing = normalize(light.direction);
    if (light.type != LightType::rectangle && !light.color_texture) return scalar::make_basis(facing);
    Vec3f width = cross(normalize(light.up), facing);
    if (length(width) < 1e-4f) width = cross({0, 0, -1}, facing);
    if (length(width) < 1e-4f) return scalar::make_basis(facing);
    width = normalize(width);
    return {width, cross(facing, width), facing};
}

void place_light(const Light& light, scalar::LightSourceData& source) {
    source.center = light.position;
    source.radius = light.type == LightType::rectangle ? 0 : light.radius;
    source.radius2 = source.radius * source.radius;
    if (light.type == LightType::point) return;
    source.basis = make_face(light);
    if (light.type == LightType::spot) {
        source.cone = make_cone_height(light.cone_degrees);
        source.edge = make_cone_height(double(light.cone_degrees) * (1 - double(light.blend)));
        return;
    }
    if (light.type == LightType::rectangle)
        source.half_width = light.width / 2, source.half_height = light.height / 2;
    source.radius2 = scalar::shape_area(source) / (2 * std::numbers::pi_v<float>);
}

scalar::LightSourceData make_light_source(const Light& light, float power) {
    scalar::LightSourceData source = make_source(find_kind(light.type), power);
    source.color = light.color;
    source.strength = light.strength;
    source.is_visible = light.is_visible_to_camera ? 1 : 0;
    if (light.type != LightType::sun) {
        place_light(light, source);
        return source;
    }
    source.basis = scalar::make_basis(normalize(-light.direction));
    source.cone = make_cone_height(light.angle_degrees);
    return source;
}

/// Of its texture, times its colour over that of the colour alone; of a disk within the circle.
float find_mean_luminance(const Light& light) {
    const Texture& texture = *light.color_texture;
    double sum = 0, count = 0;
    for (uint32_t y = 0; y < texture.height; ++y)
        for (uint32_t x = 0; x < texture.width; ++x) {
            const double along = (2 * x + 1.0) / texture.width - 1,
                         across = (2 * y + 1.0) / texture.height - 1;
            if (light.type == LightType::disk && along * along + across * across > 1) continue;
            const std::array<float, 4> texel = read_channels(texture, x, y);
            const Vec3f color =
                scalar::make_texture_color(texture.channel_count, {texel[0], texel[1], texel[2]});
            sum += double(scalar::luminance(light.color * max(color, Vec3f{})));
            count += 1;
        }
    return count > 0 ? float(sum / count / double(scalar::luminance(light.color))) : 0;
}

bool has_place(const scalar::LightSourceData& source) {
    return source.kind != scalar::kSourceEnvironment && source.kind != scalar::kSourceSun;
}

LightLeaf make_leaf(const scalar::LightSourceData& source, uint32_t index) {
    LightLeaf leaf;
    leaf.power = source.power;
    leaf.source = index;
    const bool is_met = scalar::is_flat(source) || source.radius > 0;
    if (is_met) leaf.flags = scalar::kCanBeMet | (source.is_visible != 0 ? scalar::kCanBeSeen : 0);
    Vec3f reach{source.radius, source.radius, source.radius};
    if (source.kind == scalar::kSourceRectangle)
        for (int axis = 0; axis < 3; ++axis)
            set_component(reach, axis,
                          std::fabs(get_component(source.basis.t, axis)) * source.half_width +
                              std::fabs(get_component(source.basis.b, axis)) * source.half_height);
    leaf.box.extend(source.center - reach), leaf.box.extend(source.center + reach);
    constexpr double right_angle = std::numbers::pi / 2;
    const auto angle_of = [](float height) { return 2 * std::asin(std::sqrt(double(height) / 2)); };
    if (source.kind == scalar::kSourceSpot)
        leaf.cone = {source.basis.n, angle_of(source.edge), angle_of(source.cone) - angle_of(source.edge)};
    else if (scalar::is_flat(source))
        leaf.cone = {source.basis.n, 0, right_angle};
    else
        leaf.cone.spread = std::numbers::pi, leaf.cone.reach = right_angle;
    return leaf;
}

/// Emissive patches shine to both sides, and the displacement turns them: no way is left out.
void add_emitters(const PreparedScene& scene, const EmitterTable& emitters, std::vector<LightLeaf>& leaves) {
    for (const EmitterTable::Range& range : emitters.ranges) {
        const Instance& instance = scene.instances[range.instance];
        const Surface& surface = scene.surfaces[instance.surface];
        const float reach =
            float(find_longest_displacement(surface.map) * bound_scale(instance.world_from_object));
        for (uint32_t patch = 0; patch < surface.quads.size(); ++patch) {
            const uint32_t emitter = range.first + patch;
            LightLeaf leaf;
            leaf.power = float(double(emitters.probability(emitter)) * emitters.power);
            leaf.source = emitter | scalar::kEmitterLeaf;
            leaf.cone.spread = std::numbers::pi, leaf.cone.reach = std::numbers::pi / 2;
            for (const uint32_t vertex : surface.quads[patch].vertex)
                leaf.box.extend(transform_point(instance.world_from_object, surface.position(vertex)));
            leaf.box.lower = leaf.box.lower - Vec3f{reach, reach, reach};
            leaf.box.upper = leaf.box.upper + Vec3f{reach, reach, reach};
            if (leaf.power > 0) leaves.push_back(leaf);
        }
    }
}

void add_tree(const PreparedScene& scene, const EmitterTable& emitters, LightTables& tables) {
    std::vector<scalar::LightSourceData>& sources = tables.sources;
    const auto placed =
        std::stable_partition(sources.begin(), sources.end(),
                              [](const scalar::LightSourceData& source) { return !has_place(source); });
    tables.listed_count = uint32_t(placed - sources.begin());
    std::vector<LightLeaf> leaves;
    for (uint32_t k = tables.listed_count; k < sources.size(); ++k)
        leaves.push_back(make_leaf(sources[k], k));
    add_emitters(scene, emitters, leaves);
    tables.nodes = make_light_tree(std::move(leaves));
    tables.leaf_of_emitter.assign(emitters.size(), kNoIndex);
    for (uint32_t k = 0; k < tables.nodes.size(); ++k) {
        const uint32_t source = tables.nodes[k].source;
        if (source != scalar::kNone && (source & scalar::kEmitterLeaf) != 0)
            tables.leaf_of_emitter[source & ~scalar::kEmitterLeaf] = k;
    }
}

/// Mean factor of its tiles.
Vec3f find_mean_factor(const PlacedTexture& texture) {
    Vec3<double> sum{};
    double count = 0;
    const auto add = [&](const Vec3f& color) {
        sum.x += double(color.x), sum.y += double(color.y), sum.z += double(color.z), count += 1;
    };
    for (const auto& tile : texture.tiles)
        for (uint32_t y = 0; tile && y < tile->height; ++y)
            for (uint32_t x = 0; x < tile->width; ++x) {
                const std::array<float, 4> texel = read_channels(*tile, x, y);
                const uint32_t channels = texture.is_number ? 1 : tile->channel_count;
                const Vec3f color = scalar::make_texture_color(channels, {texel[0], texel[1], texel[2]});
                add(max(color, Vec3f{}));
            }
    if (texture.is_udim) add({1, 1, 1}); // where there is no tile
    return {float(sum.x / count), float(sum.y / count), float(sum.z / count)};
}

/// Of its surface: an estimate, where it has textures.
Vec3f find_mean_emission(const PreparedScene& scene, uint32_t material) {
    Vec3f emission = scene.materials[material].emission;
    const TexturedMaterial* textured = scene.textured.find(material);
    if (!textured || emission == Vec3f{}) return emission;
    for (const PlacedTexture& texture : textured->textures)
        if (texture.place.first == scalar::kInputEmission) emission = emission * find_mean_factor(texture);
    return emission;
}

} // namespace

EmitterTable make_emitter_table(const PreparedScene& scene) {
    EmitterTable table;
    table.first_of_instance.assign(scene.instances.size(), kNoIndex);
    table.cumulative.assign(1, 0.0);
    Box box;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const float brightness = scalar::luminance(find_mean_emission(scene, instance.material));
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

LightTables make_light_tables(const PreparedScene& scene, float environment_luminance,
                              const EmitterTable& emitters) {
    LightTables tables;
    std::vector<scalar::LightSourceData>& sources = tables.sources;
    if (environment_luminance > 0) {
        sources.push_back(
            make_source(scalar::kSourceEnvironment, std::numbers::pi_v<float> * environment_luminance));
        sources.back().group = scene.light_groups.of_environment;
    }
    for (size_t k = 0; k < scene.lights.size(); ++k) {
        const Light& light = scene.lights[k];
        float power = scalar::luminance(light.color) * light.strength;
        if (power > 0 && light.color_texture) power *= find_mean_luminance(light);
        if (!(power > 0)) continue;
        sources.push_back(make_light_source(light, power));
        sources.back().group = scene.light_groups.find(light.light_group);
        if (light.color_texture) {
            sources.back().texture = uint32_t(tables.textures.size());
            tables.textures.push_back(light.color_texture);
        }
        if (!scene.links.first_word.empty()) sources.back().link = scene.links.first_word[k];
    }
    tables.link_words = scene.links.words;
    if (sources.size() + emitters.ranges.size() > kMostListedLights) {
        add_tree(scene, emitters, tables);
        return tables;
    }
    if (emitters.power > 0) {
        scalar::LightSourceData source = make_source(scalar::kSourceEmitters, float(emitters.power));
        source.center = emitters.center;
        source.radius2 = emitters.radius2;
        sources.push_back(source);
    }
    tables.listed_count = uint32_t(sources.size());
    return tables;
}

} // namespace relief
