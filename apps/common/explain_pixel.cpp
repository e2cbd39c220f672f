#include "common/explain_pixel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "common/texel_values.h"
#include "common/vectors.h"

namespace relief::cli {

using namespace vectors;

namespace {

/// Of an explanation.
constexpr int kPathCount = 6;

std::string format_vector(const Vec3f& a) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", a.x, a.y, a.z); }

/// The texel nearest to the hit, and what it means. Without a word where the tile is not known: of several.
std::string describe_texel(const Displacement& map, const Vec2f& uv) {
    if (map.tiles.size() != 1) return {};
    const Texture& texture = *map.tiles.front().texture;
    const float v = map.flip_v ? uv.y : 1 - uv.y;
    const auto place = [](float share, uint32_t count) {
        return uint32_t(std::clamp(std::floor(share * float(count)), 0.0f, float(count - 1)));
    };
    const uint32_t x = place(uv.x, texture.width), y = place(v, texture.height);
    const Vec3f value = read_texel(texture, x, y);
    return fmt::format("uv       ({:.6g}, {:.6g}), texel ({}, {}) of map '{}': {}\n"
                       "moved    {} along {}\n",
                       uv.x, uv.y, x, y, map.name, format_vector(value),
                       format_vector(decode_texel(map, value)),
                       map.space == DisplacementSpace::tangent  ? "t, b, n"
                       : map.space == DisplacementSpace::object ? "x, y, z of the object"
                                                                : "x, y, z of the world");
}

std::string describe_hit(const Scene& scene, const Ray& ray, const RayHit& hit, const Vec2f& uv) {
    if (hit.object == kNoIndex) return "hit      nothing: the ray leaves the scene\n";
    const Object& object = scene.objects[hit.object];
    std::string text =
        fmt::format("object   {} '{}', mesh '{}'\n"
                    "patch    {} at (u, v) = ({:.6g}, {:.6g})\n"
                    "t        {:.7g}\n"
                    "position {}\n"
                    "normal   {}\n",
                    hit.object, object.name, scene.meshes[object.mesh].name, hit.patch, hit.uv.x, hit.uv.y,
                    hit.t, format_vector(ray.origin + ray.direction * hit.t), format_vector(hit.normal));
    if (object.displacement != kNoIndex) text += describe_texel(scene.displacements[object.displacement], uv);
    return text;
}

/// What finding the pixel's light took, a sample.
std::string describe_work(const Statistics& s, int spp) {
    if (s.upper_nodes + s.patch_nodes + s.blocks == 0) return {}; // of other traversals nothing is counted
    const auto per_sample = [&](uint64_t count) { return double(count) / spp; };
    std::string levels;
    for (size_t level = 0; level < s.bottom_levels.size(); ++level)
        if (s.bottom_levels[level] > 0)
            levels +=
                fmt::format("{}{} at level {}", levels.empty() ? "" : ", ", s.bottom_levels[level], level);
    return fmt::format(
        "visited  {:.4g} nodes of scene trees, {:.4g} of patch trees, {:.4g} blocks of triangles "
        "a sample\n"
        "built    {}\n",
        per_sample(s.upper_nodes), per_sample(s.patch_nodes), per_sample(s.blocks),
        levels.empty() ? "no trees of patches" : "trees of patches: " + levels);
}

/// Cosine-weighted about a unit normal.
Vec3f choose_direction(const Vec3f& normal, std::mt19937& random) {
    std::uniform_real_distribution<float> number(0, 1);
    const float z = 1 - 2 * number(random), turn = 6.2831853f * number(random);
    const float radius = std::sqrt(std::max(0.0f, 1 - z * z));
    const Vec3f sum = normal + Vec3f{radius * std::cos(turn), radius * std::sin(turn), z} * 0.999f;
    return normalize(sum);
}

/// Goes on from `hit`, from surface to surface, until it leaves the scene.
std::vector<Vec3f> trace_path(const Intersector& intersector, Ray ray, RayHit hit, int bounces,
                              std::mt19937& random) {
    const float reach = hit.t; // of a line that leaves the scene
    std::vector<Vec3f> corners = {ray.origin};
    for (int bounce = 0; hit.object != kNoIndex; ++bounce) {
        corners.push_back(ray.origin + ray.direction * hit.t);
        if (bounce == bounces) return corners;
        const Vec3f& n = hit.normal;
        const bool is_behind = n.x * ray.direction.x + n.y * ray.direction.y + n.z * ray.direction.z > 0;
        ray.direction = choose_direction(is_behind ? Vec3f{-n.x, -n.y, -n.z} : n, random);
        ray.origin = corners.back();
        ray.t_min = 1e-4f * reach;
        hit = intersector.closest_hit(ray);
    }
    corners.push_back(ray.origin + ray.direction * (0.3f * reach));
    return corners;
}

std::string describe_color(const RenderResult& result, const RenderSettings& settings) {
    std::array<float, 4> color{};
    const std::array<const char*, 4> names = {"R", "G", "B", "A"};
    for (size_t c = 0; c < 4; ++c) {
        if (const auto channel = result.image.find_channel(names[c]))
            color[c] = result.image.pixels[*channel];
    }
    const Statistics& s = result.statistics;
    return fmt::format("colour   {} alpha {:.4g}, mean of {} samples, {} rays\n",
                       format_vector({color[0], color[1], color[2]}), color[3], settings.image.spp,
                       s.camera_rays + s.shadow_rays + s.bounce_rays);
}

} // namespace

Ray make_pixel_ray(const Camera& camera, int width, int height, int x, int y) {
    constexpr double kPi = 3.14159265358979323846;
    const Vec3f forward = normalize(camera.to - camera.from);
    const Vec3f right = normalize(cross(forward, camera.up));
    const Vec3f up = cross(right, forward);
    const float half_height = float(std::tan(double(camera.fov_degrees) * kPi / 360));
    const float scale = 2 * half_height / float(height);
    const float height_pixels = float(height);
    const float across = (float(x) + 0.5f - 0.5f * float(width) + camera.shift.x * height_pixels) * scale;
    const float down = (float(y) + 0.5f - 0.5f * height_pixels - camera.shift.y * height_pixels) * scale;
    Ray ray;
    ray.origin = camera.from;
    ray.direction = normalize(forward + right * across - up * down);
    return ray;
}

PixelExplanation explain_pixel(const Scene& scene, const RenderSettings& settings, int x, int y) {
    const Ray ray = make_pixel_ray(scene.camera, settings.image.width, settings.image.height, x, y);
    RayHit hit;
    HitAttributes attributes;
    RayQuery query;
    query.attributes = kTextureUv;
    const Intersector intersector(
        scene, {settings.surface, settings.device, settings.experiment, settings.image.height});
    intersector.closest_hits(std::span(&ray, 1), std::span(&hit, 1), query, std::span(&attributes, 1));
    RenderSettings one_pixel = settings;
    one_pixel.image.crop = {x, y, x + 1, y + 1};
    const RenderResult result = render(scene, one_pixel);
    PixelExplanation explanation;
    explanation.text = fmt::format("pixel    ({}, {}) of {}x{}\n"
                                   "ray      from {} along {}\n",
                                   x, y, settings.image.width, settings.image.height,
                                   format_vector(ray.origin), format_vector(ray.direction)) +
                       describe_hit(scene, ray, hit, attributes.texture_uv) +
                       describe_work(result.statistics, settings.image.spp) +
                       describe_color(result, settings);
    explanation.object = hit.object;
    std::mt19937 random(uint32_t(y) * 65536u + uint32_t(x));
    for (int k = 0; k < kPathCount && hit.object != kNoIndex; ++k)
        explanation.paths.push_back(trace_path(intersector, ray, hit, settings.image.bounces, random));
    return explanation;
}

} // namespace relief::cli
