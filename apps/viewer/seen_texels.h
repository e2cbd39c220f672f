// Which texels of a map a picture shows near a point.
#pragma once

#include <vector>

#include "viewer/surface_point.h"

namespace relief::viewer {

/// The texel that a pixel shows.
struct SeenTexel {
    int udim = 1001;
    float column = 0, row = 0; ///< texels, from the corner of the tile
    Vec3f position{};          ///< that the pixel shows, world
};

/// One per pixel of the object within `radius`, world units, of `centre`. Of tiles that the map lacks: none.
std::vector<SeenTexel> find_seen_texels(const Scene& scene, const ShownPicture& picture,
                                        const SurfacePoint& centre, float radius);

/// Width of a pixel of the shown picture at the centre, world units.
float find_pixel_width(const ShownPicture& picture, const SurfacePoint& centre);

} // namespace relief::viewer
