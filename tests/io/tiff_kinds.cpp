// TIFF files of many kinds of samples, sound and hostile ones, written tag by tag.
#include <array>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "io/test_files.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

enum Tag : int {
    kWidth = 256,
    kHeight,
    kBits,
    kCompression,
    kPhotometric = 262,
    kOffsets = 273,
    kSamples = 277,
    kRows,
    kByteCounts,
    kPlanar = 284,
    kPalette = 320,
    kTileWidth = 322,
    kTileHeight,
    kTileOffsets,
    kTileByteCounts,
    kFormat = 339,
    kSubsampling = 530
};

void append(std::string& bytes, uint32_t value, int count) {
    for (int k = 0; k < count; ++k) bytes.push_back(char(value >> 8 * k & 255));
}

/// Values of tags, and the bytes of the only strip or of all tiles.
struct TiffParts {
    std::map<int, std::vector<uint32_t>> tags;
    std::string pixels;
};

/// Returns a file of one directory with numbers of 16 bits (palette, subsampling) or 32 bits.
std::string make_tiff(TiffParts parts) {
    constexpr uint32_t kHeaderBytes = 8;
    const bool is_tiled = parts.tags.contains(kTileWidth);
    const size_t count = parts.tags[kPlanar] == std::vector<uint32_t>{2} ? parts.tags[kSamples][0] : 1;
    parts.tags[is_tiled ? kTileOffsets : kOffsets] = std::vector<uint32_t>(count, kHeaderBytes);
    parts.tags[is_tiled ? kTileByteCounts : kByteCounts] =
        std::vector<uint32_t>(count, uint32_t(parts.pixels.size()));
    if (!is_tiled) parts.tags.try_emplace(kRows, parts.tags[kHeight]);
    std::erase_if(parts.tags, [](const auto& tag) { return tag.second.empty(); });
    std::string bytes = "II", directory;
    append(bytes, 42, 2);
    std::string tail = parts.pixels;
    append(directory, uint32_t(parts.tags.size()), 2);
    for (const auto& [tag, values] : parts.tags) {
        const bool is_short = tag == kPalette || tag == kSubsampling;
        std::string all;
        for (const uint32_t value : values) append(all, value, is_short ? 2 : 4);
        append(directory, uint32_t(tag), 2), append(directory, is_short ? 3 : 4, 2);
        append(directory, uint32_t(values.size()), 4);
        if (all.size() > 4) {
            append(directory, uint32_t(kHeaderBytes + tail.size()), 4);
            tail += all;
        } else {
            all.resize(4);
            directory += all;
        }
    }
    append(bytes, uint32_t(kHeaderBytes + tail.size()), 4);
    return bytes + tail + directory + std::string(4, '\0');
}

TiffParts make_parts(uint32_t width, uint32_t photometric, uint32_t samples, uint32_t bits, uint32_t format,
                     const std::string& pixels) {
    return {{{kWidth, {width}},
             {kHeight, {1}},
             {kBits, {bits}},
             {kCompression, {1}},
             {kPhotometric, {photometric}},
             {kSamples, {samples}},
             {kPlanar, {1}},
             {kFormat, {format}}},
            pixels};
}

constexpr uint32_t kGrey = 1, kRgb = 2, kIndexed = 3, kInks = 5, kYCbCr = 6, kLogL = 32844, kLogLuv = 32845;
constexpr uint32_t kUnsigned = 1, kSigned = 2, kFloat = 3;

} // namespace

class TiffKinds : public FileTest {
  protected:
    Texture read(const TiffParts& parts) const { return read_texture(write("a.tif", make_tiff(parts))); }

    static std::array<float, 3> get_pixel(const Texture& texture, size_t x) {
        std::array<float, 3> pixel{};
        for (size_t c = 0; c < pixel.size(); ++c) pixel[c] = texture.floats[texture.find_texel(x, 0) + c];
        return pixel;
    }

