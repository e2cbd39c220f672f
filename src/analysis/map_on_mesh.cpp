#include "analysis/map_on_mesh.h"

#include <algorithm>
#include <cmath>

#include "math/vec.h"
#include "surface/patch/patch_samples.h"

namespace relief {

namespace {

constexpr uint32_t kMostPatches = 1 << 14;
constexpr size_t kMostEdges = 1 << 14;

/// Blending has made unit axes shorter.
Frame normalize_frame(const Surface& surface, const Frame& frame) {
    if (!surface.derivatives.empty()) return {frame.t, frame.b, normalize(frame.n)};
    return {normalize(frame.t), normalize(frame.b), normalize(frame.n)};
}

MapSample sample_vertex_data(const Surface& surface, const VertexData& data) {
    MapSample sample;
    if (data.tile != Surface::kNoTile) sample.value = fetch_displacement(surface.map, data.tile, data.uv);
    sample.frame = normalize_frame(surface, data.frame);
    sample.tile = data.tile;
    return sample;
}

void sample_places(const Surface& surface, MapSamples& samples) {
    const uint32_t step = std::max(1u, surface.patch_count() / kMostPatches);
    for (uint32_t patch = 0; patch < surface.patch_count(); patch += step) {
        const PatchSamples unpacked(surface, patch);
        for (const float u : {0.25f, 0.75f})
            for (const float v : {0.25f, 0.75f})
                samples.places.push_back(
                    sample_vertex_data(surface, blend_corners(unpacked.corners(), u, v)));
    }
}

std::vector<AxisMap> make_all_axis_maps() {
    std::vector<AxisMap> all;
    std::array<uint8_t, 3> axis{0, 1, 2};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            AxisMap axes{axis, {}};
            for (size_t c = 0; c < 3; ++c) axes.sign[c] = (signs >> c & 1) != 0 ? -1 : 1;
            all.push_back(axes);
        }
    } while (std::next_permutation(axis.begin(), axis.end()));
    return all;
}

/// Of pairs of vectors: the distance over the length, both as root mean squares.
template <class Turn> double measure_gap(const std::vector<SeamSample>& seams, const Turn& turn) {
    double gap = 0, size = 0;
    for (const SeamSample& seam : seams) {
        const Vec3f a = turn(seam.first), b = turn(seam.second), apart = a - b;
        gap += double(dot(apart, apart));
        size += double(dot(a, a) + dot(b, b)) / 2;
    }
    return size > 0 ? std::sqrt(gap / size) : 0;
}

} // namespace

MapSamples sample_map(const Surface& surface) {
    MapSamples samples;
    sample_places(surface, samples);
    samples.seams = sample_seams(surface, kMostEdges);
    return samples;
}

MapSamples keep_tile(const MapSamples& samples, TileIndex tile) {
    MapSamples kept;
    for (const MapSample& place : samples.places)
        if (place.tile == tile) kept.places.push_back(place);
    for (const SeamSample& seam : samples.seams)
        if (seam.first.tile == tile && seam.second.tile == tile) kept.seams.push_back(seam);
    return kept;
}

std::vector<SeamSample> sample_seams(const Surface& surface, size_t most) {
    std::vector<SeamSample> seams;
    const std::vector<EdgeOverride> overrides = surface.overrides.list();
    const size_t step = std::max<size_t>(1, (overrides.size() + most - 1) / most);
    for (size_t k = 0; k < overrides.size(); k += step) {
        const EdgeOverride& entry = overrides[k];
        const Quad quad = surface.quads[entry.patch_edge / 4];
        const uint32_t a = quad.vertex[entry.patch_edge & 3], b = quad.vertex[(entry.patch_edge + 1) & 3];
        if (a == entry.first && b == entry.second) continue;
        const VertexData own[2] = {load_vertex(surface, a), load_vertex(surface, b)};
        const VertexData other[2] = {load_vertex(surface, entry.first), load_vertex(surface, entry.second)};
        for (const float s : {0.25f, 0.75f})
            seams.push_back({sample_vertex_data(surface, blend_line(own[0], own[1], s)),
                             sample_vertex_data(surface, blend_line(other[0], other[1], s))});
    }
    return seams;
}

const std::vector<AxisMap>& get_all_axis_maps() {
    static const std::vector<AxisMap> all = make_all_axis_maps();
    return all;
}

Vec3f turn_by_axes(const Vec3f& value, const AxisMap& axes) {
    Vec3f d;
    for (size_t c = 0; c < 3; ++c)
        set_component(d, axes.axis[c], get_component(value, int(c)) * float(axes.sign[c]));
    return d;
}

Vec3f turn_by_frame(const MapSample& sample, const AxisMap& axes) {
    const Vec3f d = turn_by_axes(sample.value, axes);
    return sample.frame.t * d.x + sample.frame.b * d.y + sample.frame.n * d.z;
}

double measure_object_gap(const std::vector<SeamSample>& seams) {
    return measure_gap(seams, [](const MapSample& sample) { return sample.value; });
}

double measure_tangent_gap(const std::vector<SeamSample>& seams, const AxisMap& axes) {
    return measure_gap(seams, [&](const MapSample& sample) { return turn_by_frame(sample, axes); });
}

double measure_object_rise(const std::vector<MapSample>& places, const AxisMap& axes) {
    double rise = 0, size = 0;
    for (const MapSample& sample : places) {
        rise += double(dot(turn_by_axes(sample.value, axes), sample.frame.n));
        size += double(length(sample.value));
    }
    return size > 0 ? rise / size : 0;
}

double measure_folded_share(const Surface& surface) {
    constexpr uint32_t kCells = 1 << 16;
    int level = 2;
    while (level < 8 && (uint64_t(surface.patch_count()) << (2 * level + 2)) <= kCells) ++level;
    const uint32_t step = std::max(1u, uint32_t((uint64_t(surface.patch_count()) << (2 * level)) / kCells));
    const uint32_t side = 1u << level;
    const auto narrow = uint8_t(level);
    const PatchLevels levels{narrow, {narrow, narrow, narrow, narrow}};
    std::vector<Vec3f> points(size_t(side + 1) * (side + 1));
    uint64_t count = 0, folded = 0;
    for (uint32_t patch = 0; patch < surface.patch_count(); patch += step) {
        const PatchSamples samples(surface, patch);
        for (uint32_t j = 0; j <= side; ++j)
            for (uint32_t i = 0; i <= side; ++i)
                points[size_t(j) * (side + 1) + i] = evaluate_vertex(samples, levels, i, j);
        for (uint32_t j = 0; j < side; ++j)
            for (uint32_t i = 0; i < side; ++i) {
                const Vec3f* p = &points[size_t(j) * (side + 1) + i];
                const Vec3f normal = cross(p[side + 2] - p[0], p[side + 1] - p[1]);
                const VertexData base = blend_corners(samples.corners(), (float(i) + 0.5f) / float(side),
                                                      (float(j) + 0.5f) / float(side));
                ++count;
                folded += dot(normal, base.frame.n) < 0;
            }
    }
    return count > 0 ? double(folded) / double(count) : 0;
}

} // namespace relief
