#include "inspect/picture_lines.h"

#include <algorithm>
#include <cmath>

namespace relief {

void draw_line(Image& image, const Vec2<int>& size, const Vec2f& from, const Vec2f& to, const Vec3f& color) {
    constexpr float kLongest = 1e4f; // pixels; farther ends come from points beside the camera
    const float reach = std::max(std::fabs(to.x - from.x), std::fabs(to.y - from.y));
    if (!(reach < kLongest)) return;
    const int steps = int(std::ceil(reach)) + 1;
    for (int k = 0; k <= steps; ++k) {
        const float s = float(k) / float(steps);
        const float px = std::floor(from.x + (to.x - from.x) * s);
        const float py = std::floor(from.y + (to.y - from.y) * s);
        if (!(px >= 0 && py >= 0 && px < float(size.x) && py < float(size.y))) continue;
        for (int y = int(py); y < std::min(int(py) + 2, size.y); ++y)
            for (int x = int(px); x < std::min(int(px) + 2, size.x); ++x) {
                image.at(x, y, 0) = color.x, image.at(x, y, 1) = color.y;
                image.at(x, y, 2) = color.z;
            }
    }
}

} // namespace relief
