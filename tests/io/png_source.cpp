// PNG files read by libpng alone are as OpenImageIO reads them.
#include <cstdint>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "io/picture/picture_library.h"
#include "io/picture/png_source.h"
#include "io/source_values.h"
#include "io/test_files.h"

namespace relief {

using PngSources = FileTest;

namespace {

std::unique_ptr<PixelSource> open_file(const std::filesystem::path& file) {
    PictureRemarks remarks;
    return open_png(std::make_unique<std::ifstream>(file, std::ios::binary), file.string(), remarks);
}

template <class T> std::vector<T> make_noise(size_t count) {
    std::vector<T> values(count);
    for (size_t k = 0; k < count; ++k) values[k] = T(k * 2654435761u >> 7);
    return values;
}

} // namespace

TEST_F(PngSources, have_the_values_of_the_library_of_pictures) {
    std::vector<std::filesystem::path> files;
    for (int channels = 1; channels <= 4; ++channels) {
        const std::string name = std::to_string(channels);
        files.push_back(write_pixels<uint8_t>("a" + name + ".png", 7, 5, channels, OIIO::TypeDesc::UINT8,
                                              make_noise<uint8_t>(size_t(35) * size_t(channels))));
        files.push_back(write_pixels<uint16_t>("b" + name + ".png", 7, 5, channels, OIIO::TypeDesc::UINT16,
                                               make_noise<uint16_t>(size_t(35) * size_t(channels))));
    }
    for (const std::filesystem::path& file : files) {
        const auto own = open_file(file), other = get_picture_library("test").open_file(file.string());
        ASSERT_TRUE(own) << file;
        EXPECT_EQ(own->header().channels, other->header().channels) << file;
        EXPECT_EQ(own->header().type, other->header().type) << file;
        EXPECT_EQ(own->header().width, 7);
        EXPECT_EQ(own->header().height, 5);
        EXPECT_EQ(read_all(*own), read_all(*other)) << file;
    }
}

TEST_F(PngSources, that_are_cut_or_no_png_are_told) {
    const auto file = write_pixels<uint8_t>("a.png", 64, 64, 3, OIIO::TypeDesc::UINT8,
                                            make_noise<uint8_t>(size_t(64) * 64 * 3));
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
    const std::string message = message_of([&] { read_all(*open_file(file)); });
    EXPECT_NE(message.find("a.png"), std::string::npos) << message;
    EXPECT_NE(message.find("damaged or incomplete"), std::string::npos) << message;
    PictureRemarks remarks;
    EXPECT_EQ(open_png(std::make_unique<std::istringstream>("GIF89a, and more"), "b.gif", remarks), nullptr);
}

} // namespace relief
