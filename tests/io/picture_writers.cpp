// What the writers of pictures do where something is wrong with the picture or the machine.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <new>
#include <stdexcept>

#include "io/picture/display_transform.h"
#include "io/picture/image_coders.h"
#include "io/picture/image_output.h"
#include "io/same_pictures.h"
#include "io/test_files.h"
#include "relief/io.h"

namespace relief {

using PictureWriters = FileTest;

TEST_F(PictureWriters, too_little_memory_is_not_a_fault_of_the_disk_and_leaves_nothing) {
    const auto encode = [](CheckedFile& file) {
        file.write("begun", 5);
        throw std::bad_alloc();
    };
    EXPECT_THROW(write_checked(folder_ / "a.exr", encode), std::bad_alloc);
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(PictureWriters, metadata_that_is_the_headers_own_is_left_out) {
    Image image;
    image.width = 2, image.height = 1, image.channels = {"R"}, image.pixels = {1, 2};
    for (const char* name : {"",
                             "name",
                             "type",
                             "view",
                             "version",
                             "channels",
                             "compression",
                             "dataWindow",
                             "displayWindow",
                             "lineOrder",
                             "pixelAspectRatio",
                             "screenWindowCenter",
                             "screenWindowWidth",
                             "chunkCount",
                             "tiles",
                             "chromaticities",
                             "whiteLuminance",
                             "preview",
                             "multiView",
                             "maxSamplesPerPixel",
                             "envmap",
                             "dwaCompressionLevel",
                             "timeCode",
                             "keyCode",
                             "framesPerSecond"})
        image.metadata[name] = "a text";
    image.metadata["owner"] = "second", image.metadata["Copyright"] = "first";
    image.metadata["kept"] = "yes";
    write_image(image, folder_ / "a.exr");
    const Image read = read_image(folder_ / "a.exr");
    EXPECT_EQ(read.pixels, image.pixels);
    EXPECT_EQ(read.metadata.at("kept"), "yes");
    EXPECT_EQ(read.metadata.at("Copyright"), "first");
    for (const char* name : {"", "name", "type", "channels", "compression", "lineOrder", "pixelAspectRatio"})
        EXPECT_FALSE(read.metadata.contains(name)) << name;
}

TEST_F(PictureWriters, metadata_of_a_megabyte_and_of_any_characters_is_kept) {
    Image image;
    image.width = 2, image.height = 1, image.channels = {"R"}, image.pixels = {1, 2};
    std::string manifest = "{";
    for (int k = 0; manifest.size() < 1 << 20; ++k)
        manifest += "\"\u03b4\xcf\x80 " + std::to_string(k) + "\":\"13851a76\",";
    image.metadata["cryptomatte/3ae39a5/manifest"] = manifest;
    write_image(image, folder_ / "a.exr");
    EXPECT_TRUE(read_image(folder_ / "a.exr").metadata.at("cryptomatte/3ae39a5/manifest") == manifest);
    expect_read_as_by_the_module(folder_ / "a.exr");
}

TEST_F(PictureWriters, radiance_beyond_rgbe_is_stored_as_the_nearest_that_it_holds) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = NAN;
    constexpr float kLargest = 0x1.fep126f;
    const std::vector<std::array<float, 6>> cases = {
        // written, read
        {0x1p127f, 0x1p126f, 0, kLargest, 0x1p126f, 0},
        {std::numeric_limits<float>::max(), 1, -1, kLargest, 0, 0},
        {kInfinity, kInfinity, 2, kLargest, kLargest, 0},
        {2, kInfinity, -kInfinity, 0, kLargest, 0},
        {kNan, 2, 1, 0, 2, 1},
        {1, kNan, 2, 1, 0, 2},
        {2, 1, kNan, 2, 1, 0},
        {kNan, kNan, kNan, 0, 0, 0},
        {1e-38f, 0, 0, 0, 0, 0},
    };
    Image image;
    image.width = int(cases.size()), image.height = 1, image.channels = {"R", "G", "B"};
    for (const auto& values : cases)
        image.pixels.insert(image.pixels.end(), values.begin(), values.begin() + 3);
    write_image(image, folder_ / "a.hdr");
    const Image read = read_image(folder_ / "a.hdr");
    for (size_t i = 0; i < cases.size(); ++i)
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(read.pixels[3 * i + c], cases[i][3 + c], cases[i][3 + c] / 127) << i << ", " << c;
}

TEST_F(PictureWriters, png_of_several_chunks_is_whole) {
    Image image;
    image.width = 300, image.height = 200, image.channels = {"R", "G", "B"};
    for (unsigned i = 0; i < 300 * 200 * 3; ++i) // noise, which no coding makes shorter
        image.pixels.push_back(float(((i * 2654435761u) ^ (i * i * 40503u)) >> 8 & 0xffff) / 0xffff);
    constexpr float kStep = 1.001f / 255; // values are dithered
    write_image(image, folder_ / "a.png");
    EXPECT_GT(std::filesystem::file_size(folder_ / "a.png"), size_t(2) << 16);
    const Image read = read_image(folder_ / "a.png");
    ASSERT_EQ(read.pixels.size(), image.pixels.size());
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
        const Vec3f shown = show_color({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]}, {});
        ASSERT_NEAR(read.pixels[i], shown.x, kStep);
        ASSERT_NEAR(read.pixels[i + 1], shown.y, kStep);
        ASSERT_NEAR(read.pixels[i + 2], shown.z, kStep);
    }
}

