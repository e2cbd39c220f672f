// Explains one pixel: what its centre ray hits, the texel that displaces it there, and its colour.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "relief/intersect.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief::cli {

/// Pinhole ray through the centre of pixel (x, y); direction of unit length.
Ray make_pixel_ray(const Camera& camera, int width, int height, int x, int y);

struct PixelExplanation {
    std::string text;           ///< lines
    uint32_t object = kNoIndex; ///< that the centre ray hits
    /// Ways that light may take to the pixel: corners from the camera on, world space. Beyond the first hit
    /// directions are drawn at random, as those of a matt surface; they are not those of the samples.
    std::vector<std::vector<Vec3f>> paths;
};

/// Object, patch, patch uv, t, position, normal, texel, nodes visited, trees built and colour of a pixel.
/// Prepares the scene for itself. Throws as render().
PixelExplanation explain_pixel(const Scene& scene, const RenderSettings& settings, int x, int y);

} // namespace relief::cli
