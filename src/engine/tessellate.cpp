#include "engine/tessellate.h"

#include <fmt/format.h>

#include <utility>

#include "base/machine.h"
#include "base/parallel.h"
#include "relief/error.h"

namespace relief {

namespace {

/// A vertex and a quad of the result, tree and boxes of the builder at its peak included.
constexpr uint64_t kBytesPerVertex = sizeof(Vec3f) + sizeof(PackedFrame) + sizeof(Vec2f);
constexpr uint64_t kBytesPerQuad = sizeof(Quad) + sizeof(Box) + 2 * 32 + sizeof(uint32_t) + 24;

uint64_t count_cells(const Surface& surface, const LevelField& levels) {
    uint64_t cells = 0;
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        cells += uint64_t(1) << (2 * levels.at(patch).patch);
    return cells;
}

bool have_equal_levels(const Surface& surface, const LevelField& a, const LevelField& b) {
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        if (!(a.at(patch) == b.at(patch))) return false;
    return true;
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
                     surface.name, "render it directly (--surface direct) or lower --level"});
    return offsets;
}

void tessellate_patch(const Surface& surface, uint32_t patch, const PatchLevels& levels, uint64_t vertex,
                      uint64_t cell, Surface& result) {
    const uint32_t side = 1u << levels.patch;
    const Quad& quad = surface.quads[patch];
    for (uint32_t j = 0; j <= side; ++j)
        for (uint32_t i = 0; i <= side; ++i) {
            const uint64_t at = vertex + uint64_t(j) * (side + 1) + i;
            const float u = float(i) / float(side), v = float(j) / float(side);
            result.positions[at] = evaluate_vertex(surface, patch, levels, i, j);
            const Vec3f normal = compute_shading_normal(surface, patch, levels.patch, u, v);
            result.frames[at] = pack_frame(normal, {0, 0, 0}, 1);
            const auto& uvs = surface.uvs;
            result.uvs[at] = (uvs[quad.vertex[0]] * (1 - u) + uvs[quad.vertex[1]] * u) * (1 - v) +
                             (uvs[quad.vertex[3]] * (1 - u) + uvs[quad.vertex[2]] * u) * v;
        }
    for (uint32_t j = 0; j < side; ++j)
        for (uint32_t i = 0; i < side; ++i) {
            const uint32_t first = uint32_t(vertex) + j * (side + 1) + i;
            result.quads[cell + uint64_t(j) * side + i] = {
                {first, first + 1, first + side + 2, first + side + 1}};
        }
}

Surface tessellate_surface(const Surface& surface, const LevelField& levels) {
    const PatchOffsets offsets = compute_offsets(surface, levels);
    Surface result;
    result.name = surface.name;
    result.positions.resize(offsets.vertex.back());
    result.frames.resize(offsets.vertex.back());
    result.uvs.resize(offsets.vertex.back());
    result.quads.resize(offsets.cell.back());
    parallel_for("tessellate", surface.patch_count(), 16, [&](size_t begin, size_t end) {
        for (size_t patch = begin; patch < end; ++patch)
            tessellate_patch(surface, uint32_t(patch), levels.at(uint32_t(patch)), offsets.vertex[patch],
                             offsets.cell[patch], result);
    });
    return result;
}

} // namespace

uint64_t estimate_tessellation_bytes(const PreparedScene& scene) {
    uint64_t bytes = 0;
    for (const Instance& instance : scene.instances) {
        const Surface& surface = scene.surfaces[instance.surface];
        if (!surface.has_displacement) continue;
        bytes += count_cells(surface, *instance.levels) * (kBytesPerVertex + kBytesPerQuad);
    }
    return bytes;
}

void tessellate_scene(PreparedScene& scene) {
    const uint64_t needed = estimate_tessellation_bytes(scene), available = available_memory_bytes();
    if (needed > available)
        throw Error(
            ErrorKind::out_of_memory,
            {fmt::format("the tessellated scene needs {} bytes ({:.1f} GiB), {:.1f} GiB are available",
                         needed, double(needed) / (1 << 30), double(available) / (1 << 30)),
             "", "render it directly (--surface direct) or lower --level"});
    struct Done {
        uint32_t source, surface;
        std::shared_ptr<const LevelField> levels;
    };
    std::vector<Done> done;
    const uint32_t source_count = uint32_t(scene.surfaces.size());
    for (Instance& instance : scene.instances) {
        if (!scene.surfaces[instance.surface].has_displacement) continue;
        const Done* shared = nullptr;
        for (const Done& other : done)
            if (other.source == instance.surface &&
                have_equal_levels(scene.surfaces[other.source], *other.levels, *instance.levels))
                shared = &other;
        if (!shared) {
            scene.surfaces.push_back(tessellate_surface(scene.surfaces[instance.surface], *instance.levels));
            done.push_back({instance.surface, uint32_t(scene.surfaces.size()) - 1, instance.levels});
            shared = &done.back();
        }
        instance.surface = shared->surface;
    }
    // The displaced originals are no longer seen by any instance.
    for (uint32_t k = 0; k < source_count; ++k)
        if (scene.surfaces[k].has_displacement) scene.surfaces[k] = Surface{};
    LevelFieldConfig flat;
    flat.fixed_level = 0;
    for (Instance& instance : scene.instances)
        instance.levels = std::make_shared<const LevelField>(
            LevelField::compute(scene.surfaces[instance.surface], instance.world_from_object, flat));
}

} // namespace relief
