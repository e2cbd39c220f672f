// PNG files of every layout have the values that the standard gives them, and their damage is reported.
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "io/picture/png_source.h"
#include "io/png_bytes.h"
#include "io/source_values.h"
#include "io/test_files.h"
#include "relief/io.h"

namespace relief {

namespace {

using test::make_png;
using test::make_png_chunk;
using test::PngColors;
using test::PngPicture;
using Values = std::vector<float>;

/// Returns the bytes of a literal, zeros included.
template <size_t kSize> std::string to_bytes(const char (&text)[kSize]) { return {text, kSize - 1}; }

const std::string kThreeColors = make_png_chunk("PLTE", to_bytes("\xff\x00\x00\x00\xff\x00\x00\x00\xff"));

/// Pixels 0 1 2 0 in two bits each.
PngPicture make_palette_picture() {
    return {.width = 4,
            .bits = 2,
            .kind = PngColors::palette,
            .chunks = kThreeColors,
            .rows = to_bytes("\x00\x18")};
}

} // namespace

class PngFiles : public FileTest {
  protected:
    std::unique_ptr<PixelSource> open(const std::string& bytes) {
        const std::filesystem::path file = write("a.png", bytes);
        return open_png(std::make_unique<std::ifstream>(file, std::ios::binary), file.string(), remarks_);
    }
    Values read(const PngPicture& picture) { return read_all(*open(make_png(picture))); }

