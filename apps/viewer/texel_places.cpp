#include "viewer/texel_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>

#include "common/texel_values.h"
#include "common/vectors.h"
#include "relief/convert.h"

namespace relief::viewer {

using namespace vectors;

namespace {

constexpr int kMostSide = 1024;                ///< samples of the base, per side of a tile
constexpr int kMostLevel = 4;                  ///< of the mesh that stands for the base
constexpr size_t kMostFaces = size_t(1) << 20; ///< of that mesh
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// A scene of one object whose map displaces nothing.
Scene make_base_scene(const Scene& scene, uint32_t object) {
    Scene base;
    base.objects = {scene.objects[object]};
    base.meshes = {scene.meshes[base.objects[0].mesh]};
    base.displacements = {scene.displacements[base.objects[0].displacement]};
    base.objects[0].mesh = base.objects[0].displacement = 0;
    base.objects[0].material = kNoIndex;
    base.objects[0].world_from_object = Affine{};
    Displacement& map = base.displacements[0];
    map.space = DisplacementSpace::object, map.type = DisplacementType::vector;
    map.frame = FrameKind::mikk, map.lengths = FrameLengths::absolute;
    map.filter = MapFilter::none, map.dequantize = false, map.autobump = false;
    map.axes = {}, map.midlevel = {}, map.scale = {1, 1, 1};
    auto zero = std::make_shared<Texture>();
    zero->width = zero->height = 1, zero->channel_count = 3;
    zero->floats = {0, 0, 0, 1};
    for (MapTile& tile : map.tiles) tile.texture = zero;
    return base;
}

int choose_level(const Mesh& mesh) {
    int level = 0;
    while (level < kMostLevel && mesh.face_sizes.size() << (2 * (level + 1)) <= kMostFaces) ++level;
    return level;
}

bool is_there(const Vec3f& p) { return !std::isnan(p.x); }

} // namespace

TexelPlaces::TexelPlaces(const Scene& scene, uint32_t object)
    : world_from_object_(scene.objects[object].world_from_object) {
    const Object& shown = scene.objects[object];
    const Displacement& map = scene.displacements[shown.displacement];
    const Mesh& mesh = scene.meshes[shown.mesh];
    for (const MapTile& tile : map.tiles) {
        Grid& grid = grids_[tile.udim];
        grid.width = std::min(int(tile.texture->width), kMostSide);
        grid.height = std::min(int(tile.texture->height), kMostSide);
        grid.positions.assign(size_t(grid.width) * size_t(grid.height), {kNothing, 0, 0});
    }
    draw_base(make_displaced_mesh(make_base_scene(scene, object), choose_level(mesh)), map);
    if (map.type == DisplacementType::height || map.space == DisplacementSpace::tangent)
        frames_.emplace(map, mesh);
}

void TexelPlaces::draw_base(const Mesh& base, const Displacement& map) {
    size_t first = 0;
    for (const uint32_t size : base.face_sizes) {
        const auto position = [&](size_t k) { return base.positions[base.position_indices[first + k]]; };
        const auto uv = [&](size_t k) { return base.uvs[base.uv_indices[first + k]]; };
        if (base.uv_indices[first] != kNoIndex)
            for (size_t k = 2; k < size; ++k)
                draw_triangle({position(0), position(k - 1), position(k)}, {uv(0), uv(k - 1), uv(k)}, map);
        first += size;
    }
}

/// Into the samples of its tile whose middle it covers, or nearly does: a map is read a little beside faces,
/// too.
void TexelPlaces::draw_triangle(const Vec3f (&p)[3], const Vec2f (&uv)[3], const Displacement& map) {
    const float u = std::floor((uv[0].x + uv[1].x + uv[2].x) / 3),
                v = std::floor((uv[0].y + uv[1].y + uv[2].y) / 3);
    const auto found = grids_.find(map.is_udim ? 1001 + int(u) + 10 * int(v) : map.tiles.front().udim);
    if (found == grids_.end()) return;
    Grid& grid = found->second;
    Vec2f at[3];
    for (size_t k = 0; k < 3; ++k) {
        const float row = map.flip_v ? uv[k].y - v : 1 - (uv[k].y - v);
        at[k] = {(uv[k].x - u) * float(grid.width), row * float(grid.height)};
    }
    const float area = (at[1].x - at[0].x) * (at[2].y - at[0].y) - (at[1].y - at[0].y) * (at[2].x - at[0].x);
    if (!(std::fabs(area) > 1e-12f)) return;
    const auto [left, right] = std::minmax({at[0].x, at[1].x, at[2].x});
    const auto [top, bottom] = std::minmax({at[0].y, at[1].y, at[2].y});
    const float margin = 1 / std::max(1.0f, std::sqrt(std::fabs(area)));
    for (int y = int(std::floor(top)) - 1; float(y) < bottom + 1; ++y)
        for (int x = int(std::floor(left)) - 1; float(x) < right + 1; ++x) {
            const float px = float(x) + 0.5f - at[0].x, py = float(y) + 0.5f - at[0].y;
            const float b = (px * (at[2].y - at[0].y) - py * (at[2].x - at[0].x)) / area;
            const float c = (py * (at[1].x - at[0].x) - px * (at[1].y - at[0].y)) / area;
            const float inside = std::min({1 - b - c, b, c});
            if (inside < -margin) continue;
            const int column = (x % grid.width + grid.width) % grid.width,
                      line = (y % grid.height + grid.height) % grid.height;
            if (map.is_udim && (column != x || line != y)) continue;
            Vec3f& place = grid.positions[size_t(line) * size_t(grid.width) + size_t(column)];
            // Triangles that cover a sample win over those beside it.
            if (inside < 0 && is_there(place)) continue;
            place = p[0] + (p[1] - p[0]) * b + (p[2] - p[0]) * c;
        }
}

/// `column`, `row`: in samples, from the corner of the grid. Bilinear where all four are there and near.
std::optional<Vec3f> TexelPlaces::find_base(const Grid& grid, float column, float row) const {
    const auto at = [&](int x, int y) {
        return grid.positions[size_t(std::clamp(y, 0, grid.height - 1)) * size_t(grid.width) +
                              size_t(std::clamp(x, 0, grid.width - 1))];
    };
    const int x = int(std::floor(column - 0.5f)), y = int(std::floor(row - 0.5f));
    const float s = column - 0.5f - float(x), t = row - 0.5f - float(y);
    Vec3f sum{};
    float weights = 0;
    for (const auto& [dx, dy, weight] :
         {std::tuple{0, 0, (1 - s) * (1 - t)}, {1, 0, s * (1 - t)}, {0, 1, (1 - s) * t}, {1, 1, s * t}})
        if (const Vec3f place = at(x + dx, y + dy); is_there(place) && weight > 0)
            sum = sum + place * weight, weights += weight;
    if (weights <= 0) return std::nullopt;
    return sum * (1 / weights);
}

Vec3f TexelPlaces::turn(const Displacement& map, const Vec3f& displacement, int udim, float column,
                        float row) const {
    if (!frames_) return displacement;
    // Columns are what the axes of the object are in the frame; the frame takes that back.
    Affine frame_from_object;
    const Vec3f x = frames_->express({1, 0, 0}, udim, column, row),
                y = frames_->express({0, 1, 0}, udim, column, row),
                z = frames_->express({0, 0, 1}, udim, column, row);
    frame_from_object.rows = {Vec3f{x.x, y.x, z.x}, Vec3f{x.y, y.y, z.y}, Vec3f{x.z, y.z, z.z}};
    const Vec3f along = map.type == DisplacementType::height ? Vec3f{0, 0, displacement.z} : displacement;
    return untransform_vector(frame_from_object, along);
}

std::optional<Vec3f> TexelPlaces::find(const Displacement& map, const MapTile& tile, int x, int y) const {
    const auto found = grids_.find(tile.udim);
    if (found == grids_.end()) return std::nullopt;
    const Grid& grid = found->second;
    const float column = (float(x) + 0.5f) / float(tile.texture->width),
                row = (float(y) + 0.5f) / float(tile.texture->height);
    const auto base = find_base(grid, column * float(grid.width), row * float(grid.height));
    if (!base) return std::nullopt;
    const Vec3f displacement = decode_texel(map, read_texel(*tile.texture, uint32_t(x), uint32_t(y)));
    const bool is_world = map.space == DisplacementSpace::world && map.type == DisplacementType::vector;
    const Vec3f own = is_world ? *base : *base + turn(map, displacement, tile.udim, column, row);
    const Vec3f place = transform_vector(world_from_object_, own) + world_from_object_.translation;
    return is_world ? place + displacement : place;
}

} // namespace relief::viewer
