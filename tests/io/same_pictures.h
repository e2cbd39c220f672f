// Compares what Relief's own reader makes of a file with what the module relief_pictures makes of it.
#pragma once

#include <filesystem>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "io/picture/image_input.h"
#include "io/picture/picture_library.h"

namespace relief {

inline void expect_same_headers(const PixelHeader& a, const PixelHeader& b) {
    EXPECT_EQ(std::tie(a.x, a.y, a.width, a.height, a.full_x, a.full_y, a.full_width, a.full_height),
              std::tie(b.x, b.y, b.width, b.height, b.full_x, b.full_y, b.full_width, b.full_height));
    EXPECT_EQ(a.type, b.type);
    EXPECT_EQ(a.pixel_bytes, b.pixel_bytes);
    EXPECT_EQ(a.channels, b.channels);
    for (const auto& [name, value] : a.metadata) {
        ASSERT_TRUE(b.metadata.contains(name)) << name;
        EXPECT_EQ(b.metadata.at(name), value) << name;
    }
}

/// Pictures must be small and free of NaN.
inline void expect_read_as_by_the_module(const std::filesystem::path& file) {
    SCOPED_TRACE(file.filename());
    const auto own = open_image(file), other = get_picture_library("test").open_file(file.string());
    const PixelHeader& header = own->header();
    expect_same_headers(header, other->header());
    const size_t count = header.channels.size(), size = size_t(header.width) * size_t(header.height) * count;
    std::vector<float> floats(size), other_floats(size);
    own->read_floats(int(count), count, floats.data());
    other->read_floats(int(count), count, other_floats.data());
    EXPECT_EQ(floats, other_floats);
    if (header.type != SampleType::float16) return;
    std::vector<uint16_t> halves(size), other_halves(size);
    own->read_halves(int(count), count, halves.data());
    other->read_halves(int(count), count, other_halves.data());
    EXPECT_EQ(halves, other_halves);
}

} // namespace relief
