// Colours alone on their way from the device into a film, beside all sums.
#include <cstring>

#include <gtest/gtest.h>

#include "vulkan/film_reader.h"
#include "vulkan/gpu_fixture.h"
#include "vulkan/layout/bindings.h"

namespace relief::vulkan::tests {

namespace {

constexpr int kWidth = 37, kHeight = 5;
constexpr uint32_t kPixelCount = kWidth * kHeight;

/// Every word has a value of its own.
std::vector<scalar::FilmSumsData> make_sums() {
    std::vector<scalar::FilmSumsData> sums(kPixelCount);
    for (uint32_t k = 0; k < kPixelCount; ++k) {
        std::array<float, scalar::kFilmSumsWords> words;
        for (uint32_t w = 0; w < words.size(); ++w) words[w] = float(k * words.size() + w) / 64;
        std::memcpy(&sums[k], words.data(), sizeof(words));
        sums[k].hit_count = float(k % 3), sums[k].light_count = float(k % 2);
        sums[k].id = k % 3 > 0 ? k : 0;
    }
    return sums;
}

std::vector<uint32_t> list_pixels() {
    std::vector<uint32_t> pixels;
    for (uint32_t k = 0; k < kPixelCount; ++k) pixels.push_back(scalar::pack_pixel(k % kWidth, k / kWidth));
    return pixels;
}

class FilmReaderTest : public GpuTest {
  protected:
    BindingTable bindings_{device()};
    vulkan::Commands commands_{device(), bindings_};
    Buffer sums_{device(), {.name = "sums", .bytes = kPixelCount * sizeof(scalar::FilmSumsData)}};
    Buffer scratch_{device(), {.name = "scratch", .bytes = kPixelCount * sizeof(scalar::FilmColorsData)}};
    const FilmReader reader_{device()};

    void SetUp() override {
        sums_.upload(make_sums());
        bindings_.bind(scalar::kBindFilm, sums_);
        bindings_.bind(scalar::kBindPoints, scratch_);
    }

    /// The picture with the layers, by what pack() chose, and by all sums.
    void expect_equal_pictures(const std::vector<std::string>& layers, bool is_packed) {
        Film packed(kWidth, kHeight, {}, layers), whole(kWidth, kHeight, {}, layers);
        const std::vector<uint32_t> pixels = list_pixels();
        const FilmBatch batch{.pixels = pixels, .sample_count = 4};
        const BatchSums chosen = reader_.pack(commands_, packed, sums_, scratch_, kPixelCount);
        commands_.run();
        EXPECT_EQ(chosen.has_colors_alone, is_packed);
        EXPECT_EQ(chosen.buffer, is_packed ? &scratch_ : &sums_);
        FilmReader::add(packed, chosen, batch);
        FilmReader::add(whole, {&sums_}, batch);
        EXPECT_EQ(packed.resolve().pixels, whole.resolve().pixels);
    }
};

TEST_F(FilmReaderTest, brings_the_picture_of_all_sums_by_colours_alone) {
    expect_equal_pictures({"samples", "variance", "cost"}, true);
}

TEST_F(FilmReaderTest, brings_all_sums_where_a_layer_needs_them) {
    expect_equal_pictures({"variance", "N", "albedo", "id"}, false);
}

} // namespace

} // namespace relief::vulkan::tests
