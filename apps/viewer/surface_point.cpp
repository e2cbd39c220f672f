#include "viewer/surface_point.h"
#include "base/udim.h"
#include "common/vectors.h"
#include "viewer/picture_layers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace relief::viewer {

using namespace vectors;

namespace {

/// Lines begin there, in distances of the camera's target.
constexpr float kNearPlane = 1e-3f;

/// Whether a triangle of the uv plane holds a point.
bool holds(const Vec2f& a, const Vec2f& b, const Vec2f& c, const Vec2f& p) {
    const auto side = [&](const Vec2f& s, const Vec2f& e) {
        return (e.x - s.x) * (p.y - s.y) - (e.y - s.y) * (p.x - s.x);
    };
    const float ab = side(a, b), bc = side(b, c), ca = side(c, a);
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

} // namespace

std::optional<SurfacePoint> find_surface_point(const ShownPicture& picture, float x, float y) {
    const PictureLayers layers(picture.image);
    if (!layers.is_complete() || picture.full_width < 1 || picture.full_height < 1) return std::nullopt;
    const float scale_x = float(picture.full_width) / float(picture.image.width);
    const float scale_y = float(picture.full_height) / float(picture.image.height);
    const int px = int(std::floor(x / scale_x)), py = int(std::floor(y / scale_y));
    if (!layers.has_surface(px, py) || layers.id(px, py) < 1) return std::nullopt; // 0 is no object
    SurfacePoint point;
    point.object = uint32_t(layers.id(px, py)) - 1;
    point.position = layers.position(px, py);
    point.normal = normalize(layers.normal(px, py));
    point.uv = layers.uv(px, py);
    const Vec3f forward = normalize(picture.camera.to - picture.camera.from);
    const float distance = dot(point.position - picture.camera.from, forward);
    point.pixel_size = 2 * distance * std::tan(picture.camera.fov_degrees * std::numbers::pi_v<float> / 360) /
                       float(picture.full_height);
    point.distance = distance;
    return point;
}

std::optional<std::pair<Vec2f, Vec2f>> project_line(const Camera& camera, const Vec3f& a, const Vec3f& b,
                                                    int width, int height) {
    const Vec3f axis = camera.to - camera.from, forward = normalize(axis);
    const Vec3f right = normalize(cross(forward, camera.up)), up = cross(right, forward);
    const float nearest = kNearPlane * length(axis);
    Vec3f ends[2] = {a - camera.from, b - camera.from};
    const float depths[2] = {dot(ends[0], forward), dot(ends[1], forward)};
    if (std::max(depths[0], depths[1]) <= nearest) return std::nullopt;
    for (size_t k = 0; k < 2; ++k) {
        if (depths[k] >= nearest) continue;
        const float share = (nearest - depths[k]) / (depths[1 - k] - depths[k]);
        ends[k] = ends[k] + (ends[1 - k] - ends[k]) * share;
    }
    const float high = float(height);
    const float pixels = 0.5f * high / std::tan(camera.fov_degrees * std::numbers::pi_v<float> / 360);
    const auto project = [&](const Vec3f& end) -> Vec2f {
        const float scale = pixels / dot(end, forward);
        return {0.5f * float(width) - camera.shift.x * high + dot(end, right) * scale,
                0.5f * high + camera.shift.y * high - dot(end, up) * scale};
    };
    return std::pair(project(ends[0]), project(ends[1]));
}

int find_udim(const Scene& scene, const SurfacePoint& point) {
    const Object& object = scene.objects[point.object];
    const Displacement& map = scene.displacements[object.displacement];
    if (!map.is_udim) return map.tiles.front().udim;
    const Mesh& mesh = scene.meshes[object.mesh];
    int udim = map.tiles.front().udim;
    float nearest = std::numeric_limits<float>::infinity();
    for (size_t face = 0, first = 0; face < mesh.face_sizes.size(); first += mesh.face_sizes[face++]) {
        const size_t corners = mesh.face_sizes[face];
        if (mesh.uv_indices.empty() || mesh.uv_indices[first] == kNoIndex) continue;
        const auto uv = [&](size_t k) { return mesh.uvs[mesh.uv_indices[first + k]]; };
        Vec2f middle{};
        for (size_t k = 0; k < corners; ++k)
            middle.x += uv(k).x / float(corners), middle.y += uv(k).y / float(corners);
        const float column = std::floor(middle.x), row = std::floor(middle.y);
        const Vec2f p{point.uv.x + column, point.uv.y + row};
        const std::optional<int> number = relief::find_udim(middle.x, middle.y);
        bool is_inside = false;
        for (size_t k = 2; k < corners; ++k) is_inside |= holds(uv(0), uv(k - 1), uv(k), p);
        if (!is_inside || !number) continue;
        const Vec3f corner = mesh.positions[mesh.position_indices[first]];
        const Vec3f place =
            transform_vector(object.world_from_object, corner) + object.world_from_object.translation;
        if (const float distance = length(place - point.position); distance < nearest) {
            nearest = distance;
            udim = *number;
        }
    }
    return udim;
}

} // namespace relief::viewer
