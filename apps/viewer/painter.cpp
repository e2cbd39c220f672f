#include "viewer/painter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
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

/// Calls `change(value, weight)` for each texel of a piece that the dab reaches.
template <class Change> void change_texels(const DabPiece& piece, Texture& texture, const Change& change) {
    for (int y = piece.box.y0; y < piece.box.y1; ++y)
        for (int x = piece.box.x0; x < piece.box.x1; ++x) {
            const float weight = piece.weight(x, y);
            if (weight <= 0) continue;
            const Vec3f value = read_texel(texture, uint32_t(x), uint32_t(y));
            write_texel(texture, uint32_t(x), uint32_t(y), change(value, weight));
        }
}

/// Texels from the middle of a dab to its edge, as if it were round.
float find_radius(const std::vector<DabPiece>& pieces) {
    size_t count = 0;
    for (const DabPiece& piece : pieces)
        count += size_t(std::ranges::count_if(piece.weights, [](float weight) { return weight > 0; }));
    return std::sqrt(float(count) / std::numbers::pi_v<float>);
}

/// Mean of the texels at (x, y) and `reach` around it.
Vec3f average(const Texture& texture, int x, int y, int reach) {
    Vec3f sum{};
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            sum = sum + read_texel(texture, uint32_t(std::clamp(x + dx * reach, 0, int(texture.width) - 1)),
                                   uint32_t(std::clamp(y + dy * reach, 0, int(texture.height) - 1)));
    return sum * (1.0f / 9);
}

} // namespace

Texture& Painter::paint(const DabPiece& piece) {
    return document_.paint_tile(object().displacement, piece.udim);
}

std::vector<DabPiece> Painter::find_pieces(const ShownPicture& picture, const SurfacePoint& point) {
    std::unique_ptr<TexelPlaces>& places = places_[point.object];
    if (!places) places = std::make_unique<TexelPlaces>(document_.scene(), point.object);
    return find_dab(document_.scene(), picture, point, brush_.radius, *places);
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

void Painter::smooth(const std::vector<DabPiece>& pieces) {
    const int reach = std::max(1, int(find_radius(pieces) / 12));
    std::vector<std::vector<Vec3f>> means; // of all pieces, before any is changed
    for (const DabPiece& piece : pieces) {
        const Texture& texture = paint(piece);
        std::vector<Vec3f>& own = means.emplace_back();
        for (int y = piece.box.y0; y < piece.box.y1; ++y)
            for (int x = piece.box.x0; x < piece.box.x1; ++x)
                own.push_back(piece.weight(x, y) > 0 ? average(texture, x, y, reach) : Vec3f{});
    }
    const float strength = std::fabs(brush_.strength);
    for (size_t k = 0; k < pieces.size(); ++k) {
        size_t next = 0;
        Texture& texture = paint(pieces[k]);
        for (int y = pieces[k].box.y0; y < pieces[k].box.y1; ++y)
            for (int x = pieces[k].box.x0; x < pieces[k].box.x1; ++x) {
                const Vec3f mean = means[k][next++];
                const float weight = pieces[k].weight(x, y);
                if (weight <= 0) continue;
                const Vec3f value = read_texel(texture, uint32_t(x), uint32_t(y));
                write_texel(texture, uint32_t(x), uint32_t(y), blend(value, mean, weight * strength));
            }
    }
}

void Painter::apply(const std::vector<DabPiece>& pieces, const SurfacePoint& point) {
    const Displacement& displacement = map();
    if (brush_.kind == BrushKind::smooth) return smooth(pieces);
    if (brush_.kind == BrushKind::erase) {
        const bool is_height = displacement.type == DisplacementType::height;
        for (const DabPiece& piece : pieces)
            change_texels(piece, paint(piece), [&](const Vec3f& value, float weight) {
                const Vec3f zero =
                    is_height ? Vec3f{displacement.midlevel.x, value.y, value.z} : displacement.midlevel;
                return blend(value, zero, weight * std::fabs(brush_.strength));
            });
        return;
    }
    const float height = brush_.strength * kSpacing * brush_.radius * point.pixel_size;
    const Vec3f step = find_step(point.normal * height, point, find_udim(document_.scene(), point));
    for (const DabPiece& piece : pieces)
        change_texels(piece, paint(piece),
                      [&](const Vec3f& value, float weight) { return value + step * weight; });
}

void Painter::dab_at(const ShownPicture& picture, float x, float y) {
    const std::optional<SurfacePoint> point = find_surface_point(picture, x, y);
    if (!point || point->object != object_) return;
    const std::vector<DabPiece> pieces = find_pieces(picture, *point);
    for (const DabPiece& piece : pieces)
        history_.keep({object().displacement, piece.udim}, paint(piece), piece.box);
    apply(pieces, *point);
    for (const DabPiece& piece : pieces) note_change({object().displacement, piece.udim}, piece.box);
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
    history_.begin();
    if (brush.kind != BrushKind::grab) {
        dab_at(picture, x, y);
        return take_edits();
    }
    start_ = point;
    start_udim_ = find_udim(scene, *point);
    grabbed_ = find_pieces(picture, *point);
    for (const DabPiece& piece : grabbed_) {
        history_.keep({object().displacement, piece.udim}, paint(piece), piece.box);
        before_grab_.push_back(copy_texels(paint(piece), piece.box));
    }
    return {};
}

std::vector<MapEdit> Painter::grab(const ShownPicture& picture, float x, float y) {
    const OrbitCamera camera(picture.camera);
    const Vec3f shift = camera.right() * ((x - last_.x) * start_->pixel_size) +
                        camera.upward() * ((last_.y - y) * start_->pixel_size);
    const Vec3f step = find_step(shift, *start_, start_udim_);
    for (size_t k = 0; k < grabbed_.size(); ++k) {
        const DabPiece& piece = grabbed_[k];
        paste_texels(before_grab_[k], piece.box, paint(piece));
        change_texels(piece, paint(piece),
                      [&](const Vec3f& value, float weight) { return value + step * weight; });
        note_change({object().displacement, piece.udim}, piece.box);
    }
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
    grabbed_.clear(), before_grab_.clear();
    start_.reset();
}

SceneValue Painter::exchange(const SceneValue& value) {
    if (std::holds_alternative<Displacement>(value.value)) frames_.clear(), places_.clear(); // another space
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
