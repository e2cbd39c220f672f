#include "prepare/tessellate.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.h"
#include "formulas/normal_map.h"
#include "formulas/surface_point.h"
#include "relief/error.h"
#include "surface/mesh/corner_tangents.h"

namespace relief {

namespace {

constexpr uint64_t kBytesPerVertex = sizeof(Vec3f) + sizeof(PackedFrame) + sizeof(Vec2f);
/// Of the finished trees, corners of triangles included: 120 to 123 over micro-quads of the sample scenes.
constexpr double kTreeBytesPerQuad = 121, kTreeBytesPerTriangle = 61;
/// Of a quad while its tree is built: box, two binary nodes, number and its share of the wide tree.
constexpr uint64_t kBuildBytesPerQuad =
    sizeof(Box) + 2 * 32 + sizeof(uint32_t) + uint64_t(kTreeBytesPerQuad) + 10;

struct MicroCounts {
    uint64_t quads = 0, vertices = 0;
};

MicroCounts count_micro(const Surface& surface, const LevelField& levels) {
    MicroCounts counts;
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
        const uint64_t side = uint64_t(1) << levels.at(patch).patch;
        counts.quads += side * side;
        counts.vertices += (side + 1) * (side + 1);
    }
    return counts;
}

bool have_equal_levels(const Surface& surface, const LevelField& a, const LevelField& b) {
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        if (!(a.at(patch) == b.at(patch))) return false;
    return true;
}

/// For each instance the first one with the same displaced surface at the same levels, maybe itself.
std::vector<uint32_t> find_equals(const PreparedScene& scene) {
    std::vector<uint32_t> equals, firsts;
    for (uint32_t k = 0; k < scene.instances.size(); ++k) {
        const Instance& instance = scene.instances[k];
        const auto is_equal = [&](uint32_t other) {
            return scene.instances[other].surface == instance.surface &&
                   have_equal_levels(scene.surfaces[instance.surface], *scene.instances[other].levels,
                                     *instance.levels);
        };
        const auto found = std::find_if(firsts.begin(), firsts.end(), is_equal);
        equals.push_back(found == firsts.end() ? k : *found);
        if (found == firsts.end()) firsts.push_back(k);
    }
    return equals;
}

/// First cell and vertex of every patch, one entry more than patches.
struct PatchOffsets {
    std::vector<uint64_t> cell, vertex;
};

PatchOffsets compute_offsets(const Surface& surface, const LevelField& levels) {
    PatchOffsets offsets;
    offsets.cell.push_back(0), offsets.vertex.push_back(0);
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
        const uint64_t side = uint64_t(1) << levels.at(patch).patch;
        offsets.cell.push_back(offsets.cell.back() + side * side);
        offsets.vertex.push_back(offsets.vertex.back() + (side + 1) * (side + 1));
    }
    if (offsets.vertex.back() >= kNoIndex || offsets.cell.back() >= (uint64_t(1) << 28))
        throw Error(ErrorKind::out_of_memory,
                    {fmt::format("the tessellated mesh has {} micro-quads; its tree can index 268435456",
                                 offsets.cell.back()),
                     surface.name, "render it directly (surface.mode = direct) or lower surface.level"});
    return offsets;
}

void tessellate_patch(const Surface& surface, uint32_t patch, const PatchLevels& levels, uint64_t vertex,
                      uint64_t cell, Surface& result) {
    const uint32_t side = 1u << levels.patch;
    const Quad quad = surface.quads[patch];
    for (uint32_t j = 0; j <= side; ++j)
        for (uint32_t i = 0; i <= side; ++i) {
            const uint64_t at = vertex + uint64_t(j) * (side + 1) + i;
            const float u = float(i) / float(side), v = float(j) / float(side);
            result.positions[at] = evaluate_vertex(surface, patch, levels, i, j);
            const Vec3f normal = compute_shading_normal(surface, patch, levels.patch, u, v);
            result.frames[at] = pack_frame(normal, {0, 0, 0}, 1);
            const auto& uvs = surface.uvs;
            result.uvs[at] = scalar::blend_patch_uv(uvs[quad.vertex[0]], uvs[quad.vertex[1]],
                                                    uvs[quad.vertex[2]], uvs[quad.vertex[3]], {u, v});
        }
    for (uint32_t j = 0; j < side; ++j)
        for (uint32_t i = 0; i < side; ++i) {
            const uint32_t first = uint32_t(vertex) + j * (side + 1) + i;
            result.quads.set(cell + uint64_t(j) * side + i,
                             {{first, first + 1, first + side + 2, first + side + 1}});
        }
}

/// Tangents of the displaced surface at the corners of a patch's micro-quads, the first of which is `cell`.
void tessellate_tangents(const Surface& surface, uint32_t patch, const PatchLevels& levels, uint64_t cell,
                         Surface& result) {
    const uint32_t side = 1u << levels.patch;
    std::vector<uint32_t> packed;
    for (uint32_t j = 0; j <= side; ++j)
        for (uint32_t i = 0; i <= side; ++i) {
            const Vec2f at{float(i) / float(side), float(j) / float(side)};
            const Vec3f normal = compute_shading_normal(surface, patch, levels.patch, at.x, at.y);
            const Vec3f tangent =
                scalar::turn_tangent(blend_tangents(surface, patch, at),
                                     normalize(blend_base_normals(surface, patch, at)), normalize(normal));
            packed.push_back(pack_frame({}, tangent, find_handedness(surface, patch)).tangent);
        }
    for (uint32_t j = 0; j < side; ++j)
        for (uint32_t i = 0; i < side; ++i) {
            const uint32_t first = j * (side + 1) + i;
            result.corner_tangents[cell + uint64_t(j) * side + i] = {
                packed[first], packed[first + 1], packed[first + side + 2], packed[first + side + 1]};
        }
}

