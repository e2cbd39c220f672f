#include "io/picture/row_source.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "relief/half.h"

namespace relief {

namespace {

/// Column and row in the picture of pixel (x, y) of a file of width x height pixels.
std::array<int, 2> find_place(int orientation, int x, int y, int width, int height) {
    const int right = width - 1 - x, bottom = height - 1 - y;
    switch (orientation) {
    case 2:
        return {right, y};
    case 3:
        return {right, bottom};
    case 4:
        return {x, bottom};
    case 5:
        return {y, x};
    case 6:
        return {bottom, x};
    case 7:
        return {bottom, right};
    case 8:
        return {y, right};
    default:
        return {x, y};
    }
}

bool swaps_sides(int orientation) { return orientation >= 5; }

} // namespace

void RowSource::turn(int orientation, const std::string& name, PictureRemarks& remarks) {
    if (orientation <= kUpright || orientation > kLastOrientation) return;
    orientation_ = orientation;
    if (swaps_sides(orientation)) {
        std::swap(header_.width, header_.height);
        std::swap(header_.full_width, header_.full_height);
    }
    constexpr std::array<const char*, 7> kWays = {"mirrored left to right",
                                                  "turned by 180 degrees",
                                                  "mirrored top to bottom",
                                                  "mirrored at its diagonal",
                                                  "turned by 90 degrees to the right",
                                                  "mirrored at its other diagonal",
                                                  "turned by 90 degrees to the left"};
    remarks.notes.push_back(fmt::format("{}: is {}, as its orientation ({}) says", name,
                                        kWays[size_t(orientation - 2)], orientation));
}

template <class Value, class Convert>
void RowSource::read(int channel_count, size_t stride, Value* values, const Convert& convert) {
    const size_t channels = header_.channels.size();
    const int columns = header_.width;
    const int file_width = swaps_sides(orientation_) ? header_.height : header_.width,
              file_height = swaps_sides(orientation_) ? header_.width : header_.height;
    decode([&](int row, const float* pixels) {
        for (int x = 0; x < file_width; ++x) {
            const auto [column, line] = find_place(orientation_, x, row, file_width, file_height);
            Value* const target = values + (size_t(line) * size_t(columns) + size_t(column)) * stride;
            for (size_t c = 0; c < size_t(channel_count); ++c)
                target[c] = convert(pixels[size_t(x) * channels + c]);
        }
    });
}

void RowSource::read_floats(int channel_count, size_t stride, float* values) {
    read(channel_count, stride, values, [](float value) { return value; });
}

void RowSource::read_halves(int channel_count, size_t stride, uint16_t* values) {
    read(channel_count, stride, values, [](float value) { return float_to_half(value); });
}

} // namespace relief
