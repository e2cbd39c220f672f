// Walks through the tree of many lights. `root`: PathPush::first_light_node.
#ifndef RELIEF_LIGHT_TREE_GLSL
#define RELIEF_LIGHT_TREE_GLSL

#include "vulkan/shaders/lights.glsl"

float estimate_alone(const LightNodeData node, const LitPoint at) {
    if (node.source >= kEmitterLeaf) return estimate_node(node, at); // kNone too
    LightSourceData source = sources[node.source];
    return is_lit(source, at) ? estimate_leaf(node, source, at) : 0.0;
}

/// Of a node that is near, that of its children, which knows more.
float estimate_child(const uint node_index, const LitPoint at) {
    LightNodeData node = light_nodes[node_index];
    bool is_split = node.source == kNone && is_near(node, at);
    uint place = is_split ? node_index + 1u : node_index;
    float sum = 0.0;
    // A loop, so that the estimate is inlined only once.
    for (uint k = 0u; k < (is_split ? 2u : 1u); ++k) {
        node = light_nodes[place];
        sum += estimate_alone(node, at);
        place = node.end;
    }
    return sum;
}

/// Of the child beside its parent, and of the other.
vec2 estimate_children(const uint first, const LitPoint at) {
    vec2 estimates;
    for (uint k = 0u; k < 2u; ++k) estimates[k] = estimate_child(k == 0u ? first : light_nodes[first].end, at);
    return estimates;
}

/// Part of the draws that the tree gets.
float find_share_of_tree(const uint root, const LitPoint at, const float listed) {
    return kHasLightTree != 0u ? find_tree_share(listed, estimate_child(root, at)) : 0.0;
}

/// From each node to the child that the random number falls upon.
LightPick pick_in_tree(const uint root, const LitPoint at, float u, const float u_further) {
    uint place = root;
    float probability = 1.0;
    bool is_continued = false;
    while (light_nodes[place].source == kNone) {
        uint first = place + 1u;
        uint second = light_nodes[first].end;
        vec2 estimates = estimate_children(first, at);
        float sum = estimates.x + estimates.y;
        LightPick dark = {kNone, kNone, 0.0};
        if (!(sum > 0.0)) return dark;
        float share = estimates.x / sum;
        place = u < share ? first : second;
        probability *= place == first ? share : estimates.y / sum;
        u = place == first ? stretch_random(u, 0.0, share) : stretch_random(u, share, 1.0 - share);
        if (!is_continued && probability < kContinuedBelow) {
            is_continued = true;
            u = u_further;
        }
    }
    uint source = light_nodes[place].source;
    bool is_emitter = source >= kEmitterLeaf;
    LightPick pick = {is_emitter ? kNone : source, is_emitter ? source & ~kEmitterLeaf : kNone, probability};
    return pick;
}

/// Probability of a leaf among all of the tree: that of the ways down to it.
float find_in_tree(const uint root, const LitPoint at, const uint leaf) {
    uint place = root;
    float probability = 1.0;
    while (place != leaf) {
        uint first = place + 1u;
        uint second = light_nodes[first].end;
        vec2 estimates = estimate_children(first, at);
        float sum = estimates.x + estimates.y;
        if (!(sum > 0.0)) return 0.0;
        probability *= (leaf < second ? estimates.x : estimates.y) / sum;
        place = leaf < second ? first : second;
    }
    return probability;
}

/// One of all lights.
LightPick pick_light(const uint source_count, const uint root, const LitPoint at, const float u,
                     const float u_further) {
    float listed = total_irradiance(source_count, at);
    if (kHasLightTree == 0u) return pick_listed(source_count, at, u, listed);
    // As cpu/shading/light_choice.cpp, so that both round alike.
    float list_share = 1.0 - find_share_of_tree(root, at, listed);
    float tree_share = 1.0 - list_share;
    LightPick pick;
    if (u < tree_share)
        pick = pick_in_tree(root, at, stretch_random(u, 0.0, tree_share), u_further);
    else
        pick = pick_listed(source_count, at, stretch_random(u, tree_share, list_share), listed);
    pick.probability *= u < tree_share ? tree_share : list_share;
    return pick;
}

/// The next leaf from `place` on, before `end`, with a flag and a sphere that the ray meets; `end`: none.
uint find_leaf(uint place, const uint end, const vec3 origin, const vec3 direction, const float distance,
               const uint flag) {
    while (place < end) {
        LightNodeData node = light_nodes[place];
        bool is_met = (node.flags & flag) != 0u && may_meet(node, origin, direction, distance);
        if (is_met && node.source != kNone) return place;
        place = is_met ? place + 1u : node.end;
    }
    return end;
}

#endif
