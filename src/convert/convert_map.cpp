// convert_map: texel by texel from one convention to another.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/progress.h"
#include "convert/frame_inverse.h"
#include "convert/texel_frames.h"
#include "math/vec.h"
#include "relief/convert.h"
#include "relief/error.h"
#include "scene/coordinate_limit.h"
#include "scene/displacement_conventions.h"
#include "surface/map/spline_coefficients.h"
#include "surface/map/texels.h"

namespace relief {

namespace {

constexpr int kMargin = 8; ///< texels beside the faces that take over the nearest displacement

[[noreturn]] void refuse(const Displacement& map, const char* message, const char* hint) {
    throw Error(ErrorKind::usage, {message, fmt::format("displacement '{}'", map.name), hint});
}

/// Spaces that a map may be turned between; a height is along the normal.
bool uses_frames(const Displacement& map) {
    return map.type == DisplacementType::height || map.space == DisplacementSpace::tangent;
}

/// True where both are in tangent space and go through other frames; of a height only the normals count.
bool has_other_frames(const Displacement& from, const Displacement& to) {
    if (!uses_frames(from) || !uses_frames(to)) return false;
    if (from.type == DisplacementType::height) return from.frame != to.frame;
    return from.frame != to.frame || from.lengths != to.lengths;
}

void check_kinds(const Displacement& from, const Displacement& to, const Mesh* mesh) {
    if (to.type == DisplacementType::height && from.type != DisplacementType::height)
        refuse(from, "vectors do not fit into a height map", "leave the type as vector");
    if (uses_frames(from) != uses_frames(to) && !mesh)
        refuse(from, "tangent and object space differ by the frames of a mesh, and none is given",
               "name the mesh that the map is for");
    if (has_other_frames(from, to) && !mesh)
        refuse(from, "other frames need the mesh that they stand on, and none is given",
               "name the mesh that the map is for, or leave frame and lengths as they are");
    if (to.type == DisplacementType::height && has_other_frames(from, to))
        refuse(from, "a height along other normals is a vector", "leave the frame as it is");
    const bool has_world = from.space == DisplacementSpace::world || to.space == DisplacementSpace::world;
    if (has_world && from.space != to.space)
        refuse(from, "world space depends on where an object stands", "use object space");
}

Vec3f decode(const Displacement& map, const std::array<float, 3>& texel) {
    if (map.type == DisplacementType::height) return {0, 0, (texel[0] - map.midlevel.x) * map.scale.x};
    Vec3f d;
    for (size_t c = 0; c < 3; ++c) {
        const int k = int(c);
        set_component(d, map.axes.axis[c],
                      (texel[c] - get_component(map.midlevel, k)) * get_component(map.scale, k) *
                          float(map.axes.sign[c]));
    }
    return d;
}

std::array<float, 3> encode(const Displacement& map, const Vec3f& d) {
    if (map.type == DisplacementType::height) {
        const float value = d.z / map.scale.x + map.midlevel.x;
        return {value, value, value};
    }
    std::array<float, 3> texel;
    for (size_t c = 0; c < 3; ++c) {
        const int k = int(c);
        texel[c] =
            get_component(d, map.axes.axis[c]) * float(map.axes.sign[c]) / get_component(map.scale, k) +
            get_component(map.midlevel, k);
    }
    return texel;
}

/// Displacements of all texels, row by row.
using Field = std::vector<Vec3f>;

Field decode_all(const Displacement& map, const Texture& texture) {
    Field field;
    field.reserve(size_t(texture.width) * texture.height);
    for (uint32_t y = 0; y < texture.height; ++y)
        for (uint32_t x = 0; x < texture.width; ++x) field.push_back(decode(map, read_texel(texture, x, y)));
    return field;
}

Vec3f to_object(const FrameMatrix& frame, const Vec3f& d) {
    return frame[0] * d.x + frame[1] * d.y + frame[2] * d.z;
}

/// Texels whose displacement their frames do not reach.
struct Misses {
    uint32_t count = 0;
    float largest = 0; ///< scene units

