// Relief reads HDR, TIFF, JPEG and PNG files as OpenImageIO does, with their orientations and windows.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <jpeglib.h>

#include "io/file_system.h"
#include "io/picture/exif_orientation.h"
#include "io/picture/hdr_source.h"
#include "io/picture/image_input.h"
#include "io/picture/jpeg_source.h"
#include "io/picture/picture_library.h"
#include "io/picture/tiff_source.h"
#include "io/png_bytes.h"
#include "io/source_values.h"
#include "io/test_files.h"
#include "relief/io.h"

namespace relief {

namespace {

constexpr int kColumns = 37, kRows = 21;

std::unique_ptr<PixelSource> open_own(const std::filesystem::path& file, PictureRemarks& remarks) {
    for (const auto& open : {open_hdr, open_tiff, open_jpeg})
        if (auto source =
                open(std::make_unique<std::ifstream>(file, std::ios::binary), file.string(), remarks))
            return source;
    return nullptr;
}

} // namespace

class OwnPictures : public FileTest {
  protected:
    std::filesystem::path write_picture(const std::string& name, int channels, OIIO::TypeDesc type,
                                        const std::function<void(OIIO::ImageSpec&)>& change = {},
                                        int width = kColumns, int height = kRows) const {
        std::vector<float> values(size_t(width) * size_t(height) * size_t(channels));
        for (size_t k = 0; k < values.size(); ++k) values[k] = float((k * 31) % 101) / 100;
        const std::filesystem::path file = folder_ / name;
        auto output = OIIO::ImageOutput::create(file.string());
        OIIO::ImageSpec spec(width, height, channels, type);
        spec.attribute("oiio:UnassociatedAlpha", 1);
        if (change) change(spec);
        EXPECT_TRUE(output->open(file.string(), spec)) << output->geterror();
        EXPECT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data())) << output->geterror();
        EXPECT_TRUE(output->close());
        return file;
    }

    static void expect_as_by_the_module(const std::filesystem::path& file) {
        SCOPED_TRACE(file.filename());
        PictureRemarks remarks;
        const auto own = open_own(file, remarks);
        ASSERT_TRUE(own);
        const auto other = get_picture_library("test").open_file(file.string());
        EXPECT_EQ(own->header().width, other->header().width);
        EXPECT_EQ(own->header().height, other->header().height);
        EXPECT_EQ(own->header().type, other->header().type);
        ASSERT_EQ(own->header().channels.size(), other->header().channels.size());
        const std::vector<float> a = read_all(*own), b = read_all(*other);
        for (size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(a[k], b[k], 1e-6f) << k;
        EXPECT_EQ(read_all(*own), a) << "a second time";
        EXPECT_EQ(read_texture(file).width, uint32_t(own->header().width));
    }
};

TEST_F(OwnPictures, tiff_of_all_types_and_layouts_is_read_as_by_the_module) {
    int number = 0;
    for (const OIIO::TypeDesc type : {OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16, OIIO::TypeDesc::UINT32,
                                      OIIO::TypeDesc::HALF, OIIO::TypeDesc::FLOAT})
        for (const int channels : {1, 3, 4})
            for (const char* const compression : {"none", "zip", "lzw"})
                for (const bool is_tiled : {false, true})
                    for (const char* const planar : {"contig", "separate"}) {
                        const std::filesystem::path file =
                            write_picture("t" + std::to_string(number++) + ".tif", channels, type,
                                          [&](OIIO::ImageSpec& spec) {
                                              spec.attribute("compression", compression);
                                              spec.attribute("planarconfig", planar);
                                              if (is_tiled) spec.tile_width = spec.tile_height = 16;
                                          });
                        expect_as_by_the_module(file);
                        if (HasFatalFailure()) return;
                    }
}

TEST_F(OwnPictures, tiff_of_few_bits_and_of_either_byte_order_is_read_as_by_the_module) {
    for (const int bits : {1, 2, 4})
        expect_as_by_the_module(
            write_picture("b" + std::to_string(bits) + ".tif", 1, OIIO::TypeDesc::UINT8,
                          [&](OIIO::ImageSpec& spec) { spec.attribute("oiio:BitsPerSample", bits); }));
    expect_as_by_the_module(write_picture("big.tif", 3, OIIO::TypeDesc::UINT16,
                                          [](OIIO::ImageSpec& spec) { spec.attribute("tiff:bigtiff", 1); }));
}

