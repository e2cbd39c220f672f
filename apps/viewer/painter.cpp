#include "viewer/painter.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "common/texel_values.h"
#include "common/vectors.h"
#include "viewer/orbit_camera.h"

namespace relief::viewer {

using namespace vectors;

namespace {

/// Way between two dabs, as a share of the radius.
constexpr float kSpacing = 0.25f;

Vec3f blend(const Vec3f& a, const Vec3f& b, float share) { return a + (b - a) * share; }

TexelBox clip(const TexelBox& box, const Texture& texture) {
    return {std::max(box.x0, 0), std::max(box.y0, 0), std::min(box.x1, int(texture.width)),
            std::min(box.y1, int(texture.height))};
}

/// Calls `change(value, weight)` for each texel of a piece that the dab reaches.
template <class Change>
void change_texels(const TexelBox& box, const Dab& dab, Texture& texture, const Change& change) {
    for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x) {
            const float weight = find_weight(dab, float(x) + 0.5f, float(y) + 0.5f);
            if (weight <= 0) continue;
            const Vec3f value = read_texel(texture, uint32_t(x), uint32_t(y));
            write_texel(texture, uint32_t(x), uint32_t(y), change(value, weight));
        }
}

} // namespace

std::optional<Dab> Painter::make_dab(const Texture& texture, const SurfacePoint& point) {
    const float width = float(texture.width), height = float(texture.height);
    const float down = map().flip_v ? 1.0f : -1.0f; // rows along v
    Dab dab;
    const float row = map().flip_v ? point.uv.y : 1 - point.uv.y;
    dab.centre = {(point.uv.x - std::floor(point.uv.x)) * width, (row - std::floor(row)) * height};
    dab.radius = brush_.radius;
    if (!point.uv_right || !point.uv_down) {
        if (!last_dab_) return std::nullopt;
        dab.pixels_right = last_dab_->pixels_right, dab.pixels_down = last_dab_->pixels_down;
        return dab;
    }
    // Texels a pixel, then its inverse.
    const Vec2f right{point.uv_right->x * width, point.uv_right->y * down * height};
    const Vec2f below{point.uv_down->x * width, point.uv_down->y * down * height};
    const float determinant = right.x * below.y - right.y * below.x;
    if (!(std::fabs(determinant) > 1e-9f)) return std::nullopt;
    dab.pixels_right = {below.y / determinant, -right.y / determinant};
    dab.pixels_down = {-below.x / determinant, right.x / determinant};
    last_dab_ = dab;
    return dab;
}

/// Those of a map that repeats go on at its other side.
std::vector<Painter::Piece> Painter::find_pieces(const Texture& texture, const Dab& dab) const {
    const int most = map().wrap == WrapMode::repeat && !map().is_udim ? 1 : 0;
    std::vector<Piece> pieces;
    for (int row = -most; row <= most; ++row)
        for (int column = -most; column <= most; ++column) {
            Dab shifted = dab;
            shifted.centre.x += float(column * int(texture.width));
            shifted.centre.y += float(row * int(texture.height));
            const TexelBox box = clip(find_reach(shifted), texture);
            if (!box.is_empty()) pieces.push_back({box, shifted, {}});
        }
    return pieces;
}

Vec3f Painter::find_step(const Vec3f& shift_world, const SurfacePoint& point, int udim) {
    const Displacement& displacement = map();
    if (displacement.space == DisplacementSpace::world && displacement.type == DisplacementType::vector)
        return encode_step(displacement, shift_world);
    const Vec3f shift = untransform_vector(object().world_from_object, shift_world);
    if (displacement.space == DisplacementSpace::object && displacement.type == DisplacementType::vector)
        return encode_step(displacement, shift);
    if (brush_.kind == BrushKind::push) {
        const float sign = dot(shift_world, point.normal) < 0 ? -1.0f : 1.0f;
        return encode_step(displacement, {0, 0, sign * length(shift)});
    }
    std::unique_ptr<TexelFrames>& frames =
        frames_[{object().displacement, object().mesh, displacement.flip_v}];
    if (!frames)
        frames = std::make_unique<TexelFrames>(displacement, document_.scene().meshes[object().mesh]);
    const float row = displacement.flip_v ? point.uv.y : 1 - point.uv.y;
    return encode_step(displacement, frames->express(shift, udim, point.uv.x - std::floor(point.uv.x),
                                                     row - std::floor(row)));
}

