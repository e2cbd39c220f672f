// Choice among many lights: a binary tree over them, whose nodes know how much light may come from below them
// (Conty Estevez and Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree Splitting).
#ifndef RELIEF_LIGHT_TREE_H
#define RELIEF_LIGHT_TREE_H
#include "formulas/constants.h"
#include "formulas/light_source.h"

#include "formulas/begin.h"

/// Of LightNodeData::source: the rest is the number of an emissive patch.
const uint kEmitterLeaf = 0x80000000u;
// Bits of LightNodeData::flags.
const uint kCanBeMet = 1u;  ///< some light below is of the scene's list and has an extent that rays meet
const uint kCanBeSeen = 2u; ///< the same of lights that camera rays see

/// Nodes stand in depth-first order: the first child follows its parent, the second follows all that is below
/// the first. Members of 4 bytes, the same in device memory.
struct LightNodeData {
    Vec3 center; ///< of a sphere about all lights below
    float radius;
    Vec3 axis;                        ///< lights below face ways within a cone about it, ...
    float spread_cosine, spread_sine; ///< ... whose half angle is at most a half turn, ...
    float reach_cosine; ///< ... and shine within this angle of the way that they face, at most a right one
    float power;        ///< luminance of their radiant intensity; of emitters: of radiance times area
    uint source;        ///< of a leaf: a light source, or an emissive patch; kNone: an inner node
    uint end;           ///< the node behind all below this one
    uint flags;
};

/// What is lit.
struct LitPoint {
    Vec3 position;
    Vec3 normal;   ///< geometric, of the side that is seen
    uint instance; ///< that it is on
};

/// Least factor of a cosine. Estimates are rather too large than zero: what is wrong with them costs samples,
/// while a light that is never drawn would be missing.
const float kLeastCosine = 0.015625f;

/// Part of the draws that lights in the tree get at least where they give any light: beside the sun a light
/// nearby is underestimated by a tree that spans a town.
const float kLeastTreeShare = 0.25f;

/// A choice down the tree that is less likely than this goes on with another random number: little is left of
/// the digits of the first.
const float kContinuedBelow = 0.000244140625f;

/// Cosine of what is left of the angle with `cosine` and `sine` that a cone of half angle `cone` takes from
/// it; 1: nothing.
FN float shrink_angle(const float cosine, const float sine, const float cone_cosine, const float cone_sine) {
    return cosine >= cone_cosine ? 1.0f : cosine * cone_cosine + sine * cone_sine;
}

/// Bound of the cosine, at the point, of light from anywhere in a sphere that looks as large as a cone.
FN float bound_received(const Vec3 normal, const Vec3 direction, const float cone_cosine,
                        const float cone_sine) {
    float cosine = dot(normal, direction);
    float sine = length(cross(normal, direction));
    return max(shrink_angle(cosine, sine, cone_cosine, cone_sine), kLeastCosine);
}

/// Bound of the part of their strength that lights below a node send against `direction`, in which a point
/// sees the node's sphere as large as a cone; 0 where all of them are dark.
FN float bound_sent(In(LightNodeData) node, const Vec3 direction, const float cone_cosine,
                    const float cone_sine) {
    float cosine = -dot(node.axis, direction);
    float sine = length(cross(node.axis, direction));
    bool is_spread = cosine >= node.spread_cosine;
    float left = shrink_angle(cosine, sine, node.spread_cosine, node.spread_sine);
    float left_sine = is_spread ? 0.0f : sine * node.spread_cosine - cosine * node.spread_sine;
    float least = shrink_angle(left, left_sine, cone_cosine, cone_sine);
    return least < node.reach_cosine ? 0.0f : max(least, kLeastCosine);
}

/// About the irradiance at a point from the lights below an inner node, or from an emissive patch.
FN float estimate_node(In(LightNodeData) node, In(LitPoint) at) {
    Vec3 to = node.center - at.position;
    float distance = length(to);
    // About the mean over lights all over the sphere, from inside.
    float inner2 = 0.25f * node.radius * node.radius;
    if (!(distance > node.radius)) return node.power / max(max(distance * distance, inner2), 1e-30f);
    Vec3 direction = to / distance;
    float sine = node.radius / distance;
    float cosine = sqrt(max((1.0f - sine) * (1.0f + sine), 0.0f));
    float sent = bound_sent(node, direction, cosine, sine);
    float received = bound_received(at.normal, direction, cosine, sine);
    return node.power * sent * received / max(distance * distance, 1e-30f);
}

/// Whether the estimates of both children of an inner node say much more than its own.
FN bool is_near(In(LightNodeData) node, In(LitPoint) at) {
    Vec3 to = node.center - at.position;
    return dot(to, to) < 4.0f * node.radius * node.radius;
}

/// The same of a leaf that is a light of the scene's list.
FN float estimate_leaf(In(LightNodeData) node, In(LightSourceData) source, In(LitPoint) at) {
    Vec3 to = node.center - at.position;
    float distance = length(to);
    float estimate = estimate_irradiance(source, at.position);
    if (!(distance > node.radius)) return estimate;
    float sine = node.radius / distance;
    float cosine = sqrt(max((1.0f - sine) * (1.0f + sine), 0.0f));
    return estimate * bound_received(at.normal, to / distance, cosine, sine);
}

/// Part of the draws that the tree gets beside lights that are listed, by the estimates of both.
FN float find_tree_share(const float listed, const float tree) {
    if (!(tree > 0.0f)) return 0.0f;
    return listed > 0.0f ? max(tree / (tree + listed), kLeastTreeShare) : 1.0f;
}

/// What is left of a random number in [0, 1) that fell into an interval: again uniform in [0, 1).
FN float stretch_random(const float u, const float low, const float width) {
    return clamp((u - low) / width, 0.0f, 0.99999994f);
}

/// Whether a ray may come within `distance` to a light below the node.
FN bool may_meet(In(LightNodeData) node, const Vec3 origin, const Vec3 direction, const float distance) {
    Vec3 to = node.center - origin;
    float along = dot(to, direction);
    Vec3 across = to - direction * along;
    // The difference has lost digits where the node is far away.
    float reach = node.radius + 4e-6f * length(to);
    return dot(across, across) <= reach * reach && along >= -reach && along - reach <= distance;
}

#include "formulas/end.h"
#endif
