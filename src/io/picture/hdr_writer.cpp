// Ward, "Real Pixels", Graphics Gems II (1991), and the file format of Radiance.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "io/picture/image_coders.h"

namespace relief {

namespace {

using Rgbe = std::array<uint8_t, 4>;

/// What RGBE can hold: no NaN, nothing negative, and no more than the largest mantissa and exponent.
float clamp_to_rgbe(float value) {
    constexpr float kLargest = 0x1.fep126f;           // 255 / 256 * 2^127
    return value > 0 ? std::min(value, kLargest) : 0; // false for NaN
}

Rgbe encode_color(const Vec3f& color) {
    constexpr float kLeast = 1e-32f;
    const Vec3f held{clamp_to_rgbe(color.x), clamp_to_rgbe(color.y), clamp_to_rgbe(color.z)};
    const float brightest = std::max({held.x, held.y, held.z});
    if (brightest < kLeast) return {};
    int exponent = 0;
    const float scale = std::frexp(brightest, &exponent) * 256 / brightest;
    const auto encode = [&](float value) { return uint8_t(std::min(value * scale, 255.0f)); };
    return {encode(held.x), encode(held.y), encode(held.z), uint8_t(exponent + 128)};
}

/// One component of a row: runs of equal bytes, and of others.
void append_runs(const std::vector<Rgbe>& row, size_t component, std::vector<uint8_t>& bytes) {
    constexpr size_t kLeastRun = 4, kLongestRun = 127, kLongestOther = 128;
    const auto count_equal = [&](size_t begin) {
        size_t end = begin + 1;
        while (end < row.size() && end - begin < kLongestRun && row[end][component] == row[begin][component])
            ++end;
        return end - begin;
    };
    for (size_t x = 0; x < row.size();) {
        if (const size_t run = count_equal(x); run >= kLeastRun) {
            bytes.insert(bytes.end(), {uint8_t(128 + run), row[x][component]});
            x += run;
            continue;
        }
        const size_t begin = x++;
        while (x < row.size() && x - begin < kLongestOther && count_equal(x) < kLeastRun) ++x;
        bytes.push_back(uint8_t(x - begin));
        for (size_t k = begin; k < x; ++k) bytes.push_back(row[k][component]);
    }
}

} // namespace

void encode_hdr(int width, int height, const FillRow<Vec3f>& fill_row, CheckedFile& file) {
    constexpr int kNarrowest = 8, kWidest = 0x7fff; // of rows with run lengths
    const std::string header =
        fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", height, width);
    file.write(header.data(), header.size());
    std::vector<Vec3f> colors(static_cast<size_t>(width));
    std::vector<Rgbe> row(colors.size());
    std::vector<uint8_t> bytes;
    for (int y = 0; y < height; ++y) {
        fill_row(y, colors);
        std::transform(colors.begin(), colors.end(), row.begin(), encode_color);
        if (width < kNarrowest || width > kWidest) {
            file.write(row.data(), row.size() * sizeof(Rgbe));
            continue;
        }
        bytes = {2, 2, uint8_t(width >> 8), uint8_t(width)};
        for (size_t component = 0; component < 4; ++component) append_runs(row, component, bytes);
        file.write(bytes.data(), bytes.size());
    }
}

} // namespace relief
