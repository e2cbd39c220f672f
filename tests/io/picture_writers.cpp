// What the writers of pictures do where something is wrong with the picture or the machine.
#include <array>
#include <cmath>
#include <limits>
#include <new>

#include "io/image_output.h"
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

} // namespace relief
