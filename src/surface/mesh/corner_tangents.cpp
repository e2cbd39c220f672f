#include "surface/mesh/corner_tangents.h"

#include <algorithm>

#include "formulas/basis.h"
#include "formulas/frame.h"
#include "formulas/shading_normal.h"
#include "math/vec_double.h"
#include "surface/mesh/join_points.h"
#include "surface/mesh/mikk_tangents.h"

namespace relief {

namespace {

/// What tile choice took off the uvs, so that tiles join as they do in the mesh.
Vec2f find_tile_offset(const Surface& surface, uint32_t vertex) {
    const TileIndex tile = surface.tile(vertex);
    if (tile >= surface.map.tiles.size()) return {};
    const int number = surface.map.tiles[tile].udim - 1001;
    return {float(number % 10), float(number / 10)};
}

/// The patches as faces whose corners have normals.
Polygons make_faces(const Surface& surface) {
    Polygons faces;
    faces.positions = surface.positions;
    const std::vector<uint32_t> first_at = find_equal_points(surface.positions);
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
        const Quad quad = surface.quads[patch];
        const uint32_t start = uint32_t(faces.points.size()), size = quad.is_triangle() ? 3 : 4;
        faces.starts.push_back(start), faces.source_faces.push_back(patch);
        for (uint32_t k = 0; k < size; ++k) {
            const uint32_t vertex = quad.vertex[k];
            faces.points.push_back(first_at[surface.dominant(vertex)]);
            faces.uvs.push_back(surface.uvs[vertex] + find_tile_offset(surface, vertex));
            if (!surface.frames.empty()) faces.normals.push_back(unpack_normal(surface.frames[vertex]));
        }
    }
    faces.starts.push_back(uint32_t(faces.points.size()));
    if (!surface.frames.empty()) return faces;
    for (uint32_t face = 0; face < faces.face_count(); ++face)
        faces.normals.insert(faces.normals.end(), faces.face_size(face),
                             to_float(normalize_double(compute_newell_normal(faces, face))));
    return faces;
}

std::array<Vec3f, 4> unpack_tangents(const Surface& surface, uint32_t patch) {
    std::array<Vec3f, 4> result;
    for (size_t k = 0; k < 4; ++k) result[k] = scalar::unpack_tangent(surface.corner_tangents[patch][k]);
    return result;
}

Vec3f blend_corners(const Quad& quad, const std::array<Vec3f, 4>& c, const Vec2f& at) {
    return quad.is_triangle() ? scalar::interpolate_triangle(c[0], c[1], c[2], at)
                              : scalar::interpolate_quad(c[0], c[1], c[2], c[3], at);
}

} // namespace

std::vector<std::array<uint32_t, 4>> make_corner_tangents(const Surface& surface) {
    std::vector<std::array<uint32_t, 4>> result(surface.patch_count());
    if (surface.map.is_tangent && surface.derivatives.empty()) {
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
            for (size_t k = 0; k < 4; ++k)
                result[patch][k] = surface.frames[surface.quads[patch].vertex[k]].tangent;
        return result;
    }
    Polygons faces = make_faces(surface);
    add_mikk_tangents(faces, {}, FrameLengths::absolute);
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        for (uint32_t k = 0; k < 4; ++k) {
            const uint32_t corner = faces.starts[patch] + std::min(k, faces.face_size(patch) - 1);
            const std::array<float, 4>& found = faces.tangents[corner];
            Vec3f tangent{found[0], found[1], found[2]};
            if (tangent == Vec3f{}) tangent = scalar::make_basis(faces.normals[corner]).t;
            result[patch][k] = pack_frame({}, tangent, found[3]).tangent;
        }
    return result;
}

Vec3f blend_tangents(const Surface& surface, uint32_t patch, const Vec2f& at) {
    return blend_corners(surface.quads[patch], unpack_tangents(surface, patch), at);
}

float find_handedness(const Surface& surface, uint32_t patch) {
    return (surface.corner_tangents[patch][0] & 1u) != 0 ? -1.0f : 1.0f;
}

Vec3f blend_base_normals(const Surface& surface, uint32_t patch, const Vec2f& at) {
    const Quad quad = surface.quads[patch];
    std::array<Vec3f, 4> normals;
    for (size_t k = 0; k < 4; ++k) normals[k] = unpack_normal(surface.frames[quad.vertex[k]]);
    return blend_corners(quad, normals, at);
}

} // namespace relief
