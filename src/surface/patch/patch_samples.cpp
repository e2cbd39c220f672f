#include "surface/patch/patch_samples.h"

#include "base/check.h"
#include "formulas/displace.h"
#include "formulas/levels.h"
#include "formulas/mips.h"
#include "surface/map/texels.h"
#include "surface/map/tile_texels.h"

namespace relief {

namespace {

Vec3f blend(const Vec3f& a, const Vec3f& b, float s) {
    return {scalar::blend(a.x, b.x, s), scalar::blend(a.y, b.y, s), scalar::blend(a.z, b.z, s)};
}

Vec3f blend_quad(const Vec3f& c0, const Vec3f& c1, const Vec3f& c2, const Vec3f& c3, float u, float v) {
    return {scalar::blend_quad(c0.x, c1.x, c2.x, c3.x, u, v),
            scalar::blend_quad(c0.y, c1.y, c2.y, c3.y, u, v),
            scalar::blend_quad(c0.z, c1.z, c2.z, c3.z, u, v)};
}

} // namespace

Vec3f fetch_displacement(const DisplacementMap& map, TileIndex tile, const Vec2f& uv, uint32_t mip) {
    if (tile >= map.tiles.size()) return {};
    const Texture& texture = map.image(tile, mip).texture;
    const float u = uv.x * float(texture.width) - 0.5f;
    const float v = (map.flip_v ? uv.y : 1.0f - uv.y) * float(texture.height) - 0.5f;
    const float x0 = floor_texel(u), y0 = floor_texel(v);
    const float fx = u - x0, fy = v - y0;
    const std::array<float, 4> middle = {map.midlevel.x, map.midlevel.y, map.midlevel.z, 0};
    const auto read = [&](int64_t i, int64_t j) {
        const int64_t x = int64_t(x0) + i, y = int64_t(y0) + j;
        if (!map.neighbours.empty() && !is_within_image(texture, {x, x}, {y, y}))
            return read_beyond_tile(map, tile, mip, x, y);
        const int64_t column = wrap_index(x, texture.width, map.wrap),
                      row = wrap_index(y, texture.height, map.wrap);
        return column < 0 || row < 0 ? middle : read_channels(texture, column, row);
    };
    std::array<float, 4> value;
    if (map.is_smooth) {
        const auto read_coefficient = [&](size_t i, size_t j) {
            return read(int64_t(i) - 1, int64_t(j) - 1);
        };
        value = filter_spline(read_coefficient, fx, fy);
    } else {
        value = filter_channels(read(0, 0), read(1, 0), read(0, 1), read(1, 1), fx, fy);
    }
    for (size_t c = 0; c < 4; ++c) value[c] -= middle[c];
    const auto decode = [&](const Vec3f& row) {
        return scalar::decode_row(value[0], value[1], value[2], row.x, row.y, row.z);
    };
    return {decode(map.matrix[0]), decode(map.matrix[1]), decode(map.matrix[2])};
}

VertexData load_vertex(const Surface& surface, uint32_t vertex) {
    VertexData data;
    data.position = surface.position(vertex);
    if (!surface.uvs.empty()) data.uv = surface.uvs[vertex];
    if (surface.map.is_tangent && !surface.frames.empty()) data.frame = surface.frame(vertex);
    data.tile = surface.tile(vertex);
    return data;
}

Vec3f displace(const DisplacementMap& map, const VertexData& sample) {
    const Vec3f& base = sample.position;
    const Frame& frame = sample.frame;
    if (map.tiles.empty()) return base;
    const Vec3f d = fetch_displacement(map, sample.tile, sample.uv, sample.mip);
    if (!map.is_tangent) return base + d;
    return {base.x + scalar::carry_through_frame(d.x, d.y, d.z, frame.t.x, frame.b.x, frame.n.x),
            base.y + scalar::carry_through_frame(d.x, d.y, d.z, frame.t.y, frame.b.y, frame.n.y),
            base.z + scalar::carry_through_frame(d.x, d.y, d.z, frame.t.z, frame.b.z, frame.n.z)};
}

VertexData blend_corners(const std::array<VertexData, 4>& c, float u, float v) {
    const auto blend_vectors = [&](const Vec3f& a0, const Vec3f& a1, const Vec3f& a2, const Vec3f& a3) {
        return blend_quad(a0, a1, a2, a3, u, v);
    };
    VertexData result;
    result.position = blend_vectors(c[0].position, c[1].position, c[2].position, c[3].position);
    result.uv = {scalar::blend_quad(c[0].uv.x, c[1].uv.x, c[2].uv.x, c[3].uv.x, u, v),
                 scalar::blend_quad(c[0].uv.y, c[1].uv.y, c[2].uv.y, c[3].uv.y, u, v)};
    result.frame.t = blend_vectors(c[0].frame.t, c[1].frame.t, c[2].frame.t, c[3].frame.t);
    result.frame.b = blend_vectors(c[0].frame.b, c[1].frame.b, c[2].frame.b, c[3].frame.b);
    result.frame.n = blend_vectors(c[0].frame.n, c[1].frame.n, c[2].frame.n, c[3].frame.n);
    result.tile = c[0].tile, result.mip = c[0].mip;
    return result;
}

VertexData blend_line(const VertexData& a, const VertexData& b, float s) {
    VertexData result;
    result.position = blend(a.position, b.position, s);
    result.uv = {scalar::blend(a.uv.x, b.uv.x, s), scalar::blend(a.uv.y, b.uv.y, s)};
    result.frame = {blend(a.frame.t, b.frame.t, s), blend(a.frame.b, b.frame.b, s),
                    blend(a.frame.n, b.frame.n, s)};
    result.tile = a.tile, result.mip = a.mip;
    return result;
}

PatchSamples::PatchSamples(const Surface& surface, uint32_t patch, Filtering filtering) : map_(&surface.map) {
    const Quad quad = surface.quads[patch];
    const uint32_t mips = filtering == Filtering::none ? 0 : surface.packed_mips(patch);
    const auto load = [&](uint32_t vertex, uint32_t place) {
        VertexData data = load_vertex(surface, vertex);
        data.mip = uint8_t(scalar::packed_mip(mips, place));
        return data;
    };
    const uint8_t own_mip = uint8_t(scalar::packed_mip(mips, scalar::kMipInside));
    for (int k = 0; k < 4; ++k) corners_[k] = load(quad.vertex[k], scalar::kMipInside);
    if (!surface.frames.empty() && !surface.map.is_tangent)
        for (int k = 0; k < 4; ++k) corners_[k].frame.n = unpack_normal(surface.frames[quad.vertex[k]]);
    for (int k = 0; k < 4; ++k) {
        const uint32_t own[2] = {quad.vertex[k], quad.vertex[(k + 1) & 3]};
        const uint32_t dominant = surface.dominant(own[0]);
        const uint32_t corner_place = scalar::kMipCorners + uint32_t(k);
        is_corner_foreign_[k] = dominant != own[0] || scalar::packed_mip(mips, corner_place) != own_mip;
        dominants_[k] = is_corner_foreign_[k] ? load(dominant, corner_place) : corners_[k];

        const Surface::EdgeLine line = surface.edge_line(patch, k);
        const int start = line.is_reversed ? 1 : 0;
        lines_[k].is_reversed = line.is_reversed;
        const uint32_t edge_place = scalar::kMipEdges + uint32_t(k);
        lines_[k].is_foreign = line.first != own[start] || line.second != own[1 - start] ||
                               scalar::packed_mip(mips, edge_place) != own_mip;
        lines_[k].first = lines_[k].is_foreign ? load(line.first, edge_place) : corners_[(k + start) & 3];
        lines_[k].second =
            lines_[k].is_foreign ? load(line.second, edge_place) : corners_[(k + 1 - start) & 3];
        lines_[k].controls = surface.line_controls(patch, k, line);
    }
    if (surface.controls.empty()) return;
    base_.emplace(std::array<Vec3f, 4>{corners_[0].position, corners_[1].position, corners_[2].position,
                                       corners_[3].position},
                  surface.controls[patch]);
}

Vec3f PatchSamples::corner(int k) const { return displace(*map_, dominants_[k]); }

Vec3f PatchSamples::edge(int k, float s) const {
    const Line& line = lines_[k];
    VertexData sample = blend_line(line.first, line.second, s);
    if (base_)
        sample.position = blend_cubic(line.first.position, line.controls[0], line.controls[1],
                                      line.second.position, scalar::weigh_cubic(s));
    return displace(*map_, sample);
}

Vec3f PatchSamples::interior(float u, float v) const {
    VertexData sample = blend_corners(corners_, u, v);
    if (base_) sample.position = base_->evaluate(u, v);
    return displace(*map_, sample);
}

const PatchSamples& PatchSamplesCache::get(const Surface& surface, uint32_t patch) {
    if (entries_.empty()) entries_.resize(mask_ + 1);
    Entry& entry = entries_[patch & mask_];
    if (entry.surface != &surface || entry.patch != patch) {
        entry.samples.emplace(surface, patch);
        entry.surface = &surface, entry.patch = patch;
    }
    return *entry.samples;
}

Vec3f evaluate_vertex(const Surface& surface, uint32_t patch, const PatchLevels& levels, uint32_t i,
                      uint32_t j) {
    return evaluate_vertex(PatchSamples(surface, patch), levels, i, j);
}

Vec3f evaluate_vertex(const PatchSamples& samples, const PatchLevels& levels, uint32_t i, uint32_t j) {
    const uint32_t n = 1u << levels.patch;
    DCHECK(i <= n && j <= n);
    const float step = 1.0f / float(n);
    const bool is_on_u_edge = j == 0 || j == n, is_on_v_edge = i == 0 || i == n;
    if (!is_on_u_edge && !is_on_v_edge) return samples.interior(float(i) * step, float(j) * step);
    if (is_on_u_edge && is_on_v_edge) return samples.corner(j == 0 ? (i == 0 ? 0 : 1) : (i == 0 ? 3 : 2));

    const int edge = int(scalar::find_sample_edge(i, j, levels.patch));
    uint32_t k = scalar::find_line_sample(i, j, levels.patch, uint32_t(edge), samples.is_line_reversed(edge));
    k = move_edge_sample(k, levels.patch, levels.edge[size_t(edge)]);
    if (k == 0) return samples.corner(samples.line_start(edge));
    if (k == n) return samples.corner(samples.line_end(edge));
    return samples.edge(edge, float(k) * step);
}

} // namespace relief
