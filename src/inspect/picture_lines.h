// Lines drawn into a picture.
#pragma once

#include "relief/image.h"
#include "relief/types.h"

namespace relief {

/// Draws from one point to another, in pixels from the top left, two pixels wide, into the first three
/// channels. What lies outside of the top left `size` pixels of the image is left out.
void draw_line(Image& image, const Vec2<int>& size, const Vec2f& from, const Vec2f& to, const Vec3f& color);

} // namespace relief
