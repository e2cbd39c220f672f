// Displaced models of the sample scenes: one map each, and base meshes that may be bent.
#pragma once

#include <functional>

#include "relief/progress.h"
#include "samples/lathe.h"
#include "samples/shapes.h"

namespace relief::samples {

struct Model {
    Displacement displacement;
    Material material;
    std::function<Mesh(const Deformation&)> make_mesh;
};

/// A squash of 800 patches: ribs, warts, cork veins, bent stem. Radius 1, low point -0.8. Object space.
Model make_pumpkin(const ProgressFunction& on_progress = {});

/// A trunk of radius 1 from y = 0 up with curled bark; the tile repeats upwards. Tangent space.
struct TrunkShape {
    int cap_cells = 10; ///< 4 times as many columns, even
    int rows = 73;
    float height = 11.5f;
};
Model make_trunk(const TrunkShape& shape, const ProgressFunction& on_progress = {});
LatheBody make_trunk_body(const TrunkShape& shape);

/// A ring of overlapping scales: a torus about the y axis, radii 1 and 0.36. Tangent space.
Model make_scale_ring(const ProgressFunction& on_progress = {});

/// A fly agaric of 696 patches, 1.35 high, standing on y = 0: warts, gills, a skirt. Tangent space.
Model make_mushroom(const ProgressFunction& on_progress = {});

/// A ball of 512 patches and radius 1 that is covered with leaning polyps. Object space.
Model make_coral(const ProgressFunction& on_progress = {});

/// An ear sculpted out of a single quad, [-1, 1]^2 in the xy plane. Tangent space.
Model make_ear(const ProgressFunction& on_progress = {});

} // namespace relief::samples
