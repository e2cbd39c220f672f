#include "viewer/display_table.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "common/texel_values.h"
#include "common/vectors.h"
#include "relief/io.h"

namespace relief::viewer {

using namespace vectors;

namespace {

/// Entries a side. They lie along powers of two, as eyes and films see light; entry 0 is black.
constexpr int kSide = 40;
constexpr float kLeastStop = -12, kMostStop = 7;

float get_entry_light(int index) {
    if (index == 0) return 0;
    return std::exp2(kLeastStop + (kMostStop - kLeastStop) * float(index - 1) / float(kSide - 2));
}

/// Place of a value between the entries.
float compute_place(float light) {
    const float least = get_entry_light(1);
    if (!(light > 0)) return 0;
    if (light < least) return light / least;
    const float stop = (std::log2(light) - kLeastStop) / (kMostStop - kLeastStop);
    return std::min(1 + stop * float(kSide - 2), float(kSide - 1));
}

/// The same by the first 16 bits of a float, 7 of which are of its mantissa: no logarithm a pixel.
float find_place(float light) {
    static const std::vector<float> places = [] {
        std::vector<float> table(1 << 15);
        for (uint32_t k = 0; k < table.size(); ++k)
            table[k] = compute_place(std::bit_cast<float>((k << 16) | 0x8000u));
        return table;
    }();
    if (!(light > 0)) return 0;
    return places[std::bit_cast<uint32_t>(std::min(light, std::numeric_limits<float>::max())) >> 16];
}

uint8_t encode_screen(float light) {
    const float x = clamp_to_unit(light);
    return round_to_byte(x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f);
}

/// Entries enough for bytes: no power function a pixel.
const std::array<uint8_t, 4097>& get_curve() {
    static const std::array<uint8_t, 4097> curve = [] {
        std::array<uint8_t, 4097> table{};
        // By the square root, so that dark values have entries enough.
        for (size_t k = 0; k < table.size(); ++k) {
            const float root = float(k) / 4096;
            table[k] = encode_screen(root * root);
        }
        return table;
    }();
    return curve;
}

Image make_all_colors(const std::string& name) {
    Image image;
    image.width = image.full_width = kSide * kSide;
    image.height = image.full_height = kSide;
    image.channels = {"R", "G", "B"};
    for (int b = 0; b < kSide; ++b)
        for (int g = 0; g < kSide; ++g)
            for (int r = 0; r < kSide; ++r)
                for (const int index : {r, g, b}) image.pixels.push_back(get_entry_light(index));
    image.metadata["relief:display"] = name;
    image.metadata["relief:png_bits"] = "16";
    return image;
}

/// Removes the file at the end of a scope.
struct TemporaryFile {
    std::filesystem::path file;
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
    }
};

} // namespace

DisplayTable::DisplayTable(const std::string& name) {
    static std::atomic<int> count{0};
    check_tone_map(name);
    const TemporaryFile table{std::filesystem::temp_directory_path() /
                              fmt::format("relief-display-{}-{}.png", getpid(), count++)};
    write_image(make_all_colors(name), table.file);
    const Texture texture = read_texture(table.file);
    entries_.reserve(size_t(texture.width) * texture.height);
    for (uint32_t y = 0; y < texture.height; ++y)
        for (uint32_t x = 0; x < texture.width; ++x) entries_.push_back(read_texel(texture, x, y));
}

void DisplayTable::show(const Vec3f& linear, uint8_t* bytes) const {
    const float light[] = {linear.x, linear.y, linear.z};
    if (entries_.empty()) {
        const std::array<uint8_t, 4097>& curve = get_curve();
        for (size_t c = 0; c < 3; ++c)
            bytes[c] = curve[size_t(std::sqrt(clamp_to_unit(light[c])) * 4096 + 0.5f)];
        return;
    }
    size_t base = 0, stride = 1;
    size_t steps[3];
    float shares[3];
    for (size_t c = 0; c < 3; ++c, stride *= kSide) {
        const float place = find_place(light[c]);
        const int entry = std::min(int(place), kSide - 2);
        shares[c] = place - float(entry);
        base += size_t(entry) * stride;
        steps[c] = stride;
    }
    Vec3f sum{};
    for (size_t corner = 0; corner < 8; ++corner) {
        float weight = 1;
        size_t at = base;
        for (size_t c = 0; c < 3; ++c) {
            const bool is_next = (corner >> c) & 1;
            weight *= is_next ? shares[c] : 1 - shares[c];
            if (is_next) at += steps[c];
        }
        sum = sum + entries_[at] * weight;
    }
    bytes[0] = round_to_byte(sum.x), bytes[1] = round_to_byte(sum.y), bytes[2] = round_to_byte(sum.z);
}

} // namespace relief::viewer
