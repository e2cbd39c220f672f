// What the writers of pictures do where something is wrong with the picture or the machine.
#include <array>
#include <cmath>
#include <limits>
#include <new>

#include "formulas/tonemap.h"
#include "io/picture/image_output.h"
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
    write_image(image, folder_ / "a.png");
    EXPECT_GT(std::filesystem::file_size(folder_ / "a.png"), size_t(2) << 16);
    const Image read = read_image(folder_ / "a.png");
    ASSERT_EQ(read.pixels.size(), image.pixels.size());
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
        const Vec3f shown =
            scalar::tone_map_filmic({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
        ASSERT_NEAR(read.pixels[i], scalar::encode_srgb(shown.x), 0.6f / 255);
        ASSERT_NEAR(read.pixels[i + 1], scalar::encode_srgb(shown.y), 0.6f / 255);
        ASSERT_NEAR(read.pixels[i + 2], scalar::encode_srgb(shown.z), 0.6f / 255);
    }
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
