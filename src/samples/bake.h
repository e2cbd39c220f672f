// Turns a formula over the unit square of uv into a displacement map and a colour texture.
#pragma once

#include <functional>
#include <memory>

#include "relief/progress.h"
#include "relief/scene.h"

namespace relief::samples {

/// What a map holds at one uv.
struct MapSample {
    Vec3f displacement; ///< in the map's channels
    Vec3f color;        ///< linear base colour, each in [0, 1]
};

struct Maps {
    std::shared_ptr<const Texture> displacement; ///< size x size
    std::shared_ptr<const Texture> color;        ///< half as wide and high, halves
};

enum class Texels { halves, floats };

/// `sample` (thread safe) at every texel centre of a square map, row 0 at v = 1; colour: means of four.
Maps bake_maps(const std::string& name, uint32_t size, Texels texels,
               const std::function<MapSample(Vec2f uv)>& sample, const ProgressFunction& on_progress = {});

} // namespace relief::samples
