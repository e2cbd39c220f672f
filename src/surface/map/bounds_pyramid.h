// Min and max of every channel over rectangles of a map: tight bounds without user padding.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "relief/scene.h"
#include "surface/map/texel_range.h"

namespace relief {

/// Min/max pyramid over 8 x 8 texels, each level a quarter of the last. Thread safe but for `update`.
class BoundsPyramid {
  public:
    /// Throws bad_input with the pixel for a NaN or an infinity.
    static BoundsPyramid build(const Texture& texture);

    /// Range of the raw channels over all texels in [x0, x1] x [y0, y1] (inclusive, any integers; wrapped by
    /// `wrap`; the black outside of WrapMode::black reads `black`). At most a few dozen nodes are visited.
    ChannelRange query(int64_t x0, int64_t y0, int64_t x1, int64_t y1, WrapMode wrap,
                       const std::array<float, 3>& black) const;

    /// Follows a change of texels in a rectangle. If it throws, as build, the rectangle's ranges are invalid.
    void update(const Texture& texture, const TexelRectangle& changed);

    size_t byte_count() const;

  private:
    struct Level {
        uint32_t width = 0, height = 0;
        std::vector<ChannelRange> ranges;
    };
    /// Makes the nodes in a rectangle of `coarse` anew.
    static void join_ranges(const Level& fine, Level& coarse, const TexelRectangle& nodes);

    uint32_t width_ = 0, height_ = 0;
    std::vector<Level> levels_;
};

} // namespace relief
