// The studio of a mesh that comes alone: a key light, and a picture of an environment that holds fill, rim
// and backdrop.
#pragma once

#include <memory>
#include <optional>

#include "relief/scene.h"

namespace relief {

/// The picture, the same object at each call: what has it for its environment is in the studio. Its azimuths
/// count from the camera. From 5 degrees below the horizon to 5 above it is one colour all around, so that a
/// floor of that radiance ends nowhere.
std::shared_ptr<const Texture> get_studio();

/// Replaces environment and lights by those of the studio, placed for the scene's camera: the key light comes
/// from its upper left, the fill from its right, the rim from behind the objects. The light has no size and
/// no distance but angles, so it is the same for objects of all sizes.
void enter_studio(Scene& scene);

/// Places the light for the scene's camera; `before` is the camera that it was placed for. What is not as
/// enter_studio() left it stays as it is.
void turn_studio(Scene& scene, const Camera& before);

/// Colour of a diffuse floor without a clear surface that looks like the backdrop at the horizon wherever no
/// shadow falls on it. Nothing outside the studio, or where no colour up to 1 does.
std::optional<Vec3f> match_floor(const Scene& scene);

} // namespace relief
