// load_mesh_scene: a camera that shows the whole object, a material and a light, for a mesh that comes alone.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "io/asset_cache.h"
#include "io/content_hash.h"
#include "io/displacement_reader.h"
#include "math/affine.h"
#include "math/box.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

/// Corners of one face, as positions and uvs, and its flat frame.
struct FaceFrame {
    std::array<Vec3f, 4> positions;
    std::array<Vec2f, 4> uvs;
    Vec3f t, b, n;
};

FaceFrame make_face_frame(const Mesh& mesh, size_t first, uint32_t size) {
    FaceFrame face;
    for (size_t k = 0; k < 4; ++k) {
        const size_t corner = first + std::min<size_t>(k, size - 1);
        face.positions[k] = mesh.positions[mesh.position_indices[corner]];
        if (!mesh.uv_indices.empty()) face.uvs[k] = mesh.uvs[mesh.uv_indices[corner]];
    }
    const Vec3f a = face.positions[1] - face.positions[0], c = face.positions[2] - face.positions[0];
    const Vec2f ua = face.uvs[1] - face.uvs[0], uc = face.uvs[2] - face.uvs[0];
    const float determinant = ua.x * uc.y - ua.y * uc.x;
    const float sign = determinant < 0 ? -1.0f : 1.0f;
    face.n = normalize(cross(a, c));
    const Vec3f along_u = (a * uc.y - c * ua.y) * sign;
    face.t = normalize(along_u - face.n * dot(face.n, along_u));
    face.b = cross(face.n, face.t) * sign;
    return face;
}

/// Displacement at a uv by the nearest texel: close enough to frame a picture.
Vec3f sample_displacement(const Displacement& map, const Vec2f& uv, const FaceFrame& face) {
    const MapTile* tile = &map.tiles.front();
    const float column = std::floor(uv.x), row = std::floor(uv.y);
    if (map.is_udim) {
        const auto found = std::find_if(map.tiles.begin(), map.tiles.end(), [&](const MapTile& candidate) {
            return float(candidate.udim) == 1001 + column + 10 * row;
        });
        if (found == map.tiles.end()) return {};
        tile = &*found;
    }
    const Texture& texture = *tile->texture;
    const float v = uv.y - row;
    const auto to_texel = [](float f, uint32_t size) {
        return uint32_t(std::clamp(f * float(size), 0.0f, float(size - 1)));
    };
    const uint32_t x = to_texel(uv.x - column, texture.width);
    const uint32_t y = to_texel(map.flip_v ? v : 1 - v, texture.height);
    if (map.type == DisplacementType::height)
        return face.n * ((get_texel(texture, x, y, 0) - map.midlevel.x) * map.scale.x);
    Vec3f local;
    for (int c = 0; c < 3; ++c) {
        const float value = get_texel(texture, x, y, uint32_t(c)) - get_component(map.midlevel, c);
        set_component(local, map.axes.axis[size_t(c)],
                      value * get_component(map.scale, c) * float(map.axes.sign[size_t(c)]));
    }
    return map.space == DisplacementSpace::tangent ? face.t * local.x + face.b * local.y + face.n * local.z
                                                   : local;
}

struct Extent {
    Box base, displaced;
    Vec3f normal; ///< sum over the faces, weighted by area
};

/// About a quarter of a million samples, spread evenly over the faces.
Extent compute_extent(const Mesh& mesh, const Displacement* map) {
    Extent extent;
    const double per_face = map ? std::sqrt(262144.0 / double(mesh.face_sizes.size())) : 1;
    const int steps = std::clamp(int(per_face), 1, 512);
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        const FaceFrame face = make_face_frame(mesh, first, size);
        for (size_t k = 0; k < size; ++k)
            extent.base.extend(mesh.positions[mesh.position_indices[first + k]]);
        extent.normal += cross(face.positions[2] - face.positions[0], face.positions[3] - face.positions[1]);
        for (int j = 0; map && j <= steps; ++j) {
            for (int i = 0; i <= steps; ++i) {
                const float u = float(i) / float(steps), v = float(j) / float(steps);
                const auto mix = [&](const auto& c) {
                    return (c[0] * (1 - u) + c[1] * u) * (1 - v) + (c[3] * (1 - u) + c[2] * u) * v;
                };
                extent.displaced.extend(mix(face.positions) + sample_displacement(*map, mix(face.uvs), face));
            }
        }
        first += size;
    }
    extent.displaced.extend(extent.base);
    return extent;
}

Vec3f make_direction(float azimuth_degrees, float elevation_degrees) {
    constexpr float kRadians = std::numbers::pi_v<float> / 180;
    const float azimuth = azimuth_degrees * kRadians, elevation = elevation_degrees * kRadians;
    return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
            std::cos(azimuth) * std::cos(elevation)};
}

