// Which texels a dab changes: those whose surface is near the cursor, also over an overhang and across seams.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "common/texel_values.h"
#include "common/vectors.h"
#include "viewer/dab.h"
#include "viewer/fixture.h"

namespace relief::viewer {

using namespace vectors;

namespace {

constexpr int kSide = 256;

/// A wave along y that leans to the right, so that its side hangs over the plane.
Vec3f make_wave(float x) {
    if (std::fabs(x) > 0.5f) return {};
    const float height = 0.25f * (1 + std::cos(2 * std::numbers::pi_v<float> * x));
    return {0.9f * height, 0, height};
}

/// Of the surface at the middle of a texel.
Vec3f find_place(int x, int y) {
    const float u = (float(x) + 0.5f) / kSide, v = 1 - (float(y) + 0.5f) / kSide;
    return Vec3f{2 * u - 1, 2 * v - 1, 0} + make_wave(2 * u - 1);
}

float find_distance_to_surface(const Vec3f& place) {
    float nearest = 1e9f;
    for (int k = 0; k < 16 * kSide; ++k) {
        const float x = 2 * (float(k) + 0.5f) / (16 * kSide) - 1;
        const Vec3f off = Vec3f{x, place.y, 0} + make_wave(x) - place;
        nearest = std::min(nearest, length(off));
    }
    return nearest;
}

Scene make_wave_scene() {
    Scene scene = make_bumpy_scene(DisplacementSpace::object);
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = kSide;
    texture->channel_count = 3;
    texture->source_type = SampleType::float32;
    texture->floats.assign(size_t(4) * kSide * kSide, 1);
    for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x)
            write_texel(*texture, x, y, make_wave(2 * (float(x) + 0.5f) / kSide - 1));
    scene.displacements[0].tiles = {{1001, texture}};
    return scene;
}

RenderSettings make_settings(int spp) {
    RenderSettings settings = make_small_settings(spp);
    settings.image.width = 240, settings.image.height = 160;
    return settings;
}

std::vector<DabPiece> find_dab_at(const Scene& scene, const ShownPicture& picture, float x, float radius) {
    const auto centre = find_surface_point(picture, x, 80.5f);
    if (!centre) return {};
    return find_dab(scene, picture, *centre, radius, TexelPlaces(scene, 0));
}

} // namespace

TEST(Dab, reaches_no_further_than_its_radius_in_space) {
    const Scene scene = make_wave_scene();
    for (const int spp : {1, 4}) {
        const ShownPicture picture = make_picture(scene, make_settings(spp));
        size_t centres = 0;
        for (const float radius : {8.0f, 16.0f, 30.0f})
            for (float x = 60.5f; x < 180; x += 6) {
                const auto centre = find_surface_point(picture, x, 80.5f);
                ASSERT_TRUE(centre) << x;
                // At the rim of the overhang, samples of both sheets have a mean that is on neither.
                if (find_distance_to_surface(centre->position) > 0.5f * centre->pixel_size) continue;
                ++centres;
                float farthest = 0, largest = 0;
                const std::vector<DabPiece> pieces =
                    find_dab(scene, picture, *centre, radius, TexelPlaces(scene, 0));
                for (const DabPiece& piece : pieces)
                    largest = std::max(largest, *std::ranges::max_element(piece.weights));
                EXPECT_GT(largest, 0.7f) << spp << ' ' << radius << ' ' << x;
                for (const DabPiece& piece : pieces)
                    for (int row = piece.box.y0; row < piece.box.y1; ++row)
                        for (int column = piece.box.x0; column < piece.box.x1; ++column)
                            if (piece.weight(column, row) > 0.1f * largest)
                                farthest =
                                    std::max(farthest, length(find_place(column, row) - centre->position));
                EXPECT_LE(farthest, 1.1f * radius * centre->pixel_size) << spp << ' ' << radius << ' ' << x;
            }
    }
}

TEST(Dab, has_no_holes_where_the_surface_is_seen) {
    const Scene scene = make_wave_scene();
    for (const int spp : {1, 4}) {
        const ShownPicture picture = make_picture(scene, make_settings(spp));
        const auto centre = find_surface_point(picture, 90.5f, 80.5f); // on the side that is seen
        ASSERT_TRUE(centre);
        constexpr float kRadius = 20;
        std::vector<float> weights(size_t(kSide) * kSide);
        for (const DabPiece& piece : find_dab(scene, picture, *centre, kRadius, TexelPlaces(scene, 0)))
            for (int y = piece.box.y0; y < piece.box.y1; ++y)
                for (int x = piece.box.x0; x < piece.box.x1; ++x)
                    weights[size_t(y) * kSide + size_t(x)] = piece.weight(x, y);
        size_t inside = 0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide / 2; ++x) {
                const float share =
                    length(find_place(x, y) - centre->position) / (kRadius * centre->pixel_size);
                const float expected = share < 1 ? (1 - share * share) * (1 - share * share) : 0;
                inside += share < 1;
                EXPECT_NEAR(weights[size_t(y) * kSide + size_t(x)], expected, 0.1f) << x << ' ' << y;
            }
        EXPECT_GT(inside, 500u);
    }
}

