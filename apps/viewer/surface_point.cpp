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

/// The faces of an object around a uv that a picture shows. Such uvs are relative to a tile that their face
/// reaches into.
class FaceSearch {
  public:
    FaceSearch(const Scene& scene, const SurfacePoint& point)
        : object_(scene.objects[point.object]),
          mesh_(scene.meshes[object_.mesh]),
          map_(scene.displacements[object_.displacement]),
          point_(point),
          udim_(map_.tiles.front().udim) {}

    /// The tile of the place that is nearest to the point.
    int run() {
        for (size_t face = 0; face < mesh_.face_sizes.size(); first_ += mesh_.face_sizes[face++])
            if (!mesh_.uv_indices.empty() && mesh_.uv_indices[first_] != kNoIndex)
                add_face(mesh_.face_sizes[face]);
        return udim_;
    }

  private:
    Vec2f uv(size_t k) const { return mesh_.uvs[mesh_.uv_indices[first_ + k]]; }
    Vec3f position(size_t k) const { return mesh_.positions[mesh_.position_indices[first_ + k]]; }

    void add_face(size_t corners) {
        Vec2f low = uv(0), high = low, middle{};
        for (size_t k = 0; k < corners; ++k) {
            low = {std::min(low.x, uv(k).x), std::min(low.y, uv(k).y)};
            high = {std::max(high.x, uv(k).x), std::max(high.y, uv(k).y)};
            middle = {middle.x + uv(k).x / float(corners), middle.y + uv(k).y / float(corners)};
        }
        const Vec2f square{std::floor(middle.x), std::floor(middle.y)};
        const bool is_in_one = low.x > square.x - kUvRounding && high.x < square.x + 1 + kUvRounding &&
                               low.y > square.y - kUvRounding && high.y < square.y + 1 + kUvRounding;
        if (is_in_one)
            add_place(corners, {point_.uv.x + square.x, point_.uv.y + square.y}, middle);
        else
            add_across(corners, low, high);
    }

    /// Adds a face across tiles, whose uvs are relative to any tile of the map that it reaches into.
    void add_across(size_t corners, const Vec2f& low, const Vec2f& high) {
        for (const MapTile& tile : map_.tiles) {
            const UdimSquare square = find_udim_square(tile.udim);
            const Vec2f place{point_.uv.x + float(square.column), point_.uv.y + float(square.row)};
            if (place.x >= low.x && place.x <= high.x && place.y >= low.y && place.y <= high.y)
                add_place(corners, place, place);
        }
    }

    /// Looks whether a place of the uv plane lies in the face. `of_tile`: a uv in the tile of the place.
    void add_place(size_t corners, const Vec2f& place, const Vec2f& of_tile) {
        const std::optional<int> udim = relief::find_udim(of_tile.x, of_tile.y);
        for (size_t k = 2; udim && k < corners; ++k) {
            const std::optional<Vec3f> own = find_position(k, place);
            if (!own) continue;
            const Vec3f world =
                transform_vector(object_.world_from_object, *own) + object_.world_from_object.translation;
            if (const float distance = length(world - point_.position); distance < nearest_)
                nearest_ = distance, udim_ = *udim;
        }
    }

    /// The position at a place of the uv plane within triangle k of the face: corners 0, k - 1 and k.
    std::optional<Vec3f> find_position(size_t k, const Vec2f& place) const {
        const auto side = [&](const Vec2f& s, const Vec2f& e) {
            return (e.x - s.x) * (place.y - s.y) - (e.y - s.y) * (place.x - s.x);
        };
        const Vec2f a = uv(0), b = uv(k - 1), c = uv(k);
        const float ab = side(a, b), bc = side(b, c), ca = side(c, a), area = ab + bc + ca;
        const bool is_inside = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
        if (!is_inside) return std::nullopt;
        if (area == 0) return position(0);
        return (position(0) * bc + position(k - 1) * ca + position(k) * ab) * (1 / area);
    }

    const Object& object_;
    const Mesh& mesh_;
    const Displacement& map_;
    const SurfacePoint& point_;
    size_t first_ = 0; ///< first corner of the face
    int udim_;
    float nearest_ = std::numeric_limits<float>::infinity();
};

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
    const Displacement& map = scene.displacements[scene.objects[point.object].displacement];
    return map.is_udim ? FaceSearch(scene, point).run() : map.tiles.front().udim;
}

} // namespace relief::viewer
