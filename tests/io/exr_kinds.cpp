// EXR files as other programs write them: every layout of the pixels in the file gives the same picture.
#include <map>
#include <string>
#include <vector>

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include "io/picture/exr_source.h"
#include "io/same_pictures.h"
#include "io/test_files.h"
#include "relief/io.h"

namespace relief {

namespace {

constexpr int kWidth = 50, kHeight = 70; // several blocks and tiles, the last ones cut

/// Channels of a picture at its data window, all different.
class ExrPixels {
  public:
    explicit ExrPixels(const Imf::Header& header) {
        const Imath::Box2i window = header.dataWindow();
        const size_t width = size_t(window.max.x - window.min.x + 1);
        const size_t count = width * size_t(window.max.y - window.min.y + 1);
        for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
            const float channel = float(1 + values_.size());
            std::vector<char>& bytes = values_[it.name()];
            for (size_t i = 0; i < count; ++i)
                append(0.25f * channel * float(i % 97), it.channel().type, bytes);
            const size_t value_bytes = bytes.size() / count;
            buffer_.insert(it.name(), Imf::Slice::Make(it.channel().type, bytes.data(), window, value_bytes,
                                                       value_bytes * width));
        }
    }

    const Imf::FrameBuffer& buffer() const { return buffer_; }

  private:
    static void append(float value, Imf::PixelType type, std::vector<char>& bytes) {
        const half short_value(value);
        const void* source = type == Imf::HALF ? static_cast<const void*>(&short_value) : &value;
        const auto* first = static_cast<const char*>(source);
        bytes.insert(bytes.end(), first, first + (type == Imf::HALF ? 2 : 4));
    }

    std::map<std::string, std::vector<char>> values_;
    Imf::FrameBuffer buffer_;
};

Imf::Header make_header(Imf::PixelType type = Imf::FLOAT) {
    Imf::Header header(kWidth, kHeight);
    for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(type));
    return header;
}

} // namespace

class ExrKinds : public FileTest {
  protected:
    std::filesystem::path write_rows(const std::string& name, const Imf::Header& header) const {
        const ExrPixels pixels(header);
        Imf::OutputFile output((folder_ / name).c_str(), header, 0);
        output.setFrameBuffer(pixels.buffer());
        const Imath::Box2i window = header.dataWindow();
        output.writePixels(window.max.y - window.min.y + 1);
        return folder_ / name;
    }

    std::filesystem::path write_tiles(const std::string& name, Imf::Header header) const {
        header.setTileDescription(Imf::TileDescription(16, 32, Imf::ONE_LEVEL));
        const ExrPixels pixels(header);
        Imf::TiledOutputFile output((folder_ / name).c_str(), header, 0);
        output.setFrameBuffer(pixels.buffer());
        output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
        return folder_ / name;
    }

    static bool is_plain(const std::filesystem::path& file) {
        return open_plain_exr(std::make_unique<std::ifstream>(file, std::ios::binary), file.string()) !=
               nullptr;
    }

    static void expect_plain(const std::filesystem::path& file) {
        EXPECT_TRUE(is_plain(file)) << file;
        expect_read_as_by_the_module(file);
    }
};

TEST_F(ExrKinds, every_compression_and_order_of_rows_is_read) {
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT})
        for (const Imf::Compression compression :
             {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
              Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION})
            for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
                Imf::Header header = make_header(type);
                header.compression() = compression;
                header.lineOrder() = order;
                expect_plain(write_rows(
                    "c" + std::to_string(compression) + "_" + std::to_string(order) + ".exr", header));
            }
}

TEST_F(ExrKinds, tiles_are_read) {
    expect_plain(write_tiles("float.exr", make_header()));
    Imf::Header header = make_header(Imf::HALF);
    header.compression() = Imf::PIZ_COMPRESSION;
    header.lineOrder() = Imf::RANDOM_Y;
    expect_plain(write_tiles("half.exr", header));
}

TEST_F(ExrKinds, data_windows_lie_anywhere) {
    for (const Imath::V2i& first : {Imath::V2i(-7, -11), Imath::V2i(-70, 3), Imath::V2i(1000, -200)}) {
        Imf::Header header = make_header();
        header.dataWindow() = Imath::Box2i(first, first + Imath::V2i(kWidth - 1, kHeight - 1));
        expect_plain(write_rows("rows.exr", header));
        expect_plain(write_tiles("tiles.exr", header));
        header.displayWindow() = Imath::Box2i(first - Imath::V2i(2), first + Imath::V2i(kWidth + 5));
        expect_plain(write_rows("display.exr", header));
    }
}

TEST_F(ExrKinds, mixed_types_are_left_to_the_module) {
    Imf::Header header = make_header(Imf::HALF);
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    const auto file = write_rows("mixed.exr", header);
    EXPECT_FALSE(is_plain(file));
    expect_read_as_by_the_module(file);
}

TEST_F(ExrKinds, cryptomatte_layers_are_read) {
    Imf::Header header = make_header();
    for (const char* layer : {"CryptoMaterial00.", "CryptoObject00.", "CryptoObject01."})
        for (const char* suffix : {"r", "g", "b", "a"})
            header.channels().insert(std::string(layer) + suffix, Imf::Channel(Imf::FLOAT));
    const auto file = write_rows("mattes.exr", header);
    expect_plain(file);
    EXPECT_EQ(read_image(file).channels[4], "CryptoMaterial00.g");
    header.channels().insert("CryptoObject00.A", Imf::Channel(Imf::FLOAT));
    const auto mixed = write_rows("both.exr", header);
    EXPECT_FALSE(is_plain(mixed));
    expect_read_as_by_the_module(mixed);
}

TEST_F(ExrKinds, many_parts_are_left_to_the_module) {
    std::vector<Imf::Header> headers = {make_header(), make_header(Imf::HALF)};
    headers[0].setName("first"), headers[1].setName("second");
    for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);
    const auto file = folder_ / "parts.exr";
    {
        Imf::MultiPartOutputFile output(file.c_str(), headers.data(), int(headers.size()), false, 0);
        for (int part = 0; part < 2; ++part) {
            const ExrPixels pixels(headers[size_t(part)]);
            Imf::OutputPart rows(output, part);
            rows.setFrameBuffer(pixels.buffer());
            rows.writePixels(kHeight);
        }
    }
    EXPECT_FALSE(is_plain(file));
    expect_read_as_by_the_module(file);
}

TEST_F(ExrKinds, a_cut_file_is_refused_or_read_whole) {
    constexpr size_t kStep = 97;
    for (const auto& file :
         {write_rows("rows.exr", make_header()), write_tiles("tiles.exr", make_header())}) {
        std::ifstream stream(file, std::ios::binary);
        const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
        const Texture whole = parse_texture(bytes, file.string());
        for (size_t length = 0; length < bytes.size(); length += kStep) {
            try {
                EXPECT_EQ(parse_texture(std::string_view(bytes).substr(0, length), file.string()).floats,
                          whole.floats);
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::bad_input) << error.what();
                EXPECT_HAS(std::string(error.what()), file.filename().string());
            }
        }
    }
}

} // namespace relief