/// A dab fades into what an overhang hides: few of the texels that change visibly lie there.
TEST(Dab, leaves_the_surface_behind_an_overhang_alone) {
    const Scene scene = make_wave_scene();
    const ShownPicture picture = make_picture(scene, make_settings(1));
    size_t hidden_in_all = 0, changed_in_all = 0;
    // The lip is at the largest x of the wave, beyond it the plane is seen.
    for (float x = 100.5f; x < 180; x += 4) {
        const std::vector<DabPiece> pieces = find_dab_at(scene, picture, x, 24);
        float largest = 0;
        for (const DabPiece& piece : pieces)
            largest = std::max(largest, *std::ranges::max_element(piece.weights));
        size_t hidden = 0, changed = 0;
        for (const DabPiece& piece : pieces)
            for (int column = piece.box.x0; column < piece.box.x1; ++column)
                for (int row = piece.box.y0; row < piece.box.y1; ++row) {
                    if (piece.weight(column, row) <= 0.1f * largest) continue;
                    const float slope =
                        find_place(column + 1, row).x - find_place(std::max(column - 1, 0), row).x;
                    ++changed;
                    hidden += slope < -0.004f; // faces down by more than what a pixel at its rim spans
                }
        EXPECT_LE(hidden, changed / 8) << x;
        hidden_in_all += hidden, changed_in_all += changed;
    }
    EXPECT_LE(hidden_in_all, changed_in_all / 40);
    EXPECT_GT(changed_in_all, 1000u);
}

TEST(Dab, goes_on_across_a_seam_and_into_the_next_tile) {
    Scene scene = make_bumpy_scene(DisplacementSpace::object);
    Mesh& mesh = scene.meshes[0];
    // The right half has uvs of its own, in the next tile and upside down.
    mesh.uvs.clear(), mesh.uv_indices.clear();
    for (size_t face = 0; face < 4; ++face)
        for (size_t k = 0; k < 4; ++k) {
            const Vec3f p = mesh.positions[mesh.position_indices[4 * face + k]];
            mesh.uv_indices.push_back(uint32_t(mesh.uvs.size()));
            mesh.uvs.push_back(face % 2 == 0 ? Vec2f{(p.x + 1) * 0.9f, (p.y + 1) / 2}
                                             : Vec2f{1.95f - p.x * 0.9f, (1 - p.y) / 2});
        }
    scene.displacements[0].is_udim = true;
    scene.displacements[0].tiles.push_back({1002, make_bumps(false)});
    const ShownPicture picture = make_picture(scene, make_settings(1));
    float largest[2] = {};
    for (const DabPiece& piece : find_dab_at(scene, picture, 120.5f, 20)) {
        ASSERT_TRUE(piece.udim == 1001 || piece.udim == 1002);
        float& own = largest[piece.udim - 1001];
        own = std::max(own, *std::ranges::max_element(piece.weights));
    }
    EXPECT_GT(largest[0], 0.8f);
    EXPECT_GT(largest[1], 0.8f);
}

/// Texels of both tiles are where the face has them, although it has one tile in the middle.
TEST(Dab, paints_both_tiles_of_a_face_across_them) {
    for (const bool is_one_face : {false, true}) {
        Scene scene = make_bumpy_scene(DisplacementSpace::object);
        Mesh& mesh = scene.meshes[0];
        if (is_one_face) {
            mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
            mesh.face_sizes = {4}, mesh.position_indices = {0, 1, 2, 3};
        }
        mesh.uvs.clear(), mesh.uv_indices.clear();
        for (const uint32_t point : mesh.position_indices) {
            const Vec3f p = mesh.positions[point];
            mesh.uv_indices.push_back(uint32_t(mesh.uvs.size()));
            mesh.uvs.push_back({(p.x + 1) * 0.6f + 0.2f, (p.y + 1) / 2});
        }
        scene.displacements[0].is_udim = true;
        scene.displacements[0].tiles.push_back({1002, make_bumps(false)});
        const ShownPicture picture = make_picture(scene, make_settings(1));
        float x = 120.5f; // goes to the pixel at the border of the tiles
        while (x < 230 && find_surface_point(picture, x, 80.5f)->position.x < 1.0f / 3) ++x;
        const auto centre = find_surface_point(picture, x, 80.5f);
        ASSERT_TRUE(centre);
        float largest[2] = {};
        for (const DabPiece& piece : find_dab_at(scene, picture, x, 20))
            for (int row = piece.box.y0; row < piece.box.y1; ++row)
                for (int column = piece.box.x0; column < piece.box.x1; ++column) {
                    const float weight = piece.weight(column, row);
                    ASSERT_TRUE(piece.udim == 1001 || piece.udim == 1002);
                    float& own = largest[piece.udim - 1001];
                    own = std::max(own, weight);
                    const float u = float(piece.udim - 1001) + (float(column) + 0.5f) / 64,
                                v = 1 - (float(row) + 0.5f) / 64;
                    const Vec3f place{(u - 0.2f) / 0.6f - 1, 2 * v - 1, centre->position.z};
                    if (weight > 0.1f)
                        EXPECT_LE(length(place - centre->position), 1.1f * 20 * centre->pixel_size)
                            << piece.udim << ' ' << column << ' ' << row;
                }
        EXPECT_GT(largest[0], 0.7f) << is_one_face;
        EXPECT_GT(largest[1], 0.7f) << is_one_face;
    }
}

} // namespace relief::viewer