    PictureRemarks remarks_;
};

TEST_F(PngFiles, with_a_palette_have_its_colours) {
    const auto source = open(make_png(make_palette_picture()));
    EXPECT_EQ(source->header().channels, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(source->header().pixel_bytes, 1u);
    EXPECT_EQ(read_all(*source), (Values{1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0}));
    EXPECT_TRUE(source->list_warnings().empty());
}

TEST_F(PngFiles, with_transparent_palette_entries_have_an_alpha) {
    PngPicture picture = make_palette_picture();
    picture.chunks += make_png_chunk("tRNS", to_bytes("\xff\x00"));
    EXPECT_EQ(read(picture), (Values{1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 1, 1, 0, 0, 1}));
}

TEST_F(PngFiles, with_pixels_beyond_the_palette_are_warned_of) {
    PngPicture picture = make_palette_picture();
    picture.rows = to_bytes("\x00\x1b"); // 0 1 2 3
    const auto source = open(make_png(picture));
    EXPECT_EQ(read_all(*source), (Values{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}));
    ASSERT_EQ(source->list_warnings().size(), 1u);
    EXPECT_HAS(source->list_warnings()[0], "a.png: is damaged");
    EXPECT_HAS(source->list_warnings()[0], "1 pixel of a color that the palette lacks");
}

TEST_F(PngFiles, of_one_bit_are_black_and_white) {
    EXPECT_EQ(read({.width = 8, .bits = 1, .rows = to_bytes("\x00\xa5")}), (Values{1, 0, 1, 0, 0, 1, 0, 1}));
}

TEST_F(PngFiles, of_sixteen_bits_with_a_transparent_colour_have_an_alpha) {
    const PngPicture picture{.width = 2,
                             .bits = 16,
                             .kind = PngColors::rgb,
                             .chunks = make_png_chunk("tRNS", to_bytes("\xff\xff\x00\x00\xff\xff")),
                             .rows = to_bytes("\x00\xff\xff\x00\x00\xff\xff\x00\x00\xff\xff\x00\x00")};
    EXPECT_EQ(read(picture), (Values{1, 0, 1, 0, 0, 1, 0, 1}));
}

TEST_F(PngFiles, that_are_interlaced_have_all_rows) {
    // 2 x 3 pixels in the passes 1, 6, 5 and 7 of Adam7 that are not empty; by pass: (0,0), (0,2), (1,0)
    // (1,2), row 1.
    const PngPicture picture{.width = 2,
                             .height = 3,
                             .is_interlaced = true,
                             .rows = to_bytes("\x00\x00") + to_bytes("\x00\xff") + to_bytes("\x00\xff") +
                                     to_bytes("\x00\x00") + to_bytes("\x00\x00\xff")};
    EXPECT_EQ(read(picture), (Values{0, 1, 0, 1, 1, 0}));
}

TEST_F(PngFiles, with_a_damaged_transparency_are_warned_of) {
    std::string chunk = make_png_chunk("tRNS", to_bytes("\xff\x00"));
    chunk.back() = char(chunk.back() ^ 1);
    PngPicture picture = make_palette_picture();
    picture.chunks += chunk;
    const Texture texture = read_texture(write("b.png", make_png(picture)));
    ASSERT_EQ(texture.warnings.size(), 1u);
    EXPECT_HAS(texture.warnings[0],
               "b.png: is damaged, and parts of the picture may be wrong: libpng reports 'tRNS");
}

TEST_F(PngFiles, with_damaged_texts_are_not_warned_of) {
    std::string chunk = make_png_chunk("tEXt", to_bytes("Comment\0abc"));
    chunk.back() = char(chunk.back() ^ 1);
    PngPicture picture = make_palette_picture();
    picture.chunks += chunk;
    EXPECT_TRUE(read_texture(write("b.png", make_png(picture))).warnings.empty());
}

TEST_F(PngFiles, are_turned_as_their_exif_data_say) {
    // One entry: tag 274, a short, one of them, 6: turned to the right.
    const std::string exif = to_bytes("MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0");
    PngPicture picture{.width = 2, .chunks = make_png_chunk("eXIf", exif), .rows = to_bytes("\x00\x00\xff")};
    const auto source = open(make_png(picture));
    EXPECT_EQ(source->header().width, 1);
    EXPECT_EQ(source->header().height, 2);
    EXPECT_EQ(read_all(*source), (Values{0, 1}));
    ASSERT_EQ(remarks_.notes.size(), 1u);
    EXPECT_HAS(remarks_.notes[0], "is turned by 90 degrees to the right");
}

TEST_F(PngFiles, take_little_memory_for_texts) {
    const std::string text = to_bytes("Comment\0\0") + test::deflate_all(std::string(7900000, 'a'));
    std::string chunks;
    for (int k = 0; k < 100; ++k) chunks += make_png_chunk("zTXt", text);
    PngPicture picture = make_palette_picture();
    picture.chunks += chunks;
    const std::string bytes = make_png(picture);
    const auto read_peak = [] {
        std::ifstream status("/proc/self/status");
        for (std::string line; std::getline(status, line);)
            if (line.starts_with("VmHWM:")) return std::stoul(line.substr(6)); // KiB
        return 0ul;
    };
    std::ofstream("/proc/self/clear_refs") << "5"; // the peak becomes the present size
    const unsigned long before = read_peak();
    EXPECT_EQ(read_all(*open(bytes)).size(), 12u);
    EXPECT_LT(read_peak() - before, 200 * 1024); // the texts take 790 MB
}

TEST_F(PngFiles, with_a_mangled_start_are_refused_as_none) {
    std::string bytes = make_png(make_palette_picture());
    bytes.erase(4, 1); // "\r\n" became "\n"
    EXPECT_HAS(message_of([&] { read_texture(write("m.png", bytes)); }),
               "m.png: is no EXR, TIFF, PNG, JPEG or HDR file: it starts otherwise");
}

TEST_F(PngFiles, of_few_bits_may_be_packed_tight) {
    constexpr uint32_t kSide = 4096;
    const PngPicture picture{.width = kSide,
                             .height = kSide,
                             .bits = 1,
                             .kind = PngColors::palette,
                             .chunks = make_png_chunk("PLTE", to_bytes("\x10\x20\x30")),
                             .rows = std::string(kSide * (1 + kSide / 8), '\0')};
    EXPECT_EQ(read_texture(write("blank.png", make_png(picture))).width, kSide);
}

TEST_F(PngFiles, of_linear_colours_are_warned_of) {
    PngPicture picture = make_palette_picture();
    picture.chunks = make_png_chunk("gAMA", test::make_big_endian(100000)) + picture.chunks;
    write("linear.png", make_png(picture)), write("quad.obj", kQuadObj);
    const auto read_warnings = [&](const std::string& texture) {
        const auto file =
            write("scene.json", R"({"version": 1, "materials": {"m": {"base_color_texture": )" + texture +
                                    R"(}}, "meshes": {"q": {"file": "quad.obj"}},
                                   "objects": [{"mesh": "q", "material": "m"}]})");
        return load_scene(file).warnings;
    };
    const std::vector<std::string> warnings = read_warnings("\"linear.png\"");
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "linear.png: its header says that its values are linear");
    EXPECT_TRUE(read_warnings(R"({"file": "linear.png", "color_space": "linear"})").empty());
}

} // namespace relief
