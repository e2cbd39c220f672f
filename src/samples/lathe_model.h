// Bakes a displacement that is given in object space over a lathe body into its atlas.
#pragma once

#include <string>

#include "samples/bake.h"
#include "samples/lathe.h"
#include "samples/models.h"

namespace relief::samples {

/// What a model does to a place of its body.
struct Sculpture {
    Vec3f offset; ///< object space
    Vec3f color;  ///< linear base colour
};

/// A model with a map of 2048 x 2048 halves and a colour texture; `sculpt` must be thread safe.
Model make_lathe_model(const std::string& name, const LatheBody& body, DisplacementSpace space,
                       const std::function<Sculpture(const BodyPoint&)>& sculpt,
                       const ProgressFunction& on_progress);

/// The same with a `Sculptor` made for the body.
template <class Sculptor>
Model make_sculpted_model(const std::string& name, const LatheShape& shape, DisplacementSpace space,
                          float roughness, const ProgressFunction& on_progress) {
    const LatheBody body(shape);
    const Sculptor sculptor(body);
    Model model = make_lathe_model(
        name, body, space, [&](const BodyPoint& p) { return sculptor.sculpt(p); }, on_progress);
    model.material.roughness = roughness;
    return model;
}

/// A displacement and a material of that name with one map each. `sample`: as of bake_maps.
Model bake_model(const std::string& name, DisplacementSpace space, WrapMode wrap, Texels texels,
                 const std::function<MapSample(Vec2f uv)>& sample, const ProgressFunction& on_progress);

/// Edge length of all maps here, texels.
inline constexpr uint32_t kMapSize = 2048;

} // namespace relief::samples