void Painter::smooth(const Piece& piece, Texture& texture) const {
    const Vec2f &a = piece.dab.pixels_right, &b = piece.dab.pixels_down;
    const float texels = piece.dab.radius / std::sqrt(std::fabs(a.x * b.y - a.y * b.x));
    const int reach = std::max(1, int(texels / 12));
    const TexelBox& box = piece.box;
    const TexelBox around = clip({box.x0 - reach, box.y0 - reach, box.x1 + reach, box.y1 + reach}, texture);
    const Texture before = copy_texels(texture, around);
    const auto read = [&](int x, int y) {
        return read_texel(before, uint32_t(std::clamp(x, around.x0, around.x1 - 1) - around.x0),
                          uint32_t(std::clamp(y, around.y0, around.y1 - 1) - around.y0));
    };
    const float strength = std::fabs(brush_.strength);
    for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x) {
            const float weight = find_weight(piece.dab, float(x) + 0.5f, float(y) + 0.5f);
            if (weight <= 0) continue;
            Vec3f sum{};
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) sum = sum + read(x + dx * reach, y + dy * reach);
            write_texel(texture, uint32_t(x), uint32_t(y),
                        blend(read(x, y), sum * (1.0f / 9), weight * strength));
        }
}

void Painter::apply(const Piece& piece, const SurfacePoint& point, int udim, Texture& texture) {
    const Displacement& displacement = map();
    if (brush_.kind == BrushKind::smooth) return smooth(piece, texture);
    if (brush_.kind == BrushKind::erase) {
        const bool is_height = displacement.type == DisplacementType::height;
        change_texels(piece.box, piece.dab, texture, [&](const Vec3f& value, float weight) {
            const Vec3f zero =
                is_height ? Vec3f{displacement.midlevel.x, value.y, value.z} : displacement.midlevel;
            return blend(value, zero, weight * std::fabs(brush_.strength));
        });
        return;
    }
    const float height = brush_.strength * kSpacing * brush_.radius * point.pixel_size;
    const Vec3f step = find_step(point.normal * height, point, udim);
    change_texels(piece.box, piece.dab, texture,
                  [&](const Vec3f& value, float weight) { return value + step * weight; });
}

void Painter::dab_at(const ShownPicture& picture, float x, float y) {
    const std::optional<SurfacePoint> point = find_surface_point(picture, x, y);
    if (!point || point->object != object_) return;
    const TilePlace place{object().displacement, find_udim(document_.scene(), *point)};
    Texture& texture = document_.paint_tile(place.displacement, place.udim);
    const std::optional<Dab> dab = make_dab(texture, *point);
    if (!dab) return;
    for (const Piece& piece : find_pieces(texture, *dab)) {
        history_.keep(place, texture, piece.box);
        apply(piece, *point, place.udim, texture);
        note_change(place, piece.box);
    }
}

/// Dabs lie close together: those that overlap are one edit.
void Painter::note_change(const TilePlace& place, const TexelBox& box) {
    for (auto& [other, wide] : changed_) {
        const bool is_apart = box.x0 > wide.x1 || box.x1 < wide.x0 || box.y0 > wide.y1 || box.y1 < wide.y0;
        if (other != place || is_apart) continue;
        wide = {std::min(wide.x0, box.x0), std::min(wide.y0, box.y0), std::max(wide.x1, box.x1),
                std::max(wide.y1, box.y1)};
        return;
    }
    changed_.emplace_back(place, box);
}

