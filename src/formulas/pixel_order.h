// Order in which a device processes the pixels of a window: by squares, for coherence.
#ifndef RELIEF_PIXEL_ORDER_H
#define RELIEF_PIXEL_ORDER_H
#include "formulas/exact.h"

#include "formulas/begin.h"

/// Side of a square, pixels; rays of one square are coherent.
const uint kPixelSquare = 8u;

struct PixelPlace {
    uint x, y;
};

/// Pixel `index` of a window: bands of rows, squares in a band, rows in a square, clipped at the border.
FN PixelPlace place_pixel(const uint index, const uint width, const uint height) {
    uint band = index / (kPixelSquare * width);
    uint in_band = index - band * kPixelSquare * width;
    uint rows = min_uint(kPixelSquare, height - band * kPixelSquare);
    uint square = in_band / (kPixelSquare * rows);
    uint in_square = in_band - square * kPixelSquare * rows;
    uint columns = min_uint(kPixelSquare, width - square * kPixelSquare);
    PixelPlace result = {square * kPixelSquare + in_square % columns,
                         band * kPixelSquare + in_square / columns};
    return result;
}

/// Inverse of place_pixel.
FN uint find_pixel_number(const uint x, const uint y, const uint width, const uint height) {
    uint band = y / kPixelSquare;
    uint square = x / kPixelSquare;
    uint rows = min_uint(kPixelSquare, height - band * kPixelSquare);
    uint columns = min_uint(kPixelSquare, width - square * kPixelSquare);
    return kPixelSquare * (band * width + square * rows) + y % kPixelSquare * columns + x % kPixelSquare;
}

#include "formulas/end.h"
#endif
