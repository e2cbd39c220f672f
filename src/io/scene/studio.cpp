#include "io/scene/studio.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "formulas/environment.h"
#include "math/vec.h"
#include "relief/aim.h"

namespace relief {

namespace {

constexpr float kPi = std::numbers::pi_v<float>, kRadians = kPi / 180;
constexpr uint32_t kWidth = 128, kHeight = 64;
constexpr Vec3f kGrey{0.97f, 0.99f, 1.04f}; ///< of the backdrop: a little cooler than the clay
constexpr float kHorizon = 0.15f;           ///< radiance, times kGrey
constexpr float kBand = 5;                  ///< degrees about the horizon that have that radiance

/// Radiance of the backdrop at an elevation, times kGrey; smooth between the stops.
struct Stop {
    float elevation, radiance;
};
constexpr std::array<Stop, 6> kBackdrop = {
    {{-90, 0.07f}, {-45, 0.09f}, {-kBand, kHorizon}, {kBand, kHorizon}, {45, 0.10f}, {90, 0.14f}}};

/// A soft light of the picture, degrees; it fades from its middle to its rim.
struct SoftLight {
    float azimuth, elevation, radius;
    Vec3f radiance; ///< of its middle
};
constexpr SoftLight kFill = {70, 25, 90, {0.40f, 0.45f, 0.50f}};
constexpr SoftLight kRim = {165, 58, 52, {1.60f, 1.68f, 1.76f}};

float smooth_step(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

float find_backdrop(float elevation) {
    size_t k = 1;
    while (k + 1 < kBackdrop.size() && elevation > kBackdrop[k].elevation) ++k;
    const Stop &low = kBackdrop[k - 1], &high = kBackdrop[k];
    return low.radiance +
           (high.radiance - low.radiance) * smooth_step(low.elevation, high.elevation, elevation);
}

Vec3f find_light_radiance(const SoftLight& light, const Vec3f& direction) {
    const float azimuth = light.azimuth * kRadians, elevation = light.elevation * kRadians;
    const Vec3f middle{std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                       std::cos(azimuth) * std::cos(elevation)};
    const float angle = std::acos(std::clamp(dot(middle, direction), -1.0f, 1.0f)) / kRadians;
    return light.radiance * smooth_step(light.radius, 0, angle);
}

Vec3f find_radiance(const Vec3f& direction) {
    const float elevation = std::asin(std::clamp(direction.y, -1.0f, 1.0f)) / kRadians;
    const float above = smooth_step(2 * kBand, 6 * kBand, elevation); // no light reaches the horizon
    return kGrey * find_backdrop(elevation) +
           (find_light_radiance(kFill, direction) + find_light_radiance(kRim, direction)) * above;
}

std::shared_ptr<const Texture> make_studio() {
    auto texture = std::make_shared<Texture>();
    texture->width = kWidth, texture->height = kHeight;
    texture->channel_count = texture->stride = 3;
    texture->file = "studio";
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const Vec2f place{(float(x) + 0.5f) / kWidth, (float(y) + 0.5f) / kHeight};
            const Vec3f radiance = find_radiance(scalar::latlong_to_direction(place));
            texture->floats.insert(texture->floats.end(), {radiance.x, radiance.y, radiance.z});
        }
    texture->floats.resize(texture->value_count());
    return texture;
}

/// Irradiance of a surface that faces upwards.
Vec3f measure_irradiance(const Texture& studio) {
    Vec3f sum;
    for (uint32_t y = 0; y < studio.height / 2; ++y) {
        const float top = std::sin(kPi * float(y) / float(studio.height));
        const float bottom = std::sin(kPi * float(y + 1) / float(studio.height));
        const float projected = kPi * (bottom * bottom - top * top) / float(studio.width);
        for (uint32_t x = 0; x < studio.width; ++x) {
            const float* const texel = &studio.floats[studio.find_texel(x, y)];
            sum += Vec3f{texel[0], texel[1], texel[2]} * projected;
        }
    }
    return sum;
}

/// Degrees about +y from +z towards +x; of a camera that looks straight up or down by its up axis.
float find_azimuth(const Camera& camera) {
    const Vec3f toward = camera.from - camera.to;
    const Vec3f across = camera.up * (toward.y > 0 ? -length(toward) : length(toward));
    return std::atan2(toward.x + across.x, toward.z + across.z) / kRadians;
}

/// From the camera's upper left, and never from below: a floor is lit too.
Light make_key(const Camera& camera) {
    constexpr float kLeast = 0.26f; // sine of the least elevation
    const Vec3f toward = normalize(camera.from - camera.to);
    const Vec3f right = normalize(cross(camera.up, toward)), up = cross(toward, right);
    Vec3f to_light = normalize(up * 0.75f - right * 0.8f + toward * 0.45f);
    if (to_light.y < kLeast) {
        const float across = std::max(std::hypot(to_light.x, to_light.z), 1e-6f);
        const float scale = std::sqrt(1 - kLeast * kLeast) / across;
        to_light = {to_light.x * scale, kLeast, to_light.z * scale};
    }
    Light key;
    key.direction = to_light * -1.0f;
    key.angle_degrees = 6;
    key.color = {1.0f, 0.94f, 0.86f};
    key.strength = 4.2f;
    return key;
}

/// Whether the camera has a direction and an up axis that the studio can follow.
bool has_axes(const Camera& camera) {
    const Vec3f toward = camera.from - camera.to;
    return length(cross(camera.up, toward)) > 1e-6f * length(camera.up) * length(toward);
}

bool is_in_studio(const Scene& scene) {
    return scene.environment && scene.environment->texture == get_studio();
}

} // namespace

std::shared_ptr<const Texture> get_studio() {
    static const std::shared_ptr<const Texture> studio = make_studio();
    return studio;
}

void enter_studio(Scene& scene) {
    Environment environment;
    environment.texture = get_studio();
    environment.rotate_degrees = find_azimuth(scene.camera);
    scene.environment = std::move(environment);
    scene.lights = {make_key(scene.camera)};
}

void turn_studio(Scene& scene, const Camera& before) {
    if (!is_in_studio(scene) || !has_axes(before) || !has_axes(scene.camera)) return;
    if (scene.environment->rotate_degrees == find_azimuth(before))
        scene.environment->rotate_degrees = find_azimuth(scene.camera);
    const Vec3f placed = make_key(before).direction;
    for (Light& light : scene.lights)
        if (light.type == LightType::sun && light.direction == placed)
            light.direction = make_key(scene.camera).direction;
}

std::optional<Vec3f> match_floor(const Scene& scene) {
    if (!is_in_studio(scene)) return std::nullopt;
    static const Vec3f studio = measure_irradiance(*get_studio());
    const Vec3f scale = scene.environment->color * scene.environment->strength;
    Vec3f irradiance = studio * scale;
    for (const Light& light : scene.lights) {
        if (light.type != LightType::sun) return std::nullopt;
        irradiance += light.color * (light.strength * std::max(-normalize(light.direction).y, 0.0f));
    }
    Vec3f color;
    for (int k = 0; k < 3; ++k) {
        const float wanted = get_component(kGrey, k) * kHorizon * kPi * get_component(scale, k);
        if (!(wanted > 0 && wanted <= get_component(irradiance, k))) return std::nullopt;
        set_component(color, k, wanted / get_component(irradiance, k));
    }
    return color;
}

void recognize_studio(Scene& scene) {
    if (!scene.environment || !scene.environment->texture) return;
    const Texture &texture = *scene.environment->texture, &studio = *get_studio();
    if (texture.width != studio.width || texture.height != studio.height) return;
    if (texture.stride == studio.stride && texture.floats == studio.floats)
        scene.environment->texture = get_studio();
}

} // namespace relief