    void add(float error, const Vec3f& d) {
        constexpr float kTolerance = 0.01f; ///< of the displacement
        if (error > kTolerance * length(d)) ++count;
        largest = std::max(largest, error);
    }
    std::string describe(int udim) const {
        return fmt::format(
            "tile {}: tangent space does not hold the displacement of {} texels, by up to {:.3g} scene "
            "units: the frames of the mesh nearly collapse there, as tangents of other directions meet "
            "inside a face; use object space, or unwrap these faces anew",
            udim, count, largest);
    }
};

/// One texel more around what is known: the mean of its known neighbours.
void grow(Field& field, std::vector<uint8_t>& is_known, uint32_t width, uint32_t height) {
    const std::vector<uint8_t> before = is_known;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const size_t at = size_t(y) * width + x;
            if (before[at]) continue;
            Vec3f sum;
            int count = 0;
            for (uint32_t j = y > 0 ? y - 1 : 0; j <= std::min(y + 1, height - 1); ++j)
                for (uint32_t i = x > 0 ? x - 1 : 0; i <= std::min(x + 1, width - 1); ++i)
                    if (before[size_t(j) * width + i]) sum += field[size_t(j) * width + i], ++count;
            if (count == 0) continue;
            field[at] = sum / float(count);
            is_known[at] = 1;
        }
}

struct FramedTile {
    const Surface& surface;
    TileIndex tile;
    ProgressFunction on_progress;
};

/// Through the frames of the surface: `turn(frame, index of the texel)` makes the new displacement.
template <class Turn> Field change_space(const FramedTile& framed, const Field& field, const Turn& turn) {
    const Texture& texture = *framed.surface.map.tiles[framed.tile].texture;
    Field changed(field.size());
    std::vector<uint8_t> is_known(field.size());
    visit_texel_frames(
        framed.surface, framed.tile,
        [&](uint32_t x, uint32_t y, const TexelFrame& frame) {
            const size_t at = size_t(y) * texture.width + x;
            changed[at] = turn(frame, at);
            is_known[at] = 1;
        },
        framed.on_progress);
    for (int k = 0; k < kMargin; ++k) grow(changed, is_known, texture.width, texture.height);
    return changed;
}

Field change_to_object(const FramedTile& framed, const Field& field) {
    return change_space(framed, field,
                        [&](const TexelFrame& frame, size_t at) { return to_object(frame.axes, field[at]); });
}

/// A texel may be visited again, by a nearer patch.
Field change_to_tangent(const FramedTile& framed, const Field& field, Misses& misses) {
    std::vector<float> errors(field.size());
    Field changed = change_space(framed, field, [&](const TexelFrame& frame, size_t at) {
        const FrameCoordinates inverse = invert_frame(frame, field[at]);
        errors[at] = inverse.error;
        return inverse.tbn;
    });
    for (size_t at = 0; at < field.size(); ++at) misses.add(errors[at], field[at]);
    return changed;
}

/// Rows the other way up.
void turn_rows(Field& field, uint32_t width) {
    for (size_t low = 0, high = field.size() / width - 1; low < high; ++low, --high)
        std::swap_ranges(field.begin() + ptrdiff_t(low * width), field.begin() + ptrdiff_t((low + 1) * width),
                         field.begin() + ptrdiff_t(high * width));
}

std::shared_ptr<const Texture> encode_all(const Displacement& to, const Texture& source, const Field& field) {
    auto texture = std::make_shared<Texture>();
    texture->width = source.width, texture->height = source.height;
    texture->channel_count = to.type == DisplacementType::height ? 1 : 3;
    texture->file = source.file;
    texture->stride = texture->channel_count;
    texture->floats.resize(texture->value_count());
    for (size_t k = 0; k < field.size(); ++k) {
        const std::array<float, 3> texel = encode(to, field[k]);
        std::copy_n(texel.begin(), texture->stride, &texture->floats[texture->stride * k]);
    }
    return texture;
}

/// A render refuses such a map, and quotients of its values would be infinite.
void check_reach(const Displacement& map, const std::string& file, const Field& field) {
    for (const Vec3f& d : field) {
        const double reach =
            std::max({std::fabs(double(d.x)), std::fabs(double(d.y)), std::fabs(double(d.z))});
        if (!(reach <= kLargestCoordinate)) refuse_reach(map.name, file, reach);
    }
}

/// Texels that a surface with `dequantize` would show, whatever its filter.
std::shared_ptr<const Texture> smooth_steps(const Displacement& map,
                                            const std::shared_ptr<const Texture>& texture) {
    SplineForm form = make_spline_form(map);
    form.is_interpolating = false;
    return make_spline(texture, form);
}

/// The surface with the frames of `meant` and the tiles of `map`.
Surface make_framed_surface(const Displacement& map, const Displacement& meant, const Mesh& mesh) {
    Displacement framed = map;
    framed.frame = meant.frame, framed.lengths = meant.lengths;
    framed.space = DisplacementSpace::tangent;
    framed.filter = MapFilter::none, framed.dequantize = false; // only frames are asked for
    // Tangents are of no use to a height, and not every mesh can have those that are requested.
    if (meant.type == DisplacementType::vector) framed.type = DisplacementType::vector;
    return make_surface(mesh, &framed, {});
}

} // namespace

