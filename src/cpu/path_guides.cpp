// Guides of a denoiser along the paths of a wave: those of the first vertex that is neither a mirror nor
// clear glass, or of what is behind all surfaces.
#include "cpu/tile_tracer.h"
#include "formulas/guides.h"
#include "formulas/layered_bsdf.h"
#include "formulas/shading_normal.h"

namespace relief::cpu {

/// What is behind all surfaces has its colour for an albedo; seen in a mirror it faces the path. After
/// add_backgrounds().
void TileTracer::note_sky() {
    const bool is_plain = depth_ == 0 && settings_.image.background;
    for (size_t n = 0; n < missed_.size(); ++n) {
        const uint32_t path = active_[missed_[n]];
        if (!path_lights_.looks_for_guides(path)) continue;
        const Vec3f& light = is_plain ? *settings_.image.background : backgrounds_[n].radiance;
        path_lights_.set_guides(path, scalar::find_guide_albedo(paths_[path].throughput, light),
                                depth_ > 0 ? -directions_[n] : Vec3f{});
    }
}

void TileTracer::note_guides(size_t k, const VertexLanes& lanes, size_t lane, const Vec3f& emission) {
    const auto is_set = [lane](uint32_t mask) { return (mask >> lane & 1) != 0; };
    scalar::GuideVertex vertex{get_lane(lanes.base_color, lane), emission, lanes.roughness[lane],
                               lanes.metallic[lane], is_set(lanes.has_glass)};
    if (is_set(lanes.has_layers)) {
        const auto& layers = vertex_inputs_.layers().records[lanes.layers[lane]];
        vertex.roughness = scalar::roughen_base(vertex.roughness, layers);
        vertex.metallic = lanes.layered_metallic[lane];
    }
    if (depth_ < settings_.image.bounces && scalar::is_mirror(vertex)) return;
    const uint32_t path = active_[k];
    path_lights_.set_guides(
        path, scalar::find_guide_albedo(paths_[path].throughput, scalar::find_guide_color(vertex)),
        scalar::bend_normal(get_lane(lanes.shading_normal, lane), get_lane(lanes.geometric_normal, lane),
                            -rays_[k].direction));
}

} // namespace relief::cpu
