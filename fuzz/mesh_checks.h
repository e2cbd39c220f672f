// What must hold for every mesh that a reader returns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <vector>

#include "math/vec.h"
#include "relief/error.h"
#include "relief/inspect.h"
#include "surface/patch/surface.h"

namespace relief {

/// A small map that moves every texel differently.
inline Displacement make_small_map() {
    constexpr uint32_t kMapSize = 4;
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = kMapSize;
    for (uint32_t k = 0; k < 4 * kMapSize * kMapSize; ++k)
        texture->floats.push_back(float(k * 37 % 11) * 0.1f - 0.5f);
    Displacement displacement;
    displacement.tiles.push_back({1001, texture});
    return displacement;
}

inline void require(bool holds) {
    if (!holds) std::abort();
}

/// The surface has its vertices in range and in the boxes of their patches, or the mesh is refused.
inline void check_surface(const Mesh& mesh, const Displacement* displacement) {
    try {
        const Surface surface = make_surface(mesh, displacement, {});
        for (const Quad& quad : surface.quads)
            for (const uint32_t vertex : quad.vertex)
                require(vertex < surface.vertex_count() &&
                        surface.dominant(vertex) < surface.positions.size());
        if (!surface.has_displacement) return;
        const PatchLevels levels{2, {2, 1, 0, 2}};
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            const Box box = compute_patch_box(surface, patch);
            for (uint32_t k = 0; k < 25; ++k)
                require(box.contains(evaluate_vertex(surface, patch, levels, k % 5, k / 5)));
        }
    } catch (const Error&) {
        // refused with a message: what is wanted
    }
}

inline void check_indices(const std::vector<uint32_t>& indices, size_t corners, size_t count) {
    require(indices.empty() || indices.size() == corners);
    for (const uint32_t index : indices) require(index < count);
}

/// A face has a uv at each of its corners, or at none; some face has them, or there are no indices.
inline void check_uv_indices(const Mesh& mesh, size_t corners) {
    if (mesh.uv_indices.empty()) return;
    require(mesh.uv_indices.size() == corners);
    size_t first = 0, faces_with_uvs = 0;
    for (const uint32_t size : mesh.face_sizes) {
        const bool has_uvs = mesh.uv_indices[first] != kNoIndex;
        faces_with_uvs += has_uvs;
        for (size_t corner = first; corner < first + size; ++corner) {
            const uint32_t index = mesh.uv_indices[corner];
            require(has_uvs ? index < mesh.uvs.size() : index == kNoIndex);
        }
        first += size;
    }
    require(faces_with_uvs > 0 || corners == 0);
}

inline void check_mesh(const Mesh& mesh) {
    const size_t corners =
        std::accumulate(mesh.face_sizes.begin(), mesh.face_sizes.end(), size_t(0),
                        [](size_t sum, uint32_t size) { return require(size >= 3), sum + size; });
    require(mesh.position_indices.size() == corners);
    check_indices(mesh.position_indices, corners, mesh.positions.size());
    check_uv_indices(mesh, corners);
    check_indices(mesh.normal_indices, corners, mesh.normals.size());
    require(mesh.tangents.empty() || mesh.tangents.size() == corners);
    for (const Crease& crease : mesh.creases) {
        require(crease.first < mesh.positions.size() && crease.second < mesh.positions.size());
        require(crease.sharpness >= 0);
    }
    inspect_mesh(mesh);
    static const Displacement displacement = make_small_map();
    check_surface(mesh, nullptr);
    if (!mesh.uv_indices.empty()) check_surface(mesh, &displacement);
}

} // namespace relief
