// What lies under a pixel of a picture, from its layers: no ray is traced.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "relief/scene.h"
#include "viewer/render_loop.h"

namespace relief::viewer {

/// Layers that pictures of the viewer have.
inline constexpr const char* kViewerLayers[] = {"depth", "N", "P", "uv", "id", "cost", "samples"};

struct SurfacePoint {
    uint32_t object = 0;
    Vec3f position{}, normal{}; ///< world
    Vec2f uv{};                 ///< within its tile
    float pixel_size = 0;       ///< scene units a pixel of the whole picture, at that distance
    float distance = 0;         ///< from the camera, along its axis
};

/// (x, y) in pixels of the whole picture. Nothing where the pixel shows no surface or lies outside.
std::optional<SurfacePoint> find_surface_point(const ShownPicture& picture, float x, float y);

/// Where a line of the world lies in a picture of so many pixels, as far as it is before the camera; nothing:
/// it is behind.
std::optional<std::pair<Vec2f, Vec2f>> project_line(const Camera& camera, const Vec3f& a, const Vec3f& b,
                                                    int width, int height);

/// The tile that a point's uv is in; 1001 for a map without tiles. Where several faces are around the uv, the
/// place that is nearest to the position counts.
int find_udim(const Scene& scene, const SurfacePoint& point);

} // namespace relief::viewer