/// Further uvs at the corners of a patch's micro-quads, the first of which is `cell`.
void tessellate_uvs(const Surface& surface, uint32_t patch, const PatchLevels& levels, uint64_t cell,
                    Surface& result) {
    const uint32_t side = 1u << levels.patch;
    for (size_t n = 0; n < surface.further_uvs.size(); ++n) {
        const std::array<Vec2f, 4>& c = surface.further_uvs[n].corners[patch];
        const auto at = [&](uint32_t i, uint32_t j) {
            return scalar::blend_patch_uv(c[0], c[1], c[2], c[3],
                                          {float(i) / float(side), float(j) / float(side)});
        };
        for (uint32_t j = 0; j < side; ++j)
            for (uint32_t i = 0; i < side; ++i)
                result.further_uvs[n].corners[cell + uint64_t(j) * side + i] = {
                    at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
    }
}

Surface tessellate_surface(const Surface& surface, const LevelField& levels) {
    const PatchOffsets offsets = compute_offsets(surface, levels);
    Surface result;
    result.name = surface.name;
    result.has_bilinear_uvs = true;
    result.positions.resize(offsets.vertex.back());
    result.frames.resize(offsets.vertex.back());
    result.uvs.resize(offsets.vertex.back());
    result.quads.reset(offsets.cell.back(), uint32_t(offsets.vertex.back()));
    const bool has_tangents = !surface.corner_tangents.empty();
    if (has_tangents) result.corner_tangents.resize(offsets.cell.back());
    for (const PatchUvs& set : surface.further_uvs) {
        PatchUvs& uvs = result.further_uvs.emplace_back();
        uvs.number = set.number;
        uvs.corners.resize(offsets.cell.back());
    }
    parallel_for("tessellate", surface.patch_count(), 16, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const uint32_t patch = uint32_t(k);
            const PatchLevels patch_levels = levels.at(patch);
            tessellate_patch(surface, patch, patch_levels, offsets.vertex[k], offsets.cell[k], result);
            if (has_tangents) tessellate_tangents(surface, patch, patch_levels, offsets.cell[k], result);
            tessellate_uvs(surface, patch, patch_levels, offsets.cell[k], result);
        }
    });
    return result;
}

} // namespace

TessellationCost estimate_tessellation(const PreparedScene& scene) {
    const std::vector<uint32_t> equals = find_equals(scene);
    TessellationCost cost;
    double plain_bytes = 0;
    for (const Surface& surface : scene.surfaces) {
        if (surface.has_displacement) continue;
        cost.geometry_bytes += surface.geometry_bytes();
        for (const Quad quad : surface.quads)
            plain_bytes += quad.is_triangle() ? kTreeBytesPerTriangle : kTreeBytesPerQuad;
    }
    cost.geometry_bytes += scene.instances.size() * sizeof(Instance);
    for (uint32_t k = 0; k < scene.instances.size(); ++k) {
        const Surface& surface = scene.surfaces[scene.instances[k].surface];
        if (!surface.has_displacement || equals[k] != k) continue;
        const MicroCounts counts = count_micro(surface, *scene.instances[k].levels);
        const uint64_t tangent_bytes =
            surface.corner_tangents.empty() ? 0 : counts.quads * sizeof(surface.corner_tangents[0]);
        const uint64_t uv_bytes =
            surface.further_uvs.size() * counts.quads * sizeof(surface.further_uvs[0].corners[0]);
        const uint64_t bytes = QuadList::byte_count(counts.quads, counts.vertices) +
                               counts.vertices * kBytesPerVertex + tangent_bytes + uv_bytes;
        cost.micro_quads += counts.quads;
        cost.geometry_bytes += bytes;
        cost.peak_bytes += bytes + counts.quads * kBuildBytesPerQuad;
    }
    cost.structures_bytes = uint64_t(kTreeBytesPerQuad * double(cost.micro_quads) + plain_bytes);
    return cost;
}

void tessellate_scene(PreparedScene& scene, uint64_t available_bytes) {
    const uint64_t needed = estimate_tessellation(scene).peak_bytes;
    if (needed > available_bytes)
        throw Error(
            ErrorKind::out_of_memory,
            {fmt::format("the tessellated scene needs {} bytes ({:.1f} GiB), {:.1f} GiB are available",
                         needed, double(needed) / (1 << 30), double(available_bytes) / (1 << 30)),
             "", "render it directly (surface.mode = direct) or lower surface.level"});
    const std::vector<uint32_t> equals = find_equals(scene);
    const std::vector<Instance> instances = scene.instances;
    const size_t source_count = scene.surfaces.size();
    for (uint32_t k = 0; k < instances.size(); ++k) {
        if (!scene.surfaces[instances[k].surface].has_displacement) continue;
        if (equals[k] == k)
            scene.surfaces.push_back(
                tessellate_surface(scene.surfaces[instances[k].surface], *instances[k].levels));
        scene.instances[k].surface =
            equals[k] == k ? uint32_t(scene.surfaces.size()) - 1 : scene.instances[equals[k]].surface;
    }
    // The displaced originals are no longer seen by any instance.
    for (size_t k = 0; k < source_count; ++k)
        if (scene.surfaces[k].has_displacement) scene.surfaces[k] = Surface{};
    LevelFieldConfig flat;
    flat.fixed_level = 0;
    for (Instance& instance : scene.instances)
        instance.levels = std::make_shared<const LevelField>(
            LevelField::compute(scene.surfaces[instance.surface], instance.world_from_object, flat));
}

} // namespace relief
