// Smooth filters: coefficients, their evaluation, bounds and levels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "relief/error.h"
#include "relief/half.h"
#include "surface/map/gutter.h"
#include "surface/map/spline_coefficients.h"
#include "surface/map/texels.h"
#include "surface/patch/level_field.h"
#include "surface/test_scenes.h"

namespace relief {
namespace {

constexpr WrapMode kWraps[] = {WrapMode::clamp, WrapMode::repeat, WrapMode::mirror, WrapMode::black};

Displacement make_smooth(std::shared_ptr<const Texture> texture, MapFilter filter, WrapMode wrap) {
    Displacement displacement = test::make_displacement(std::move(texture));
    displacement.space = DisplacementSpace::object;
    displacement.filter = filter, displacement.wrap = wrap;
    return displacement;
}

DisplacementMap make_map(const Displacement& displacement) {
    PyramidCache pyramids;
    return make_displacement_map(displacement, {}, pyramids);
}

/// `value` at the centre of each texel, rounded to integers as a file of 8 bits has them.
template <class Value>
std::shared_ptr<Texture> make_stairs(uint32_t width, uint32_t height, const Value& value) {
    auto texture = test::make_constant(width, height, {0, 0, 0});
    texture->source_type = SampleType::uint8;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (size_t c = 0; c < 3; ++c)
                texture->floats[4 * (size_t(y) * width + x) + c] =
                    float(std::round(255 * value(double(x), double(y)))) / 255;
    return texture;
}

SplineForm make_form(bool is_interpolating, bool is_dequantized, WrapMode wrap) {
    return {is_interpolating, is_dequantized, wrap, {0.25f, -0.5f, 0.125f}};
}

} // namespace

TEST(Spline, weights_are_not_negative_and_sum_to_one) {
    for (uint32_t k = 0; k <= 100000; ++k) {
        const float s = std::min(float(k) / 100000, 0x1.fffffep-1f);
        const scalar::CubicWeights w = scalar::weigh_spline(s);
        ASSERT_TRUE(w.first >= 0 && w.second >= 0 && w.third >= 0 && w.fourth >= 0) << s;
        ASSERT_NEAR(double(w.first) + w.second + w.third + w.fourth, 1, 2e-7) << s;
        // The moment of order 1: a ramp stays a ramp.
        ASSERT_NEAR(-double(w.first) + w.third + 2.0 * w.fourth, s, 4e-7) << s;
    }
}

TEST(Spline, cubic_goes_through_the_texels_in_every_wrap_mode) {
    for (const WrapMode wrap : kWraps)
        for (const auto& [width, height] : {std::pair(24u, 17u), std::pair(3u, 40u), std::pair(1u, 2u)}) {
            const auto texels = test::make_noise(width, height, 1, 5);
            Displacement displacement = make_smooth(texels, MapFilter::cubic, wrap);
            displacement.midlevel = {0.25f, -0.5f, 0.125f};
            const DisplacementMap map = make_map(displacement);
            for (uint32_t y = 0; y < height; ++y)
                for (uint32_t x = 0; x < width; ++x) {
                    const Vec2f uv{(float(x) + 0.5f) / float(width), 1 - (float(y) + 0.5f) / float(height)};
                    const Vec3f d = fetch_displacement(map, 0, uv) + displacement.midlevel;
                    const auto texel = read_texel(*texels, x, y);
                    for (int c = 0; c < 3; ++c)
                        ASSERT_NEAR(get_component(d, c), texel[size_t(c)], 3e-5f)
                            << int(wrap) << " " << x << " " << y << " of " << width << " x " << height;
                }
        }
}

TEST(Spline, has_no_kinks_where_bilinear_has) {
    const auto texels = test::make_noise(16, 16, 1, 8);
    const auto find_kink = [&](MapFilter filter) {
        const DisplacementMap map = make_map(make_smooth(texels, filter, WrapMode::clamp));
        double kink = 0;
        for (int x = 1; x < 15; ++x) { // the slopes on both sides of the texel's centre
            const auto at = [&](double offset) {
                return double(fetch_displacement(map, 0, {float((x + 0.5 + offset) / 16), 0.4f}).x);
            };
            const double h = 1.0 / 64;
            kink = std::max(kink, std::fabs((at(h) - at(0)) - (at(0) - at(-h))) / h);
        }
        return kink;
    };
    EXPECT_GT(find_kink(MapFilter::none), 0.5);
    EXPECT_LT(find_kink(MapFilter::cubic), 0.25);
    EXPECT_LT(find_kink(MapFilter::bspline), 0.1);
}

TEST(Spline, bspline_keeps_the_texels_and_their_precision) {
    const auto texels = test::make_noise(8, 8, 1, 3);
    const Displacement displacement = make_smooth(texels, MapFilter::bspline, WrapMode::clamp);
    EXPECT_EQ(make_map(displacement).tiles[0].texture, texels);
    EXPECT_TRUE(make_map(displacement).is_smooth);
}

TEST(Spline, an_edit_gives_the_coefficients_of_a_fresh_map) {
    std::mt19937 random(4);
    for (const WrapMode wrap : kWraps)
        for (const bool is_interpolating : {false, true})
            for (const bool is_dequantized : {false, true}) {
                const SplineForm form = make_form(is_interpolating, is_dequantized, wrap);
                if (form.keeps_texels()) continue;
                auto texels = make_stairs(310, 250, [](double x, double y) {
                    return 0.4 + 0.2 * std::sin(x / 40) + 0.1 * std::cos(y / 25);
                });
                auto coefficients = std::make_shared<Texture>(*make_spline(texels, form));
                for (int round = 0; round < 4; ++round) {
                    const uint32_t x0 = uint32_t(random() % 300),
                                   y0 = round == 0 ? 0 : uint32_t(random() % 240);
                    const TexelRectangle changed{x0, y0, x0 + uint32_t(random() % 10),
                                                 y0 + uint32_t(random() % 10)};
                    const Texture before = *coefficients;
                    for (uint32_t y = changed.y0; y <= changed.y1; ++y)
                        for (uint32_t x = changed.x0; x <= changed.x1; ++x)
                            texels->floats[4 * (size_t(y) * 310 + x)] = float(random() % 256) / 255;
                    const TexelRectangle reached = update_spline(*texels, form, changed, *coefficients);
                    ASSERT_EQ(coefficients->floats, make_spline(texels, form)->floats)
                        << int(wrap) << is_interpolating << is_dequantized << " round " << round;
                    ASSERT_NE(coefficients->floats, before.floats);
                    for (uint32_t y = 0; y < 250; ++y)
                        for (uint32_t x = 0; x < 310; ++x) {
                            const bool is_reached =
                                x >= reached.x0 && x <= reached.x1 && y >= reached.y0 && y <= reached.y1;
                            const size_t at = 4 * (size_t(y) * 310 + x);
                            ASSERT_TRUE(is_reached || before.floats[at] == coefficients->floats[at]);
                        }
                }
            }
}

TEST(Spline, halves_have_the_coefficients_of_the_same_floats) {
    auto texels = test::make_noise(20, 30, 1, 6);
    auto halves = std::make_shared<Texture>(*texels);
    for (float& value : texels->floats) {
        halves->halves.push_back(float_to_half(value));
        value = half_to_float(halves->halves.back());
    }
    halves->floats.clear();
    const SplineForm form = make_form(true, false, WrapMode::mirror);
    EXPECT_EQ(make_spline(texels, form)->floats, make_spline(halves, form)->floats);
}

TEST(Spline, refuses_a_texel_that_is_not_finite_by_its_own_place) {
    auto texels = test::make_noise(20, 30, 1, 6);
    texels->floats[4 * (7 * 20 + 11)] = NAN;
    std::string where;
    try {
        make_spline(texels, make_form(true, false, WrapMode::clamp));
    } catch (const Error& error) {
        where = error.where();
    }
    EXPECT_EQ(where, "noise.exr, pixel (11, 7)");
}

TEST(Dequantize, makes_slopes_of_stairs_within_half_a_step) {
    const auto dome = [](double x, double y) {
        return 0.5 * std::exp(-((x - 256) * (x - 256) + (y - 256) * (y - 256)) / 32768);
    };
    const auto stairs = make_stairs(512, 512, dome);
    const auto smooth = make_spline(stairs, make_form(false, true, WrapMode::clamp));
    double squares[2] = {0, 0}, most = 0;
    for (uint32_t y = 64; y < 448; ++y)
        for (uint32_t x = 64; x < 448; ++x) {
            const auto get = [&](const Texture& map, uint32_t column) {
                return double(map.floats[4 * (size_t(y) * 512 + column)]);
            };
            most = std::max(most, std::fabs(get(*smooth, x) - get(*stairs, x)) * 255);
            const double slope = dome(x + 1, y) - dome(x - 1, y);
            for (int k = 0; k < 2; ++k) {
                const Texture& map = k == 0 ? *stairs : *smooth;
                const double error = get(map, x + 1) - get(map, x - 1) - slope;
                squares[k] += error * error;
            }
        }
    EXPECT_LE(most, 0.5001);
    EXPECT_GT(most, 0.4);
    EXPECT_LT(std::sqrt(squares[1] / squares[0]), 0.12) << "error of the slopes, of that of the stairs";
}

TEST(Dequantize, leaves_detail_and_edges_within_their_steps) {
    const auto stairs = make_stairs(200, 160, [](double x, double y) {
        return (x > 100 ? 0.7 : 0.3) + 0.05 * std::sin(x) * std::sin(y * 1.3);
    });
    const auto smooth = make_spline(stairs, make_form(false, true, WrapMode::repeat));
    for (size_t k = 0; k < stairs->floats.size(); ++k)
        ASSERT_NEAR(smooth->floats[k], stairs->floats[k], 0.5001f / 255) << k;
}

TEST(Spline, boxes_hold_dense_samples) {
    std::mt19937 random(7);
    for (uint32_t round = 0; round < 48; ++round) {
        const MapFilter filter = round % 2 == 0 ? MapFilter::cubic : MapFilter::bspline;
        // Spikes among nothing: a box that forgets one texel is too small.
        auto texels = test::make_constant(23, 19, {0, 0, 0});
        for (int k = 0; k < 12; ++k)
            for (size_t c = 0; c < 3; ++c)
                texels->floats[4 * (random() % (23 * 19)) + c] = random() % 2 == 0 ? 5.0f : -7.0f;
        Displacement displacement = make_smooth(texels, filter, kWraps[round / 2 % 4]);
        if (round % 3 == 0) displacement.space = DisplacementSpace::tangent;
        displacement.flip_v = round % 5 == 0;
        Mesh mesh = test::make_random_grid(5, 4, 0.4f, round);
        if (round % 4 == 3)
            for (Vec2f& uv : mesh.uvs) uv = {uv.x * 3 - 1, uv.y * 2 + 0.3f};
        const Surface surface = make_surface(mesh, &displacement, {});
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            const Box box = compute_patch_box(surface, patch);
            const PatchLevels levels{6, {6, 6, 6, 6}};
            const uint32_t i0 = uint32_t(random() % 60), j0 = uint32_t(random() % 60);
            const Box tile = compute_tile_box(surface, patch, levels, {i0, j0, i0 + 4, j0 + 4});
            for (uint32_t j = 0; j <= 64; ++j)
                for (uint32_t i = 0; i <= 64; ++i) {
                    const Vec3f p = evaluate_vertex(surface, patch, levels, i, j);
                    ASSERT_TRUE(box.contains(p)) << "round " << round << " patch " << patch;
                    const bool is_in_tile = i >= i0 && i <= i0 + 4 && j >= j0 && j <= j0 + 4;
                    ASSERT_TRUE(!is_in_tile || tile.contains(p)) << "round " << round << " patch " << patch;
                }
        }
    }
}

