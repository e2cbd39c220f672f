// The tree over many lights that engines choose from (formulas/light_tree.h).
#pragma once

#include <cstdint>
#include <vector>

#include "formulas/light_tree.h"
#include "math/box.h"

namespace relief {

/// The ways in which lights face, within `spread` of an axis, and how far from those they shine; radians.
struct LightCone {
    Vec3f axis{0, 0, 1};
    double spread = 0; ///< [0, pi]; pi: every way
    double reach = 0;  ///< [0, pi / 2]
};

/// One light, or one emissive patch.
struct LightLeaf {
    Box box;
    LightCone cone;
    float power = 0;     ///< > 0
    uint32_t source = 0; ///< as LightNodeData::source
    uint32_t flags = 0;
};

/// A cone about two others.
LightCone join_cones(const LightCone& a, const LightCone& b);

/// All leaves, whose order changes, under one root, the first node. Empty without leaves.
std::vector<scalar::LightNodeData> make_light_tree(std::vector<LightLeaf> leaves);

} // namespace relief
