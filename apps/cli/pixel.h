// Explains one pixel: what its centre ray hits, and its colour.
#pragma once

#include "relief/intersect.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief::cli {

/// Pinhole ray through the centre of pixel (x, y); direction of unit length.
Ray make_pixel_ray(const Camera& camera, int width, int height, int x, int y);

/// Prints object, patch, patch uv, t, normal and colour of a pixel on stdout.
void explain_pixel(const Scene& scene, const RenderSettings& settings, int x, int y);

} // namespace relief::cli