std::vector<MapEdit> Painter::take_edits() {
    std::vector<MapEdit> edits;
    for (const auto& [place, box] : std::exchange(changed_, {})) {
        const Texture& texture = document_.paint_tile(place.displacement, place.udim);
        edits.push_back({document_.scene().displacements[place.displacement].name, place.udim,
                         uint32_t(box.x0), uint32_t(box.y0), copy_texels(texture, box)});
    }
    return edits;
}

std::vector<MapEdit> Painter::begin(const Brush& brush, const ShownPicture& picture, float x, float y) {
    end();
    const Scene& scene = document_.scene();
    const std::optional<SurfacePoint> point = find_surface_point(picture, x, y);
    if (!point || point->object >= scene.objects.size() ||
        scene.objects[point->object].displacement == kNoIndex)
        return {};
    brush_ = brush;
    object_ = point->object;
    last_ = {x, y};
    last_dab_.reset();
    history_.begin();
    if (brush.kind != BrushKind::grab) {
        dab_at(picture, x, y);
        return take_edits();
    }
    start_ = point;
    start_udim_ = find_udim(scene, *point);
    const TilePlace place{object().displacement, start_udim_};
    Texture& texture = document_.paint_tile(place.displacement, place.udim);
    const std::optional<Dab> dab = make_dab(texture, *point);
    grabbed_ = dab ? find_pieces(texture, *dab) : std::vector<Piece>();
    for (Piece& piece : grabbed_) {
        history_.keep(place, texture, piece.box);
        piece.before = copy_texels(texture, piece.box);
    }
    return {};
}

std::vector<MapEdit> Painter::grab(const ShownPicture& picture, float x, float y) {
    const OrbitCamera camera(picture.camera);
    const Vec3f shift = camera.right() * ((x - last_.x) * start_->pixel_size) +
                        camera.upward() * ((last_.y - y) * start_->pixel_size);
    const Vec3f step = find_step(shift, *start_, start_udim_);
    const TilePlace place{object().displacement, start_udim_};
    Texture& texture = document_.paint_tile(place.displacement, place.udim);
    for (const Piece& piece : grabbed_) paste_texels(piece.before, piece.box, texture);
    for (const Piece& piece : grabbed_)
        change_texels(piece.box, piece.dab, texture,
                      [&](const Vec3f& value, float weight) { return value + step * weight; });
    for (const Piece& piece : grabbed_) note_change(place, piece.box);
    return take_edits();
}

std::vector<MapEdit> Painter::move(const ShownPicture& picture, float x, float y) {
    if (!is_active()) return {};
    if (brush_.kind == BrushKind::grab) return grab(picture, x, y);
    const float step = std::max(1.0f, kSpacing * brush_.radius);
    for (float way = std::hypot(x - last_.x, y - last_.y); way >= step;
         way = std::hypot(x - last_.x, y - last_.y)) {
        last_ = {last_.x + (x - last_.x) * step / way, last_.y + (y - last_.y) * step / way};
        dab_at(picture, last_.x, last_.y);
    }
    return take_edits();
}

void Painter::end() {
    history_.end();
    object_ = kNoIndex;
    grabbed_.clear();
    start_.reset();
}

SceneValue Painter::exchange(const SceneValue& value) {
    if (std::holds_alternative<Displacement>(value.value)) frames_.clear(); // the space may be another
    return document_.exchange(value);
}

std::vector<MapEdit> Painter::undo() {
    history_.undo(
        [&](const TilePlace& p) -> Texture& { return document_.paint_tile(p.displacement, p.udim); },
        [&](const TilePlace& place, const TexelBox& box) { note_change(place, box); },
        [&](const SceneValue& value) { return exchange(value); });
    return take_edits();
}

std::vector<MapEdit> Painter::redo() {
    history_.redo(
        [&](const TilePlace& p) -> Texture& { return document_.paint_tile(p.displacement, p.udim); },
        [&](const TilePlace& place, const TexelBox& box) { note_change(place, box); },
        [&](const SceneValue& value) { return exchange(value); });
    return take_edits();
}

} // namespace relief::viewer
