// make_check_picture: base, displaced, displacement as colours, folds.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/progress.h"
#include "cpu/cpu_engine.h"
#include "formulas/camera.h"
#include "inspect/picture_lines.h"
#include "inspect/picture_text.h"
#include "math/affine.h"
#include "prepare/camera_frame.h"
#include "prepare/validate_settings.h"
#include "relief/convert.h"
#include "relief/inspect.h"
#include "surface/patch/patch_samples.h"

namespace relief {

namespace {

constexpr Vec3f kPaper{0.18f, 0.18f, 0.2f};

Image make_sheet(const RenderSettings& settings) {
    Image sheet;
    sheet.width = sheet.full_width = 2 * settings.image.width;
    sheet.height = sheet.full_height = 2 * settings.image.height;
    sheet.channels = {"R", "G", "B", "A"};
    sheet.pixels.assign(size_t(sheet.width) * size_t(sheet.height) * 4, 1.0f);
    return sheet;
}

void set_pixel(Image& image, int x, int y, const Vec3f& color) {
    image.at(x, y, 0) = color.x, image.at(x, y, 1) = color.y, image.at(x, y, 2) = color.z;
}

void copy_picture(const Image& picture, int x0, int y0, Image& sheet) {
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            set_pixel(sheet, x0 + x, y0 + y, {picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2)});
}

Scene make_base(const Scene& scene) {
    Scene base = scene;
    for (Object& object : base.objects) object.displacement = kNoIndex;
    return base;
}

std::vector<Ray> make_rays(const scalar::CameraFrame& camera, const RenderSettings& settings) {
    std::vector<Ray> rays;
    for (int y = 0; y < settings.image.height; ++y)
        for (int x = 0; x < settings.image.width; ++x) {
            const scalar::CameraRay ray =
                scalar::make_pinhole_ray(camera, Vec2f{float(x) + 0.5f, float(y) + 0.5f});
            rays.push_back({ray.origin, 0, ray.direction, std::numeric_limits<float>::infinity()});
        }
    return rays;
}

/// What a hit shows of its patch, in object space.
struct Place {
    VertexData base;
    Vec3f displacement; ///< along t, b, n or x, y, z
};

Place find_place(const Surface& surface, uint32_t patch, const Vec2f& uv) {
    const PatchSamples samples(surface, patch);
    Place place;
    place.base = blend_corners(samples.corners(), uv.x, uv.y);
    if (place.base.tile != Surface::kNoTile)
        place.displacement = fetch_displacement(surface.map, place.base.tile, place.base.uv);
    return place;
}

/// Longest component of the displacement at the hits, by which colours are scaled; 1 where there is none.
float find_longest(const PreparedScene& scene, const std::vector<RayHit>& hits) {
    float longest = 0;
    for (const RayHit& hit : hits) {
        if (hit.object == kNoIndex) continue;
        const Surface& surface = scene.surfaces[scene.instances[hit.object].surface];
        if (!surface.has_displacement) continue;
        const Vec3f d = find_place(surface, hit.patch, hit.uv).displacement;
        longest = std::max({longest, std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
    }
    return longest > 0 ? longest : 1;
}

/// Form by a light at the eye.
float shade(const Vec3f& normal, const Vec3f& direction) {
    return 0.35f + 0.65f * std::fabs(dot(normal, normalize(direction)));
}

struct PointColors {
    Vec3f axes = kPaper, folds = kPaper;
    bool is_displaced = false, is_folded = false;
};

PointColors color_point(const PreparedScene& scene, const Ray& ray, const RayHit& hit, float longest) {
    PointColors colors;
    if (hit.object == kNoIndex) return colors;
    const Instance& instance = scene.instances[hit.object];
    const Surface& surface = scene.surfaces[instance.surface];
    const float light = shade(hit.normal, ray.direction);
    colors.axes = colors.folds = Vec3f{0.5f, 0.5f, 0.5f} * light;
    if (!surface.has_displacement) return colors;
    colors.is_displaced = true;
    const Place place = find_place(surface, hit.patch, hit.uv);
    const Vec3f half{0.5f, 0.5f, 0.5f};
    colors.axes = (half + place.displacement * (0.5f / longest)) * light;
    const Vec3f base_normal = transform_normal(instance.object_space.from_origin, place.base.frame.n);
    const float facing = dot(hit.normal, base_normal) * (instance.is_mirrored ? -1.0f : 1.0f);
    colors.is_folded = facing < 0;
    if (colors.is_folded) colors.folds = Vec3f{0.9f, 0.08f, 0.05f} * light;
    return colors;
}

/// Frames of some patches as arrows on the base: t or x red, b or y green, n or z blue.
void draw_frames(const PreparedScene& scene, const scalar::CameraFrame& camera,
                 const RenderSettings& settings, Image& sheet) {
    constexpr uint32_t kMostFrames = 48;
    constexpr std::array<Vec3f, 3> kColors{{{0.9f, 0.05f, 0.05f}, {0.05f, 0.7f, 0.05f}, {0.1f, 0.2f, 1.0f}}};
    for (const Instance& instance : scene.instances) {
        const Surface& surface = scene.surfaces[instance.surface];
        if (!surface.has_displacement) continue;
        const uint32_t step = std::max(1u, surface.patch_count() / kMostFrames);
        for (uint32_t patch = 0; patch < surface.patch_count(); patch += step) {
            const PatchSamples samples(surface, patch);
            const VertexData base = blend_corners(samples.corners(), 0.5f, 0.5f);
            const std::array<Vec3f, 3> axes =
                surface.map.is_tangent ? std::array{base.frame.t, base.frame.b, base.frame.n}
                                       : std::array{Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}};
            const Vec3f from = transform_point(instance.world_from_object, base.position);
            const scalar::CameraProjection start = scalar::project_point(camera, from);
            const Vec3f normal = transform_normal(instance.object_space.from_origin, base.frame.n);
            if (!(start.distance > 0) || dot(normal, camera.origin - from) < 0) continue;
            // A sixteenth of the height of the picture long, wherever the patch is.
            const float size = start.distance * length(camera.step_y) * float(settings.image.height) / 16;
            for (size_t k = 0; k < 3; ++k) {
                const Vec3f along = normalize(transform_vector(instance.world_from_object, axes[k])) * size;
                const scalar::CameraProjection end = scalar::project_point(camera, from + along);
                if (end.distance > 0)
                    draw_line(sheet, {settings.image.width, settings.image.height}, {start.x, start.y},
                              {end.x, end.y}, kColors[k]);
            }
        }
    }
}

/// How the maps are read, of one; of several their number.
std::string describe_reading(const Scene& scene) {
    std::vector<const Displacement*> used;
    for (const Object& object : scene.objects)
        if (object.displacement != kNoIndex &&
            std::ranges::find(used, &scene.displacements[object.displacement]) == used.end())
            used.push_back(&scene.displacements[object.displacement]);
    if (used.empty()) return "no displacement";
    if (used.size() > 1) return fmt::format("{} maps", used.size());
    const Displacement& map = *used.front();
    const Vec3f& m = map.midlevel;
    const std::string midlevel = m.x == m.y && m.y == m.z
                                     ? fmt::format("{:.4g}", m.x)
                                     : fmt::format("{:.4g}, {:.4g}, {:.4g}", m.x, m.y, m.z);
    if (map.type == DisplacementType::height) return fmt::format("heights, midlevel {}", midlevel);
    const char* space = map.space == DisplacementSpace::tangent  ? "tangent"
                        : map.space == DisplacementSpace::object ? "object"
                                                                 : "world";
    return fmt::format("{} space, axes {}, midlevel {}", space, format_map_axes(map.axes, map.space),
                       midlevel);
}

/// Above each of the four views. `folds`: share of the pixels of displaced surfaces whose surface faces away
/// from its base.
void draw_captions(const Scene& scene, const RenderSettings& settings, double folds, Image& sheet) {
    const int width = settings.image.width, height = settings.image.height;
    constexpr int kWideLetters = 53; ///< that a view has room for at two pixels each
    const int scale = width >= 2 * kGlyphWidth * kWideLetters ? 2 : 1;
    const bool is_flat = std::ranges::all_of(scene.displacements, [](const Displacement& map) {
        return map.space == DisplacementSpace::tangent || map.type == DisplacementType::height;
    });
    const char* names = is_flat ? "red t, green b, blue n" : "red x, green y, blue z";
    draw_text(sheet, {0, 0}, width, scale, fmt::format("base, axes as arrows: {}", names));
    draw_text(sheet, {width, 0}, width, scale, "as rendered: " + describe_reading(scene));
    draw_text(sheet, {0, height}, width, scale, fmt::format("displacement: {}, grey 0", names));
    draw_text(sheet, {width, height}, width, scale,
              fmt::format("red faces away from its base: {:.1f} %", 100 * folds));
}

} // namespace

Image make_check_picture(const Scene& scene, const RenderSettings& settings,
                         const ProgressFunction& on_progress) {
    validate_settings(settings);
    RenderSettings plain = settings;
    plain.device.engine = EngineKind::cpu;
    plain.image.crop = {}, plain.image.layers = {}, plain.surface.mode = SurfaceMode::direct;
    Image sheet = make_sheet(plain);
    ProgressCounter steps(on_progress, 3);
    copy_picture(render(make_base(scene), plain).image, 0, 0, sheet);
    steps.add(1);
    copy_picture(render(scene, plain).image, plain.image.width, 0, sheet);
    steps.add(1);

    const std::shared_ptr<const PreparedScene> prepared = prepare_scene(scene, plain);
    const scalar::CameraFrame camera = make_camera_frame(*prepared);
    const std::vector<Ray> rays = make_rays(camera, plain);
    std::vector<RayHit> hits(rays.size());
    make_cpu_engine(prepared, plain)->closest_hits(rays, hits, kVisibleToAll);
    const float longest = find_longest(*prepared, hits);
    size_t displaced = 0, folded = 0;
    for (size_t k = 0; k < rays.size(); ++k) {
        const int x = int(k % size_t(plain.image.width)), y = int(k / size_t(plain.image.width));
        const PointColors colors = color_point(*prepared, rays[k], hits[k], longest);
        displaced += colors.is_displaced, folded += colors.is_folded;
        set_pixel(sheet, x, plain.image.height + y, colors.axes);
        set_pixel(sheet, plain.image.width + x, plain.image.height + y, colors.folds);
    }
    draw_frames(*prepared, camera, plain, sheet);
    draw_captions(scene, plain, displaced > 0 ? double(folded) / double(displaced) : 0, sheet);
    steps.add(1);
    return sheet;
}

} // namespace relief
