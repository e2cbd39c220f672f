#include "samples/lathe_model.h"

#include "math/vec.h"
#include "samples/bake.h"

namespace relief::samples {

Model bake_model(const std::string& name, DisplacementSpace space, WrapMode wrap, Texels texels,
                 const std::function<MapSample(Vec2f uv)>& sample, const ProgressFunction& on_progress) {
    Maps maps = bake_maps(name, kMapSize, texels, sample, on_progress);
    Model model;
    model.displacement.name = name;
    model.displacement.space = space;
    model.displacement.wrap = wrap;
    model.displacement.tiles = {{1001, std::move(maps.displacement)}};
    model.material.name = name;
    model.material.base_color = {1, 1, 1};
    set_input_texture(model.material, MaterialInput::base_color, std::move(maps.color));
    return model;
}

Model make_lathe_model(const std::string& name, const LatheBody& body, DisplacementSpace space,
                       const std::function<Sculpture(const BodyPoint&)>& sculpt,
                       const ProgressFunction& on_progress) {
    const auto sample = [&](Vec2f uv) {
        const BodyPoint point = body.point_at_uv(uv);
        const Sculpture result = sculpt(point);
        MapSample sample{result.offset, result.color};
        if (space == DisplacementSpace::tangent) {
            const Vec3f t = body.tangent_at_uv(uv, point), b = cross(point.normal, t);
            sample.displacement = {dot(result.offset, t), dot(result.offset, b),
                                   dot(result.offset, point.normal)};
        }
        return sample;
    };
    Model model = bake_model(name, space, WrapMode::repeat, Texels::halves, sample, on_progress);
    model.make_mesh = [body, name](const Deformation& deform) { return body.make_mesh(name, deform); };
    return model;
}

} // namespace relief::samples
