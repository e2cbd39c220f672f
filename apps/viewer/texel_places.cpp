#include "viewer/texel_places.h"

#include <algorithm>
#include <memory>

#include "common/texel_values.h"
#include "common/vectors.h"
#include "relief/convert.h"

namespace relief::viewer {

using namespace vectors;

namespace {

constexpr int kMostSide = 1024;                ///< samples of the base, per side of a tile
constexpr int kMostLevel = 4;                  ///< of the mesh that stands for the base
constexpr size_t kMostFaces = size_t(1) << 20; ///< of that mesh

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

} // namespace

TexelPlaces::TexelPlaces(const Scene& scene, uint32_t object)
    : world_from_object_(scene.objects[object].world_from_object) {
    const Object& shown = scene.objects[object];
    const Displacement& map = scene.displacements[shown.displacement];
    const Mesh& mesh = scene.meshes[shown.mesh];
    base_ = make_displaced_mesh(make_base_scene(scene, object), choose_level(mesh));
    if (map.type == DisplacementType::height || map.space == DisplacementSpace::tangent)
        frames_.emplace(map, mesh);
}

const PlaceGrid& TexelPlaces::find_grid(const Displacement& map, const MapTile& tile) const {
    const auto known = grids_.find(tile.udim);
    if (known != grids_.end()) return known->second;
    PlaceGrid& grid = grids_
                          .try_emplace(tile.udim, std::min(int(tile.texture->width), kMostSide),
                                       std::min(int(tile.texture->height), kMostSide))
                          .first->second;
    const UdimSquare square = map.is_udim ? find_udim_square(tile.udim) : UdimSquare{};
    grid.draw(base_, {map.is_udim, square, map.flip_v});
    return grid;
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
    const PlaceGrid& grid = find_grid(map, tile);
    const float column = (float(x) + 0.5f) / float(tile.texture->width),
                row = (float(y) + 0.5f) / float(tile.texture->height);
    const auto base = grid.find(column * float(grid.width()), row * float(grid.height()));
    if (!base) return std::nullopt;
    const Vec3f displacement = decode_texel(map, read_texel(*tile.texture, uint32_t(x), uint32_t(y)));
    const bool is_world = map.space == DisplacementSpace::world && map.type == DisplacementType::vector;
    const Vec3f own = is_world ? *base : *base + turn(map, displacement, tile.udim, column, row);
    const Vec3f place = transform_vector(world_from_object_, own) + world_from_object_.translation;
    return is_world ? place + displacement : place;
}

} // namespace relief::viewer
