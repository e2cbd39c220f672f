// Facts of an FBX file that its importer leaves out or gets wrong.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh/fbx_document.h"
#include "relief/types.h"

namespace relief {

/// A crease between two points of a mesh, or at one point where both are equal.
struct FbxCrease {
    Vec3f first, second; ///< in the space of the mesh, not bent
    float sharpness = 0; ///< as Crease::sharpness
};

/// Whether the scale of the parent is applied before the rotation of a node, as in every other format, or
/// behind it, or not at all.
enum class FbxInherit { behind_rotation, before_rotation, no_scale };

struct FbxNode {
    std::string name;
    FbxInherit inherit = FbxInherit::before_rotation;
    bool is_hidden = false;                     ///< itself, or by a node above it
    std::array<double, 3> geometric_rotation{}; ///< degrees around x, y and z, in this order
    std::vector<FbxCrease> creases;             ///< of its meshes
};

struct FbxFacts {
    std::vector<FbxNode> nodes;
    /// For each channel of blend shapes the weights of its shapes.
    std::vector<std::vector<float>> channel_weights;
    std::vector<std::string> surfaces; ///< names of nodes whose surface is none of polygons
    std::vector<std::string> warnings;

    /// Find a node or a channel by the name that prepare_fbx() gave to it. They return null for other names.
    const FbxNode* find_node(std::string_view name) const;
    const std::vector<float>* find_channel(std::string_view name) const;
};

/// Collects the facts, and changes the document for the importer: nodes, channels and shapes get names that
/// find_node() and find_channel() know, and rotations that are not active are taken away.
FbxFacts prepare_fbx(FbxDocument& document);

} // namespace relief
