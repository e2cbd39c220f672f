// Where a camera stands so that the objects of a scene fill the picture.
#pragma once

#include "math/box.h"
#include "relief/aim.h"

namespace relief {

/// Bounds of the displaced surfaces in the world, from samples; empty without objects.
Box measure_scene(const Scene& scene);

/// From the middle of the objects to the camera, a unit vector. A body that is longer along z than across is
/// taken for an animal or a vehicle: its front is the end where its higher parts are; all others face +z.
Vec3f choose_view(const Scene& scene, View view);

/// What stays in the picture: the objects as seen, or through a whole turn about the camera's up axis.
enum class Framing { still, turn };

/// `camera` looking along -`view`, near enough for the objects to take about 85 % of the picture's height or
/// of the width of its middle square; `aspect` is width / height. The displacement counts in coarse steps, so
/// that one relief in two encodings has one camera. Sets position, target and focus distance.
Camera frame_scene(const Scene& scene, Camera camera, const Vec3f& view, float aspect, Framing framing);

} // namespace relief