/// The chunks of a PNG before its pixels: each kind with its content.
std::map<std::string, std::string> read_png_tags(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    std::map<std::string, std::string> tags;
    for (size_t at = 8; at + 12 <= bytes.size() && bytes.compare(at + 4, 4, "IDAT") != 0;) {
        size_t size = 0;
        for (size_t k = 0; k < 4; ++k) size = size << 8 | uint8_t(bytes[at + k]);
        tags[bytes.substr(at + 4, 4)] = bytes.substr(at + 8, size);
        at += 12 + size;
    }
    return tags;
}

TEST_F(PictureWriters, png_is_tagged_as_srgb_and_data_is_not) {
    const auto fill_row = [](int y, std::vector<uint8_t>& row) {
        for (size_t k = 0; k < row.size(); ++k) row[k] = uint8_t(size_t(y) * 16 + k);
    };
    write_checked(folder_ / "shown.png",
                  [&](CheckedFile& file) { encode_png(2, 3, PngKind{}, fill_row, file); });
    const auto tags = read_png_tags(folder_ / "shown.png");
    ASSERT_EQ(tags.size(), 3u);
    EXPECT_EQ(tags.at("IHDR"), std::string("\0\0\0\2\0\0\0\3\10\2\0\0\0", 13));
    EXPECT_EQ(tags.at("sRGB"), std::string(1, '\0'));
    EXPECT_EQ(tags.at("gAMA"), std::string("\x00\x00\xb1\x8f", 4));
    write_checked(folder_ / "data.png", [&](CheckedFile& file) {
        encode_png(2, 3, {.bits = 16, .meaning = PngMeaning::data}, fill_row, file);
    });
    const auto data_tags = read_png_tags(folder_ / "data.png");
    ASSERT_EQ(data_tags.size(), 1u);
    EXPECT_EQ(data_tags.at("IHDR"), std::string("\0\0\0\2\0\0\0\3\20\2\0\0\0", 13));
    const Texture data = read_texture(folder_ / "data.png");
    ASSERT_EQ(data.floats.size(), data.value_count());
    EXPECT_FLOAT_EQ(data.floats[data.find_texel(0, 1) + 1], float((16 + 2) * 256 + 16 + 3) / 65535);
}

TEST_F(PictureWriters, png_of_several_blocks_of_rows_has_each_row_in_its_place) {
    constexpr int kWidth = 1000, kHeight = 800; // 2.4 megabytes
    const auto find_byte = [](int y, size_t k) { return uint8_t((uint32_t(y) * 40503u + k * 2531u) >> 7); };
    const auto fill_row = [&](int y, std::vector<uint8_t>& row) {
        for (size_t k = 0; k < row.size(); ++k) row[k] = find_byte(y, k);
    };
    for (const PngMeaning meaning : {PngMeaning::srgb, PngMeaning::data}) {
        write_checked(folder_ / "a.png", [&](CheckedFile& file) {
            encode_png(kWidth, kHeight, {.meaning = meaning}, fill_row, file);
        });
        const Image read = read_image(folder_ / "a.png");
        ASSERT_EQ(read.pixels.size(), size_t(3) * kWidth * kHeight);
        size_t wrong = 0;
        for (int y = 0; y < kHeight; ++y)
            for (size_t k = 0; k < 3 * kWidth; ++k) {
                const float value = read.pixels[size_t(y) * 3 * kWidth + k] * 255;
                wrong += uint8_t(std::lround(value)) != find_byte(y, k);
            }
        EXPECT_EQ(wrong, 0u) << "meaning " << int(meaning);
    }
}

TEST_F(PictureWriters, png_may_be_wider_than_the_default_limit_of_libpng) {
    const auto fill_row = [](int, std::vector<uint8_t>& row) { std::fill(row.begin(), row.end(), 7); };
    write_checked(folder_ / "a.png",
                  [&](CheckedFile& file) { encode_png(1000001, 1, PngKind{}, fill_row, file); });
    EXPECT_EQ(read_png_tags(folder_ / "a.png").at("IHDR").substr(0, 4), std::string("\x00\x0f\x42\x41", 4));
}

TEST_F(PictureWriters, a_png_that_fails_on_the_way_is_an_error_and_leaves_nothing) {
    const auto write_png = [&](int width, int rows_that_work) {
        write_checked(folder_ / "a.png", [&](CheckedFile& file) {
            const auto fill_row = [&](int y, std::vector<uint8_t>&) {
                if (y >= rows_that_work) throw std::runtime_error("no more rows");
            };
            encode_png(width, 8, PngKind{}, fill_row, file);
        });
    };
    EXPECT_HAS(message_of([&] { write_png(0, 8); }, ErrorKind::failed), "a.png: cannot be written: ");
    EXPECT_HAS(message_of([&] { write_png(4, 5); }, ErrorKind::failed), "no more rows");
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
    write_png(4, 8);
    EXPECT_EQ(read_image(folder_ / "a.png").height, 8);
}

TEST_F(PictureWriters, hdr_rows_of_any_runs_are_whole) {
    for (const int width : {7, 8, 127, 128, 129, 131, 254, 255, 259, 700}) {
        Image image;
        image.width = width, image.height = 4, image.channels = {"R", "G", "B"};
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < width; ++x) { // a run of all; none; short ones; a run after others
                const int value = y == 0    ? 100
                                  : y == 1  ? 128 + x % 2
                                  : y == 2  ? 130 + x / 3 % 90
                                  : x < 130 ? x
                                            : 9;
                const float red = float(value) / 256;
                image.pixels.insert(image.pixels.end(), {red, 0.5f, 0.5f});
            }
        write_image(image, folder_ / "a.hdr");
        const Image read = read_image(folder_ / "a.hdr");
        ASSERT_EQ(read.pixels.size(), image.pixels.size());
        for (size_t i = 0; i < image.pixels.size(); ++i)
            ASSERT_NEAR(read.pixels[i], image.pixels[i], 1.01f / 256) << width << ", " << i;
    }
}

} // namespace relief
