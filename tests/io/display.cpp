// What PNG files show: display transforms, exposure, backgrounds.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "formulas/tonemap.h"
#include "io/picture/display_transform.h"
#include "math/vec.h"
#include "relief/io.h"
#include "test_files.h"

namespace relief {

using Display = FileTest;

Image make_image(const std::vector<float>& rgba) {
    Image image;
    image.width = image.full_width = int(rgba.size() / 4), image.height = image.full_height = 1;
    image.channels = {"R", "G", "B", "A"};
    image.pixels = rgba;
    return image;
}

TEST_F(Display, agx_goes_from_black_to_white_through_the_middle) {
    const DisplaySettings agx;
    const auto show_grey = [&](float x) { return show_color({x, x, x}, agx); };
    EXPECT_LT(show_grey(0).x, 0.01f);
    EXPECT_GT(show_grey(1e5f).x, 0.99f);
    // Half of the code values of a 2.2 display.
    const Vec3f middle = show_grey(0.18f);
    EXPECT_NEAR(middle.x, 0.5f, 0.01f);
    EXPECT_NEAR(middle.x, middle.z, 1e-3f) << "grey stays grey";
    float last = -1;
    for (float ev = -12; ev < 8; ev += 0.25f) {
        const float shown = show_grey(0.18f * std::exp2(ev)).x;
        EXPECT_GE(shown, last - 1e-5f);
        last = shown;
    }
    const Vec3f broken = show_color({NAN, -1, INFINITY}, agx);
    for (const float value : {broken.x, broken.y, broken.z}) EXPECT_TRUE(value >= 0 && value <= 1) << value;
}

/// Hue of an sRGB colour, degrees.
float find_hue(const Vec3f& c) {
    return std::atan2(std::sqrt(3.0f) * (c.y - c.z), 2 * c.x - c.y - c.z) * 57.29578f;
}

TEST_F(Display, strong_blue_stays_blue_in_agx_and_turns_in_filmic) {
    const Vec3f blue{0.02f, 0.05f, 3};
    const float hue = find_hue({0.02f, 0.05f, 3});
    const auto shift = [&](DisplayTransform transform) {
        DisplaySettings settings;
        settings.transform = transform;
        return std::fabs(find_hue(show_color(blue, settings)) - hue);
    };
    EXPECT_LT(shift(DisplayTransform::agx), 8);
    EXPECT_GT(shift(DisplayTransform::filmic), shift(DisplayTransform::agx));
}

TEST_F(Display, standard_is_the_transfer_function_alone) {
    DisplaySettings settings;
    settings.transform = DisplayTransform::standard;
    EXPECT_NEAR(show_color({0.2140411f, 0, 0}, settings).x, 0.5f, 1e-5f);
    EXPECT_NEAR(show_color({7, 0, 0}, settings).x, 1, 1e-6f);
    settings.transform = DisplayTransform::raw;
    EXPECT_EQ(show_color({0.25f, 7, -1}, settings).x, 0.25f);
    EXPECT_EQ(show_color({0.25f, 7, -1}, settings).y, 1);
    EXPECT_EQ(show_color({0.25f, 7, -1}, settings).z, 0);
}

/// Figures of ACES 1.0 (RRT and ODT for sRGB, Academy 2014): middle grey 0.18 shows as 0.10 of the white.
TEST_F(Display, aces_shows_middle_grey_at_a_tenth_and_white_at_sixteen_times_white) {
    Image image = make_image({0, 0, 0, 1});
    image.metadata["relief:display"] = "aces";
    const DisplaySettings aces = read_display_settings(image);
    const Vec3f grey = show_color({0.18f, 0.18f, 0.18f}, aces);
    EXPECT_NEAR(scalar::decode_srgb(grey.x), 0.10f, 0.005f);
    EXPECT_NEAR(grey.x, grey.z, 2e-3f) << "grey stays grey";
    EXPECT_LT(show_color({0, 0, 0}, aces).x, 0.01f);
    EXPECT_GT(show_color({16.3f, 16.3f, 16.3f}, aces).x, 0.99f);
    const Vec3f broken = show_color({NAN, -1, INFINITY}, aces);
    for (const float value : {broken.x, broken.y, broken.z}) EXPECT_TRUE(value >= 0 && value <= 1) << value;
}

/// From black to far beyond white; every fourth pixel is grey.
Image make_many_colors(int width, int height) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> stops(-16, 8);
    Image image;
    image.width = image.full_width = width, image.height = image.full_height = height;
    image.channels = {"R", "G", "B"};
    for (int k = 0; k < width * height; ++k) {
        const float red = std::exp2(stops(random));
        for (int c = 0; c < 3; ++c)
            image.pixels.push_back(k % 4 == 0 || c == 0 ? red : std::exp2(stops(random)));
    }
    return image;
}

TEST_F(Display, estimates_are_within_their_tolerance) {
    const Image image = make_many_colors(512, 512);
    for (size_t t = 0; t < std::size(kDisplayTransforms); ++t) {
        DisplaySettings settings;
        settings.transform = DisplayTransform(t);
        if (settings.transform == DisplayTransform::aces) continue;
        float greatest = 0;
        for (size_t k = 0; k < image.pixels.size(); k += 3) {
            const Vec3f color{image.pixels[k], image.pixels[k + 1], image.pixels[k + 2]};
            const Vec3f estimate = estimate_color(color, settings), exact = show_color(color, settings);
            for (const float error : {estimate.x - exact.x, estimate.y - exact.y, estimate.z - exact.z})
                greatest = std::max(greatest, std::fabs(error));
        }
        EXPECT_LT(greatest, kEstimateTolerance) << kDisplayTransforms[t];
    }
    for (const Vec3f& color : {Vec3f{NAN, -1, INFINITY}, Vec3f{0, 0, 0}, Vec3f{1e30f, 1e-30f, 1}}) {
        const Vec3f estimate = estimate_color(color, {}), exact = show_color(color, {});
        EXPECT_NEAR(estimate.x, exact.x, kEstimateTolerance);
        EXPECT_NEAR(estimate.y, exact.y, kEstimateTolerance);
        EXPECT_NEAR(estimate.z, exact.z, kEstimateTolerance);
    }
}