    void expect_grey(const TiffParts& parts, const std::vector<float>& values) const {
        const Texture texture = read(parts);
        ASSERT_EQ(texture.width, values.size());
        for (size_t x = 0; x < values.size(); ++x)
            EXPECT_NEAR(texture.floats[texture.find_texel(x, 0)], values[x], 1e-6f) << x;
    }
};

TEST_F(TiffKinds, of_packed_bits_signs_and_doubles_have_their_values) {
    expect_grey(make_parts(2, kGrey, 1, 12, kUnsigned, "\xff\xf8\x01"), {1, 2049.0f / 4095});
    expect_grey(make_parts(2, kGrey, 1, 10, kUnsigned, std::string("\xff\xc0\x10", 3)), {1, 1.0f / 1023});
    expect_grey(make_parts(2, kGrey, 1, 24, kUnsigned, std::string("\xff\xff\xff\1\0\0", 6)),
                {1, 1.0f / 16777215});
    expect_grey(make_parts(3, kGrey, 1, 8, kSigned, std::string("\x80\0\x7f", 3)), {-1, 0, 1});
    expect_grey(make_parts(2, kGrey, 1, 16, kSigned, std::string("\1\x80\0\0", 4)), {-1, 0});
    const std::array<double, 2> doubles = {-2.5, 1e3};
    std::string bytes(sizeof(doubles), '\0');
    std::memcpy(bytes.data(), doubles.data(), bytes.size());
    expect_grey(make_parts(2, kGrey, 1, 64, kFloat, bytes), {-2.5f, 1e3f});
    const Texture small = read(make_parts(1, kRgb, 3, 4, kUnsigned, "\xf5\x0f"));
    EXPECT_EQ(get_pixel(small, 0), (std::array<float, 3>{1, 5.0f / 15, 0}));
}

TEST_F(TiffKinds, of_other_colours_become_rgb) {
    TiffParts palette = make_parts(2, kIndexed, 2, 8, kUnsigned, std::string("\0\x55\1\x55", 4));
    palette.tags[kPalette].assign(3 * 256, 0);
    palette.tags[kPalette][1] = palette.tags[kPalette][512] = 0xffff;
    EXPECT_EQ(get_pixel(read(palette), 0), (std::array<float, 3>{0, 0, 1}));
    EXPECT_EQ(get_pixel(read(palette), 1), (std::array<float, 3>{1, 0, 0}));
    TiffParts large = make_parts(2, kIndexed, 1, 16, kUnsigned, std::string("\1\xff\0\0", 4));
    large.tags[kPalette].assign(3 * 65536, 0);
    large.tags[kPalette][65536 + 0xff01] = 0xffff;
    EXPECT_EQ(get_pixel(read(large), 0), (std::array<float, 3>{0, 1, 0}));
    const TiffParts inks = make_parts(1, kInks, 4, 8, kUnsigned, std::string("\0\xff\x33\x33", 4));
    const std::array<float, 3> ink = get_pixel(read(inks), 0);
    EXPECT_NEAR(ink[0], 0.8f, 1e-6f);
    EXPECT_NEAR(ink[1], 0, 1e-6f);
    EXPECT_NEAR(ink[2], 0.64f, 1e-6f);
    TiffParts chroma = make_parts(1, kYCbCr, 3, 8, kUnsigned, "\x4c\x55\xff");
    chroma.tags[kSubsampling] = {1, 1};
    const std::array<float, 3> red = get_pixel(read(chroma), 0);
    EXPECT_GT(red[0], 0.99f);
    EXPECT_LT(red[1], 0.01f);
}

TEST_F(TiffKinds, of_logarithms_keep_values_above_one) {
    constexpr float kRadiance = 4; // 2^(0x4200 / 256 - 64)
    TiffParts grey = make_parts(1, kLogL, 1, 16, kSigned, std::string("\1\x42\1\0", 4));
    TiffParts colors =
        make_parts(1, kLogLuv, 3, 16, kSigned, std::string("\1\x42\1\0\1\x56\1\xc2", 8)); // white
    for (TiffParts* const parts : {&grey, &colors}) {
        parts->tags[kCompression] = {34676};
        const std::array<float, 3> pixel = get_pixel(read(*parts), 0);
        for (size_t c = 0; c < (parts == &grey ? 1 : 3); ++c) EXPECT_NEAR(pixel[c], kRadiance, 0.1f) << c;
    }
}

