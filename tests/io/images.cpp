#include <algorithm>
#include <csignal>
#include <iterator>
#include <limits>

#include <sys/resource.h>

#include "io/picture/display_transform.h"
#include "io/picture/image_input.h"
#include "io/same_pictures.h"
#include "io/test_files.h"
#include "relief/io.h"

namespace relief {

using ImageFiles = FileTest;

namespace {

Image make_image() {
    Image image;
    image.width = 3, image.height = 2, image.x0 = 4, image.y0 = 5, image.full_width = 16,
    image.full_height = 9;
    image.channels = {"R", "G", "B", "A", "depth.Z", "N.X", "id.I"};
    for (size_t i = 0; i < 6 * image.channels.size(); ++i) image.pixels.push_back(0.1f * float(i) - 0.3f);
    image.pixels[4] = std::numeric_limits<float>::infinity();
    image.metadata = {{"relief:seed", "7"}, {"relief:samples", "0:16"}, {"Software", "Relief 0.1"}};
    return image;
}

} // namespace

TEST_F(ImageFiles, exr_layers_windows_and_metadata_round_trip) {
    const Image image = make_image();
    write_image(image, folder_ / "a.exr");
    const Image read = read_image(folder_ / "a.exr");
    EXPECT_EQ(read.width, 3);
    EXPECT_EQ(read.height, 2);
    EXPECT_EQ(read.x0, 4);
    EXPECT_EQ(read.y0, 5);
    EXPECT_EQ(read.full_width, 16);
    EXPECT_EQ(read.full_height, 9);
    ASSERT_EQ(read.channels.size(), image.channels.size());
    for (size_t c = 0; c < image.channels.size(); ++c) {
        const auto found = std::find(read.channels.begin(), read.channels.end(), image.channels[c]);
        ASSERT_NE(found, read.channels.end()) << image.channels[c];
        for (size_t i = 0; i < 6; ++i)
            EXPECT_EQ(read.pixels[i * 7 + size_t(found - read.channels.begin())], image.pixels[i * 7 + c]);
    }
    for (const auto& [name, value] : image.metadata) EXPECT_EQ(read.metadata.at(name), value);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1)
        << "a temporary file is left";
}

TEST_F(ImageFiles, that_end_too_early_are_named_and_not_filled_in) {
    std::vector<uint8_t> noise(size_t(64) * 64 * 3);
    for (size_t k = 0; k < noise.size(); ++k) noise[k] = uint8_t(k * 2654435761u >> 13);
    for (const char* name : {"a.tif", "a.jpg", "a.png"}) {
        const std::filesystem::path file = write_pixels(name, 64, 64, 3, OIIO::TypeDesc::UINT8, noise);
        EXPECT_EQ(read_image(file).width, 64) << name;
        std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
        for (const std::string& message :
             {message_of([&] { read_image(file); }), message_of([&] { read_texture(file); })}) {
            EXPECT_NE(message.find(name), std::string::npos) << message;
            EXPECT_NE(message.find("damaged or incomplete"), std::string::npos) << message;
        }
    }
}

TEST_F(ImageFiles, jpeg_with_something_behind_its_picture_is_whole) {
    const std::vector<uint8_t> grey(size_t(32) * 32 * 3, 128);
    const std::filesystem::path file = write_pixels("a.jpg", 32, 32, 3, OIIO::TypeDesc::UINT8, grey);
    // As telephones put a film there, which may hold any markers.
    std::ofstream(file, std::ios::binary | std::ios::app) << "film\xff\xd8\xff\xda film";
    EXPECT_EQ(read_image(file).width, 32);
}

TEST_F(ImageFiles, png_is_tone_mapped_and_hdr_keeps_radiance) {
    Image image;
    image.width = 2, image.height = 1, image.channels = {"R", "G", "B"};
    image.pixels = {0, 0, 0, 4, 4, 4};
    write_image(image, folder_ / "a.png");
    const Image png = read_image(folder_ / "a.png");
    EXPECT_EQ(png.pixels[0], 0.0f);
    EXPECT_GT(png.pixels[3], 0.9f);
    EXPECT_NEAR(png.pixels[3], show_color({4, 4, 4}, {}).x, 0.003f);
    write_image(image, folder_ / "a.hdr");
    EXPECT_NEAR(read_image(folder_ / "a.hdr").pixels[3], 4.0f, 0.03f);
}

