// Nodes of an FBX file in the world.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <assimp/scene.h>

#include "io/mesh/fbx_facts.h"

namespace relief {

/// World from node, by the names that prepare_fbx() gave to the nodes.
using NodePlaces = std::map<std::string, aiMatrix4x4, std::less<>>;

/// The place at which a node holds its meshes.
struct MeshPlace {
    aiMatrix4x4 world_from_mesh;
    aiMatrix4x4 node_from_mesh; ///< the geometric transform
};

struct PlacedNode {
    const aiNode* node;
    const FbxNode* facts; ///< null for the root
    MeshPlace place;
};

struct PlacedNodes {
    std::vector<PlacedNode> nodes; ///< parents before their children
    NodePlaces places;
};

/// Refers to the nodes and the facts. The importer makes a chain of a node with pivots or a geometric
/// transform, and knows neither how nodes inherit scales nor that a geometric rotation has an order of its
/// own.
PlacedNodes place_nodes(const aiNode& root, const aiMatrix4x4& world_from_file, const FbxFacts& facts);

} // namespace relief
