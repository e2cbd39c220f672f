#include "cpu/shading/light_choice.h"

#include "cpu/shading/textures.h"

namespace relief::cpu {

Vec3f LightChoice::fetch_color(const scalar::LightSourceData& source, const Vec3f& origin,
                               const Vec3f& direction) const {
    const Texture& texture = *tables_.textures[source.texture];
    const Vec2f size{float(texture.width), float(texture.height)};
    return max(fetch_texture(texture, scalar::find_face_uv(source, origin, direction, size)), Vec3f{});
}

LightChoice::Shares LightChoice::find_shares(const scalar::LitPoint& at) const {
    const float listed = chooser().estimate_listed(tables_.listed_count, at);
    return {listed, chooser().find_list_share(kRoot, at, listed)};
}

float LightChoice::find_probability(const Shares& shares, const scalar::LightSourceData& source,
                                    const scalar::LitPoint& at) const {
    return shares.listed > 0 ? chooser().estimate_source(source, at) / shares.listed * shares.list_share
                             : 0.0f;
}

LightChoice::Pick LightChoice::pick(const scalar::LitPoint& at, float u, float u_further) const {
    const auto found = chooser().pick_light(tables_.listed_count, kRoot, at, u, u_further);
    return {found.source == scalar::kNone ? nullptr : &tables_.sources[found.source], found.emitter,
            found.probability};
}

float LightChoice::find_emitter_probability(const scalar::LitPoint& at, uint32_t emitter) const {
    const uint32_t leaf = has_tree() ? tables_.leaf_of_emitter[emitter] : scalar::kNone;
    return chooser().find_emitter_probability(tables_.listed_count, kRoot, at, leaf);
}

size_t LightChoice::byte_count() const {
    return tables_.sources.size() * sizeof(scalar::LightSourceData) +
           tables_.nodes.size() * sizeof(scalar::LightNodeData) +
           (tables_.leaf_of_emitter.size() + tables_.link_words.size()) * sizeof(uint32_t);
}

} // namespace relief::cpu
