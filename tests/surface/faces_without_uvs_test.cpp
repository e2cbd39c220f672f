// Faces without uvs lie where the mesh has them, up to and with their edges; the others are displaced.
#include <gtest/gtest.h>

#include <cmath>

#include "relief/error.h"
#include "support/bodies.h"
#include "surface/patch/surface.h"

namespace relief {
namespace {

constexpr int kLevel = 3;

struct Choice {
    FrameKind frame;
    FrameLengths lengths;
    DisplacementSpace space;
    SubdivisionScheme scheme;
};

/// A sphere of 96 quads, of which each fifth has no uvs.
Mesh make_mesh(SubdivisionScheme scheme) {
    Mesh mesh = test::make_cube_sphere(4);
    test::remove_uvs(mesh, 5);
    mesh.subdivision.scheme = scheme;
    mesh.subdivision.level = 0;
    return mesh;
}

Vec3f find_vertex(const Surface& surface, uint32_t patch, uint32_t i, uint32_t j) {
    const PatchLevels levels{kLevel, {kLevel, kLevel, kLevel, kLevel}};
    return evaluate_vertex(surface, patch, levels, i, j);
}

float find_difference(const Surface& a, const Surface& b, uint32_t patch, uint32_t i, uint32_t j) {
    return length(find_vertex(a, patch, i, j) - find_vertex(b, patch, i, j));
}

void expect_undisplaced_faces(const Choice& choice) {
    const Mesh mesh = make_mesh(choice.scheme);
    Displacement map = test::make_displacement(test::make_random_map(32, 32, 0.2f, 3), choice.space);
    map.frame = choice.frame, map.lengths = choice.lengths;
    Displacement flat = map;
    flat.scale = {0, 0, 0};
    const Surface surface = make_surface(mesh, &map, {}), base = make_surface(mesh, &flat, {});
    constexpr uint32_t kSide = 1u << kLevel;
    size_t flat_count = 0;
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
        float largest = 0;
        for (uint32_t j = 0; j <= kSide; ++j)
            for (uint32_t i = 0; i <= kSide; ++i)
                largest = std::fmax(largest, find_difference(surface, base, patch, i, j));
        const bool has_uvs = surface.tile(surface.quads[patch].vertex[0]) != Surface::kNoTile;
        if (choice.scheme == SubdivisionScheme::none) EXPECT_EQ(has_uvs, patch % 5 != 4);
        flat_count += !has_uvs;
        if (!has_uvs)
            EXPECT_EQ(largest, 0) << patch;
        else
            EXPECT_GT(largest, 0.01f) << patch;
        EXPECT_TRUE(std::isfinite(largest));
    }
    EXPECT_GE(flat_count, mesh.face_sizes.size() / 5);
}

TEST(FacesWithoutUvs, are_not_displaced_up_to_their_edges) {
    using enum DisplacementSpace;
    using enum FrameKind;
    using enum FrameLengths;
    using enum SubdivisionScheme;
    for (const Choice& choice : {Choice{mikk, absolute, tangent, none}, Choice{mikk, relative, tangent, none},
                                 Choice{dpdu, relative, tangent, none}, Choice{mikk, absolute, object, none},
                                 Choice{mikk, absolute, tangent, catmark}})
        expect_undisplaced_faces(choice);
}

TEST(FacesWithoutUvs, have_a_uv_at_no_corner) {
    Mesh mesh = make_mesh(SubdivisionScheme::none);
    validate_mesh(mesh);
    mesh.uv_indices[4 * 4 + 1] = 0;
    EXPECT_THROW(validate_mesh(mesh), Error);
    mesh.uv_indices.assign(mesh.position_indices.size(), kNoIndex);
    EXPECT_THROW(validate_mesh(mesh), Error);
}

} // namespace
} // namespace relief