Displacement convert_map(const Displacement& from, const Displacement& to, const Mesh* mesh,
                         std::vector<std::string>* warnings, const ProgressFunction& on_progress) {
    check_kinds(from, to, mesh);
    if (to.scale.x == 0 || to.scale.y == 0 || to.scale.z == 0)
        refuse(to, "a scale of 0 leaves nothing to be stored", "say another scale");
    Displacement result = to;
    result.name = from.name, result.is_udim = from.is_udim, result.wrap = from.wrap;
    result.dequantize = false; // floats have no steps
    result.dilate = from.dilate, result.filter = from.filter, result.autobump = from.autobump;
    result.tiles.clear();
    const bool turns = uses_frames(from) != uses_frames(to) || has_other_frames(from, to);
    std::optional<Surface> source_frames, target_frames;
    if (turns && uses_frames(from)) source_frames = make_framed_surface(from, from, *mesh);
    if (turns && uses_frames(to)) target_frames = make_framed_surface(from, to, *mesh);
    for (size_t k = 0; k < from.tiles.size(); ++k) {
        const Texture& stored = *from.tiles[k].texture;
        const TexelRectangle all{0, 0, stored.width - 1, stored.height - 1};
        if (!find_texel_range(stored, all)) refuse_bad_texel(stored, all);
        const std::shared_ptr<const Texture> texels = smooth_steps(from, from.tiles[k].texture);
        const Texture& source = *texels;
        const double count = double(from.tiles.size());
        const ProgressFunction tile_progress =
            make_part(on_progress, double(k) / count, (double(k) + 1) / count);
        Field field = decode_all(from, source);
        check_reach(from, stored.file, field);
        // Frames take most of the time.
        const double half = target_frames ? 0.5 : 0.9;
        if (source_frames)
            field =
                change_to_object({*source_frames, TileIndex(k), make_part(tile_progress, 0.05, half)}, field);
        Misses misses;
        if (target_frames)
            field = change_to_tangent(
                {*target_frames, TileIndex(k), make_part(tile_progress, source_frames ? 0.5 : 0.05, 0.9)},
                field, misses);
        if (warnings && misses.count > 0) warnings->push_back(misses.describe(from.tiles[k].udim));
        if (from.flip_v != to.flip_v) turn_rows(field, source.width);
        result.tiles.push_back({from.tiles[k].udim, encode_all(to, source, field)});
        if (tile_progress) tile_progress(1);
    }
    return result;
}

std::string format_map_axes(const AxisMap& axes, DisplacementSpace space) { return format_axes(axes, space); }

float find_largest_displacement(const Displacement& map) {
    float largest = 0;
    for (const MapTile& tile : map.tiles)
        for (const Vec3f& d : decode_all(map, *tile.texture))
            largest = std::max({largest, std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
    return largest;
}

} // namespace relief