/// From the middle of the object to the camera: bodies from above the front; flat ones from the side that
/// they face.
Vec3f choose_view(const Extent& extent) {
    const Vec3f size = extent.base.extent();
    const float largest = std::max({size.x, size.y, size.z});
    constexpr float kFlat = 0.05f;
    if (size.y < kFlat * largest) return make_direction(25, extent.normal.y < 0 ? -40.0f : 40.0f);
    if (size.x < kFlat * largest) return make_direction(extent.normal.x < 0 ? -65.0f : 115.0f, 18);
    if (size.z < kFlat * largest) return make_direction(extent.normal.z < 0 ? 205.0f : 25.0f, 18);
    return make_direction(30, 22);
}

/// Looks at the box along `view` from so far that all its corners are in a square picture.
Camera frame_box(const Box& box, const Vec3f& view) {
    Camera camera;
    constexpr float kMargin = 1.04f;
    const float tangent = std::tan(camera.fov_degrees * std::numbers::pi_v<float> / 360);
    const Vec3f center = box.center(), half = box.extent() * 0.5f;
    const Vec3f right = normalize(cross(camera.up, view)), up = cross(view, right);
    float distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3f p{corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y,
                      corner & 4 ? half.z : -half.z};
        const float side = std::max(std::fabs(dot(p, right)), std::fabs(dot(p, up)));
        distance = std::max(distance, side * kMargin / tangent + dot(p, view));
    }
    if (!(distance > 0)) distance = 1;
    camera.to = center;
    camera.from = center + view * distance;
    camera.focus_distance = distance;
    return camera;
}

void add_default_light(Scene& scene, const Vec3f& view) {
    Environment sky;
    sky.color = {0.36f, 0.40f, 0.46f};
    scene.environment = sky;
    const Vec3f left = normalize(cross(view, Vec3f{0, 1, 0}));
    Light sun;
    sun.direction = normalize(left * 0.8f + Vec3f{0, 0.9f, 0} + view * 0.55f) * -1.0f;
    sun.angle_degrees = 3;
    sun.color = {1.0f, 0.95f, 0.88f};
    sun.strength = 2.4f;
    scene.lights.push_back(sun);
}

void add_map(Scene& scene, const MeshSceneOptions& options, AssetCache& assets) {
    const Mesh& mesh = scene.meshes.front();
    if (mesh.uv_indices.empty())
        throw Error(ErrorKind::bad_input, {"the mesh has no uvs, which its displacement map needs",
                                           mesh.source, "export the mesh with texture coordinates"});
    DisplacementRequest request;
    request.name = options.displacement_map.stem().string();
    request.file = std::filesystem::absolute(options.displacement_map).string();
    request.preset = options.preset;
    request.space = options.space;
    request.axes = options.axes;
    if (options.midlevel) request.midlevel = Vec3f{*options.midlevel, *options.midlevel, *options.midlevel};
    if (options.scale) request.scale = Vec3f{*options.scale, *options.scale, *options.scale};
    request.flip_v = options.flip_v;
    scene.displacements.push_back(make_displacement(request, assets));
    scene.objects.front().displacement = 0;
}

uint64_t compute_hash(const Scene& scene, const MeshSceneOptions& options) {
    ContentHash hash;
    const auto add_float = [&](const std::optional<float>& value) {
        hash.add(value ? fmt::format("{}", *value) : std::string("-"));
    };
    hash.add(options.preset), hash.add(options.space.value_or("-")), hash.add(options.axes.value_or("-"));
    add_float(options.midlevel), add_float(options.scale);
    hash.add(options.flip_v ? "flip" : "-");
    add_scene_content(hash, scene);
    return hash.value();
}

} // namespace

Scene load_mesh_scene(const std::filesystem::path& mesh, const MeshSceneOptions& options) {
    Scene scene;
    scene.source = mesh.string();
    scene.meshes.push_back(load_mesh(mesh));
    Material clay;
    clay.name = "clay";
    clay.base_color = {0.75f, 0.55f, 0.45f};
    clay.roughness = 0.6f;
    scene.materials.push_back(clay);
    Object object;
    object.name = scene.meshes.front().name;
    object.material = 0;
    scene.objects.push_back(object);

    AssetCache assets("");
    if (!options.displacement_map.empty()) add_map(scene, options, assets);
    const Extent extent = compute_extent(
        scene.meshes.front(), scene.displacements.empty() ? nullptr : &scene.displacements.front());
    const Vec3f view = choose_view(extent);
    scene.camera = frame_box(extent.displaced, view);
    if (options.environment.empty()) {
        add_default_light(scene, view);
    } else {
        Environment environment;
        environment.texture = assets.load(options.environment.string(), TextureUse::radiance);
        scene.environment = environment;
    }
    scene.warnings = std::move(assets.warnings());
    validate_scene(scene);
    scene.hash = compute_hash(scene, options);
    return scene;
}

} // namespace relief