TEST(Spline, levels_go_beyond_the_texels) {
    const auto texels = test::make_noise(16, 16, 0.1f, 2);
    LevelFieldConfig config;
    config.camera = {0.5f, 0.5f, 0.2f}, config.pixel_angle = 1e-5f;
    const auto find_level = [&](MapFilter filter) {
        const Displacement displacement = make_smooth(texels, filter, WrapMode::clamp);
        const Surface surface = make_surface(test::make_plane(), &displacement, {});
        return LevelField::compute(surface, {}, config).at(0).patch;
    };
    EXPECT_EQ(find_level(MapFilter::none), 4);
    EXPECT_EQ(find_level(MapFilter::cubic), 7);
    EXPECT_EQ(find_level(MapFilter::bspline), 7);
}

TEST(Spline, the_background_beside_an_island_does_not_bleed_into_it) {
    // One square in the middle of the map, all of it 1; the background is far away from that.
    Mesh mesh = test::make_plane();
    for (Vec2f& uv : mesh.uvs) uv = {0.303f + 0.4f * uv.x, 0.303f + 0.4f * uv.y};
    for (const MapFilter filter : {MapFilter::cubic, MapFilter::bspline}) {
        auto texels = test::make_constant(128, 128, {0, 0, 0});
        for (uint32_t y = 0; y < 128; ++y)
            for (uint32_t x = 0; x < 128; ++x) {
                const double u = (x + 0.5) / 128, v = 1 - (y + 0.5) / 128;
                const bool is_inside = u > 0.303 && u < 0.703 && v > 0.303 && v < 0.703;
                texels->floats[4 * (y * 128 + x) + 2] = is_inside ? 1.0f : 0.0f;
            }
        Displacement displacement = make_smooth(texels, filter, WrapMode::clamp);
        const UvOutlines outlines = make_uv_outlines(mesh);
        const UvOutlines* meshes[] = {&outlines};
        GutterFill fill = find_gutter(displacement, displacement.tiles[0], meshes);
        fill.apply(*texels);
        const Surface surface = make_surface(mesh, &displacement, {});
        for (uint32_t j = 0; j <= 256; ++j)
            for (uint32_t i = 0; i <= 256; ++i)
                ASSERT_NEAR(evaluate_vertex(surface, 0, {8, {8, 8, 8, 8}}, i, j).z, 1, 1e-5f)
                    << i << " " << j;
    }
}

} // namespace relief
