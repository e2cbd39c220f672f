// Pictures from the sums that renders of their tiles and ranges of samples wrote.
#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "relief/error.h"
#include "relief/render.h"
#include "support/saved_film.h"
#include "support/session_scenes.h"

namespace relief {

namespace {

using test::make_rough_torus, test::render_film;

constexpr int kWidth = 40, kHeight = 30;

RenderSettings make_part_settings(int first, int last, const Window& window) {
    RenderSettings settings;
    settings.image.width = kWidth, settings.image.height = kHeight;
    settings.image.first_sample = first, settings.image.spp = last - first;
    settings.image.crop = window;
    settings.image.bounces = 1;
    settings.surface.pixel_error = 3;
    settings.image.layers = {"depth", "N", "N_camera", "P", "id", "samples", "CryptoObject"};
    return settings;
}

FilmPart make_film_part(const std::string& bytes, const std::string& name, int first, const Window& window) {
    return {name, [bytes] { return std::make_unique<std::istringstream>(bytes); }, window, first};
}

/// Four parts: two bands, two ranges.
std::vector<FilmPart> render_parts() {
    std::vector<FilmPart> parts;
    for (const auto& [first, last] : {std::pair(5, 12), std::pair(0, 5)})
        for (const Window& window : {Window{0, 0, kWidth, 13}, Window{0, 13, kWidth, kHeight}})
            parts.push_back(make_film_part(
                render_film(make_rough_torus(), make_part_settings(first, last, window)),
                "rows " + std::to_string(window.y0) + " from " + std::to_string(first), first, window));
    return parts;
}

RenderResult join(std::vector<FilmPart> parts, int spp) {
    Checkpoints checkpoints;
    checkpoints.parts = std::move(parts);
    return render(make_rough_torus(), make_part_settings(0, spp, {}), nullptr, checkpoints);
}

std::string find_refusal(std::vector<FilmPart> parts) {
    try {
        join(std::move(parts), 12);
        return "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        return error.what();
    }
}

} // namespace

TEST(FilmParts, join_to_the_bits_of_one_render_without_a_ray) {
    const RenderResult whole = render(make_rough_torus(), make_part_settings(0, 12, {}));
    const RenderResult joined = join(render_parts(), 12);
    EXPECT_EQ(joined.image.pixels, whole.image.pixels);
    EXPECT_EQ(joined.image.metadata, whole.image.metadata);
    EXPECT_EQ(joined.statistics.camera_rays, 0u);
    EXPECT_EQ(joined.whole_samples, 12);
}

TEST(FilmParts, that_leave_samples_out_are_rendered_to_the_end) {
    const RenderResult whole = render(make_rough_torus(), make_part_settings(0, 16, {}));
    const RenderResult joined = join(render_parts(), 16);
    EXPECT_EQ(joined.image.pixels, whole.image.pixels);
    EXPECT_EQ(joined.statistics.camera_rays, uint64_t(kWidth) * kHeight * 4);
}

TEST(FilmParts, are_refused_by_name) {
    const std::vector<FilmPart> parts = render_parts();
    EXPECT_EQ(find_refusal({parts[0], parts[2], parts[3]}), "accepted") << "its band is rendered";
    EXPECT_NE(find_refusal({parts[0], parts[1], parts[3]}).find("rows 0 from 5: its samples of pixel (0, 0)"),
              std::string::npos);
    std::vector<FilmPart> twice = parts;
    twice.push_back(parts[2]);
    EXPECT_NE(find_refusal(twice).find("rows 0 from 0: "), std::string::npos);
    std::string bytes = render_film(make_rough_torus(), make_part_settings(0, 5, {0, 0, kWidth, 13}));
    bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 1);
    std::vector<FilmPart> damaged = parts;
    damaged[2] = make_film_part(bytes, "the damaged one", 0, {0, 0, kWidth, 13});
    EXPECT_NE(find_refusal(damaged).find("the damaged one: the sums of samples are damaged"),
              std::string::npos);
    damaged[2].open = [] { return std::unique_ptr<std::istream>(); };
    EXPECT_NE(find_refusal(damaged).find("the damaged one: it cannot be read"), std::string::npos);
}

} // namespace relief
