#include "cpu/shading/light_choice.h"

#include "cpu/shading/textures.h"

namespace relief::cpu {

Vec3f LightChoice::fetch_color(const scalar::LightSourceData& source, const Vec3f& origin,
                               const Vec3f& direction) const {
    const Texture& texture = *tables_.textures[source.texture];
    const Vec2f size{float(texture.width), float(texture.height)};
    return max(fetch_texture(texture, scalar::find_face_uv(source, origin, direction, size)), Vec3f{});
}

float LightChoice::estimate(const scalar::LightSourceData& source, const scalar::LitPoint& at) const {
    if (!is_lit(source, at)) return 0;
    // Spares a call: estimate_irradiance() of these is their power.
    const bool is_far = source.kind == scalar::kSourceEnvironment || source.kind == scalar::kSourceSun;
    return is_far ? source.power : scalar::estimate_irradiance(source, at.position);
}

float LightChoice::total_estimate(const scalar::LitPoint& at) const {
    float total = 0;
    for (const scalar::LightSourceData& source : listed()) total += estimate(source, at);
    return total;
}

float LightChoice::estimate_child(uint32_t node_index, const scalar::LitPoint& at) const {
    const scalar::LightNodeData& node = tables_.nodes[node_index];
    if (node.source != scalar::kNone || !scalar::is_near(node, at)) return estimate_alone(node, at);
    const scalar::LightNodeData& first = tables_.nodes[node_index + 1];
    return estimate_alone(first, at) + estimate_alone(tables_.nodes[first.end], at);
}

float LightChoice::estimate_alone(const scalar::LightNodeData& node, const scalar::LitPoint& at) const {
    if (node.source >= scalar::kEmitterLeaf) return scalar::estimate_node(node, at); // kNone too
    const scalar::LightSourceData& source = tables_.sources[node.source];
    return is_lit(source, at) ? scalar::estimate_leaf(node, source, at) : 0.0f;
}

LightChoice::Shares LightChoice::find_shares(const scalar::LitPoint& at) const {
    const float listed = total_estimate(at);
    return {listed, has_tree() ? 1 - scalar::find_tree_share(listed, estimate_child(0, at)) : 1.0f};
}

float LightChoice::find_probability(const Shares& shares, const scalar::LightSourceData& source,
                                    const scalar::LitPoint& at) const {
    return shares.listed > 0 ? estimate(source, at) / shares.listed * shares.list_share : 0.0f;
}

LightChoice::Pick LightChoice::pick(const scalar::LitPoint& at, float u, float u_further) const {
    const Shares shares = find_shares(at);
    if (!has_tree()) return pick_listed(at, u, shares.listed);
    const float tree_share = 1 - shares.list_share;
    Pick pick = u < tree_share ? pick_in_tree(at, scalar::stretch_random(u, 0, tree_share), u_further)
                               : pick_listed(at, scalar::stretch_random(u, tree_share, shares.list_share),
                                             shares.listed);
    pick.probability *= u < tree_share ? tree_share : shares.list_share;
    return pick;
}

LightChoice::Pick LightChoice::pick_listed(const scalar::LitPoint& at, float u, float total) const {
    if (!(total > 0)) return {nullptr, kNoIndex, 0};
    const std::span<const scalar::LightSourceData> sources = listed();
    const float target = u * total;
    size_t picked = 0;
    float found = estimate(sources[0], at);
    for (float running = found; running <= target && picked + 1 < sources.size(); running += found)
        found = estimate(sources[++picked], at);
    return {&sources[picked], kNoIndex, found / total};
}

/// From each node to the child that the random number falls upon.
LightChoice::Pick LightChoice::pick_in_tree(const scalar::LitPoint& at, float u, float u_further) const {
    uint32_t place = 0;
    float probability = 1;
    bool is_continued = false;
    while (tables_.nodes[place].source == scalar::kNone) {
        const uint32_t first = place + 1, second = tables_.nodes[first].end;
        const float a = estimate_child(first, at), b = estimate_child(second, at), sum = a + b;
        if (!(sum > 0)) return {nullptr, kNoIndex, 0};
        const float share = a / sum;
        place = u < share ? first : second;
        probability *= place == first ? share : b / sum;
        u = place == first ? scalar::stretch_random(u, 0, share)
                           : scalar::stretch_random(u, share, 1 - share);
        if (!is_continued && probability < scalar::kContinuedBelow) is_continued = true, u = u_further;
    }
    const uint32_t source = tables_.nodes[place].source;
    if (source >= scalar::kEmitterLeaf) return {nullptr, source & ~scalar::kEmitterLeaf, probability};
    return {&tables_.sources[source], kNoIndex, probability};
}

/// Probability of a leaf among all of the tree: that of the ways down to it.
float LightChoice::find_in_tree(const scalar::LitPoint& at, uint32_t leaf) const {
    uint32_t place = 0;
    float probability = 1;
    while (place != leaf) {
        const uint32_t first = place + 1, second = tables_.nodes[first].end;
        const float a = estimate_child(first, at), b = estimate_child(second, at), sum = a + b;
        if (!(sum > 0)) return 0;
        probability *= (leaf < second ? a : b) / sum;
        place = leaf < second ? first : second;
    }
    return probability;
}

float LightChoice::find_emitter_probability(const scalar::LitPoint& at, uint32_t emitter) const {
    if (has_tree()) {
        const uint32_t leaf = tables_.leaf_of_emitter[emitter];
        return leaf == kNoIndex ? 0 : (1 - find_shares(at).list_share) * find_in_tree(at, leaf);
    }
    if (listed().empty() || listed().back().kind != scalar::kSourceEmitters) return 0;
    return estimate(listed().back(), at) / total_estimate(at);
}

size_t LightChoice::byte_count() const {
    return tables_.sources.size() * sizeof(scalar::LightSourceData) +
           tables_.nodes.size() * sizeof(scalar::LightNodeData) +
           (tables_.leaf_of_emitter.size() + tables_.link_words.size()) * sizeof(uint32_t);
}

} // namespace relief::cpu
