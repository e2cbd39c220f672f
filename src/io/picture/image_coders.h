// The kinds of pictures that Relief writes.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "io/picture/image_output.h"
#include "math/vec.h"
#include "relief/image.h"

namespace relief {

/// All channels as floats, ZIP, windows and metadata.
void encode_exr(const Image& image, CheckedFile& file);
/// The texels as they are, ZIP; channels Y, R G, R G B or R G B A.
void encode_exr(const Texture& texture, CheckedFile& file);

/// Fills row y, which has the right size: pictures are encoded without a second copy of the whole.
template <class Value> using FillRow = std::function<void(int y, std::vector<Value>& row)>;

/// What the values of a PNG file are. sRGB and linear ones are tagged as such; data are not.
enum class PngMeaning { srgb, linear, data };
struct PngKind {
    int channels = 3; ///< RGB, 4: RGBA, or 1: grey
    int bits = 8;     ///< of a value; of 16 the high byte comes first
    PngMeaning meaning = PngMeaning::srgb;
};
/// `fill_row` is called on several threads at the same time, with rows in any order.
void encode_png(int width, int height, const PngKind& kind, const FillRow<uint8_t>& fill_row,
                CheckedFile& file);
/// Radiance RGBE: three mantissas and a common exponent, run lengths.
void encode_hdr(int width, int height, const FillRow<Vec3f>& fill_row, CheckedFile& file);

} // namespace relief