TEST_F(ImageFiles, written_rows_are_those_of_the_picture) {
    Image image;
    image.width = 300, image.height = 70, image.channels = {"G", "B", "R"};
    for (int i = 0; i < 300 * 70 * 3; ++i) // runs, and noise between them
        image.pixels.push_back(i % 600 < 250 ? 0.5f : float((i * 7919) % 1000) * 0.001f);
    write_image(image, folder_ / "a.hdr");
    write_image(image, folder_ / "a.png");
    const Image hdr = read_image(folder_ / "a.hdr"), png = read_image(folder_ / "a.png");
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Vec3f color{image.at(x, y, 2), image.at(x, y, 0), image.at(x, y, 1)};
            const float step = std::max({color.x, color.y, color.z}) / 128;
            ASSERT_NEAR(hdr.at(x, y, 0), color.x, step);
            ASSERT_NEAR(hdr.at(x, y, 1), color.y, step);
            ASSERT_NEAR(hdr.at(x, y, 2), color.z, step);
            const Vec3f shown = show_color(color, {}); // dithered to one of two steps
            ASSERT_NEAR(png.at(x, y, 0), shown.x, 1.001f / 255);
            ASSERT_NEAR(png.at(x, y, 1), shown.y, 1.001f / 255);
            ASSERT_NEAR(png.at(x, y, 2), shown.z, 1.001f / 255);
        }
}

TEST_F(ImageFiles, plain_exr_is_read_as_the_library_of_pictures_reads_it) {
    Image image = make_image();
    image.metadata["Copyright"] = "nobody";
    write_image(image, folder_ / "layers.exr");
    expect_read_as_by_the_module(folder_ / "layers.exr");
    image.channels = {"X", "Z", "Y", "A", "shape.B", "shape.R", "shape.G"};
    write_image(image, folder_ / "axes.exr");
    expect_read_as_by_the_module(folder_ / "axes.exr"); // mixed names: left to the library
    for (int channels = 1; channels <= 4; ++channels) {
        const std::vector<uint16_t> halves(size_t(channels) * 6, 0x3c01);
        expect_read_as_by_the_module(
            write_pixels<uint16_t>("h.exr", 3, 2, channels, OIIO::TypeDesc::HALF, halves));
        const std::vector<float> floats(size_t(channels) * 6, 0.3f);
        expect_read_as_by_the_module(
            write_pixels<float>("f.exr", 3, 2, channels, OIIO::TypeDesc::FLOAT, floats));
    }
    expect_read_as_by_the_module(write_pixels<uint32_t>("u.exr", 1, 1, 1, OIIO::TypeDesc::UINT32, {7}));
}

TEST_F(ImageFiles, texels_come_as_stored) {
    const Texture u8 = read_texture(
        write_pixels<uint8_t>("a.png", 2, 1, 4, OIIO::TypeDesc::UINT8, {255, 128, 0, 0, 10, 20, 30, 128}));
    EXPECT_EQ(u8.source_type, SampleType::uint8);
    const std::vector<int> bytes = {255, 128, 0, 0, 10, 20, 30, 128};
    ASSERT_EQ(u8.floats.size(), bytes.size());
    for (size_t i = 0; i < bytes.size(); ++i) EXPECT_FLOAT_EQ(u8.floats[i], float(bytes[i]) / 255);
    const Texture u16 =
        read_texture(write_pixels<uint16_t>("b.png", 2, 1, 1, OIIO::TypeDesc::UINT16, {32768, 65535}));
    EXPECT_EQ(u16.channel_count, 1u);
    EXPECT_EQ(u16.stride, 1u);
    EXPECT_EQ(u16.floats, (std::vector<float>{32768 / 65535.f, 1, 0, 0, 0}));
    const Texture tiff =
        read_texture(write_pixels<float>("c.tif", 1, 1, 3, OIIO::TypeDesc::FLOAT, {-0.25f, 3.5f, 1e-3f}));
    EXPECT_EQ(tiff.floats, (std::vector<float>{-0.25f, 3.5f, 1e-3f, 0}));
    const Texture half = read_texture(
        write_pixels<uint16_t>("d.exr", 1, 1, 3, OIIO::TypeDesc::HALF, {0x3c00, 0xc000, 0x0001}));
    EXPECT_EQ(half.source_type, SampleType::float16);
    EXPECT_EQ(half.halves, (std::vector<uint16_t>{0x3c00, 0xc000, 0x0001, 0}));
    EXPECT_TRUE(half.floats.empty());
}