TEST_F(TiffKinds, that_are_not_read_are_named_with_a_way_out) {
    const std::string pixels(64, '\x7b');
    TiffParts palette = make_parts(4, kIndexed, 1, 16, kFloat, pixels);
    palette.tags[kPalette].assign(3 * 65536, 1000);
    const std::string message = message_of([&] { read(palette); });
    EXPECT_HAS(message, "a.tif");
    EXPECT_HAS(message, "palette, 16 bits, float");
    EXPECT_HAS(message, "save it as RGB or grey with 8, 16 or 32 bits per sample");
    EXPECT_HAS(message_of([&] { read(make_parts(1, kRgb, 3, 64, 6, pixels)); }), "complex");
    TiffParts wavelets = make_parts(4, kGrey, 1, 8, kUnsigned, pixels);
    wavelets.tags[kCompression] = {34712};
    EXPECT_HAS(message_of([&] { read(wavelets); }), "LZW or ZIP");
    EXPECT_HAS(message_of([&] { read_texture(write("b.tif", "II no picture at all")); }), "starts otherwise");
}

/// Each file is read, or refused with a message: a crash ends this program.
TEST_F(TiffKinds, of_hostile_headers_are_read_or_refused) {
    size_t read_count = 0, refused_count = 0;
    const std::string pixels = [] {
        std::string bytes;
        for (uint32_t k = 0; k < 4096; ++k) bytes.push_back(char(k * 2654435761u >> 24));
        return bytes;
    }();
    const auto try_file = [&](const std::string& bytes) {
        try {
            read_texture(write("h.tif", bytes));
            ++read_count;
        } catch (const Error& error) {
            EXPECT_HAS(std::string(error.what()), "h.tif");
            ++refused_count;
        }
    };
    uint32_t number = 0;
    for (const uint32_t bits : {1, 8, 12, 16, 32, 64})
        for (const uint32_t format : {0u, kUnsigned, kSigned, kFloat})
            for (const uint32_t photometric : {0u, kGrey, kRgb, kIndexed, kInks, kYCbCr, 8u, kLogL, kLogLuv})
                for (const uint32_t samples : {1, 2, 3, 9})
                    for (const uint32_t planar : {1, 2})
                        for (const bool is_tiled : {false, true}) {
                            constexpr std::array<uint32_t, 7> kCompressions = {1, 5, 1, 8, 7, 34676, 6};
                            constexpr std::array<uint32_t, 4> kSides = {1, 3, 16, 65};
                            constexpr std::array<uint32_t, 4> kTileSides = {16, 64, 1 << 20, 7};
                            if (++number % 3 != 0) continue; // a sample of all combinations
                            TiffParts parts =
                                make_parts(kSides[number % 4], photometric, samples, bits, format, pixels);
                            parts.tags[kHeight] = {kSides[number / 4 % 4]};
                            parts.tags[kPlanar] = {planar};
                            parts.tags[kCompression] = {kCompressions[number % 7]};
                            if (photometric == kIndexed && bits <= 8 && number % 5 > 0)
                                parts.tags[kPalette].assign(size_t(3) << bits, 1000);
                            if (is_tiled) {
                                parts.tags[kTileWidth] = {kTileSides[number / 3 % 4]};
                                parts.tags[kTileHeight] = {kTileSides[number / 5 % 4]};
                            }
                            if (number % 11 == 0) parts.pixels.resize(5);
                            try_file(make_tiff(parts));
                        }
    EXPECT_GT(read_count, 20u);
    EXPECT_GT(refused_count, 200u);
}

} // namespace relief
