// One pixel, explained: what its centre ray hits and what colour it gets.
#pragma once

#include "relief/intersect.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief::cli {

/// Ray through the centre of pixel (x, y) of a picture, lens closed; direction of unit length.
Ray make_pixel_ray(const Camera& camera, int width, int height, int x, int y);

/// Prints object, patch, position on it, t, normal and colour of a pixel on stdout.
void explain_pixel(const Scene& scene, const RenderSettings& settings, int x, int y);

} // namespace relief::cli
