// What the writers of pictures do where something is wrong with the picture or the machine.
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

} // namespace relief
