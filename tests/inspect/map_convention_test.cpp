// What a map looks like: channels, signs and space.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "inspect/findings.h"
#include "math/affine.h"
#include "relief/render.h"
#include "support/bodies.h"
#include "support/sculpt.h"
#include "surface/patch/surface.h"

namespace relief::test {
namespace {

constexpr uint32_t kSize = 64;

AxisMap draw_axes(std::mt19937& random) {
    AxisMap axes;
    for (size_t c = 2; c > 0; --c) std::swap(axes.axis[c], axes.axis[random() % (c + 1)]);
    for (int8_t& sign : axes.sign) sign = random() % 2 == 0 ? 1 : -1;
    return axes;
}

/// Whether the channel along the normal and its sign are equal, and the other two differ by quarters of a
/// turn.
bool are_turned(AxisMap a, const AxisMap& b) {
    for (int turn = 0; turn < 4; ++turn) {
        if (a == b) return true;
        for (size_t c = 0; c < 3; ++c) // t becomes b, b becomes -t
            if (a.axis[c] < 2)
                a.sign[c] = int8_t(a.axis[c] == 1 ? -a.sign[c] : a.sign[c]),
                a.axis[c] = uint8_t(1 - a.axis[c]);
    }
    return false;
}

TEST(MapConvention, twelve_signed_permutations_are_all_named_but_for_turns_of_t_and_b) {
    std::mt19937 random(20);
    for (int k = 0; k < 12; ++k) {
        const AxisMap axes = draw_axes(random);
        const Displacement map = make_map(make_sculpt_texture(kSize, axes));
        const Displacement guess = guess_map_meaning(map);
        EXPECT_TRUE(are_turned(guess.axes, axes)) << "number " << k;
        EXPECT_EQ(guess.space, DisplacementSpace::tangent);
        EXPECT_EQ(guess.midlevel, Vec3f{});
    }
}

TEST(MapConvention, the_orders_of_programs_are_named_by_presets) {
    const auto looks = [](const AxisMap& axes) {
        return get_fact(inspect_map(make_map(make_sculpt_texture(kSize, axes)), MapMeaning::unknown),
                        "looks_like");
    };
    EXPECT_HAS_PART(looks({}), "blender-brush");
    EXPECT_HAS_PART(looks({{0, 2, 1}, {1, 1, 1}}), "mudbox");
    EXPECT_EQ(looks({{0, 2, 1}, {1, 1, -1}}).find("presets"), std::string::npos);
    EXPECT_HAS_PART(looks({}), "; t and b may be turned by quarters");
}

TEST(MapConvention, rows_the_other_way_up_turn_no_sign) {
    auto texture = make_sculpt_texture(kSize);
    auto turned = std::make_shared<Texture>(*texture);
    for (uint32_t y = 0; y < kSize; ++y)
        std::copy_n(&texture->floats[size_t(4) * kSize * y], 4 * kSize,
                    &turned->floats[size_t(4) * kSize * (kSize - 1 - y)]);
    Displacement map = make_map(turned);
    map.flip_v = true;
    EXPECT_EQ(guess_map_meaning(map).axes, AxisMap{});
}

TEST(MapConvention, declared_axes_that_the_values_contradict_are_noted) {
    Displacement map = make_map(make_sculpt_texture(kSize, {{0, 2, 1}, {1, 1, 1}}));
    const Inspection declared = inspect_map(map, MapMeaning::declared);
    EXPECT_HAS_PART(find_text(declared, "I-AXES"), "the declared axes");
    EXPECT_HAS_PART(find_text(declared, "I-AXES"), "moonray write t,n,b");
    map.assumed.axes = true;
    EXPECT_HAS_PART(find_text(inspect_map(map, MapMeaning::declared), "I-AXES"), "the assumed axes");
    map.axes = {{0, 2, 1}, {1, 1, 1}};
    EXPECT_FALSE(has_code(inspect_map(map, MapMeaning::declared), "I-AXES"));
}

TEST(MapConvention, waves_without_a_side_are_not_clear) {
    auto texture = make_sculpt_texture(kSize);
    constexpr float kTurn = 2 * std::numbers::pi_v<float>;
    for (uint32_t k = 0; k < kSize * kSize; ++k) {
        const float u = float(k % kSize) / kSize, v = float(k / kSize) / kSize;
        texture->floats[4 * k] = 0.1f * std::sin(kTurn * u),
                            texture->floats[4 * k + 1] = 0.1f * std::sin(kTurn * v);
        texture->floats[4 * k + 2] = 0.2f * std::cos(kTurn * u) * std::cos(kTurn * v);
    }
    const Inspection inspection = inspect_map(make_map(texture), MapMeaning::unknown);
    EXPECT_HAS_PART(get_fact(inspection, "looks_like"), "not clear");
    EXPECT_HAS_PART(get_fact(inspection, "wrap"), "repeat");
    EXPECT_EQ(count_severe(inspection), 0u);
}

/// A cube, each side an island of its own that lies turned by another angle in the atlas of 3 x 2 cells.
Mesh make_cube() {
    Mesh cube;
    cube.name = "cube";
    for (int k = 0; k < 8; ++k)
        cube.positions.push_back({float(k & 1) * 2 - 1, float(k >> 1 & 1) * 2 - 1, float(k >> 2) * 2 - 1});
    const uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    constexpr uint32_t kCuts = 4;
    for (uint32_t face = 0; face < 6; ++face) {
        const auto mix = [&](const auto* c, float s, float t) {
            return (c[0] * (1 - s) + c[1] * s) * (1 - t) + (c[3] * (1 - s) + c[2] * s) * t;
        };
        Vec3f corners[4];
        Vec2f uvs[4];
        for (uint32_t k = 0; k < 4; ++k) {
            corners[k] = cube.positions[faces[face][k]];
            const uint32_t turned = (k + face) % 4;
            uvs[k] = {(float(face % 3) + (turned == 1 || turned == 2 ? 0.9f : 0.1f)) / 3,
                      (float(face / 3) + (turned >= 2 ? 0.9f : 0.1f)) / 2};
        }
        for (uint32_t j = 0; j < kCuts; ++j)
            for (uint32_t i = 0; i < kCuts; ++i) {
                cube.face_sizes.push_back(4);
                for (const auto& [a, b] : {std::pair(i, j), {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
                    cube.position_indices.push_back(uint32_t(cube.positions.size()));
                    cube.uv_indices.push_back(uint32_t(cube.uvs.size()));
                    cube.positions.push_back(mix(corners, float(a) / kCuts, float(b) / kCuts));
                    cube.uvs.push_back(mix(uvs, float(a) / kCuts, float(b) / kCuts));
                }
            }
    }
    return cube;
}

/// A map of the cube by a function of position and frame, at the nearest place of each texel.
template <class Displace> Displacement bake(const Mesh& cube, const Displace& displace) {
    constexpr uint32_t kWidth = 192, kHeight = 128;
    auto texture = std::make_shared<Texture>();
    texture->width = kWidth, texture->height = kHeight, texture->channel_count = 3;
    texture->floats.assign(size_t(4) * kWidth * kHeight, 0.0f);
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const uint32_t face = x / (kWidth / 3) + 3 * ((kHeight - 1 - y) / (kHeight / 2));
            // Corners of the whole side, from its grid of quads.
            const size_t first = size_t(face) * 64;
            const auto at = [&](size_t quad, size_t k) {
                return cube.positions[cube.position_indices[first + 4 * quad + k]];
            };
            const auto uv = [&](size_t quad, size_t k) {
                return cube.uvs[cube.uv_indices[first + 4 * quad + k]];
            };
            const Vec3f a = at(0, 0), along_s = at(3, 1) - a, along_t = at(12, 3) - a;
            const Vec2f o = uv(0, 0), us = uv(3, 1) - o, ut = uv(12, 3) - o;
            const Vec2f here{(float(x) + 0.5f) / kWidth - o.x, 1 - (float(y) + 0.5f) / kHeight - o.y};
            const float determinant = us.x * ut.y - us.y * ut.x;
            const float s = (here.x * ut.y - here.y * ut.x) / determinant;
            const float t = (us.x * here.y - us.y * here.x) / determinant;
            const Vec3f n = normalize(cross(along_s, along_t));
            const Vec3f tangent = normalize(along_s * ut.y - along_t * us.y);
            const Vec3f d = displace(a + along_s * s + along_t * t, Frame{tangent, cross(n, tangent), n});
            for (int c = 0; c < 3; ++c)
                texture->floats[4 * (size_t(y) * kWidth + x) + size_t(c)] = get_component(d, c);
        }
    return make_map(texture);
}

TEST(MapConvention, seams_of_the_mesh_tell_object_space) {
    const Mesh cube = make_cube();
    // Outwards from the middle, more at the top.
    const auto puff = [](const Vec3f& p) { return p * (0.1f + 0.05f * p.y); };
    const Displacement object = bake(cube, [&](const Vec3f& p, const Frame&) {
        const Vec3f d = puff(p);
        return Vec3f{d.x, d.z, d.y};
    });
    const Inspection inspection = inspect_map(object, MapMeaning::unknown, &cube);
    EXPECT_HAS_PART(get_fact(inspection, "space"), "object: ");
    EXPECT_HAS_PART(get_fact(inspection, "looks_like"), "object space, axes x,z,y");
    EXPECT_TRUE(has_code(inspect_map(object, MapMeaning::declared, &cube), "I-SPACE"));
    EXPECT_EQ(count_severe(inspection), 0u);
}

/// The cube in tile 1002, and beside it in tile 1001 one that lies mirrored in its uvs.
Mesh make_cubes_in_tiles() {
    const Mesh cube = make_cube();
    Mesh both = cube;
    for (Vec2f& uv : both.uvs) uv.x += 1;
    const auto points = uint32_t(cube.positions.size()), uvs = uint32_t(cube.uvs.size());
    for (const Vec3f& position : cube.positions) both.positions.push_back(position + Vec3f{5, 0, 0});
    for (const Vec2f& uv : cube.uvs) both.uvs.push_back({1 - uv.x, uv.y});
    both.face_sizes.insert(both.face_sizes.end(), cube.face_sizes.begin(), cube.face_sizes.end());
    for (const uint32_t index : cube.position_indices) both.position_indices.push_back(points + index);
    for (const uint32_t index : cube.uv_indices) both.uv_indices.push_back(uvs + index);
    return both;
}

TEST(MapConvention, one_image_on_a_mesh_with_tiles_is_tried_in_that_of_its_name_or_its_seams) {
    const Mesh cubes = make_cubes_in_tiles();
    const Displacement map =
        bake(make_cube(), [](const Vec3f& p, const Frame&) { return p * (0.1f + 0.05f * p.y); });
    for (const char* file : {"maps/cube.1002.exr", "maps/cube.exr"}) {
        auto texture = std::make_shared<Texture>(*map.tiles[0].texture);
        texture->file = file;
        const Inspection inspection = inspect_map(make_map(texture), MapMeaning::unknown, &cubes);
        EXPECT_HAS_PART(get_fact(inspection, "space"), "object: as tile 1002 of the mesh, ");
        EXPECT_HAS_PART(get_fact(inspection, "looks_like"), "object space, axes x,y,z");
    }
}

TEST(MapConvention, a_tile_that_moves_to_one_side_along_two_channels_is_object_space_without_a_mesh) {
    const auto make = [](float b, const std::string& file) {
        auto texture = make_sculpt_texture(kSize);
        for (size_t k = 0; k < texture->floats.size(); k += 4) {
            const float height = texture->floats[k + 2];
            texture->floats[k] = 0, texture->floats[k + 1] = -height, texture->floats[k + 2] = b * height;
        }
        texture->file = file;
        return inspect_map(make_map(texture), MapMeaning::unknown);
    };
    const Inspection tile = make(-0.9f, "maps/jaw.1003.exr");
    EXPECT_HAS_PART(get_fact(tile, "space"), "object: G and B lie to one side");
    EXPECT_HAS_PART(get_fact(tile, "looks_like"), "object space, axes x,y,z");
    // A brush may lean as a whole, and one channel alone is the normal.
    EXPECT_HAS_PART(get_fact(make(-0.9f, "maps/horn.exr"), "space"), "tangent");
    EXPECT_HAS_PART(get_fact(make(-0.9f, "maps/horn_2048.exr"), "space"), "tangent");
    EXPECT_HAS_PART(get_fact(make(-0.3f, "maps/jaw.1003.exr"), "space"), "tangent");
}

std::vector<std::string> render_for_warnings(const Mesh& mesh, Displacement map, DisplacementSpace space) {
    map.space = space;
    RenderSettings settings;
    settings.image.width = settings.image.height = 4, settings.image.spp = 1, settings.image.bounces = 0;
    Scene scene = make_body_scene(mesh, std::move(map));
    scene.environment.emplace();
    return render(std::move(scene), settings).statistics.warnings;
}

TEST(MapConvention, a_render_warns_of_object_space_that_is_read_as_tangent) {
    const Mesh cube = make_cube();
    const Displacement object =
        bake(cube, [](const Vec3f& p, const Frame&) { return p * (0.1f + 0.05f * p.y); });
    const Displacement tangent = bake(cube, [](const Vec3f& p, const Frame& frame) {
        const Vec3f d = Vec3f{0.03f * p.z, 0.05f, 0.04f * p.x} + frame.n * 0.15f;
        return Vec3f{dot(d, frame.t), dot(d, frame.b), dot(d, frame.n)};
    });
    const std::vector<std::string> warnings = render_for_warnings(cube, object, DisplacementSpace::tangent);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS_PART(warnings[0], "looks like object space");
    EXPECT_HAS_PART(warnings[0], "displacement.space = object");
    EXPECT_EQ(find_seam_warnings(make_body_scene(cube, object)), warnings);
    EXPECT_TRUE(find_seam_warnings(make_body_scene(cube, tangent)).empty());
    EXPECT_TRUE(render_for_warnings(cube, object, DisplacementSpace::object).empty());
    EXPECT_TRUE(render_for_warnings(cube, tangent, DisplacementSpace::tangent).empty());
}

TEST(MapConvention, a_render_warns_of_no_heights_and_of_no_map_that_is_laid_over_a_mesh_twice) {
    const Mesh cube = make_cube();
    const Displacement vectors =
        bake(cube, [](const Vec3f& p, const Frame&) { return p * (0.1f + 0.05f * p.y); });
    // The same height on both sides of an edge, along two normals.
    auto level = std::make_shared<Texture>(*vectors.tiles[0].texture);
    std::fill(level->floats.begin(), level->floats.end(), 0.1f);
    Displacement heights = vectors;
    heights.type = DisplacementType::height, heights.tiles[0].texture = level;
    EXPECT_TRUE(render_for_warnings(cube, heights, DisplacementSpace::tangent).empty());
    // Each face has the whole map, whose sides hold the same texels.
    Mesh tiled = cube;
    for (size_t face = 0; face < tiled.face_sizes.size(); ++face) {
        Vec2f low{1e9f, 1e9f}, high{-1e9f, -1e9f};
        for (size_t k = 0; k < 4; ++k) {
            const Vec2f& uv = cube.uvs[cube.uv_indices[4 * face + k]];
            low = {std::min(low.x, uv.x), std::min(low.y, uv.y)};
            high = {std::max(high.x, uv.x), std::max(high.y, uv.y)};
        }
        for (size_t k = 0; k < 4; ++k) {
            Vec2f& uv = tiled.uvs[tiled.uv_indices[4 * face + k]];
            uv = {(uv.x - low.x) / (high.x - low.x), (uv.y - low.y) / (high.y - low.y)};
        }
    }
    auto texture = std::make_shared<Texture>(*vectors.tiles[0].texture);
    for (size_t k = 0; k < texture->floats.size(); ++k)
        texture->floats[k] = 0.05f + 0.1f * float(k % 4); // leans to one side: torn at every edge
    Displacement leaning = vectors;
    leaning.tiles[0].texture = texture;
    EXPECT_TRUE(render_for_warnings(tiled, leaning, DisplacementSpace::tangent).empty());
    EXPECT_FALSE(render_for_warnings(cube, leaning, DisplacementSpace::tangent).empty());
}

TEST(MapConvention, seams_of_the_mesh_tell_tangent_space) {
    const Mesh cube = make_cube();
    const Displacement tangent = bake(cube, [](const Vec3f& p, const Frame& frame) {
        const Vec3f wind{0.03f * p.z, 0.05f, 0.04f * p.x};
        const Vec3f d = wind + frame.n * 0.15f;
        return Vec3f{dot(d, frame.t), dot(d, frame.n), dot(d, frame.b)};
    });
    const Inspection inspection = inspect_map(tangent, MapMeaning::unknown, &cube);
    EXPECT_HAS_PART(get_fact(inspection, "space"), "tangent: ");
    EXPECT_HAS_PART(get_fact(inspection, "looks_like"), "tangent space, axes t,n,b");
}

} // namespace
} // namespace relief::test