TEST_F(OwnPictures, tiff_of_jpeg_tiles_has_colours_and_no_chroma) {
    const std::filesystem::path file = folder_ / "jpeg.tif";
    std::vector<float> values;
    for (int k = 0; k < 64 * 64; ++k) values.insert(values.end(), {0.8f, 0.4f, 0.2f});
    auto output = OIIO::ImageOutput::create(file.string());
    OIIO::ImageSpec spec(64, 64, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("compression", "jpeg");
    ASSERT_TRUE(output->open(file.string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close());
    const Texture texture = read_texture(file);
    for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(texture.floats[texture.find_texel(30, 20) + c], values[c], 0.03f) << c;
}

TEST_F(OwnPictures, hdr_is_read_as_by_the_module) {
    expect_as_by_the_module(write_picture("a.hdr", 3, OIIO::TypeDesc::FLOAT));
    // Too narrow for runs.
    expect_as_by_the_module(write_picture("narrow.hdr", 3, OIIO::TypeDesc::FLOAT, {}, 5, 3));
    Image image;
    image.width = image.full_width = 40, image.height = image.full_height = 2;
    image.channels = {"R", "G", "B"};
    for (int k = 0; k < 240; ++k) image.pixels.push_back(k < 120 ? 2.5f : float(k) * 100);
    write_image(image, folder_ / "own.hdr");
    expect_as_by_the_module(folder_ / "own.hdr");
}

TEST_F(OwnPictures, hdr_with_repeated_pixels_and_other_scan_lines_is_read) {
    const auto pixel = [](int r, int g, int b, int e) {
        return std::string{char(r), char(g), char(b), char(e)};
    };
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    const Texture runs =
        read_texture(write("runs.hdr", header + "-Y 1 +X 4\n" + pixel(128, 0, 64, 129) + pixel(1, 1, 1, 3)));
    for (size_t x = 0; x < 4; ++x) {
        EXPECT_EQ(runs.floats[3 * x], 1.0f);
        EXPECT_EQ(runs.floats[3 * x + 2], 0.5f);
    }
    const std::string two = pixel(128, 0, 0, 129) + pixel(0, 128, 0, 129);
    const Texture turned = read_texture(write("turned.hdr", header + "-Y 1 -X 2\n" + two));
    EXPECT_EQ(turned.floats[0], 0.0f);
    EXPECT_EQ(turned.floats[3], 1.0f);
    ASSERT_EQ(turned.notes.size(), 1u);
    const Texture columns = read_texture(write("columns.hdr", header + "+X 2 -Y 1\n" + two));
    EXPECT_EQ(columns.width, 2u);
    EXPECT_EQ(columns.floats[0], 1.0f);
    EXPECT_HAS(message_of([&] { read_texture(write("cut.hdr", header + "-Y 2 +X 2\n" + two)); }),
               "ends too early");
    EXPECT_HAS(
        message_of([&] { read_texture(write("run.hdr", header + "-Y 1 +X 2\n" + pixel(1, 1, 1, 9) + two)); }),
        "damaged");
}

TEST_F(OwnPictures, jpeg_is_read_as_by_the_module) {
    for (const int channels : {1, 3}) {
        expect_as_by_the_module(
            write_picture("a" + std::to_string(channels) + ".jpg", channels, OIIO::TypeDesc::UINT8));
        expect_as_by_the_module(write_picture("p" + std::to_string(channels) + ".jpg", channels,
                                              OIIO::TypeDesc::UINT8, [](OIIO::ImageSpec& spec) {
                                                  spec.attribute("jpeg:progressive", 1);
                                                  spec.attribute("jpeg:subsampling", "4:2:0");
                                              }));
    }
}

namespace {

struct CmykKind {
    J_COLOR_SPACE stored = JCS_CMYK;
    bool has_adobe_marker = true;
};

/// Returns a JPEG file of 16 x 16 pixels whose left and right halves have one colour each.
std::string make_cmyk_jpeg(const std::array<std::array<uint8_t, 4>, 2>& inks, const CmykKind& kind) {
    constexpr int kSide = 16;
    jpeg_compress_struct info;
    jpeg_error_mgr errors;
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* bytes = nullptr;
    unsigned long count = 0;
    jpeg_mem_dest(&info, &bytes, &count);
    info.image_width = info.image_height = kSide;
    info.input_components = 4, info.in_color_space = JCS_CMYK;
    jpeg_set_defaults(&info);
    jpeg_set_colorspace(&info, kind.stored);
    jpeg_set_quality(&info, 100, TRUE);
    for (int c = 0; c < 4; ++c) info.comp_info[c].h_samp_factor = info.comp_info[c].v_samp_factor = 1;
    info.write_Adobe_marker = kind.has_adobe_marker ? TRUE : FALSE;
    jpeg_start_compress(&info, TRUE);
    std::vector<uint8_t> row;
    for (int x = 0; x < kSide; ++x)
        row.insert(row.end(), inks[size_t(2 * x / kSide)].begin(), inks[size_t(2 * x / kSide)].end());
    uint8_t* rows[] = {row.data()};
    for (int y = 0; y < kSide; ++y) jpeg_write_scanlines(&info, rows, 1);
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    const std::string result(reinterpret_cast<const char*>(bytes), count);
    std::free(bytes);
    return result;
}

} // namespace

TEST_F(OwnPictures, jpeg_of_unknown_components_is_refused) {
    std::string bytes = read_file_bytes(write_picture("a.jpg", 1, OIIO::TypeDesc::UINT8));
    const size_t frame = bytes.find("\xff\xc0"), scan = bytes.find("\xff\xda");
    constexpr size_t kFrameEnd = 13, kComponentCount = 9; // with one component of three bytes
    std::string second = bytes.substr(frame + kFrameEnd - 3, 3);
    second[0] = '\x02';
    bytes.insert(scan + 7, std::string{"\x02\x00", 2}), bytes[scan + 3] += 2, bytes[scan + 4] = 2;
    bytes.insert(frame + kFrameEnd, second), bytes[frame + 3] += 3, bytes[frame + kComponentCount] = 2;
    EXPECT_HAS(message_of([&] { read_texture(write("two.jpg", bytes)); }),
               "two.jpg: has 2 components of no known colours");
}

TEST_F(OwnPictures, jpeg_of_four_inks_becomes_colours) {
    for (const CmykKind& kind : {CmykKind{}, CmykKind{JCS_YCCK, true}, CmykKind{JCS_CMYK, false}}) {
        std::array<std::array<uint8_t, 4>, 2> light{{{200, 100, 50, 128}, {30, 220, 140, 255}}};
        if (!kind.has_adobe_marker)
            for (auto& pixel : light)
                for (uint8_t& ink : pixel) ink = uint8_t(255 - ink);
        const std::filesystem::path file = write("inks.jpg", make_cmyk_jpeg(light, kind));
        const Texture texture = read_texture(file);
        ASSERT_EQ(texture.channel_count, 3u);
        ASSERT_EQ(texture.warnings.size(), 1u);
        EXPECT_HAS(texture.warnings[0], "inks.jpg: is CMYK, and its colours become RGB without its profile");
        PictureRemarks remarks;
        const std::vector<float> values = read_all(*open_own(file, remarks));
        ASSERT_EQ(values.size(), 16u * 16 * 3);
        const float dark = 128.0f / 255 / 255, bright = 1.0f / 255;
        const std::array<float, 3> left{200 * dark, 100 * dark, 50 * dark},
            right{30 * bright, 220 * bright, 140 * bright};
        for (size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(values[c], left[c], 0.015f);
            EXPECT_NEAR(values[7 * 3 + c], left[c], 0.015f);
            EXPECT_NEAR(values[8 * 3 + c], right[c], 0.015f);
            EXPECT_NEAR(values[values.size() - 3 + c], right[c], 0.015f);
        }
    }
}

TEST_F(OwnPictures, jpeg_with_an_unknown_transform_of_colours_is_warned_of) {
    std::string bytes = make_cmyk_jpeg({{{200, 100, 50, 128}, {200, 100, 50, 128}}}, {});
    const size_t marker = bytes.find("\xff\xee");
    constexpr size_t kTransform = 15; // after marker, length, "Adobe", version and two sets of flags
    ASSERT_NE(marker, std::string::npos);
    bytes[marker + kTransform] = 1;
    const Texture texture = read_texture(write("odd.jpg", bytes));
    ASSERT_EQ(texture.warnings.size(), 2u);
    EXPECT_HAS(texture.warnings[1],
               "odd.jpg: its marker of Adobe's programs names an unknown colour transform (1)");
}

TEST_F(OwnPictures, hdr_of_other_values_is_refused_by_name) {
    const std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + std::string(4, '\x80');
    EXPECT_HAS(message_of([&] { read_texture(write("x.hdr", text)); }),
               "x.hdr: has other values than RGBE (FORMAT=32-bit_rle_xyze)");
}

namespace {

/// Returns a compressed text chunk of XMP whose elements are nested `depth` deep.
std::string make_nested_metadata(int depth) {
    std::string xmp = "<x:xmpmeta xmlns:x='adobe:ns:meta/'>"
                      "<rdf:RDF xmlns:rdf='http://www.w3.org/1999/02/22-rdf-syntax-ns#'><rdf:Description>";
    for (int k = 0; k < depth; ++k) xmp += "<x:a>";
    for (int k = 0; k < depth; ++k) xmp += "</x:a>";
    xmp += "</rdf:Description></rdf:RDF></x:xmpmeta>";
    return test::make_png_chunk("zTXt", "XML:com.adobe.xmp" + std::string(2, '\0') + test::deflate_all(xmp));
}

} // namespace

TEST_F(OwnPictures, png_may_have_metadata_that_are_nested_deep) {
    const std::string plain = read_file_bytes(write_picture("a.png", 3, OIIO::TypeDesc::UINT8));
    constexpr size_t kHeaderEnd = 8 + 25;
    std::string nested = plain;
    nested.insert(kHeaderEnd, make_nested_metadata(100000));
    const Texture texture = read_texture(write("nested.png", nested));
    const Texture expected = read_texture(write("plain.png", plain));
    ASSERT_EQ(texture.width, uint32_t(kColumns));
    EXPECT_FALSE(expected.floats.empty() && expected.halves.empty());
    EXPECT_EQ(texture.floats, expected.floats);
    EXPECT_EQ(texture.halves, expected.halves);
}

TEST_F(OwnPictures, jpeg_that_is_damaged_is_warned_of) {
    std::string bytes = read_file_bytes(write_picture("a.jpg", 3, OIIO::TypeDesc::UINT8, {}, 90, 90));
    EXPECT_TRUE(parse_texture(bytes, "a.jpg").warnings.empty());
    for (size_t k = bytes.size() / 2; k < bytes.size() / 2 + 60; ++k)
        if (bytes[k] != '\xff' && bytes[k - 1] != '\xff') bytes[k] = char(0x55 + k % 3); // no marker
    const std::filesystem::path file = write("b.jpg", bytes);
    for (const Texture& texture : {read_texture(file), parse_texture(bytes, file.string())}) {
        ASSERT_EQ(texture.warnings.size(), 1u);
        EXPECT_HAS(texture.warnings[0], "b.jpg: is damaged, and parts of the picture may be wrong");
        EXPECT_HAS(texture.warnings[0], "Corrupt JPEG data");
    }
}

TEST_F(OwnPictures, jpeg_of_too_many_scans_is_refused) {
    const std::string bytes =
        read_file_bytes(write_picture("a.jpg", 1, OIIO::TypeDesc::UINT8,
                                      [](OIIO::ImageSpec& spec) { spec.attribute("jpeg:progressive", 1); }));
    const size_t last = bytes.rfind("\xff\xda"), end = bytes.rfind("\xff\xd9");
    const auto repeat = [&](int count) {
        std::string all = bytes.substr(0, end);
        for (int k = 0; k < count; ++k) all += bytes.substr(last, end - last);
        return write("b.jpg", all + bytes.substr(end));
    };
    EXPECT_EQ(read_texture(repeat(100)).width, uint32_t(kColumns));
    EXPECT_HAS(message_of([&] { read_texture(repeat(600)); }), "more than 500 scans");
}

TEST_F(OwnPictures, are_turned_as_their_orientation_says) {
    // Bright in the file's first row and column alone.
    for (const char* const name : {"o.tif", "o.jpg"})
        for (int orientation = 1; orientation <= 8; ++orientation) {
            const std::filesystem::path file = folder_ / name;
            constexpr int kFileWidth = 48, kFileHeight = 32;
            std::vector<uint8_t> values(size_t(kFileWidth) * kFileHeight, 0);
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 16; ++x)
                    values[size_t(y * kFileWidth + x)] = 255; // at the top left, wide
            auto output = OIIO::ImageOutput::create(file.string());
            OIIO::ImageSpec spec(kFileWidth, kFileHeight, 1, OIIO::TypeDesc::UINT8);
            spec.attribute("Orientation", orientation);
            ASSERT_TRUE(output->open(file.string(), spec));
            ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, values.data()) && output->close());
            const Texture texture = read_texture(file);
            const bool is_turned = orientation >= 5;
            EXPECT_EQ(texture.width, uint32_t(is_turned ? kFileHeight : kFileWidth));
            EXPECT_EQ(texture.notes.size(), orientation == 1 ? 0u : 1u);
            // Where the first row and column of the file are seen (TIFF 6.0, Orientation).
            const bool is_right =
                orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
            const bool is_bottom =
                orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
            const uint32_t wide = is_turned ? 6 : 12, high = is_turned ? 12 : 6;
            const uint32_t x = is_right ? texture.width - wide : wide - 1,
                           y = is_bottom ? texture.height - high : high - 1;
            EXPECT_GT(texture.floats[texture.find_texel(x, y)], 0.9f) << name << " " << orientation;
            EXPECT_LT(texture.floats[texture.find_texel(texture.width - 1 - x, y)], 0.1f)
                << name << orientation;
            EXPECT_LT(texture.floats[texture.find_texel(x, texture.height - 1 - y)], 0.1f)
                << name << orientation;
        }
}