TEST_F(Display, a_png_has_the_bytes_of_exact_values) {
    const Image image = make_many_colors(512, 512);
    Image exact = image; // shown already, so that they are written as they are
    exact.metadata["relief:display"] = "raw";
    for (size_t k = 0; k < image.pixels.size(); k += 3) {
        const Vec3f shown = show_color({image.pixels[k], image.pixels[k + 1], image.pixels[k + 2]}, {});
        exact.pixels[k] = shown.x, exact.pixels[k + 1] = shown.y, exact.pixels[k + 2] = shown.z;
    }
    write_image(image, folder_ / "shown.png");
    write_image(exact, folder_ / "exact.png");
    EXPECT_TRUE(read_image(folder_ / "shown.png").pixels == read_image(folder_ / "exact.png").pixels);
}

TEST_F(Display, slow_gradients_are_dithered_and_whole_steps_are_not) {
    Image image;
    image.width = image.full_width = image.height = image.full_height = 64;
    image.channels = {"R", "G", "B"};
    // 100.3 and 200 steps of 255, and 7 of 65535.
    for (int k = 0; k < 64 * 64; ++k)
        image.pixels.insert(image.pixels.end(), {100.3f / 255, 200.0f / 255, 7.0f / 65535});
    image.metadata["relief:display"] = "raw";
    write_image(image, folder_ / "8.png");
    const Image bytes = read_image(folder_ / "8.png");
    double sum = 0;
    for (size_t k = 0; k < bytes.pixels.size(); k += 3) {
        const float steps = bytes.pixels[k] * 255;
        EXPECT_TRUE(std::fabs(steps - 100) < 0.01f || std::fabs(steps - 101) < 0.01f) << steps;
        EXPECT_NEAR(bytes.pixels[k + 1] * 255, 200, 0.01f);
        sum += steps;
    }
    EXPECT_NEAR(sum / (64 * 64), 100.3, 0.01) << "the mean is kept";
    image.metadata["relief:png_bits"] = "16";
    write_image(image, folder_ / "16.png");
    EXPECT_EQ(read_texture(folder_ / "16.png").source_type, SampleType::uint16);
    EXPECT_NEAR(read_image(folder_ / "16.png").pixels[0], 100.3f / 255, 1.1f / 65535);
    EXPECT_NEAR(read_image(folder_ / "16.png").pixels[2] * 65535, 7, 0.01f);
}

TEST_F(Display, automatic_exposure_puts_the_objects_in_the_middle) {
    // The third pixel is background.
    const Image image = make_image({0.72f, 0.72f, 0.72f, 1, 0.72f, 0.72f, 0.72f, 1, 90, 90, 90, 0});
    EXPECT_NEAR(find_exposure(image), -2, 1e-4f);
    EXPECT_NEAR(find_exposure(make_image({0.09f, 0.09f, 0.09f, 0})), 1, 1e-4f) << "nothing is hit";
    EXPECT_EQ(find_exposure(make_image({0, 0, 0, 1})), 0);
    Image shown = image;
    shown.metadata["relief:exposure"] = "auto";
    EXPECT_NEAR(read_display_settings(shown).factor, 0.25f, 1e-4f);
    shown.metadata["relief:exposure"] = "1.5";
    EXPECT_NEAR(read_display_settings(shown).factor, std::exp2(1.5f), 1e-4f);
    shown.metadata["relief:exposure"] = "much", shown.metadata["relief:display"] = "none";
    EXPECT_EQ(read_display_settings(shown).factor, 1);
}

TEST_F(Display, a_png_is_laid_over_its_background_or_transparent) {
    // Premultiplied: half covered by 0.5, and nothing at all.
    Image image = make_image({0.25f, 0.25f, 0.25f, 0.5f, 0, 0, 0, 0});
    image.metadata["relief:display"] = "standard";
    image.metadata["relief:background"] = "#ff0080";
    write_image(image, folder_ / "over.png");
    const Image over = read_image(folder_ / "over.png");
    ASSERT_EQ(over.channels.size(), 3u);
    const float half = 0.7353569f; // sRGB of 0.5
    EXPECT_NEAR(over.pixels[0], (half + 1) / 2, 0.004f);
    EXPECT_NEAR(over.pixels[1], half / 2, 0.004f);
    EXPECT_EQ(over.pixels[3], 1);
    EXPECT_EQ(over.pixels[4], 0);
    EXPECT_NEAR(over.pixels[5], 128 / 255.0f, 1e-5f);
    image.metadata["relief:background"] = "transparent";
    write_image(image, folder_ / "film.png");
    const Texture film = read_texture(folder_ / "film.png");
    ASSERT_EQ(film.channel_count, 4u);
    EXPECT_NEAR(film.floats[0], half, 0.004f) << "not premultiplied, as PNG has it";
    EXPECT_NEAR(film.floats[3], 0.5f, 0.004f);
    EXPECT_EQ(film.floats[7], 0);
}

} // namespace relief
