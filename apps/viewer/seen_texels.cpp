#include "viewer/seen_texels.h"

#include <algorithm>
#include <cmath>

#include "common/vectors.h"
#include "viewer/brush.h"
#include "viewer/picture_layers.h"

namespace relief::viewer {

using namespace vectors;

namespace {

/// If the uvs of two neighbours differ by more, the tile of the second one is looked for anew.
constexpr float kNearUv = 0.05f;

/// Tiles of pixels, from left to right.
class TileFinder {
  public:
    TileFinder(const Scene& scene, const SurfacePoint& centre)
        : scene_(scene),
          centre_(centre),
          map_(scene.displacements[scene.objects[centre.object].displacement]) {}

    const Displacement& map() const { return map_; }

    /// Finds the tile that a pixel shows. If uvs go on from the last pixel it is the tile of that pixel;
    /// otherwise all faces are searched. Null: the map has no tile there.
    const MapTile* find(int x, int y, const Vec2f& uv, const Vec3f& position) {
        if (!map_.is_udim) return &map_.tiles.front();
        const bool goes_on =
            y == last_y_ && x == last_x_ + 1 && std::hypot(uv.x - last_uv_.x, uv.y - last_uv_.y) < kNearUv &&
            std::floor(uv.x) == std::floor(last_uv_.x) && std::floor(uv.y) == std::floor(last_uv_.y);
        if (!goes_on) {
            SurfacePoint point = centre_;
            point.uv = uv, point.position = position;
            const auto found = std::ranges::find(map_.tiles, find_udim(scene_, point), &MapTile::udim);
            tile_ = found == map_.tiles.end() ? nullptr : &*found;
        }
        last_x_ = x, last_y_ = y, last_uv_ = uv;
        return tile_;
    }

  private:
    const Scene& scene_;
    const SurfacePoint& centre_;
    const Displacement& map_;
    const MapTile* tile_ = nullptr;
    int last_x_ = -2, last_y_ = -1;
    Vec2f last_uv_{};
};

/// Pixels of the shown picture around the centre that a ball about it may cover.
TexelBox find_pixels(const ShownPicture& picture, const SurfacePoint& centre, float radius) {
    const Vec3f forward = normalize(picture.camera.to - picture.camera.from);
    const Vec3f right = normalize(cross(forward, picture.camera.up)), up = cross(right, forward);
    const Vec3f to = centre.position - picture.camera.from;
    const float pixel = find_pixel_width(picture, centre), high = float(picture.image.height);
    const float x =
        0.5f * float(picture.image.width) - picture.camera.shift.x * high + dot(to, right) / pixel;
    const float y = 0.5f * high + picture.camera.shift.y * high - dot(to, up) / pixel;
    const float nearer = std::min(0.75f, radius / std::max(centre.distance, 1e-20f));
    const float reach = std::min(radius / (pixel * (1 - nearer)) + 1, 1e6f);
    return {std::max(0, int(x - reach)), std::max(0, int(y - reach)),
            std::min(picture.image.width, int(x + reach) + 1),
            std::min(picture.image.height, int(y + reach) + 1)};
}

} // namespace

float find_pixel_width(const ShownPicture& picture, const SurfacePoint& centre) {
    return centre.pixel_size * float(picture.full_width) / float(picture.image.width);
}

std::vector<SeenTexel> find_seen_texels(const Scene& scene, const ShownPicture& picture,
                                        const SurfacePoint& centre, float radius) {
    const PictureLayers layers(picture.image);
    TileFinder tiles(scene, centre);
    std::vector<SeenTexel> seen;
    const TexelBox box = find_pixels(picture, centre, radius);
    for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x) {
            if (!layers.has_surface(x, y) || layers.id(x, y) != float(centre.object + 1)) continue;
            const Vec3f position = layers.position(x, y);
            if (!(length(position - centre.position) < radius)) continue;
            const Vec2f uv = layers.uv(x, y);
            const MapTile* const tile = tiles.find(x, y, uv, position);
            if (!tile || !tile->texture) continue;
            const float row = tiles.map().flip_v ? uv.y : 1 - uv.y;
            seen.push_back({tile->udim, (uv.x - std::floor(uv.x)) * float(tile->texture->width),
                            (row - std::floor(row)) * float(tile->texture->height), position});
        }
    return seen;
}

} // namespace relief::viewer