TEST_F(ImageFiles, damaged_images_are_refused_with_their_names) {
    const auto whole =
        write_pixels<float>("w.exr", 64, 64, 3, OIIO::TypeDesc::FLOAT, std::vector<float>(64 * 64 * 3, 1.5f));
    std::ifstream stream(whole, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    EXPECT_HAS(message_of([&] { read_texture(write("t.exr", bytes.substr(0, bytes.size() / 2))); }), "t.exr");
    EXPECT_HAS(message_of([&] { read_texture(write("e.exr", "")); }), "e.exr");
    EXPECT_HAS(message_of([&] {
                   read_texture(write("z.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 0\n"));
               }),
               "z.hdr");
    EXPECT_HAS(message_of([&] {
                   read_texture(write("l.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n"));
               }),
               "l.hdr");
    // The first attribute, channels, claims 2 GiB: OpenEXR itself would allocate them.
    std::string long_header = bytes;
    const size_t size_at = long_header.find("chlist") + 7;
    ASSERT_LT(size_at, long_header.size());
    long_header.replace(size_at, 4, "\xff\xff\xff\x7f");
    for (const auto& message : {message_of([&] { read_texture(write("h.exr", long_header)); }),
                                message_of([&] { parse_texture(long_header, "h.exr"); })})
        EXPECT_HAS(message, "attribute 'channels' is longer than the file");
    const std::string long_chunk = std::string("\x89PNG\r\n\x1a\n") + "\x7f\xff\xff\xf0tEXt";
    EXPECT_HAS(message_of([&] { read_texture(write("c.png", long_chunk)); }), "ends within a chunk");
    EXPECT_HAS(message_of([&] { read_texture(write("a.txt", "x")); }), "unknown kind of image");
    EXPECT_HAS(message_of([&] { read_texture(write("text.png", "some text")); }),
               "is no EXR, TIFF, PNG, JPEG or HDR");
    EXPECT_EQ(parse_texture(bytes, "memory.exr").width, 64u);
}

TEST_F(ImageFiles, attributes_that_are_not_as_long_as_their_type_are_refused) {
    const auto whole =
        write_pixels<float>("w.exr", 4, 4, 3, OIIO::TypeDesc::FLOAT, std::vector<float>(4 * 4 * 3, 1.5f));
    std::ifstream stream(whole, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    const auto expect_refused = [&](const std::string& damaged, const std::string& attribute) {
        EXPECT_HAS(message_of([&] { parse_texture(damaged, "h.exr"); }), "attribute '" + attribute + "' is");
    };
    // A list of channels that ends early: OpenEXR would take its rest for attributes, of any length.
    std::string short_list = bytes;
    short_list[bytes.find("chlist") + 11] = 0;
    expect_refused(short_list, "channels");
    std::string long_number = bytes;
    const size_t at = bytes.find("pixelAspectRatio") + 17 + 6;
    ASSERT_EQ(bytes[at], 4);
    long_number[at] = 8;
    expect_refused(long_number, "pixelAspectRatio");
}

TEST_F(ImageFiles, unwritable_outputs_are_refused) {
    EXPECT_HAS(message_of([&] { check_writable(folder_ / "none" / "a.exr"); }, ErrorKind::failed),
               "does not exist");
    EXPECT_HAS(message_of([&] { check_writable(folder_ / "a.exf"); }, ErrorKind::usage),
               "did you mean '.exr'?");
    std::filesystem::create_directory(folder_ / "d.png");
    EXPECT_HAS(message_of([&] { write_image(make_image(), folder_ / "d.png"); }, ErrorKind::failed),
               "is a folder");
    EXPECT_NO_THROW(check_writable(folder_ / "a.png"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.png"));
}

TEST_F(ImageFiles, a_full_disk_is_noticed_and_leaves_nothing) {
    Image image;
    image.width = image.height = 128, image.channels = {"R", "G", "B"};
    for (int i = 0; i < 128 * 128 * 3; ++i) image.pixels.push_back(float((i * 7919) % 1000) * 0.00137f);
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit old_limit{};
    getrlimit(RLIMIT_FSIZE, &old_limit);
    for (const char* name : {"a.exr", "a.png", "a.hdr"}) {
        const rlimit limit{200, old_limit.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
        const std::string message =
            message_of([&] { write_image(image, folder_ / name); }, ErrorKind::failed);
        setrlimit(RLIMIT_FSIZE, &old_limit);
        EXPECT_HAS(message, name);
        EXPECT_TRUE(std::filesystem::is_empty(folder_)) << name;
    }
}

} // namespace relief
