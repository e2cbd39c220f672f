#include <string>

#include <gtest/gtest.h>

#include "inspect/picture_text.h"

namespace relief::test {
namespace {

/// Rows of a picture, '#' where there is ink, '.' on the ground of the text, ' ' where nothing was drawn.
std::string draw(int width, int room, int scale, std::string_view text) {
    Image image;
    image.width = image.full_width = width, image.height = image.full_height = 10 * scale;
    image.channels = {"R", "G", "B", "A"};
    image.pixels.assign(size_t(4) * size_t(width) * size_t(image.height), 0.5f);
    draw_text(image, {0, 0}, room, scale, text);
    std::string rows;
    for (int y = 0; y < image.height; ++y, rows += '\n')
        for (int x = 0; x < width; ++x)
            rows += image.at(x, y, 1) == 0.5f ? ' ' : image.at(x, y, 1) > 0.5f ? '#' : '.';
    return rows;
}

TEST(PictureText, has_letters_in_capitals_and_blanks_for_what_has_no_glyph) {
    const std::string wanted =
        ".............  \n.#####.......  \n...#.........  \n...#.........  \n...#.........  \n"
        "...#.........  \n...#.........  \n...#.........  \n.............  \n               \n";
    EXPECT_EQ(draw(15, 15, 1, "t\x01"), wanted);
    EXPECT_EQ(draw(15, 15, 1, "T "), wanted);
}

TEST(PictureText, is_cut_where_there_is_no_room_and_grows_by_its_scale) {
    EXPECT_EQ(draw(40, 14, 1, "TTTTT"), draw(40, 40, 1, "TT"));
    const std::string large = draw(14, 14, 2, "T");
    EXPECT_EQ(large.substr(2 * 15, 15), "..##########..\n");
    EXPECT_EQ(large.substr(2 * 15, 15), large.substr(3 * 15, 15));
    EXPECT_EQ(draw(8, 40, 1, "TTTT").substr(9, 9), ".#####.#\n") << "beyond the picture";
}

} // namespace
} // namespace relief::test
