// Chooses one among all lights of a scene: by the estimates of those that are listed, or down the tree of
// many. C++ includes this file in the body of a class, after formulas/light_tree.h and with In(Type) as const
// Type&; kernels include it as it is. It calls these functions of its includer:
// - LightSourceData load_light_source(uint), LightNodeData load_light_node(uint)
// - bool has_light_tree(): false where all lights are listed
// - bool is_lit(LightSourceData, LitPoint): whether the light lights the object that the point is on
// - float estimate_source(LightSourceData, LitPoint): about the irradiance at the point; 0 where it is not
// lit
//
// The first `listed_count` sources are listed. `root` is the number of the tree's root.
#ifndef RELIEF_LIGHT_CHOICE_H
#ifndef __cplusplus
#define RELIEF_LIGHT_CHOICE_H
#endif

/// A light source or an emissive patch that was chosen among all lights with `probability`.
struct LightPick {
    uint source;       ///< kNone: an emissive patch, or no light reaches the point
    uint emitter;      ///< number of that patch; kNone: a source, or no light reaches the point
    float probability; ///< 0: no light reaches the point
};

LightPick pick_no_light() {
    LightPick pick = {kNone, kNone, 0.0f};
    return pick;
}

/// Adds up the estimates of the lights that are listed.
float estimate_listed(const uint listed_count, In(LitPoint) at) {
    float total = 0.0f;
    for (uint k = 0u; k < listed_count; ++k) total += estimate_source(load_light_source(k), at);
    return total;
}

/// `total`: estimate_listed of the point.
LightPick pick_listed(const uint listed_count, In(LitPoint) at, const float u, const float total) {
    if (!(total > 0.0f)) return pick_no_light();
    float target = u * total;
    float running = 0.0f;
    for (uint k = 0u;; ++k) {
        float estimate = estimate_source(load_light_source(k), at);
        running += estimate;
        LightPick pick = {k, kNone, estimate / total};
        if (running > target || k + 1u >= listed_count) return pick;
    }
}

float estimate_alone(In(LightNodeData) node, In(LitPoint) at) {
    if (node.source >= kEmitterLeaf)
        return estimate_node(node, at); // also of inner nodes, whose source is kNone
    In(LightSourceData) source = load_light_source(node.source);
    return is_lit(source, at) ? estimate_leaf(node, source, at) : 0.0f;
}

/// The estimate of a node. Where that is near, the estimates of its children say more, and their sum is
/// taken.
float estimate_child(const uint node_index, In(LitPoint) at) {
    In(LightNodeData) node = load_light_node(node_index);
    bool is_split = node.source == kNone && is_near(node, at);
    uint place = is_split ? node_index + 1u : node_index;
    float sum = 0.0f;
    // A loop, so that drivers inline the estimate only once.
    for (uint k = 0u; k < (is_split ? 2u : 1u); ++k) {
        In(LightNodeData) part = load_light_node(place);
        sum += estimate_alone(part, at);
        place = part.end;
    }
    return sum;
}

/// Estimates both children of a node. `first` is the number of the first one.
Vec2 estimate_children(const uint first, In(LitPoint) at) {
    Vec2 estimates = {0.0f, 0.0f};
    for (uint k = 0u; k < 2u; ++k) {
        float estimate = estimate_child(k == 0u ? first : load_light_node(first).end, at);
        if (k == 0u)
            estimates.x = estimate;
        else
            estimates.y = estimate;
    }
    return estimates;
}

/// The part of the draws that the listed lights get. The tree gets the rest.
float find_list_share(const uint root, In(LitPoint) at, const float listed) {
    return has_light_tree() ? 1.0f - find_tree_share(listed, estimate_child(root, at)) : 1.0f;
}

/// Goes from each node to the child that the random number falls upon.
LightPick pick_in_tree(const uint root, In(LitPoint) at, float u, const float u_further) {
    uint place = root;
    float probability = 1.0f;
    bool is_continued = false;
    while (load_light_node(place).source == kNone) {
        uint first = place + 1u;
        uint second = load_light_node(first).end;
        Vec2 estimates = estimate_children(first, at);
        float sum = estimates.x + estimates.y;
        if (!(sum > 0.0f)) return pick_no_light();
        float share = estimates.x / sum;
        place = u < share ? first : second;
        probability *= place == first ? share : estimates.y / sum;
        u = place == first ? stretch_random(u, 0.0f, share) : stretch_random(u, share, 1.0f - share);
        if (!is_continued && probability < kContinuedBelow) {
            is_continued = true;
            u = u_further;
        }
    }
    uint source = load_light_node(place).source;
    bool is_emitter = source >= kEmitterLeaf;
    LightPick pick = {is_emitter ? kNone : source, is_emitter ? source & ~kEmitterLeaf : kNone, probability};
    return pick;
}

/// The probability of a leaf among all leaves of the tree: the product of those of the steps down to it.
float find_in_tree(const uint root, In(LitPoint) at, const uint leaf) {
    uint place = root;
    float probability = 1.0f;
    while (place != leaf) {
        uint first = place + 1u;
        uint second = load_light_node(first).end;
        Vec2 estimates = estimate_children(first, at);
        float sum = estimates.x + estimates.y;
        if (!(sum > 0.0f)) return 0.0f;
        probability *= (leaf < second ? estimates.x : estimates.y) / sum;
        place = leaf < second ? first : second;
    }
    return probability;
}

/// Draws one of all lights. `u_further` is a second random number, for choices of which `u` has too few
/// digits.
LightPick pick_light(const uint listed_count, const uint root, In(LitPoint) at, const float u,
                     const float u_further) {
    float listed = estimate_listed(listed_count, at);
    if (!has_light_tree()) return pick_listed(listed_count, at, u, listed);
    float list_share = find_list_share(root, at, listed);
    float tree_share = 1.0f - list_share;
    LightPick pick;
    if (u < tree_share)
        pick = pick_in_tree(root, at, stretch_random(u, 0.0f, tree_share), u_further);
    else
        pick = pick_listed(listed_count, at, stretch_random(u, tree_share, list_share), listed);
    pick.probability *= u < tree_share ? tree_share : list_share;
    return pick;
}

/// The probability of an emissive patch; without a tree, of all of them together. `leaf`: its leaf in the
/// tree; kNone: none.
float find_emitter_probability(const uint listed_count, const uint root, In(LitPoint) at, const uint leaf) {
    if (has_light_tree()) {
        if (leaf == kNone) return 0.0f;
        float list_share = find_list_share(root, at, estimate_listed(listed_count, at));
        return (1.0f - list_share) * find_in_tree(root, at, leaf);
    }
    if (listed_count == 0u || load_light_source(listed_count - 1u).kind != kSourceEmitters) return 0.0f;
    return estimate_source(load_light_source(listed_count - 1u), at) / estimate_listed(listed_count, at);
}

/// The next leaf from `place` on, before `end`, with a flag and a sphere that the ray meets; `end`: none.
uint find_leaf(uint place, const uint end, const Vec3 origin, const Vec3 direction, const float distance,
               const uint flag) {
    while (place < end) {
        In(LightNodeData) node = load_light_node(place);
        bool is_met = (node.flags & flag) != 0u && may_meet(node, origin, direction, distance);
        if (is_met && node.source != kNone) return place;
        place = is_met ? place + 1u : node.end;
    }
    return end;
}

#endif
