// Short captions drawn into a picture.
#pragma once

#include <string_view>

#include "relief/image.h"
#include "relief/types.h"

namespace relief {

inline constexpr int kGlyphWidth = 6, kGlyphHeight = 8; ///< pixels, with the gap to the next; times the scale

/// Draws one line in capitals on a dark ground, its top left corner at x, y, as far as it fits into `width`
/// pixels, into the first three channels. Letters, digits and the usual punctuation have glyphs; others are
/// blank. `scale`: pixels of the picture per pixel of a glyph.
void draw_text(Image& image, const Vec2<int>& place, int width, int scale, std::string_view text);

} // namespace relief
