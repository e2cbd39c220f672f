// How a picture of a sky is turned and scaled to light an object that comes alone.
#pragma once

#include "relief/image.h"
#include "relief/types.h"

namespace relief {

struct SkyPlacement {
    float rotate_degrees = 0;
    float strength = 1;
};

/// Turns the sky so that a surface that faces the camera from its left and above receives the most light of
/// all turns, and scales it so that the brightest white diffuse surface that the camera can see has
/// radiance 1. `view` points from the object to the camera, a unit vector. Strength 1 for a black picture.
SkyPlacement place_sky(const Texture& texture, const Vec3f& view);

} // namespace relief
