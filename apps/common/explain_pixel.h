// Explains one pixel: what its centre ray hits, the texel that displaces it there, and its colour.
#pragma once

#include <string>

#include "relief/intersect.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief::cli {

/// Pinhole ray through the centre of pixel (x, y); direction of unit length.
Ray make_pixel_ray(const Camera& camera, int width, int height, int x, int y);

/// Lines of object, patch, patch uv, t, position, normal, texel and colour of a pixel. Prepares the scene for
/// itself. Throws as render().
std::string explain_pixel(const Scene& scene, const RenderSettings& settings, int x, int y);

} // namespace relief::cli
