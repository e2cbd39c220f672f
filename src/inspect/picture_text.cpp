#include "inspect/picture_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

namespace relief {

namespace {

constexpr int kRows = 7, kColumns = 5;

struct Glyph {
    char letter;
    std::array<uint8_t, kRows> rows; ///< of five bits, the highest at the left
};

constexpr Glyph kGlyphs[] = {{'A', {14, 17, 17, 31, 17, 17, 17}}, {'B', {30, 17, 17, 30, 17, 17, 30}},
                             {'C', {14, 17, 16, 16, 16, 17, 14}}, {'D', {30, 17, 17, 17, 17, 17, 30}},
                             {'E', {31, 16, 16, 30, 16, 16, 31}}, {'F', {31, 16, 16, 30, 16, 16, 16}},
                             {'G', {14, 17, 16, 23, 17, 17, 15}}, {'H', {17, 17, 17, 31, 17, 17, 17}},
                             {'I', {14, 4, 4, 4, 4, 4, 14}},      {'J', {7, 2, 2, 2, 2, 18, 12}},
                             {'K', {17, 18, 20, 24, 20, 18, 17}}, {'L', {16, 16, 16, 16, 16, 16, 31}},
                             {'M', {17, 27, 21, 21, 17, 17, 17}}, {'N', {17, 25, 21, 19, 17, 17, 17}},
                             {'O', {14, 17, 17, 17, 17, 17, 14}}, {'P', {30, 17, 17, 30, 16, 16, 16}},
                             {'Q', {14, 17, 17, 17, 21, 18, 13}}, {'R', {30, 17, 17, 30, 20, 18, 17}},
                             {'S', {15, 16, 16, 14, 1, 1, 30}},   {'T', {31, 4, 4, 4, 4, 4, 4}},
                             {'U', {17, 17, 17, 17, 17, 17, 14}}, {'V', {17, 17, 17, 17, 17, 10, 4}},
                             {'W', {17, 17, 17, 21, 21, 27, 17}}, {'X', {17, 17, 10, 4, 10, 17, 17}},
                             {'Y', {17, 17, 10, 4, 4, 4, 4}},     {'Z', {31, 1, 2, 4, 8, 16, 31}},
                             {'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},
                             {'2', {14, 17, 1, 2, 4, 8, 31}},     {'3', {31, 2, 4, 2, 1, 17, 14}},
                             {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
                             {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},
                             {'8', {14, 17, 17, 14, 17, 17, 14}}, {'9', {14, 17, 17, 15, 1, 2, 12}},
                             {'.', {0, 0, 0, 0, 0, 12, 12}},      {',', {0, 0, 0, 0, 12, 4, 8}},
                             {':', {0, 12, 12, 0, 12, 12, 0}},    {'-', {0, 0, 0, 31, 0, 0, 0}},
                             {'%', {24, 25, 2, 4, 8, 19, 3}},     {'/', {0, 1, 2, 4, 8, 16, 0}},
                             {'(', {2, 4, 8, 8, 8, 4, 2}},        {')', {8, 4, 2, 2, 2, 4, 8}},
                             {'+', {0, 4, 4, 31, 4, 4, 0}},       {'=', {0, 0, 31, 0, 31, 0, 0}}};

bool is_set(char letter, int x, int y) {
    if (x >= kColumns || y >= kRows) return false;
    const char capital = char(std::toupper(static_cast<unsigned char>(letter)));
    const auto* const glyph = std::ranges::find(kGlyphs, capital, &Glyph::letter);
    return glyph != std::end(kGlyphs) && (glyph->rows[size_t(y)] >> (kColumns - 1 - x) & 1) != 0;
}

} // namespace

void draw_text(Image& image, const Vec2<int>& place, int width, int scale, std::string_view text) {
    constexpr Vec3f kGround{0.02f, 0.02f, 0.02f}, kInk{0.85f, 0.85f, 0.85f};
    const int most = std::max(0, (width / scale - 1) / kGlyphWidth);
    const int count = std::min(most, int(text.size()));
    const int x1 = std::min(place.x + scale * (count * kGlyphWidth + 1), image.width);
    const int y1 = std::min(place.y + scale * (kGlyphHeight + 1), image.height);
    for (int y = place.y; y < y1; ++y)
        for (int x = place.x; x < x1; ++x) {
            const int column = (x - place.x) / scale - 1, row = (y - place.y) / scale - 1;
            const bool is_ink = column >= 0 && row >= 0 && column / kGlyphWidth < count &&
                                is_set(text[size_t(column / kGlyphWidth)], column % kGlyphWidth, row);
            const Vec3f& color = is_ink ? kInk : kGround;
            image.at(x, y, 0) = color.x, image.at(x, y, 1) = color.y, image.at(x, y, 2) = color.z;
        }
}

} // namespace relief