TEST_F(OwnPictures, tiff_windows_are_put_into_their_picture) {
    const std::filesystem::path file =
        write_picture("w.tif", 1, OIIO::TypeDesc::FLOAT, [](OIIO::ImageSpec& spec) {
            spec.x = 3, spec.y = 2, spec.full_x = 0, spec.full_y = 0, spec.full_width = 50,
            spec.full_height = 30;
        });
    const Texture texture = read_texture(file);
    EXPECT_EQ(texture.width, 50u);
    EXPECT_EQ(texture.height, 30u);
    EXPECT_EQ(texture.floats[texture.find_texel(2, 2)], 0.0f);
    EXPECT_EQ(texture.floats[texture.find_texel(4, 2)], 0.31f);
    ASSERT_EQ(texture.notes.size(), 1u);
    EXPECT_HAS(texture.notes[0], "at (3, 2) of a picture of 50 x 30");
}

TEST_F(OwnPictures, that_are_cut_are_refused) {
    for (const char* const name : {"c.tif", "c.jpg", "c.hdr"}) {
        const std::filesystem::path file = write_picture(
            name, 3, std::string(name) == "c.hdr" ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8, {}, 90,
            90);
        std::ifstream stream(file, std::ios::binary);
        const std::string bytes(std::istreambuf_iterator<char>(stream), {});
        for (const size_t length : {bytes.size() - 40, bytes.size() / 2, size_t(40), size_t(3)}) {
            write(std::string("cut.") + name, bytes.substr(0, length));
            EXPECT_THROW(read_texture(folder_ / (std::string("cut.") + name)), Error)
                << name << " " << length;
        }
    }
}

TEST_F(OwnPictures, of_other_kinds_are_named_with_a_way_out) {
    for (const auto& [name, kind] : {std::pair("a.ktx2", "KTX"),
                                     {"a.ktx", "KTX"},
                                     {"a.dpx", "DPX"},
                                     {"a.jxl", "JPEG XL"},
                                     {"a.pfm", "Netpbm"},
                                     {"a.cr2", "raw"}}) {
        const std::filesystem::path file = write(name, "something");
        const std::string message = message_of([&] { read_texture(file); });
        EXPECT_HAS(message, kind);
        EXPECT_HAS(message, "EXR, TIFF or PNG");
    }
    const std::string webp = message_of([&] { read_texture(write("x.png", "RIFF1234WEBPVP8 ....")); });
    EXPECT_HAS(webp, "a WebP file");
    EXPECT_EQ(webp.find("damaged"), std::string::npos);
}

} // namespace relief
