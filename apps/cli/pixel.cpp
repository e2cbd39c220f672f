#include "pixel.h"

#include <array>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace relief::cli {

namespace {

// The command uses the public value types only; this is all the arithmetic it needs.
Vec3f add_scaled(const Vec3f& a, const Vec3f& b, float s) {
    return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
Vec3f cross(const Vec3f& a, const Vec3f& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec3f normalize(const Vec3f& a) {
    const float length = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
    return {a.x / length, a.y / length, a.z / length};
}

std::string format_vector(const Vec3f& a) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", a.x, a.y, a.z); }

void print_hit(const Scene& scene, const Ray& ray, const RayHit& hit) {
    if (hit.object == kNoIndex) {
        fmt::print("hit      nothing: the ray leaves the scene\n");
        return;
    }
    const Object& object = scene.objects[hit.object];
    fmt::print("object   {} '{}', mesh '{}'\n", hit.object, object.name, scene.meshes[object.mesh].name);
    fmt::print("patch    {} at (u, v) = ({:.6g}, {:.6g})\n", hit.patch, hit.uv.x, hit.uv.y);
    fmt::print("t        {:.7g}\n", hit.t);
    fmt::print("position {}\n", format_vector(add_scaled(ray.origin, ray.direction, hit.t)));
    fmt::print("normal   {}\n", format_vector(hit.normal));
}

} // namespace

Ray make_pixel_ray(const Camera& camera, int width, int height, int x, int y) {
    constexpr double kPi = 3.14159265358979323846;
    const Vec3f forward = normalize(add_scaled(camera.to, camera.from, -1));
    const Vec3f right = normalize(cross(forward, camera.up));
    const Vec3f up = cross(right, forward);
    const float half_height = float(std::tan(double(camera.fov_degrees) * kPi / 360));
    const float scale = 2 * half_height / float(height);
    const float across = (float(x) + 0.5f - 0.5f * float(width) + camera.shift.x * float(height)) * scale;
    const float down = (float(y) + 0.5f - 0.5f * float(height) - camera.shift.y * float(height)) * scale;
    Ray ray;
    ray.origin = camera.from;
    ray.direction = normalize(add_scaled(add_scaled(forward, right, across), up, -down));
    return ray;
}

void explain_pixel(const Scene& scene, const RenderSettings& settings, int x, int y) {
    const Ray ray = make_pixel_ray(scene.camera, settings.image.width, settings.image.height, x, y);
    const RayHit hit =
        Intersector(scene, {settings.surface, settings.device, settings.experiment, settings.image.height})
            .closest_hit(ray);
    RenderSettings one_pixel = settings;
    one_pixel.image.crop = {x, y, x + 1, y + 1};
    const RenderResult result = render(scene, one_pixel);
    fmt::print("pixel    ({}, {}) of {}x{}\n", x, y, settings.image.width, settings.image.height);
    fmt::print("ray      from {} along {}\n", format_vector(ray.origin), format_vector(ray.direction));
    print_hit(scene, ray, hit);
    std::array<float, 4> color{};
    const std::array<const char*, 4> names = {"R", "G", "B", "A"};
    for (size_t c = 0; c < 4; ++c) {
        if (const auto channel = result.image.find_channel(names[c]))
            color[c] = result.image.pixels[*channel];
    }
    fmt::print("colour   {} alpha {:.4g}, mean of {} samples, {} rays\n",
               format_vector({color[0], color[1], color[2]}), color[3], settings.image.spp,
               result.statistics.camera_rays + result.statistics.shadow_rays + result.statistics.bounce_rays);
}

} // namespace relief::cli
